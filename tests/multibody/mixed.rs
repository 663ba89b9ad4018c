//! Held and free bodies together, swimmers, undisturbed flows, and flows that are known everywhere.

use std::f64::consts::PI;

use axistokes::body::kernel::Stokeslet;
use axistokes::{Answer, Body, Frame, LinearFlow, Motion, Polar, Slip, Suspension};
use nalgebra::{Point3, Unit, Vector3};

use super::common::{Curve, answer, at, ball, direction, moving, pushed, random, spheroid};

/// A held rod, a free disc and a free sphere, with gaps of some tenths.
fn three() -> Vec<Body> {
    let mut rng = fastrand::Rng::with_seed(11);
    let places = [
        Point3::origin(),
        Point3::new(2.2, 0.8, 0.3),
        Point3::new(-0.2, 0.3, 2.4),
    ];
    let curves = [spheroid(1.0, 0.5), spheroid(0.5, 0.8), ball()];
    let frames = places.map(|center| Frame::along(center, direction(&mut rng)));
    let mut bodies: Vec<Body> = curves
        .into_iter()
        .zip(frames)
        .map(|(curve, frame)| Body::new(curve, frame))
        .collect();
    bodies[2].frame = bodies[2].frame.scaled(0.7);
    bodies
}

/// Two discs that move side by side: nothing drives fluid through the narrow gap, whose tractions
/// would be so large that they turn what little the velocity is off by into torques. By the
/// reciprocal theorem the torque is the force when one disc turns.
#[test]
fn torques_in_a_narrow_gap_are_no_worse_than_estimated() {
    let disc = spheroid(0.05, 1.0);
    let discs = |motions: [Motion; 2]| {
        let bodies = [0.0, 0.12]
            .into_iter()
            .zip(motions)
            .map(|(z, motion)| Body {
                motion,
                ..Body::new(disc.clone(), at(0.0, 0.0, z))
            });
        Suspension::new(bodies.collect::<Vec<_>>())
    };
    let (rest, x, y) = (Vector3::zeros(), Vector3::x(), Vector3::y());
    let turning = answer(&discs([moving(rest, y), moving(rest, rest)]), 1e-7);
    let exact: f64 = turning.bodies.iter().map(|body| body.wrench.force.x).sum();
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let found = answer(&discs([moving(x, rest); 2]), tolerance);
        let largest = (found.bodies.iter()).fold(0.0f64, |most, body| {
            most.max(body.wrench.force.norm())
                .max(body.wrench.torque.norm())
        });
        let error = (found.bodies[0].wrench.torque.y - exact).abs() / largest;
        println!(
            "{tolerance:e}: {error:.1e}, estimate {:.1e}",
            found.error_estimate
        );
        assert!(error <= found.error_estimate && found.error_estimate <= tolerance);
    }
}

/// The residual is small in the mean over all nodes. In a gap, where panels are short, an iteration
/// leaves larger errors, and more panels would not help.
#[test]
fn what_an_iteration_leaves_in_a_gap_is_iterated_away() {
    let weight = pushed(-Vector3::z(), Vector3::zeros());
    let bodies = [0.0, 2.01].map(|x| Body {
        motion: weight,
        ..Body::new(ball(), at(x, 0.0, 0.0))
    });
    let answer = answer(&Suspension::new(bodies.to_vec()), 1e-6);
    assert!(answer.error_estimate <= 1e-6);
    let resolution = &answer.bodies[0].resolution;
    // Turned towards each other, the spheres have one axis.
    assert_eq!(resolution.modes, 1);
    let nodes = resolution.panels.len() * resolution.order;
    assert!(nodes <= 7 * 16, "{nodes}");
}

#[test]
fn motions_that_were_found_give_back_the_forces() {
    let mut rng = fastrand::Rng::with_seed(12);
    let mut bodies = three();
    bodies[0].motion = moving(random(&mut rng), random(&mut rng));
    bodies[1].motion = pushed(10.0 * random(&mut rng), 10.0 * random(&mut rng));
    bodies[2].motion = pushed(10.0 * random(&mut rng), Vector3::zeros());
    let background = LinearFlow::shear(0.5, Vector3::x(), Vector3::z());
    let mixed = Suspension {
        background,
        ..Suspension::new(bodies.clone())
    };
    let tolerance = 1e-4;
    let free = answer(&mixed, tolerance);
    for (body, found) in bodies.iter_mut().zip(&free.bodies) {
        body.motion = Motion::Given(found.motion);
    }
    let held = answer(
        &Suspension {
            background,
            ..Suspension::new(bodies)
        },
        tolerance,
    );
    let largest = (held.bodies.iter()).fold(0.0f64, |most, b| {
        most.max(b.wrench.force.norm()).max(b.wrench.torque.norm())
    });
    let error = free
        .bodies
        .iter()
        .zip(&held.bodies)
        .fold(0.0f64, |most, (a, b)| {
            let off = a.wrench - b.wrench;
            most.max(off.force.norm().max(off.torque.norm()) / largest)
        });
    let stresslets = free
        .bodies
        .iter()
        .zip(&held.bodies)
        .map(|(a, b)| (a.stresslet - b.stresslet).amax() / b.stresslet.amax());
    println!(
        "forces and torques given back within {error:.1e}, stresslets {:.1e}; estimates {:.1e} and {:.1e}",
        stresslets.fold(0.0, f64::max),
        free.error_estimate,
        held.error_estimate
    );
    assert!(error <= 1e-5);
}

