//! How far apart bodies are, and whether they touch or overlap.
//!
//! Pairs that may be near are found by their bounding spheres. Of a pair, the surface of the smaller body is cut into patches around
//! points of it; the distance from the larger body is that of a point from a meridian, negative inside, and changes by no more than the
//! way gone. So most patches are ruled out, on any shape, convex or not; from points in those that are left the distance is
//! minimised by a Newton method. Bodies with disjoint surfaces are one inside the other or not: one point tells.

use std::collections::BinaryHeap;
use std::f64::consts::{PI, TAU};

use nalgebra::Point3;
use rayon::prelude::*;
use thiserror::Error;

use super::descent::{Pair, descend};
use super::meridian::{Located, Shape};
use crate::curve::{CurveError, GeneratingCurve};
use crate::frame::Frame;
use crate::neighbours::{Ball, Neighbours};

/// Distance, in units of the larger body's size, up to which bodies touch: rounding of their coordinates.
pub const TOUCHING: f64 = 1e-12;

/// Size of the smallest patches, over the bounding sphere's radius.
const FINEST: f64 = 0.02;
/// Most patches looked at for a pair.
const MOST_PATCHES: usize = 200_000;
/// Most starts of the minimisation.
const MOST_STARTS: usize = 12;

/// A body in the laboratory.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// The generating curve.
    pub curve: &'a dyn GeneratingCurve,
    /// Where it is, and how large.
    pub frame: Frame,
    /// Distance from this body up to which others are of interest; for a pair the larger one of the two counts.
    pub reach: f64,
}

/// How two bodies lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// They are disjoint.
    Apart,
    /// They are no farther apart than [`TOUCHING`].
    Touching,
    /// Their surfaces cross.
    Overlapping,
    /// The body with this index is inside the other one.
    Inside(usize),
}

/// Two bodies that are near each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The bodies' indices, the smaller one first.
    pub bodies: [usize; 2],
    /// Distance of the surfaces of bodies that are [apart](Relation::Apart); of bodies that overlap or are one in the other, minus the depth
    /// of some point of one below the surface of the other, not the greatest.
    pub distance: f64,
    /// The points of the bodies that are so far apart, in the laboratory.
    pub points: [Point3<f64>; 2],
    /// How they lie.
    pub relation: Relation,
}

/// What is wrong with the places of bodies; they are named by their index, from 0.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactError {
    /// A generating curve that is not one.
    #[error("body {body}: {source}")]
    Curve {
        /// The first body with it.
        body: usize,
        /// What is wrong with it.
        source: CurveError,
    },
    /// A number out of range.
    #[error("body {body}: {quantity} must be {expected}, got {value}")]
    Place {
        /// The body.
        body: usize,
        /// Which number.
        quantity: &'static str,
        /// What is accepted.
        expected: &'static str,
        /// What was given.
        value: f64,
    },
    /// Bodies that touch.
    #[error("bodies {first} and {second} touch, but must be apart")]
    Touch {
        /// One.
        first: usize,
        /// The other.
        second: usize,
    },
    /// Bodies that overlap.
    #[error("bodies {first} and {second} overlap by {depth:.3e} or more, but must be apart")]
    Overlap {
        /// One.
        first: usize,
        /// The other.
        second: usize,
        /// How deep a point of one is in the other.
        depth: f64,
    },
    /// A body inside another.
    #[error("body {inner} is inside body {outer}, but must be apart from it")]
    Inside {
        /// The one inside.
        inner: usize,
        /// The one around it.
        outer: usize,
    },
    /// Bodies that are too near each other.
    #[error("bodies {first} and {second} are {distance:.3e} apart, but must be {needed:.3e}")]
    Near {
        /// One.
        first: usize,
        /// The other.
        second: usize,
        /// Their distance.
        distance: f64,
        /// What is needed.
        needed: f64,
    },
}

