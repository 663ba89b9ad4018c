//! Stresslets of spheroids held in straining flows (Kim & Karrila 1991, table 3.4).

use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::nalgebra::{Matrix3, Vector3};
use axistokes::{LinearFlow, Problem, Silent, Spheroid};

use super::resistance::rows;

#[test]
fn of_spheroids_held_in_three_strains() {
    let strains = [
        Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, 2.0)),
        Matrix3::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
        Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 0.0)),
    ];
    for row in rows(include_str!("../data/stresslet_spheroid.csv")) {
        let curve = Arc::new(Spheroid::new(row[0], row[1]).expect("a spheroid"));
        for (strain, function) in strains.iter().zip(&row[2..]) {
            let problem = Problem {
                background: LinearFlow {
                    velocity: Vector3::zeros(),
                    gradient: *strain,
                },
                ..Problem::new(curve.clone())
            };
            let answer = problem.to_tolerance(1e-10, &Silent).expect("an answer");
            let exact = 20.0 / 3.0 * PI * *function * strain;
            let error = (answer.body_flow.stresslet() - exact).amax() / exact.amax();
            println!("{} : {}, {function:.6}: {error:.1e}", row[0], row[1]);
            assert!(error <= 1e-13 && answer.error_estimate <= 1e-10);
        }
    }
}
