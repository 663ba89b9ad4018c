//! The thesis's test of section 3.6.1: a flow of known Stokeslets inside a spheroid, found again from its boundary values.

use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::body::dirichlet::{DirichletSolver, Formulation};
use axistokes::body::discretization::Discretization;
use axistokes::body::surface::SurfaceModes;
use axistokes::case::Case;
use axistokes::curve::{Panels, Spheroid};
use axistokes::progress::Silent;
use nalgebra::{Point3, Vector3};

/// Stokeslets (place, force) and targets of the shared case.
fn case() -> (Vec<(Vector3<f64>, Vector3<f64>)>, Vec<Point3<f64>>) {
    let text = include_str!("data/cases/thesis-single-body.toml");
    let case = Case::parse(text, "thesis-single-body.toml").expect("a valid case");
    let test = case.test.as_ref().expect("a test flow");
    let stokeslets = test
        .stokeslets
        .iter()
        .map(|s| (s.at.into(), s.force.into()))
        .collect();
    (
        stokeslets,
        case.probes.iter().map(|p| p.value.into()).collect(),
    )
}

/// The exact flow, viscosity 1: velocity and pressure.
fn exact(stokeslets: &[(Vector3<f64>, Vector3<f64>)], x: Vector3<f64>) -> (Vector3<f64>, f64) {
    let mut velocity = Vector3::zeros();
    let mut pressure = 0.0;
    for (at, force) in stokeslets {
        let d = x - at;
        let r = d.norm();
        velocity += (force / r + d * d.dot(force) / r.powi(3)) / (8.0 * PI);
        pressure += d.dot(force) / (4.0 * PI * r.powi(3));
    }
    (velocity, pressure)
}

/// Largest errors of velocity and pressure at the targets.
fn errors(formulation: Formulation, panels: usize, order: usize, n_max: usize) -> (f64, f64) {
    let (stokeslets, targets) = case();
    let curve = Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid"));
    let panels = Panels::equal_arcs(&*curve, panels).expect("panels");
    let discretization = Discretization::new(curve, panels, order).expect("nodes");
    let solver =
        DirichletSolver::new(discretization, formulation, n_max, &Silent).expect("a solver");
    let flow = |x| exact(&stokeslets, x).0;
    let data = SurfaceModes::sample(solver.discretization(), n_max, flow).modes;
    let density = solver.solve(&data);
    let computed = solver
        .flow(&density)
        .at(&targets, 1e-14)
        .expect("targets far enough");
    let mut worst = (0.0f64, 0.0f64);
    for (target, computed) in targets.iter().zip(computed) {
        let (velocity, pressure) = exact(&stokeslets, target.coords);
        worst.0 = worst.0.max((velocity - computed.velocity).amax());
        worst.1 = worst.1.max((pressure - computed.pressure).abs());
    }
    println!(
        "{formulation:?} {} panels x {order}, {n_max} modes: velocity {:.2e}, pressure {:.2e}; assemble {:.3} s, factor {:.3} s",
        solver.discretization().panels().len(),
        worst.0,
        worst.1,
        solver.seconds().assemble,
        solver.seconds().factor,
    );
    worst
}

#[test]
fn combined_field_reaches_the_bars() {
    assert!(errors(Formulation::CombinedField, 8, 16, 60).0 <= 5e-12);
    assert!(errors(Formulation::CombinedField, 12, 10, 60).0 <= 1e-10);
    assert!(errors(Formulation::CombinedField, 12, 16, 80).0 <= 1e-13);
}

#[test]
#[ignore]
fn scan() {
    for (p, o, n) in [
        (12, 10, 50),
        (12, 10, 60),
        (12, 10, 80),
        (16, 10, 60),
        (16, 10, 80),
        (24, 10, 80),
        (8, 16, 50),
        (8, 16, 70),
        (8, 16, 80),
        (10, 16, 60),
        (10, 16, 80),
        (12, 16, 60),
        (12, 16, 80),
        (16, 16, 80),
        (16, 16, 100),
        (24, 16, 100),
    ] {
        errors(Formulation::CombinedField, p, o, n);
    }
    for (p, o, n) in [(8, 16, 60), (12, 16, 80), (12, 10, 60)] {
        errors(Formulation::SingleLayer, p, o, n);
    }
}
