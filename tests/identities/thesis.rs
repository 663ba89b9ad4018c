//! The thesis's test of section 3.6.1: a flow of known Stokeslets inside a spheroid, found again
//! from its boundary values.

use std::sync::Arc;

use axistokes::body::dirichlet::{DirichletSolver, Formulation};
use axistokes::body::discretization::Discretization;
use axistokes::body::kernel::Stokeslet;
use axistokes::body::surface::SurfaceModes;
use axistokes::case::Case;
use axistokes::geometry::curve::{Panels, Spheroid};
use axistokes::progress::Silent;
use nalgebra::{Point3, Vector3};

/// Stokeslets and targets of the shared case.
fn case() -> (Vec<Stokeslet>, Vec<Point3<f64>>) {
    let text = include_str!("../data/cases/thesis-single-body.toml");
    let case = Case::parse(text, "thesis-single-body.toml").expect("a valid case");
    let test = case.test.as_ref().expect("a test flow");
    let stokeslets = test.stokeslets.iter();
    let stokeslets = stokeslets.map(|s| Stokeslet {
        at: s.at.into(),
        force: s.force.into(),
    });
    (
        stokeslets.collect(),
        case.probes.iter().map(|p| p.value.into()).collect(),
    )
}

/// Largest errors of velocity and pressure at the targets.
fn errors(formulation: Formulation, panels: usize, order: usize, n_max: usize) -> (f64, f64) {
    let (stokeslets, targets) = case();
    let curve = Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid"));
    let panels = Panels::equal_arcs(&*curve, panels).expect("panels");
    let discretization = Discretization::new(curve, panels, order).expect("nodes");
    let solver =
        DirichletSolver::new(discretization, formulation, n_max, &Silent).expect("a solver");
    let velocity = |x: Vector3<f64>| {
        stokeslets
            .iter()
            .map(|s| s.velocity(x))
            .sum::<Vector3<f64>>()
    };
    let data = SurfaceModes::sample(solver.discretization(), n_max, velocity).modes;
    let density = solver.solve(&data);
    let computed = solver
        .flow(&density)
        .at(&targets, 1e-14)
        .expect("targets far enough");
    let mut worst = (0.0f64, 0.0f64);
    for (target, computed) in targets.iter().zip(computed) {
        let pressure: f64 = stokeslets.iter().map(|s| s.pressure(target.coords)).sum();
        worst.0 = worst
            .0
            .max((velocity(target.coords) - computed.velocity).amax());
        worst.1 = worst.1.max((pressure - computed.pressure).abs());
    }
    println!(
        "{formulation:?} {} panels x {order}, {n_max} modes: velocity {:.2e}, pressure {:.2e}",
        solver.discretization().panels().len(),
        worst.0,
        worst.1,
    );
    worst
}

#[test]
fn combined_field_reaches_the_bars_in_velocity_and_pressure() {
    for (panels, order, modes, velocity, pressure) in [
        (8, 16, 60, 1.5e-13, 1e-12),
        (12, 10, 60, 1e-11, 2e-10),
        (12, 16, 80, 1e-14, 1e-13),
        (24, 10, 80, 1e-14, 1e-13),
    ] {
        let error = errors(Formulation::CombinedField, panels, order, modes);
        assert!(error.0 <= velocity && error.1 <= pressure, "{error:?}");
    }
}

#[test]
fn single_layer_reaches_the_bars_too() {
    assert!(errors(Formulation::SingleLayer, 8, 16, 60).0 <= 5e-12);
    assert!(errors(Formulation::SingleLayer, 12, 16, 80).0 <= 1e-14);
}

#[test]
fn errors_fall_at_the_order_of_the_panels_and_exponentially_in_modes() {
    // Doubling the panels gains at least 2^p, until rounding.
    for (order, panels) in [(10, [6, 12]), (16, [5, 10])] {
        let [coarse, fine] =
            panels.map(|panels| errors(Formulation::CombinedField, panels, order, 60).0);
        let observed = (coarse / fine).log2();
        println!("observed order {observed:.1} with {order} nodes a panel");
        assert!(observed >= order as f64, "{observed}");
    }
    let modes = [10, 20, 30].map(|n| errors(Formulation::CombinedField, 12, 16, n).0);
    assert!(
        modes[1] < 0.02 * modes[0] && modes[2] < 0.02 * modes[1],
        "{modes:?}"
    );
}
