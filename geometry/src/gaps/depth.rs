//! The penetration depth of two convex bodies.
//!
//! Let $H(n)$ be the length of the translation of $A$ by $-H n$ that separates it from $B$ along
//! the unit vector $n$. Move $A$ farther, by $-T n$ with $T > H(n)$. Then the bodies are disjoint,
//! and they have nearest points at a distance $g$ with the normal $m$ of $A$, found as for any
//! disjoint bodies, also where surfaces are flat. The gap along $m$ is $g$, and so
//! $H(m) = T\, n \cdot m - g \le T - g \le H(n)$: going from $n$ to $m$ never makes the translation
//! longer. The end is where $m = n$; Newton's method for this equation goes there in a few steps.

use nalgebra::{Matrix2, Vector2, Vector3};

use super::descent::{self, descend};
use super::directions::{directions, separation};
use super::meridian::{Foot, Located};
use crate::frame::Frame;

/// Most steps.
const STEPS: usize = 60;
/// Angle between `n` and `m` at which the direction is found; the depth is off by its square.
const PARALLEL: f64 = 2e-10;
/// Step of the differences.
const DIFFERENCE: f64 = 1e-5;
/// Distance to which the bodies are separated, over the size of the smaller one.
const SEPARATED: f64 = 0.1;
/// Longest change of the direction in a step.
const LONGEST: f64 = 0.3;

/// The points that touch last when two convex bodies are separated along a direction.
#[derive(Clone, Copy)]
pub(super) struct Contact {
    pub(super) on_first: Foot,
    pub(super) on_second: Foot,
    /// The length of the separating translation along the normal.
    pub(super) depth: f64,
    /// The direction that the first body is moved against.
    direction: Vector3<f64>,
    /// The normal of the first body where the bodies are nearest after that.
    normal: Vector3<f64>,
}

impl Contact {
    fn at(first: &Located<'_>, second: &Located<'_>, direction: Vector3<f64>) -> Self {
        let slack = first.slack() + second.slack();
        let least = separation(first, second, direction).0 + slack;
        let translation = direction * (least + SEPARATED * first.radius());
        let frame = first.frame;
        let moved = Located {
            frame: Frame::new(frame.center() - translation, frame.orientation()),
            ..*first
        };
        let pair = descend(&moved, second, moved.farthest(direction), descent::STEPS);
        let mut on_first = pair.on_first;
        on_first.point += translation;
        let normal = (pair.on_first.normal - pair.on_second.normal).normalize();
        Self {
            on_first,
            on_second: pair.on_second,
            depth: (on_first.point - pair.on_second.point).dot(&normal),
            direction,
            normal,
        }
    }
}

/// The contact with the smallest translation: its length is the penetration depth.
pub(super) fn penetration(first: &Located<'_>, second: &Located<'_>) -> Contact {
    let (best, others) = directions(first, second);
    let mut least = refined(first, second, best);
    for direction in others {
        let found = refined(first, second, direction);
        if found.depth < least.depth {
            least = found;
        }
    }
    least
}

/// The minimum of the separating translation to which a direction leads.
fn refined(first: &Located<'_>, second: &Located<'_>, direction: Vector3<f64>) -> Contact {
    let rounding = 1e-15 * first.radius();
    let mut here = Contact::at(first, second, direction);
    for _ in 0..STEPS {
        let n = here.direction;
        let mut axis = Vector3::zeros();
        axis[n.iamin()] = 1.0;
        let u = n.cross(&axis).normalize();
        let v = n.cross(&u);
        let beside = |a: Vector2<f64>| (n + u * a.x + v * a.y).normalize();
        let off = |contact: &Contact| {
            let off = contact.normal - contact.direction;
            Vector2::new(off.dot(&u), off.dot(&v))
        };
        let mismatch = off(&here);
        if mismatch.norm() <= PARALLEL {
            break;
        }
        let change = |a: Vector2<f64>| {
            (off(&Contact::at(first, second, beside(a * DIFFERENCE))) - mismatch) / DIFFERENCE
        };
        let columns = Matrix2::from_columns(&[change(Vector2::x()), change(Vector2::y())]);
        // The normal is the gradient of a distance, and so its derivative is symmetric.
        let eigen = ((columns + columns.transpose()) * 0.5).symmetric_eigen();
        let along = eigen.eigenvectors.transpose() * mismatch;
        let along = along.zip_map(&eigen.eigenvalues, |a, slope| a / slope.abs().max(1e-8));
        let mut planned = eigen.eigenvectors * along;
        planned *= (LONGEST / planned.norm()).min(1.0);
        let better = |there: &Contact, share: f64| {
            there.depth
                < here.depth
                    - rounding.max(1e-4 * share * planned.dot(&mismatch).abs() * here.depth)
                || there.depth <= here.depth + rounding
                    && (there.normal - there.direction).norm() < 0.5 * mismatch.norm()
        };
        let found = (0..12).find_map(|halvings| {
            let share = 0.5f64.powi(halvings);
            let there = Contact::at(first, second, beside(planned * share));
            better(&there, share).then_some(there)
        });
        let found = found.or_else(|| {
            let there = Contact::at(first, second, here.normal);
            let nearer = (there.normal - there.direction).norm() < 0.99 * mismatch.norm();
            (nearer || there.depth < here.depth - rounding).then_some(there)
        });
        match found {
            Some(there) => here = there,
            None => break,
        }
    }
    here
}
