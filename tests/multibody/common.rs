//! What the tests share.

use std::sync::Arc;

use axistokes::{Frame, GeneratingCurve, Motion, RigidMotion, Spheroid, Wrench};
use nalgebra::{DMatrix, Point3, Unit, Vector3};

pub type Curve = Arc<dyn GeneratingCurve>;

/// A spheroid by its half axes along and across its axis.
pub fn spheroid(polar: f64, equatorial: f64) -> Curve {
    Arc::new(Spheroid::new(polar, equatorial).expect("a spheroid"))
}

pub fn ball() -> Curve {
    spheroid(1.0, 1.0)
}

pub fn at(x: f64, y: f64, z: f64) -> Frame {
    Frame::along(Point3::new(x, y, z), Vector3::z_axis())
}

pub fn moving(velocity: Vector3<f64>, angular_velocity: Vector3<f64>) -> Motion {
    Motion::Given(RigidMotion {
        velocity,
        angular_velocity,
    })
}

pub fn pushed(force: Vector3<f64>, torque: Vector3<f64>) -> Motion {
    Motion::Free(Wrench { force, torque })
}

pub use crate::ask::{answer, given, try_with};

/// Components between -1/2 and 1/2.
pub fn random(rng: &mut fastrand::Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| rng.f64() - 0.5)
}

/// A direction, all of them being equally likely.
pub fn direction(rng: &mut fastrand::Rng) -> Unit<Vector3<f64>> {
    loop {
        let v = random(rng);
        if (0.1..0.5).contains(&v.norm()) {
            return Unit::new_normalize(v);
        }
    }
}

/// The rows of a table without its comments and its heading, cell by cell.
pub fn cells(text: &str) -> Vec<Vec<&str>> {
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect()
}

pub fn number(cell: &str) -> f64 {
    cell.parse().expect("a number")
}

/// The largest entry of a difference, relative to the largest of the second matrix.
pub fn apart(found: &DMatrix<f64>, exact: &DMatrix<f64>) -> f64 {
    (found - exact).amax() / exact.amax()
}

/// By how much a matrix is not symmetric, relative to its largest entry.
pub fn asymmetry(matrix: &DMatrix<f64>) -> f64 {
    apart(&matrix.transpose(), matrix)
}