/// What the forces and torques of one answer would do at the velocities of the other.
fn power(forces: &Answer, motions: &Answer) -> (f64, f64) {
    let pairs = forces.bodies.iter().zip(&motions.bodies);
    let terms: Vec<f64> = pairs
        .map(|(a, b)| {
            a.wrench.force.dot(&b.motion.velocity) + a.wrench.torque.dot(&b.motion.angular_velocity)
        })
        .collect();
    (terms.iter().sum(), terms.iter().map(|x| x.abs()).sum())
}

/// Lorentz's theorem between two problems in each of which other bodies are held.
#[test]
fn two_mixed_problems_are_reciprocal() {
    let mut rng = fastrand::Rng::with_seed(13);
    let [first, second] = [[true, false, false], [false, true, true]].map(|held| {
        let mut bodies = three();
        for (body, held) in bodies.iter_mut().zip(held) {
            body.motion = if held {
                moving(random(&mut rng), random(&mut rng))
            } else {
                pushed(20.0 * random(&mut rng), 20.0 * random(&mut rng))
            };
        }
        answer(&Suspension::new(bodies), 1e-4)
    });
    let ((one, of_one), (other, _)) = (power(&first, &second), power(&second, &first));
    assert!((one - other).abs() <= 4e-6 * of_one);
    println!("{one} {other}: {:.1e}", (one - other).abs() / of_one);
}

/// Two squirmers (Blake 1971) on one axis swim as alone, but for the flow of the other's stresslet
/// and dipole at their centres.
#[test]
fn squirmers_far_apart_swim_as_alone() {
    let r = 1000.0;
    let b = [1.5, 3.0];
    let swimmers = [0.0, r].map(|z| Body {
        motion: Motion::Free(axistokes::Wrench::zero()),
        slip: Some(Slip::squirmer(b)),
        ..Body::new(ball(), at(0.0, 0.0, z))
    });
    let answer = answer(&Suspension::new(swimmers.to_vec()), 1e-12);
    let alone = 2.0 / 3.0 * b[0];
    // On the axis at distance r before (+) or behind (-) the squirmer: 2/3 b1 / r^3 -+ b2 / r^2
    // and, of its second mode, +- b2 / r^4.
    let dipole = alone / r.powi(3);
    let stresslet = b[1] / r.powi(2);
    let errors = [1.0, -1.0].map(|sign| {
        let body = &answer.bodies[if sign > 0.0 { 0 } else { 1 }];
        let exact = alone + dipole + sign * stresslet;
        (body.motion.velocity - exact * Vector3::z()).norm() + body.motion.angular_velocity.norm()
    });
    println!(
        "squirmers {errors:?}, estimate {:.1e}",
        answer.error_estimate
    );
    // Left out: terms of the fourth power.
    assert!(errors.iter().all(|&error| error <= 2e-11));
}

/// In a shear, a pair of free spheres far apart turns at half the vorticity and drifts with the
/// flow at its centres.
#[test]
fn free_spheres_far_apart_turn_with_the_fluid() {
    let background = LinearFlow::shear(0.8, Vector3::x(), Vector3::y());
    let r = 1000.0;
    let line = Unit::new_normalize(Vector3::new(1.0, 0.5, 0.0));
    let mut rng = fastrand::Rng::with_seed(4);
    let free = [0.0, r].map(|s| Body {
        motion: Motion::Free(axistokes::Wrench::zero()),
        ..Body::new(
            ball(),
            Frame::along(Point3::from(s * line.into_inner()), direction(&mut rng)),
        )
    });
    let answer = answer(
        &Suspension {
            background,
            ..Suspension::new(free.to_vec())
        },
        1e-10,
    );
    let rate = background.strain_rate();
    // Of the other's stresslet S = 20/3 pi E: u = -3/(8 pi) (d.S.d) d / r^2 and half its curl, to
    // the leading order (Batchelor & Green 1972).
    for (k, body) in answer.bodies.iter().enumerate() {
        let d = if k == 0 {
            -line.into_inner()
        } else {
            line.into_inner()
        };
        let strained = rate * d;
        let induced = -2.5 * d.dot(&strained) * d / (r * r);
        let turning = 2.5 * d.cross(&strained) / r.powi(3);
        let center = background.at((if k == 0 { 0.0 } else { r }) * line.into_inner());
        let drift = (body.motion.velocity - center - induced).norm();
        let plain = (body.motion.angular_velocity - background.angular_velocity()).norm();
        let turn = (body.motion.angular_velocity - background.angular_velocity() - turning).norm();
        println!(
            "drift {drift:.1e} of {:.1e}, turning {plain:.1e}, with the other's {turn:.1e}; speed {:.1e}, estimate {:.1e}",
            induced.norm(),
            answer.largest_speed,
            answer.error_estimate
        );
    }
}

