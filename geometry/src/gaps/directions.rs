//! The directions along which two convex bodies can be separated by a small translation.
//!
//! A translation along the unit vector $n$ that separates the bodies $A$ and $B$ has the length
//! $H(n) = \max_{x \in A} n \cdot x - \min_{y \in B} n \cdot y$, and the smallest one is the least
//! value of $H$. It may have several minima. The sphere of directions is cut into patches; most of
//! them cannot hold the least value: with the points $x$ and $y$ of one direction,
//! $H(m) \ge m \cdot (x - y)$ in all others.

use std::collections::BinaryHeap;

use nalgebra::Vector3;

use super::least_first::{Bounded, LeastFirst};
use super::meridian::Located;

/// Angle, in radians, between the middle and the corners of the smallest patches.
const FINEST: f64 = 0.04;
/// Most patches looked at for a pair.
const MOST_PATCHES: usize = 20_000;
/// Most directions given out besides the best one.
const MOST_OTHERS: usize = 12;

/// The translation along `n` that separates the bodies' polygons: how long, and the difference of
/// their points that touch last.
pub(super) fn separation(
    first: &Located<'_>,
    second: &Located<'_>,
    n: Vector3<f64>,
) -> (f64, Vector3<f64>) {
    let difference = first.farthest(n) - second.farthest(-n);
    (difference.dot(&n), difference)
}

/// A part of the sphere of directions: the directions of a square on a face of a cube.
struct Patch {
    /// No translation along its directions separates the polygons and is shorter.
    lower: f64,
    /// The length of the translation along its middle.
    length: f64,
    middle: Vector3<f64>,
    /// The largest angle from its middle.
    angle: f64,
    /// The face, by its outward axis and two axes along its edges.
    face: [Vector3<f64>; 3],
    corner: [f64; 2],
    edge: f64,
}

impl Patch {
    fn new(
        first: &Located<'_>,
        second: &Located<'_>,
        face: [Vector3<f64>; 3],
        corner: [f64; 2],
        edge: f64,
    ) -> Self {
        let at = |u: f64, v: f64| {
            let [out, along, across] = face;
            (out + along * (corner[0] + u * edge) + across * (corner[1] + v * edge)).normalize()
        };
        let middle = at(0.5, 0.5);
        let corners = [at(0.0, 0.0), at(0.0, 1.0), at(1.0, 0.0), at(1.0, 1.0)];
        let angle = corners
            .map(|c| c.angle(&middle))
            .into_iter()
            .fold(0.0, f64::max);
        let (length, difference) = separation(first, second, middle);
        let farthest = (difference.angle(&middle) + angle).min(std::f64::consts::PI);
        Self {
            lower: difference.norm() * farthest.cos(),
            length,
            middle,
            angle,
            face,
            corner,
            edge,
        }
    }
}

impl Bounded for Patch {
    fn lower(&self) -> f64 {
        self.lower
    }
}

/// Directions near the minima of the separating translation that may be the least, the one with the
/// shortest translation first, and the others.
pub(super) fn directions(
    first: &Located<'_>,
    second: &Located<'_>,
) -> (Vector3<f64>, Vec<Vector3<f64>>) {
    let slack = first.slack() + second.slack();
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut heap = BinaryHeap::new();
    for k in 0..3 {
        for out in [axes[k], -axes[k]] {
            let face = [out, axes[(k + 1) % 3], axes[(k + 2) % 3]];
            for corner in [[-1.0, -1.0], [-1.0, 0.0], [0.0, -1.0], [0.0, 0.0]] {
                let patch = Patch::new(first, second, face, corner, 1.0);
                heap.push(LeastFirst(patch));
            }
        }
    }
    let mut looked = heap.len();
    let (mut best, mut shortest) = (f64::INFINITY, Vector3::z());
    for LeastFirst(patch) in &heap {
        if patch.length < best {
            (best, shortest) = (patch.length, patch.middle);
        }
    }
    let mut leaves: Vec<Patch> = Vec::new();
    while let Some(LeastFirst(patch)) = heap.pop() {
        if patch.lower > best + slack {
            break;
        }
        if patch.angle <= FINEST || looked >= MOST_PATCHES {
            leaves.push(patch);
            continue;
        }
        let half = 0.5 * patch.edge;
        let [u, v] = patch.corner;
        for corner in [[u, v], [u, v + half], [u + half, v], [u + half, v + half]] {
            let part = Patch::new(first, second, patch.face, corner, half);
            if part.length < best {
                (best, shortest) = (part.length, part.middle);
            }
            looked += 1;
            heap.push(LeastFirst(part));
        }
    }
    leaves.sort_by(|a, b| a.length.total_cmp(&b.length));
    let mut others: Vec<Vector3<f64>> = Vec::new();
    for leaf in &leaves {
        // Leaves beside a better one lead to where that one does.
        let beside = |other: &Vector3<f64>| other.angle(&leaf.middle) <= 3.0 * leaf.angle;
        if others.len() < MOST_OTHERS && !beside(&shortest) && !others.iter().any(beside) {
            others.push(leaf.middle);
        }
    }
    (shortest, others)
}
