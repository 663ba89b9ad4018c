//! Other ways to the same answer.

use std::sync::Arc;

use axistokes::body::dirichlet::Formulation;
use axistokes::krylov::Method;
use axistokes::suspension::Levels;
use axistokes::{Answer, Body, Frame, Options, Panels, Resolution, Suspension, SuspensionError};
use nalgebra::{Point3, Vector3};

use super::common::{at, direction, given, moving, pushed, random, spheroid, try_with};

const TOLERANCE: f64 = 1e-6;

/// Four bodies near each other: three that move as they are told, one that is pushed.
fn four() -> Suspension {
    let mut rng = fastrand::Rng::with_seed(21);
    let curves = [spheroid(1.0, 0.5), spheroid(0.5, 1.0)];
    let places = [
        [0.0, 0.0, 0.0],
        [2.6, 0.0, 0.0],
        [0.0, 2.6, 0.0],
        [0.0, 0.0, 2.6],
    ];
    let bodies = places.iter().enumerate().map(|(k, &place)| Body {
        motion: if k == 3 {
            pushed(10.0 * random(&mut rng), 10.0 * random(&mut rng))
        } else {
            moving(random(&mut rng), random(&mut rng))
        },
        ..Body::new(
            curves[k % 2].clone(),
            Frame::along(Point3::from(place), direction(&mut rng)),
        )
    });
    Suspension::new(bodies.collect::<Vec<_>>())
}

/// The largest difference of forces and torques, relative to the largest, and of motions, relative
/// to the largest speed.
fn difference(a: &Answer, b: &Answer) -> f64 {
    let largest = b.bodies.iter().fold(0.0f64, |most, body| {
        most.max(body.wrench.force.norm())
            .max(body.wrench.torque.norm())
    });
    a.bodies.iter().zip(&b.bodies).fold(0.0, |most, (a, b)| {
        let wrench = a.wrench - b.wrench;
        let motion = a.motion - b.motion;
        most.max(wrench.force.norm() / largest)
            .max(wrench.torque.norm() / largest)
            .max(motion.velocity.norm().max(motion.angular_velocity.norm()))
    })
}

#[test]
fn agree() {
    let four = four();
    let resolutions: Vec<_> = (four.bodies.iter())
        .map(|body| {
            Arc::new(Resolution {
                panels: Panels::equal_arcs(&*body.shape, 4).expect("panels"),
                order: 12,
                modes: 8,
            })
        })
        .collect();
    let defaults = given(&resolutions, TOLERANCE);
    let reference = try_with(&four, &defaults).expect("an answer");
    let with = |change: &dyn Fn(&mut Options)| {
        let mut options = defaults.clone();
        change(&mut options);
        options
    };
    println!(
        "reference: estimate {:.1e}, {} iterations, {} near points {} bytes, speed {}",
        reference.error_estimate,
        reference.statistics.iterations,
        reference.statistics.near_points,
        reference.statistics.near_bytes,
        reference.largest_speed
    );
    let mut least = with(&|options| options.memory = Some(1));
    let Err(SuspensionError::Memory { needed, .. }) = try_with(&four, &least) else {
        panic!("a byte was enough");
    };
    least.memory = Some((needed * f64::from(1 << 30)) as usize + 2);
    let variants = [
        (
            "exact products",
            with(&|options| options.loosest_product = 0.0),
        ),
        ("one level", with(&|options| options.levels = Levels::One)),
        (
            "restarts",
            with(&|options| options.method = Method::Gmres { restart: 5 }),
        ),
        (
            "BiCGStab",
            with(&|options| options.method = Method::BiCgStab),
        ),
        (
            "BiCGStab, one level",
            with(&|options| {
                options.method = Method::BiCgStab;
                options.levels = Levels::One;
            }),
        ),
        ("little memory", least),
        (
            "single layer",
            with(&|options| options.formulation = Formulation::SingleLayer),
        ),
    ];
    for (name, options) in &variants {
        let answer = try_with(&four, options).expect("an answer");
        let difference = difference(&answer, &reference);
        println!(
            "{name}: {difference:.1e}, estimate {:.1e}, {} iterations, {} products, {} bytes near",
            answer.error_estimate,
            answer.statistics.iterations,
            answer.statistics.products,
            answer.statistics.near_bytes
        );
        assert!(difference <= 3e-7);
    }
}

#[test]
fn rows_that_are_kept_and_rows_that_are_not() {
    let curve = spheroid(1.0, 0.5);
    let bodies = [0.0, 1.05].map(|x| Body {
        motion: moving(Vector3::new(1.0, x, 0.3), Vector3::new(0.0, 0.2, 1.0)),
        ..Body::new(curve.clone(), at(x, 0.0, 0.1 * x))
    });
    let pair = Suspension::new(bodies);
    let resolution = Arc::new(Resolution {
        panels: Panels::equal_arcs(&*curve, 4).expect("panels"),
        order: 12,
        modes: 12,
    });
    let resolutions = [resolution.clone(), resolution];
    let mut options = given(&resolutions, 1e-4);
    let kept = try_with(&pair, &options).expect("an answer");
    options.memory = Some(1);
    let Err(SuspensionError::Memory { needed, .. }) = try_with(&pair, &options) else {
        panic!("a byte was enough");
    };
    options.memory = Some((needed * f64::from(1 << 30)) as usize + 2);
    let not_kept = try_with(&pair, &options).expect("an answer");
    assert!(kept.statistics.near_bytes > 0 && not_kept.statistics.near_bytes == 0);
    assert_eq!(difference(&kept, &not_kept), 0.0);
}