/// Stokeslets in eight bodies of different shapes, sizes and directions: their flow must come out
/// everywhere outside.
fn known_flow(tolerances: &[f64]) {
    let mut rng = fastrand::Rng::with_seed(5);
    let curves: [Curve; 4] = [
        spheroid(1.0, 0.5),
        spheroid(0.5, 1.0),
        std::sync::Arc::new(Polar::new(&[0.8, 0.1, 0.05, 0.08]).expect("a pear")),
        ball(),
    ];
    let frames: Vec<Frame> = (0..8)
        .map(|i| {
            let place = Point3::new((i % 2) as f64, (i / 2 % 2) as f64, (i / 4) as f64) * 2.3;
            Frame::along(place, direction(&mut rng)).scaled(0.7 + 0.3 * rng.f64())
        })
        .collect();
    let stokeslets: Vec<Stokeslet> = (frames.iter())
        .map(|frame| Stokeslet {
            at: frame
                .point_to_lab(Point3::from(0.3 * random(&mut rng)))
                .coords,
            force: random(&mut rng),
        })
        .collect();
    let exact = |x: Vector3<f64>| -> Vector3<f64> {
        stokeslets
            .iter()
            .map(|stokeslet| stokeslet.velocity(x))
            .sum()
    };
    let slips: Vec<_> = (frames.iter())
        .map(|frame| {
            let (frame, stokeslets) = (*frame, stokeslets.clone());
            Slip::new(move |x| {
                let x = frame.point_to_lab(x.into()).coords;
                frame.vector_to_body(stokeslets.iter().map(|s| s.velocity(x)).sum())
            })
        })
        .collect();
    let bodies: Vec<Body> = (0..8)
        .map(|i| Body {
            slip: Some(slips[i].clone()),
            ..Body::new(curves[i % 4].clone(), frames[i])
        })
        .collect();
    // Far away, and at a millionth from the surfaces.
    let mut probes: Vec<Point3<f64>> = (0..30)
        .map(|_| {
            Point3::from(3.0 * direction(&mut rng).into_inner() * (2.0 + rng.f64()))
                + Vector3::repeat(1.15)
        })
        .collect();
    let far = probes.len();
    for body in &bodies {
        for _ in 0..6 {
            let ends = body.shape.breakpoints();
            let t = ends[0] + (ends[ends.len() - 1] - ends[0]) * rng.f64();
            let (p, step) = (body.shape.point(t), 1e-7);
            let (before, after) = (body.shape.point(t - step), body.shape.point(t + step));
            let mut normal = [before.z - after.z, after.r - before.r];
            // Outward or inward: away from the centre will do for these shapes.
            if normal[0] * p.r + normal[1] * p.z < 0.0 {
                normal = normal.map(|x| -x);
            }
            let length = normal[0].hypot(normal[1]);
            let height = 1e-6 / body.frame.scale();
            let (r, z) = (
                p.r + height * normal[0] / length,
                p.z + height * normal[1] / length,
            );
            let (sin, cos) = (2.0 * PI * rng.f64()).sin_cos();
            probes.push(body.frame.point_to_lab(Point3::new(r * cos, r * sin, z)));
        }
    }
    let suspension = Suspension {
        probes: probes.clone(),
        ..Suspension::new(bodies)
    };
    for &tolerance in tolerances {
        let answer = answer(&suspension, tolerance);
        let error = |(x, found): (&Point3<f64>, &axistokes::FlowAt)| {
            (found.velocity - exact(x.coords)).norm() / answer.largest_speed
        };
        let errors: Vec<f64> = probes.iter().zip(&answer.probes).map(error).collect();
        let most = |errors: &[f64]| errors.iter().fold(0.0f64, |a, &b| a.max(b));
        println!(
            "tolerance {tolerance:.0e}: far {:.1e}, near {:.1e}, estimate {:.1e}, {} points, {} near, {} modes, {:?}",
            most(&errors[..far]),
            most(&errors[far..]),
            answer.error_estimate,
            answer.statistics.points,
            answer.statistics.near_points,
            answer.bodies[0].resolution.modes,
            answer.statistics.timings
        );
        // Forces are those of the Stokeslets.
        let forces = answer
            .bodies
            .iter()
            .zip(&stokeslets)
            .map(|(b, s)| (b.wrench.force - s.force).norm());
        println!("  forces {:.1e}", forces.fold(0.0, f64::max));
        assert!(most(&errors) <= answer.error_estimate && most(&errors) <= 0.5 * tolerance);
    }
}

#[test]
fn flow_of_stokeslets_comes_out_again() {
    known_flow(&[1e-4]);
}

#[test]
#[ignore = "minutes"]
fn flow_of_stokeslets_comes_out_again_to_ten_digits() {
    known_flow(&[1e-7, 1e-10]);
}
