//! Condition numbers of the combined field's modal matrices.

use std::sync::Arc;

use axistokes::body::dirichlet::Formulation;
use axistokes::body::discretization::Discretization;
use axistokes::geometry::curve::{Biconcave, GeneratingCurve, Panels, Spheroid, Torus};
use rayon::prelude::*;

/// The largest condition number of modes up to `n_max`, and its mode.
fn worst(
    curve: &Arc<dyn GeneratingCurve>,
    panels: Panels,
    order: usize,
    n_max: usize,
) -> (f64, usize) {
    let count = panels.len();
    let discretization = Discretization::new(curve.clone(), panels, order).expect("nodes");
    let matrices = (Formulation::CombinedField)
        .matrices(&discretization, n_max)
        .expect("matrices");
    let condition = |n: usize| {
        let values = matrices
            .transposed(n)
            .singular_values()
            .expect("singular values");
        (values[0] / values[values.len() - 1], n)
    };
    let worst = (0..=n_max)
        .into_par_iter()
        .map(condition)
        .reduce(|| (0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
    println!(
        "{curve:?}, {count} panels x {order}, modes 0..={n_max}: largest condition {:.2} in mode {}",
        worst.0, worst.1
    );
    worst
}

#[test]
fn thesis_body_at_every_resolution() {
    faer::set_global_parallelism(faer::Par::Seq);
    let curve: Arc<dyn GeneratingCurve> = Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid"));
    for (panels, order, n_max) in [
        (4, 16, 60),
        (8, 16, 60),
        (12, 16, 60),
        (12, 10, 60),
        (24, 16, 4),
    ] {
        let panels = Panels::uniform(&*curve, panels).expect("panels");
        assert!(worst(&curve, panels, order, n_max).0 < 20.0);
    }
}

#[test]
fn other_bodies() {
    faer::set_global_parallelism(faer::Par::Seq);
    // Slender and flat bodies are worse: the bars are what was measured, rounded up.
    let bodies: [(Arc<dyn GeneratingCurve>, f64); 7] = [
        (Arc::new(Spheroid::sphere(1.0).expect("a sphere")), 5.0),
        (Arc::new(Spheroid::new(0.1, 1.0).expect("a disc")), 30.0),
        (Arc::new(Spheroid::new(0.01, 1.0).expect("a disc")), 400.0),
        (Arc::new(Spheroid::new(10.0, 1.0).expect("a needle")), 16.0),
        (Arc::new(Torus::new(1.0, 0.25).expect("a torus")), 10.0),
        (Arc::new(Torus::new(1.0, 0.9).expect("a fat torus")), 30.0),
        (Arc::new(Biconcave::new(1.0).expect("a red cell")), 7.0),
    ];
    for (curve, bar) in bodies {
        let panels = Panels::resolving(&*curve, 16, 1e-8).expect("panels");
        assert!(worst(&curve, panels, 16, 20).0 < bar);
    }
}
