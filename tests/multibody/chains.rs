//! Chains of three and five spheres: two gaps a sphere.

use axistokes::{Body, Suspension};
use nalgebra::Vector3;

use super::common::{answer, at, ball, cells, moving, number};

#[test]
fn of_three_and_five_spheres() {
    let rows = cells(include_str!("../data/sphere_chains.csv"));
    let curve = ball();
    let mut worst = 0.0f64;
    for chain in rows.chunk_by(|a, b| a[..3] == b[..3]) {
        let [count, spacing, motion] = [chain[0][0], chain[0][1], chain[0][2]];
        let count = number(count) as usize;
        assert_eq!(chain.len(), count);
        let rest = Vector3::zeros();
        let own = if motion.starts_with("along") {
            moving(Vector3::z(), rest)
        } else if motion.starts_with("across") {
            moving(Vector3::x(), rest)
        } else {
            moving(rest, Vector3::y())
        };
        let bodies = chain.iter().enumerate().map(|(k, row)| {
            let mut body = Body::new(curve.clone(), at(0.0, 0.0, number(row[4])));
            if motion.ends_with("all") || k == count / 2 {
                body.motion = own;
            }
            body
        });
        let suspension = Suspension::new(bodies.collect::<Vec<_>>());
        let answer = answer(&suspension, 3e-9);
        let direction = if motion.starts_with("along") {
            Vector3::z()
        } else {
            Vector3::x()
        };
        let [forces, torques] =
            [5, 6].map(|k| chain.iter().map(|row| number(row[k])).collect::<Vec<_>>());
        let largest = forces
            .iter()
            .chain(&torques)
            .fold(0.0f64, |most, x| most.max(x.abs()));
        let error = answer
            .bodies
            .iter()
            .enumerate()
            .fold(0.0f64, |most, (k, body)| {
                let force = (body.wrench.force - forces[k] * direction).norm();
                let torque = (body.wrench.torque - torques[k] * Vector3::y()).norm();
                most.max(force.max(torque) / largest)
            });
        println!(
            "{count} spheres, spacing {spacing}, {motion}: {error:.1e} of the largest, estimate {:.1e}, {} iterations",
            answer.error_estimate, answer.statistics.iteration.iterations
        );
        worst = worst.max(error);
        assert!(error <= answer.error_estimate);
    }
    println!("worst {worst:.1e}");
    assert!(worst <= 5e-10);
}
