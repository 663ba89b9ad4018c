//! A sphere in a linear flow, held or free (Faxén 1922): $F = 6\pi a (U - u_\infty)$, $T = 8\pi
//! a^3 (\Omega - \omega_\infty)$, exactly.

use std::f64::consts::PI;

use axistokes::nalgebra::{Matrix3, Point3, Vector3};
use axistokes::{Answer, Body, GeneratingCurve, LinearFlow, Motion, RigidMotion, Spheroid};
use axistokes::{Suspension, Wrench};

use super::ask;

const RADIUS: f64 = 0.7;

fn background() -> LinearFlow {
    LinearFlow {
        velocity: Vector3::new(0.4, -0.1, 0.3),
        gradient: Matrix3::new(0.3, 0.5, -0.2, 0.1, -0.7, 0.6, 0.8, -0.4, 0.4),
    }
}

fn answer(motion: Motion) -> Answer {
    let sphere = Spheroid::sphere(RADIUS).expect("a sphere").shape();
    let suspension = Suspension::new([Body::held(&sphere).with_motion(motion)])
        .in_flow(background())
        .with_probes([Point3::new(0.0, 1.5, 0.5)]);
    ask::answer(&suspension, 1e-12)
}

#[test]
fn a_sphere_of_given_motion_and_a_free_one() {
    let motion = RigidMotion {
        velocity: Vector3::new(0.2, 0.9, -0.5),
        angular_velocity: Vector3::new(-0.3, 0.2, 0.6),
    };
    let flow = background();
    let wrench = Wrench {
        force: 6.0 * PI * RADIUS * (motion.velocity - flow.velocity),
        torque: 8.0 * PI * RADIUS.powi(3) * (motion.angular_velocity - flow.angular_velocity()),
    };
    let given = answer(Motion::Given(motion));
    let free = answer(Motion::Free(wrench));
    assert!((given.bodies[0].wrench.force - wrench.force).norm() < 1e-12 * wrench.force.norm());
    assert!((given.bodies[0].wrench.torque - wrench.torque).norm() < 1e-12 * wrench.torque.norm());
    assert!((free.bodies[0].motion.velocity - motion.velocity).norm() < 1e-12);
    assert!((free.bodies[0].motion.angular_velocity - motion.angular_velocity).norm() < 1e-12);
    // One flow, by two equations.
    let [a, b] = [given.probes[0], free.probes[0]];
    assert!((a.velocity - b.velocity).norm() < 1e-12 && (a.pressure - b.pressure).abs() < 1e-12);
    let exact = 20.0 / 3.0 * PI * RADIUS.powi(3) * flow.strain_rate();
    for answer in [given, free] {
        assert!((answer.bodies[0].stresslet - exact).amax() < 1e-12 * exact.amax());
    }
}
