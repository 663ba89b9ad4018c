//! Stresslets of spheroids held in straining flows (Kim & Karrila 1991, table 3.4).

use std::f64::consts::PI;

use axistokes::nalgebra::{Matrix3, Vector3};
use axistokes::{Body, GeneratingCurve, LinearFlow, Spheroid, Suspension};

use super::ask::answer;
use super::resistance::rows;

#[test]
fn of_spheroids_held_in_three_strains() {
    let strains = [
        Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, 2.0)),
        Matrix3::new(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0),
        Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, 0.0)),
    ];
    for row in rows(include_str!("../data/stresslet_spheroid.csv")) {
        let shape = Spheroid::new(row[0], row[1]).expect("a spheroid").shape();
        for (strain, function) in strains.iter().zip(&row[2..]) {
            let held = Suspension {
                background: LinearFlow {
                    velocity: Vector3::zeros(),
                    gradient: *strain,
                },
                ..Suspension::new([Body::held(&shape)])
            };
            let answer = answer(&held, 1e-10);
            let exact = 20.0 / 3.0 * PI * *function * strain;
            let error = (answer.bodies[0].stresslet - exact).amax() / exact.amax();
            println!("{} : {}, {function:.6}: {error:.1e}", row[0], row[1]);
            assert!(error <= 1e-13 && answer.error_estimate <= 1e-10);
        }
    }
}
