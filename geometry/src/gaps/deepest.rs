//! The deepest point found of one body below the surface of the other, for bodies of any shape.

use std::f64::consts::TAU;

use nalgebra::Point3;

use super::descent::{Pair, descend};
use super::meridian::{Foot, Located};

/// Points of a surface that are looked at: along the meridian and around the axis.
const GRID: [usize; 2] = [32, 16];
/// Most starts of the minimisation from points of the grid.
const MOST_STARTS: usize = 4;
/// Most steps of a minimisation. Deep inside a body the distance from its surface is not smooth,
/// and more steps gain little; at shallow depths a few are enough.
const STEPS: usize = 8;

/// Points of a polygon, spread over the surface.
fn grid(body: &Located<'_>) -> impl Iterator<Item = Point3<f64>> {
    (0..GRID[0] * GRID[1]).map(|k| {
        let along = ((k / GRID[1]) as f64 + 0.5) / GRID[0] as f64;
        let around = (k % GRID[1]) as f64 / GRID[1] as f64;
        body.at(body.length() * along, TAU * around).0
    })
}

/// Whether no point of a grid on the surface of the one is outside the other.
pub(super) fn is_inside(inner: &Located<'_>, outer: &Located<'_>) -> bool {
    grid(inner).all(|x| outer.coarse(x) < 0.0)
}

/// The depth of the deepest pair of a point of one surface and its nearest point of the other one,
/// of those to which a grid and `known` lead, and the pair in the order of the bodies.
///
/// The distance of [`Pair`] falls smoothly through zero where bodies come to overlap, and the
/// nearest points of bodies that touch are `known`: so the depth begins at zero.
pub(super) fn deepest(first: &Located<'_>, second: &Located<'_>, known: Pair) -> (f64, [Foot; 2]) {
    let a = below(first, second, known.on_first.point);
    let b = below(second, first, known.on_second.point);
    if a.distance() <= b.distance() {
        (-a.distance(), [a.on_first, a.on_second])
    } else {
        (-b.distance(), [b.on_second, b.on_first])
    }
}

/// The deepest pair found with a point of the surface of `upper` below that of `lower`.
fn below(upper: &Located<'_>, lower: &Located<'_>, known: Point3<f64>) -> Pair {
    let mut points: Vec<(f64, Point3<f64>)> = grid(upper).map(|x| (lower.coarse(x), x)).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut starts: Vec<Point3<f64>> = Vec::new();
    for (distance, x) in points {
        let beside = |y: &Point3<f64>| (x - y).norm() < 0.3 * upper.radius();
        if distance < 0.0 && starts.len() < MOST_STARTS && !starts.iter().any(beside) {
            starts.push(x);
        }
    }
    let from_known = descend(upper, lower, known, STEPS);
    starts
        .into_iter()
        .map(|start| descend(upper, lower, start, STEPS))
        .fold(from_known, |deep, pair| {
            if pair.distance() < deep.distance() {
                pair
            } else {
                deep
            }
        })
}
