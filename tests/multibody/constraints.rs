//! Bodies that are held in some directions and free in the others.

use axistokes::{Answer, Body, Component, Frame, Motion, Suspension};
use nalgebra::{Point3, UnitQuaternion, Vector3};

use super::common::{answer, at, ball, direction, moving, random, spheroid};

const FREE: Component = Component::Free(0.0);
const HELD: Component = Component::Imposed(0.0);

/// In closed form (Kim & Karrila 1991, section 3.3): a spheroid 1 x 0.5 at 45 degrees takes a force
/// of -12.17134697420 along z and 0.8244704675802 across to move along -z at unit speed.
#[test]
fn a_tilted_rod_on_a_vertical_line() {
    let push = Component::Free(-1.0);
    let rod = Body::held(&spheroid(1.0, 0.5)).along([1.0, 0.0, 1.0]);
    let rod = rod.with_motion(Motion::components([HELD, HELD, push, FREE, FREE, FREE]));
    for (scale, viscosity) in [(1.0, 1.0), (2.0, 3.0)] {
        let asked = Suspension::new([rod.clone().scaled(scale)]).with_viscosity(viscosity);
        let answer = answer(&asked, 1e-11);
        let body = &answer.bodies[0];
        let speed = 1.0 / (12.17134697420 * scale * viscosity);
        let motion = (body.motion.velocity + speed * Vector3::z()).norm() / speed;
        let across = 0.8244704675802 / 12.17134697420;
        let force = (body.wrench.force - Vector3::new(across, 0.0, -1.0)).norm();
        let turning = body.motion.angular_velocity.norm() + body.wrench.torque.norm();
        println!("{scale} {viscosity}: motion {motion:.1e}, force {force:.1e}, {turning:.1e}");
        // The reference has thirteen digits.
        assert!(motion < 2e-12 && force < 1e-13 && turning < 9e-16);
        assert!(answer.error_estimate <= 1e-11);
    }
}

/// A sphere that is kept in place turns under a torque as T/8 pi a^3, and needs no force.
#[test]
fn a_pinned_sphere_turns() {
    let torque = Vector3::new(0.3, -0.2, 0.5);
    let pinned = Body::held(&ball())
        .scaled(2.0)
        .with_motion(Motion::pinned(torque));
    let answer = answer(&Suspension::new([pinned]), 1e-11);
    let body = &answer.bodies[0];
    let exact = torque / (8.0 * std::f64::consts::PI * 8.0);
    assert!((body.motion.angular_velocity - exact).norm() < 1e-13);
    assert_eq!(body.motion.velocity.norm(), 0.0);
    assert!(body.wrench.force.norm() < 1e-12);
}

/// Three bodies of which all motions are given, and what they take.
fn reference(tolerance: f64) -> (Vec<Body>, Answer) {
    let mut rng = fastrand::Rng::with_seed(41);
    let shapes = [spheroid(1.0, 0.5), spheroid(0.5, 0.8), ball()];
    let places = [[0.0; 3], [2.2, 0.8, 0.3], [-0.2, 0.3, 2.4]];
    let bodies = shapes.into_iter().zip(places).map(|(shape, place)| {
        let frame = Frame::along(Point3::from(place), direction(&mut rng));
        let motion = moving(random(&mut rng), random(&mut rng));
        Body::new(shape, frame.scaled(0.9)).with_motion(motion)
    });
    let bodies: Vec<Body> = bodies.collect();
    let answer = answer(&Suspension::new(bodies.clone()), tolerance);
    (bodies, answer)
}

/// A body that is given some components of a motion, and the forces that this motion takes in the
/// others, moves so.
#[test]
fn components_that_were_found_give_back_the_others() {
    let tolerance = 1e-5;
    let (bodies, held) = reference(tolerance);
    let mut rng = fastrand::Rng::with_seed(42);
    for pattern in [
        [[true, false, true, false, true, false]; 3],
        [
            [false; 6],
            [true; 6],
            [false, false, true, true, true, true],
        ],
        [[true, true, true, false, false, false]; 3],
    ] {
        let axes = UnitQuaternion::from_scaled_axis(2.0 * random(&mut rng));
        let mixed = bodies.iter().enumerate().map(|(i, body)| {
            let found = &held.bodies[i];
            let [u, o] = [found.motion.velocity, found.motion.angular_velocity];
            let [f, t] = [found.wrench.force, found.wrench.torque];
            let components = [0, 1, 2, 3, 4, 5].map(|k| {
                let along = |v: [Vector3<f64>; 2]| (axes.inverse() * v[k / 3])[k % 3];
                if pattern[i][k] {
                    Component::Imposed(along([u, o]))
                } else {
                    Component::Free(along([f, t]))
                }
            });
            let motion = Motion::components_along(components, axes);
            body.clone().with_motion(motion)
        });
        let answer = answer(&Suspension::new(mixed.collect::<Vec<_>>()), tolerance);
        let largest = |answer: &Answer| {
            let forces = answer.bodies.iter().map(|b| b.wrench.force.norm());
            forces.fold(0.0, f64::max)
        };
        let both = answer.bodies.iter().zip(&held.bodies);
        let error = both.fold(0.0f64, |most, (a, b)| {
            let (wrench, motion) = (a.wrench - b.wrench, a.motion - b.motion);
            most.max(wrench.force.norm().max(wrench.torque.norm()) / largest(&held))
                .max(motion.velocity.norm().max(motion.angular_velocity.norm()))
        });
        println!(
            "{error:.1e}, estimates {:.1e} and {:.1e}, {} iterations",
            answer.error_estimate, held.error_estimate, answer.statistics.iteration.iterations
        );
        assert!(error <= 0.5 * tolerance && answer.error_estimate <= tolerance);
    }
}

/// Two pinned spheres side by side, one of them turned: the other turns against it, as far away as
/// the rotlet says, $\Omega_2 = \frac12 \nabla \times (T \times x / 8\pi r^3)$.
#[test]
fn pinned_spheres_turn_each_other() {
    let r = 40.0;
    let torque = Vector3::y();
    let pinned = [Vector3::zeros(), torque].map(Motion::pinned);
    let bodies = [at(0.0, 0.0, 0.0), at(r, 0.0, 0.0)].into_iter().zip(pinned);
    let bodies = bodies.map(|(frame, motion)| Body::new(ball(), frame).with_motion(motion));
    let answer = answer(&Suspension::new(bodies.collect::<Vec<_>>()), 1e-10);
    let found = answer.bodies[0].motion.angular_velocity.y;
    let exact = -1.0 / (16.0 * std::f64::consts::PI * r.powi(3));
    println!("{found:e} {exact:e}");
    // The next terms are smaller by r^-1, from the force that pins: 3/4r.
    assert!((found / exact - 1.0).abs() < 5e-3);
}
