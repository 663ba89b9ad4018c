//! The nearest points of two surfaces, among all.
//!
//! The first surface is cut into patches around points of it. The distance of a point from the
//! second body is that of a point from a meridian, negative inside, and it changes by no more than
//! the way gone. So most patches cannot hold the nearest point, on any shape, convex or not. From
//! points of the other patches the distance is minimised by a Newton method.

use std::collections::BinaryHeap;
use std::f64::consts::{PI, TAU};

use nalgebra::Point3;

use super::descent::{Pair, STEPS, descend};
use super::least_first::{Bounded, LeastFirst};
use super::meridian::Located;

/// Size of the smallest patches, over the bounding sphere's radius.
const FINEST: f64 = 0.02;
/// Most patches looked at for a pair.
const MOST_PATCHES: usize = 200_000;
/// Most starts of the minimisation.
const MOST_STARTS: usize = 12;

/// What the search finds.
pub(super) enum Nearest {
    /// A point of the first surface that is inside the second body; the search ends there.
    Crossing(Point3<f64>),
    /// The nearest points.
    Points(Pair),
    /// Nothing within reach.
    Nothing,
}

/// A part of the first surface.
#[derive(Clone, Copy)]
struct Patch {
    /// No point of it is nearer to the second body than this.
    lower: f64,
    /// The distance of its middle, on the polygon.
    distance: f64,
    middle: Point3<f64>,
    /// Ends along the meridian's polygon.
    length: [f64; 2],
    azimuth: [f64; 2],
    /// How far its points are from the middle, by way of the meridian and by way of the azimuth.
    extent: [f64; 2],
}

impl Patch {
    fn new(first: &Located<'_>, second: &Located<'_>, length: [f64; 2], azimuth: [f64; 2]) -> Self {
        let (middle, r) = first.at(
            0.5 * (length[0] + length[1]),
            0.5 * (azimuth[0] + azimuth[1]),
        );
        let distance = second.coarse(middle);
        let along = 0.5 * (length[1] - length[0]);
        let around = 2.0 * r * (0.25 * (azimuth[1] - azimuth[0])).min(0.5 * PI).sin();
        Self {
            lower: distance - along - around - first.slack() - second.slack(),
            distance,
            middle,
            length,
            azimuth,
            extent: [along, around],
        }
    }

    /// Whether it is small enough, or the two directions in which it is to be cut.
    fn cut(&self, finest: [f64; 2]) -> [bool; 2] {
        let wide = self.azimuth[1] - self.azimuth[0] > 0.26 * PI;
        let along = self.extent[0] > finest[0];
        let around = self.extent[1] > finest[1] || wide;
        [along, around]
    }
}

impl Bounded for Patch {
    fn lower(&self) -> f64 {
        self.lower
    }
}

/// The points of the two surfaces that are nearest to each other, if within `reach`.
pub(super) fn nearest(first: &Located<'_>, second: &Located<'_>, reach: f64) -> Nearest {
    let radius = first.radius();
    let slack = first.slack() + second.slack();
    let mut heap = BinaryHeap::new();
    for k in 0..8 {
        for m in 0..8 {
            let part = |total: f64, k: usize| total * k as f64 / 8.0;
            let length = [part(first.length(), k), part(first.length(), k + 1)];
            let azimuth = [part(TAU, m), part(TAU, m + 1)];
            heap.push(LeastFirst(Patch::new(first, second, length, azimuth)));
        }
    }
    let mut looked = heap.len();
    let mut best = f64::INFINITY;
    for LeastFirst(patch) in &heap {
        best = best.min(patch.distance);
    }
    let finest = [
        (FINEST * radius).min(first.length() / 64.0),
        FINEST * radius,
    ];
    let mut leaves: Vec<Patch> = Vec::new();
    while let Some(LeastFirst(patch)) = heap.pop() {
        // Of patches that cannot hold the nearest point, none is left that can.
        if patch.lower > reach.min(best + slack) {
            break;
        }
        if patch.distance < -2.0 * slack {
            return Nearest::Crossing(patch.middle);
        }
        // Far from the second body patches need not be small to tell where its nearest point is.
        let enough = finest.map(|finest| finest.max(0.2 * best.min(radius)));
        let [along, around] = patch.cut([enough[0].min(first.length() / 64.0), enough[1]]);
        if !(along || around) || looked >= MOST_PATCHES {
            leaves.push(patch);
            continue;
        }
        let halves = |[a, b]: [f64; 2]| [[a, 0.5 * (a + b)], [0.5 * (a + b), b]];
        let mut push = |length, azimuth| {
            let patch = Patch::new(first, second, length, azimuth);
            best = best.min(patch.distance);
            looked += 1;
            heap.push(LeastFirst(patch));
        };
        if along && (!around || patch.extent[0] >= patch.extent[1]) {
            for length in halves(patch.length) {
                push(length, patch.azimuth);
            }
        } else {
            for azimuth in halves(patch.azimuth) {
                push(patch.length, azimuth);
            }
        }
    }

    descended(first, second, leaves)
        .filter(|pair| pair.distance() <= reach)
        .map_or(Nearest::Nothing, Nearest::Points)
}

/// The nearest pair to which the minimisation leads from the middles of `leaves`.
fn descended(first: &Located<'_>, second: &Located<'_>, mut leaves: Vec<Patch>) -> Option<Pair> {
    leaves.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let mut starts = 0;
    let mut nearest: Option<Pair> = None;
    for (k, leaf) in leaves.iter().enumerate() {
        let so_far = nearest.map_or(f64::INFINITY, |pair| pair.distance());
        if starts >= MOST_STARTS || leaf.lower > so_far {
            continue;
        }
        // Leaves beside a nearer one lead to where that one does.
        let beside = 3.0 * (leaf.extent[0] + leaf.extent[1]);
        let near = |other: &Patch| (other.middle - leaf.middle).norm() <= beside;
        if leaves[..k].iter().any(near) {
            continue;
        }
        starts += 1;
        let found = descend(first, second, leaf.middle, STEPS);
        if found.distance() < so_far {
            nearest = Some(found);
        }
    }
    nearest
}
