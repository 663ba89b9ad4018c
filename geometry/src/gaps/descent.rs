//! The nearest points of two surfaces near a start.

use nalgebra::{Matrix2, Point3, Vector2, Vector3};

use super::meridian::{Foot, Located};

/// Steps that are enough where the distance is smooth.
pub(super) const STEPS: usize = 100;
/// Angle between the normals, in radians, at which the search ends. The error of the distance is
/// the square of the angle times a radius of curvature.
const PARALLEL: f64 = 1e-10;
/// Step of the differences, over the size of the smaller body.
const DIFFERENCE: f64 = 1e-8;

/// A point of the first surface and its nearest point of the second.
#[derive(Clone, Copy)]
pub(super) struct Pair {
    pub(super) on_first: Foot,
    pub(super) on_second: Foot,
}

impl Pair {
    pub(super) fn at(first: &Located<'_>, second: &Located<'_>, x: Point3<f64>) -> Self {
        let on_first = first.foot(x);
        Self {
            on_first,
            on_second: second.foot(on_first.point),
        }
    }

    /// Distance, negative if the first surface is inside the second body there.
    pub(super) fn distance(&self) -> f64 {
        self.on_second.distance
    }

    /// Whether the outward normals point the same way, and not against each other.
    pub(super) fn same_side(&self) -> bool {
        self.on_first.normal.dot(&self.on_second.normal) > 0.0
    }

    /// The same points where the bodies have changed their roles.
    pub(super) fn reversed(self) -> Self {
        Self {
            on_first: self.on_second,
            on_second: self.on_first,
        }
    }

    /// Zero if the normals are opposite.
    fn mismatch(&self) -> Vector3<f64> {
        self.on_first.normal + self.on_second.normal
    }
}

/// Minimises the signed distance from the second body over the first surface, in at most `steps`
/// steps of a Newton method.
///
/// The method works in tangent planes, because coordinates on the surface fail at the poles. The
/// signed distance is smooth where the bodies touch, so that contact needs no case of its own.
///
/// The second derivative is the sum of both curvatures. It is found from the change of the sum of
/// the outward normals along the surface.
pub(super) fn descend(
    first: &Located<'_>,
    second: &Located<'_>,
    start: Point3<f64>,
    steps: usize,
) -> Pair {
    let size = first.radius();
    let mut here = Pair::at(first, second, start);
    for _ in 0..steps {
        let normal = here.on_first.normal;
        let least = normal.iamin();
        let mut axis = Vector3::zeros();
        axis[least] = 1.0;
        let u = normal.cross(&axis).normalize();
        let v = normal.cross(&u);
        let planar = |x: Vector3<f64>| Vector2::new(x.dot(&u), x.dot(&v));
        let slope = planar(here.on_second.normal);
        if slope.norm() <= PARALLEL {
            break;
        }
        let step = DIFFERENCE * size;
        let base = planar(here.mismatch());
        let change = |direction: Vector3<f64>| {
            let ahead = Pair::at(first, second, here.on_first.point + direction * step);
            (planar(ahead.mismatch()) - base) / step
        };
        let columns = Matrix2::from_columns(&[change(u), change(v)]);
        let curvature = (columns + columns.transpose()) * 0.5;
        let eigen = curvature.symmetric_eigen();
        let floor = (1e-9 * eigen.eigenvalues.amax()).max(1e-6 / size);
        let along = eigen.eigenvectors.transpose() * slope;
        let along = along.zip_map(&eigen.eigenvalues, |a, curvature| {
            -a / curvature.abs().max(floor)
        });
        let mut planned = eigen.eigenvectors * along;
        if planned.norm() > 0.2 * size {
            planned *= 0.2 * size / planned.norm();
        }
        let expected = planned.dot(&slope);
        let mut found = None;
        let mut share = 1.0;
        for _ in 0..40 {
            let x = here.on_first.point + (u * planned.x + v * planned.y) * share;
            let there = Pair::at(first, second, x);
            let fell = there.distance() <= here.distance() + 1e-4 * share * expected;
            // Near the end the distance is rounding, and the slope has to fall.
            let flatter = there.distance() <= here.distance() + 1e-15 * size
                && tangential(&there) < 0.5 * slope.norm();
            if fell || flatter {
                found = Some(there);
                break;
            }
            share *= 0.5;
        }
        match found {
            Some(there) => here = there,
            None => break,
        }
    }
    here
}

fn tangential(pair: &Pair) -> f64 {
    let (n, m) = (pair.on_first.normal, pair.on_second.normal);
    (m - n * n.dot(&m)).norm()
}
