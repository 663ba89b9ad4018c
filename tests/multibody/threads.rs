//! Results do not depend on the number of threads, nor on luck.

use std::sync::Arc;

use axistokes::{Answer, Body, Frame, LinearFlow, Panels, Resolution, Suspension};
use nalgebra::{Point3, Vector3};

use super::common::{direction, given, moving, pushed, random, spheroid, try_with};

fn solve(tolerance: f64, panels: usize, order: usize, modes: usize) -> Answer {
    let mut rng = fastrand::Rng::with_seed(31);
    let curves = [spheroid(1.0, 0.5), spheroid(0.5, 1.0)];
    let mut bodies = Vec::new();
    let mut resolutions = Vec::new();
    for k in 0..8usize {
        let cell = [k % 2, k / 2 % 2, k / 4];
        let curve = curves[cell.iter().sum::<usize>() % 2].clone();
        resolutions.push(Arc::new(Resolution {
            panels: Panels::equal_arcs(&*curve, panels).expect("panels"),
            order,
            modes,
        }));
        let center = Point3::from(cell.map(|i| 2.1 * i as f64));
        bodies.push(Body {
            motion: if k % 3 == 0 {
                pushed(10.0 * random(&mut rng), random(&mut rng))
            } else {
                moving(random(&mut rng), random(&mut rng))
            },
            ..Body::new(curve, Frame::along(center, direction(&mut rng)))
        });
    }
    let probes: Vec<Point3<f64>> = (0..50)
        .map(|_| Point3::from(20.0 * random(&mut rng)) + Vector3::new(0.0, 0.0, 15.0))
        .collect();
    let suspension = Suspension {
        probes,
        background: LinearFlow::shear(0.3, Vector3::x(), Vector3::z()),
        ..Suspension::new(bodies)
    };
    try_with(&suspension, &given(&resolutions, tolerance)).expect("an answer")
}

/// Whether two answers are equal: no zero changes its sign and nothing is NaN, so this is bitwise.
fn same(a: &Answer, b: &Answer) -> bool {
    a.probes == b.probes
        && a.statistics.iteration == b.statistics.iteration
        && a.error_estimate == b.error_estimate
        && a.bodies.iter().zip(&b.bodies).all(|(a, b)| {
            a.motion == b.motion
                && a.wrench == b.wrench
                && a.stresslet == b.stresslet
                && a.boundary_error == b.boundary_error
        })
        && (a.flow.bodies().iter().zip(b.flow.bodies()))
            .all(|(a, b)| a.disturbance.layers() == b.disturbance.layers())
}

#[test]
fn one_and_two_threads_agree_to_the_last_bit() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool").install(|| solve(1e-4, 4, 8, 12))
    };
    let one = with(1);
    println!(
        "{} points, {} near, {} iterations, estimate {:.1e}, {:?}",
        one.statistics.points,
        one.statistics.near_points,
        one.statistics.iterations,
        one.error_estimate,
        one.statistics.timings
    );
    // More than the direct sum takes, and near points: every part of the machinery is in use.
    assert!(one.statistics.points > 5500 && one.statistics.near_points > 100);
    assert!(same(&one, &with(2)));
    assert!(same(&one, &with(2)));
    assert!(same(&one, &with(1)));
}
