//! Results do not depend on the number of threads.

use std::sync::Arc;

use axistokes::body::dirichlet::{DirichletSolver, Formulation};
use axistokes::body::discretization::Discretization;
use axistokes::body::kernel::{FlowAt, Stokeslet};
use axistokes::body::surface::SurfaceModes;
use axistokes::geometry::curve::{Panels, Spheroid};
use axistokes::progress::Silent;
use nalgebra::{Point3, Vector3};

fn solve() -> (SurfaceModes, Vec<FlowAt>) {
    let curve = Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid"));
    let panels = Panels::uniform(&*curve, 6).expect("panels");
    let discretization = Discretization::new(curve, panels, 16).expect("nodes");
    let solver = DirichletSolver::new(discretization, Formulation::CombinedField, 20, &Silent)
        .expect("a solver");
    let inside = Stokeslet {
        at: Vector3::new(0.1, -0.1, 0.2),
        force: Vector3::new(1.0, 0.3, -0.4),
    };
    let data = SurfaceModes::sample(solver.discretization(), 20, |x| inside.velocity(x));
    let density = solver.solve(&data.modes);
    let targets: Vec<_> = (0..301)
        .map(|k| {
            let t = 0.02 * f64::from(k);
            Point3::new(1.5 * t.cos(), 1.5 * t.sin(), 0.01 * f64::from(k) - 1.5)
        })
        .collect();
    let flow = solver
        .flow(&density)
        .at(&targets, 1e-14)
        .expect("targets far enough");
    (density, flow)
}

#[test]
fn one_two_and_three_threads_agree_to_the_last_bit() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool").install(solve)
    };
    let one = with(1);
    for threads in [2, 3] {
        // No zero changes its sign and nothing is NaN: equality is bitwise.
        assert!(with(threads) == one, "{threads} threads");
    }
}
