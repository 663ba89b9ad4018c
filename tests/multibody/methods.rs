//! Other ways to the same answer.

use std::sync::Arc;

use axistokes::krylov::Method;
use axistokes::multibody::SuspensionError;
use axistokes::multibody::suspension::{Answer, Options};
use axistokes::{Body, Formulation, Frame, Panels, Resolution, Silent, Suspension};
use nalgebra::{Point3, Vector3};

use super::common::{at, direction, moving, pushed, random, spheroid};

const TOLERANCE: f64 = 1e-6;

/// Four bodies near each other: three that move as they are told, one that is pushed.
fn four() -> Suspension<'static> {
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
    Suspension::new(bodies.collect())
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
                panels: Panels::equal_arcs(&*body.curve, 4).expect("panels"),
                order: 12,
                modes: 8,
            })
        })
        .collect();
    let reference = four
        .at_resolutions(&resolutions, TOLERANCE, &Silent)
        .expect("an answer");
    let defaults = Options::default();
    let with = |options: Options| Suspension {
        options,
        ..four.clone()
    };
    println!(
        "reference: estimate {:.1e}, {} iterations, {} near points {} bytes, speed {}",
        reference.error_estimate,
        reference.iteration.iterations,
        reference.near.0,
        reference.near.1,
        reference.largest_speed
    );
    let mut least = with(Options {
        memory: Some(1),
        ..defaults
    });
    let Err(SuspensionError::Memory { needed, .. }) =
        least.at_resolutions(&resolutions, TOLERANCE, &Silent)
    else {
        panic!("a byte was enough");
    };
    least.options.memory = Some((needed * f64::from(1 << 30)) as usize + 2);
    let variants = [
        (
            "exact products",
            with(Options {
                loosest_product: 0.0,
                ..defaults
            }),
        ),
        (
            "one level",
            with(Options {
                two_level: false,
                ..defaults
            }),
        ),
        (
            "restarts",
            with(Options {
                method: Method::Gmres { restart: 5 },
                ..defaults
            }),
        ),
        (
            "BiCGStab",
            with(Options {
                method: Method::BiCgStab,
                ..defaults
            }),
        ),
        (
            "BiCGStab, one level",
            with(Options {
                method: Method::BiCgStab,
                two_level: false,
                ..defaults
            }),
        ),
        ("little memory", least),
        (
            "single layer",
            Suspension {
                formulation: Formulation::SingleLayer,
                ..four.clone()
            },
        ),
    ];
    for (name, suspension) in &variants {
        let answer = suspension
            .at_resolutions(&resolutions, TOLERANCE, &Silent)
            .expect("an answer");
        let difference = difference(&answer, &reference);
        println!(
            "{name}: {difference:.1e}, estimate {:.1e}, {} iterations, {} products, {} bytes near",
            answer.error_estimate, answer.iteration.iterations, answer.products, answer.near.1
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
    let mut pair = Suspension::new(bodies.to_vec());
    let resolution = Arc::new(Resolution {
        panels: Panels::equal_arcs(&*curve, 4).expect("panels"),
        order: 12,
        modes: 12,
    });
    let resolutions = [resolution.clone(), resolution];
    let kept = pair.at_resolutions(&resolutions, 1e-4, &Silent);
    let kept = kept.expect("an answer");
    pair.options.memory = Some(1);
    let Err(SuspensionError::Memory { needed, .. }) =
        pair.at_resolutions(&resolutions, 1e-4, &Silent)
    else {
        panic!("a byte was enough");
    };
    pair.options.memory = Some((needed * f64::from(1 << 30)) as usize + 2);
    let not_kept = pair.at_resolutions(&resolutions, 1e-4, &Silent);
    let not_kept = not_kept.expect("an answer");
    assert!(kept.near.1 > 0 && not_kept.near.1 == 0);
    assert_eq!(difference(&kept, &not_kept), 0.0);
}