impl Gap {
    /// Refuses bodies that are not apart, or nearer than `needed`.
    ///
    /// # Errors
    /// How they lie, if so.
    pub fn check(&self, needed: f64) -> Result<(), ContactError> {
        let [first, second] = self.bodies;
        match self.relation {
            Relation::Apart if self.distance >= needed => Ok(()),
            Relation::Apart => Err(ContactError::Near {
                first,
                second,
                distance: self.distance,
                needed,
            }),
            Relation::Touching => Err(ContactError::Touch { first, second }),
            Relation::Overlapping => Err(ContactError::Overlap {
                first,
                second,
                depth: -self.distance,
            }),
            Relation::Inside(inner) => Err(ContactError::Inside {
                inner,
                outer: first + second - inner,
            }),
        }
    }
}

/// The pairs of bodies whose gap is within reach, those that touch or overlap among them; in the order of their indices.
///
/// Distances are good to about 1e-13 of the bodies' sizes, and of their coordinates. Bodies with the same curve in memory share what is prepared.
///
/// # Errors
/// Curves with a point or tangent that is not finite or a tangent that vanishes; places that are not finite, scales that are not positive, reaches that
/// are negative.
pub fn gaps(bodies: &[Placed<'_>]) -> Result<Vec<Gap>, ContactError> {
    let mut shapes: Vec<Shape<'_>> = Vec::new();
    let mut known = std::collections::HashMap::new();
    let mut which = Vec::with_capacity(bodies.len());
    for (body, placed) in bodies.iter().enumerate() {
        validate(body, placed)?;
        // The type's table belongs to the key: curves without fields may share an address.
        let shape = match known.get(&std::ptr::from_ref(placed.curve)) {
            Some(&shape) => shape,
            None => {
                let shape = Shape::new(placed.curve)
                    .map_err(|source| ContactError::Curve { body, source })?;
                shapes.push(shape);
                known.insert(std::ptr::from_ref(placed.curve), shapes.len() - 1);
                shapes.len() - 1
            }
        };
        which.push(shape);
    }
    let located: Vec<_> = bodies
        .iter()
        .zip(&which)
        .map(|(placed, &shape)| Located {
            shape: &shapes[shape],
            frame: placed.frame.scaled(1.0),
            scale: placed.frame.scale(),
        })
        .collect();
    let reach = |i: usize, j: usize| bodies[i].reach.max(bodies[j].reach);
    let near = candidates(&located, |i| bodies[i].reach);
    let found = near
        .par_iter()
        .filter_map(|&[i, j]| gap(&located, [i, j], reach(i, j)));
    Ok(found.collect())
}

fn validate(body: usize, placed: &Placed<'_>) -> Result<(), ContactError> {
    let bad = |quantity, expected, value| ContactError::Place {
        body,
        quantity,
        expected,
        value,
    };
    let scale = placed.frame.scale();
    if !(scale > 0.0 && scale.is_finite()) {
        return Err(bad("the scale", "a positive number", scale));
    }
    if !(placed.reach >= 0.0 && placed.reach.is_finite()) {
        return Err(bad("the reach", "zero or a positive length", placed.reach));
    }
    for direction in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
        let image = placed.frame.point_to_lab(Point3::from(direction));
        if let Some(&value) = image.iter().find(|x| !x.is_finite()) {
            return Err(bad("every coordinate of the frame", "finite", value));
        }
    }
    Ok(())
}

