//! Results do not depend on the number of threads, nor on luck.

use std::sync::Arc;

use axistokes::multibody::suspension::Answer;
use axistokes::{Body, Frame, LinearFlow, Panels, Resolution, Silent, Suspension};
use nalgebra::{Point3, Vector3};

use super::common::{direction, moving, pushed, random, spheroid};

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
    let targets: Vec<Point3<f64>> = (0..50)
        .map(|_| Point3::from(20.0 * random(&mut rng)) + Vector3::new(0.0, 0.0, 15.0))
        .collect();
    let suspension = Suspension {
        targets: &targets,
        background: LinearFlow::shear(0.3, Vector3::x(), Vector3::z()),
        ..Suspension::new(bodies)
    };
    suspension
        .at_resolutions(&resolutions, tolerance, &Silent)
        .expect("an answer")
}

/// Whether two answers are equal: no zero changes its sign and nothing is NaN, so this is bitwise.
fn same(a: &Answer, b: &Answer) -> bool {
    a.targets == b.targets
        && a.iteration == b.iteration
        && a.error_estimate == b.error_estimate
        && a.bodies.iter().zip(&b.bodies).all(|(a, b)| {
            a.motion == b.motion
                && a.wrench == b.wrench
                && a.stresslet == b.stresslet
                && a.boundary_error == b.boundary_error
        })
        && (a.flow.bodies.iter().zip(&b.flow.bodies))
            .all(|(a, b)| a.layers.double == b.layers.double && a.layers.single == b.layers.single)
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
        one.points, one.near.0, one.iteration.iterations, one.error_estimate, one.timings
    );
    // More than the direct sum takes, and near points: every part of the machinery is in use.
    assert!(one.points > 5500 && one.near.0 > 100);
    assert!(same(&one, &with(2)));
    assert!(same(&one, &with(2)));
    assert!(same(&one, &with(1)));
}
