//! How many iterations it takes: rods and discs in a cube, at random directions.

use std::sync::Arc;

use axistokes::{Body, Frame, Panels, Resolution, Suspension};
use nalgebra::Point3;

use super::common::{direction, given, moving, pushed, random, spheroid, try_with};

fn iterations(side: usize, free: bool) -> usize {
    let mut rng = fastrand::Rng::with_seed(1);
    let curves = [spheroid(1.0, 0.5), spheroid(0.5, 1.0)];
    let mut bodies = Vec::new();
    let mut resolutions = Vec::new();
    for k in 0..side.pow(3) {
        let cell = [k % side, k / side % side, k / side / side];
        let curve = curves[cell.iter().sum::<usize>() % 2].clone();
        resolutions.push(Arc::new(Resolution {
            panels: Panels::equal_arcs(&*curve, 4).expect("panels"),
            order: 8,
            modes: 8,
        }));
        let center = Point3::from(cell.map(|i| 2.4 * i as f64));
        let frame = Frame::along(center, direction(&mut rng));
        let (first, second) = (random(&mut rng), random(&mut rng));
        bodies.push(Body {
            motion: if free {
                pushed(first, second)
            } else {
                moving(first, second)
            },
            ..Body::new(curve, frame)
        });
    }
    let mut options = given(&resolutions, 1e-7);
    options.residual = Some(1e-8);
    let answer = try_with(&Suspension::new(bodies), &options).expect("an answer");
    let iteration = &answer.statistics.iteration;
    println!(
        "{} bodies, {}: {} iterations to {:.1e}, estimate {:.1e}, {:?}",
        side.pow(3),
        if free { "mobility" } else { "resistance" },
        iteration.iterations,
        iteration.residual,
        answer.error_estimate,
        answer.statistics.timings
    );
    iteration.iterations
}

#[test]
fn of_eight_bodies() {
    assert!(iterations(2, true) <= 11 && iterations(2, false) <= 15);
}

#[test]
#[ignore = "a minute"]
fn of_twenty_seven_bodies() {
    assert!(iterations(3, true) <= 12 && iterations(3, false) <= 17);
}