/// Pairs whose bounding spheres are within reach, in order.
fn candidates(bodies: &[Located<'_>], reach: impl Fn(usize) -> f64) -> Vec<[usize; 2]> {
    let balls = bodies.iter().map(|body| Ball {
        center: body.center(),
        radius: body.radius(),
    });
    let neighbours = Neighbours::new(balls);
    let near = neighbours.balls().iter().enumerate().flat_map(|(i, ball)| {
        let touching = neighbours.touching(ball.grown(reach(i))).into_iter();
        touching
            .filter(move |&j| j != i)
            .map(move |j| [i.min(j), i.max(j)])
    });
    let mut pairs: Vec<[usize; 2]> = near.collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
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

impl PartialEq for Patch {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Patch {}

impl PartialOrd for Patch {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Patch {
    /// The one that may be nearest is the greatest.
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        other.lower.total_cmp(&self.lower)
    }
}

/// The gap of two bodies, if it is within reach.
fn gap(bodies: &[Located<'_>], pair: [usize; 2], reach: f64) -> Option<Gap> {
    // The smaller one's surface is cut into patches.
    let swap = bodies[pair[0]].radius() > bodies[pair[1]].radius();
    let [i, j] = if swap { [pair[1], pair[0]] } else { pair };
    let (first, second) = (&bodies[i], &bodies[j]);
    let coordinates = first
        .center()
        .coords
        .amax()
        .max(second.center().coords.amax());
    let touching = TOUCHING * second.radius() + 4.0 * f64::EPSILON * coordinates;
    let reach = reach.max(touching);
    let gap = |distance: f64, points: [Point3<f64>; 2], relation| Gap {
        bodies: pair,
        distance,
        points: if swap { [points[1], points[0]] } else { points },
        relation,
    };

    let on_second = second.at(0.0, 0.0).0;
    let foot = first.foot(on_second);
    let (center, radius) = (first.center(), first.radius());
    let outside = (on_second - center).norm() > radius || foot.distance > 0.0;

    let slack = first.slack() + second.slack();
    let mut heap = BinaryHeap::new();
    for k in 0..8 {
        for m in 0..8 {
            let part = |total: f64, k: usize| total * k as f64 / 8.0;
            let length = [part(first.length(), k), part(first.length(), k + 1)];
            heap.push(Patch::new(
                first,
                second,
                length,
                [part(TAU, m), part(TAU, m + 1)],
            ));
        }
    }
    let mut looked = heap.len();
    let mut best = heap.iter().fold(f64::INFINITY, |m, p| m.min(p.distance));
    let finest = [
        (FINEST * radius).min(first.length() / 64.0),
        FINEST * radius,
    ];
    let mut leaves: Vec<Patch> = Vec::new();
    let crossing = |at: Point3<f64>| {
        let on_first = first.foot(at);
        let on_second = second.foot(on_first.point);
        let inside = (0..32 * 16).all(|k| {
            let length = first.length() * ((k / 16) as f64 + 0.5) / 32.0;
            second.coarse(first.at(length, TAU * (k % 16) as f64 / 16.0).0) < 0.0
        });
        let relation = if inside {
            Relation::Inside(i)
        } else {
            Relation::Overlapping
        };
        gap(
            on_second.distance,
            [on_first.point, on_second.point],
            relation,
        )
    };
    while let Some(patch) = heap.pop() {
        // Of patches that cannot hold the nearest point, none is left that can.
        if patch.lower > reach.min(best + slack) {
            break;
        }
        if patch.distance < -2.0 * slack {
            return Some(crossing(patch.middle));
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
            heap.push(patch);
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
        let found = descend(first, second, leaf.middle);
        if found.distance() < so_far {
            nearest = Some(found);
        }
    }
    let within = nearest.filter(|pair| pair.distance() <= reach);
    if let Some(pair) = within.filter(|pair| pair.distance() < -touching) {
        return Some(crossing(pair.on_first.point));
    }
    if !outside && within.is_none_or(|pair| pair.distance() > touching) {
        return Some(gap(
            foot.distance,
            [foot.point, on_second],
            Relation::Inside(j),
        ));
    }
    within.map(|pair| {
        let relation = if pair.distance() <= touching {
            Relation::Touching
        } else {
            Relation::Apart
        };
        gap(
            pair.distance(),
            [pair.on_first.point, pair.on_second.point],
            relation,
        )
    })
}

#[cfg(test)]
#[path = "tests.rs"]
mod tests;
