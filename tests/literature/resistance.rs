//! The four resistance functions of a body with fore-aft symmetry, and tables of them.

use std::sync::Arc;

use axistokes::body::dirichlet::{DirichletSolver, Formulation};
use axistokes::body::discretization::Discretization;
use axistokes::geometry::curve::{GeneratingCurve, Panels};
use axistokes::progress::Silent;
use axistokes::{RigidMotion, Wrench};
use nalgebra::Vector3;

/// Force along and across the axis, torque along and across it.
pub type Resistance = [f64; 4];

/// Solves for rigid motions.
pub struct Resistor(DirichletSolver);

impl Resistor {
    pub fn new(curve: &Arc<dyn GeneratingCurve>, panels: Panels, order: usize) -> Self {
        let discretization = Discretization::new(curve.clone(), panels, order).expect("nodes");
        Self(
            DirichletSolver::new(discretization, Formulation::CombinedField, 1, &Silent)
                .expect("a solver"),
        )
    }

    pub fn size(&self) -> f64 {
        self.0.discretization().size()
    }

    pub fn wrench(&self, velocity: Vector3<f64>, angular_velocity: Vector3<f64>) -> Wrench {
        self.0.resistance(&RigidMotion {
            velocity,
            angular_velocity,
        })
    }
}

pub fn resistance(curve: &Arc<dyn GeneratingCurve>, panels: &Panels, order: usize) -> Resistance {
    let resistor = Resistor::new(curve, panels.clone(), order);
    let rest = Vector3::zeros();
    [
        resistor.wrench(Vector3::z(), rest).force.z,
        resistor.wrench(Vector3::x(), rest).force.x,
        resistor.wrench(rest, Vector3::z()).torque.z,
        resistor.wrench(rest, Vector3::x()).torque.x,
    ]
}

/// The largest relative error.
pub fn error(value: Resistance, exact: Resistance) -> f64 {
    let relative = |k: usize| ((value[k] - exact[k]) / exact[k]).abs();
    (0..4).map(relative).fold(0.0, f64::max)
}

/// The rows of a table without its comments and its heading.
pub fn rows(text: &str) -> Vec<Vec<f64>> {
    text.lines()
        .filter(|line| !line.starts_with('#'))
        .skip(1)
        .map(|line| {
            let cells = line.split(',');
            cells.map(|x| x.parse().expect("a number")).collect()
        })
        .collect()
}

/// Four columns of a row.
pub fn four(row: &[f64], first: usize) -> Resistance {
    std::array::from_fn(|k| row[first + k])
}
