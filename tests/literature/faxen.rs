//! A sphere in a linear flow, held or free (Faxén 1922): $F = 6\pi a (U - u_\infty)$, $T = 8\pi a^3
//! (\Omega - \omega_\infty)$, exactly.

use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::nalgebra::{Matrix3, Point3, Vector3};
use axistokes::{LinearFlow, Motion, Problem, RigidMotion, Silent, Spheroid, Wrench};

const RADIUS: f64 = 0.7;

fn background() -> LinearFlow {
    LinearFlow {
        velocity: Vector3::new(0.4, -0.1, 0.3),
        gradient: Matrix3::new(0.3, 0.5, -0.2, 0.1, -0.7, 0.6, 0.8, -0.4, 0.4),
    }
}

fn problem(motion: Motion) -> Problem<'static> {
    Problem {
        motion,
        background: background(),
        targets: const { &[Point3::new(0.0, 1.5, 0.5)] },
        ..Problem::new(Arc::new(Spheroid::sphere(RADIUS).expect("a sphere")))
    }
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
    let given = problem(Motion::Given(motion))
        .to_tolerance(1e-12, &Silent)
        .expect("an answer");
    let free = problem(Motion::Free(wrench))
        .to_tolerance(1e-12, &Silent)
        .expect("an answer");
    assert!((given.wrench.force - wrench.force).norm() < 1e-12 * wrench.force.norm());
    assert!((given.wrench.torque - wrench.torque).norm() < 1e-12 * wrench.torque.norm());
    assert!((free.motion.velocity - motion.velocity).norm() < 1e-12);
    assert!((free.motion.angular_velocity - motion.angular_velocity).norm() < 1e-12);
    // One flow, by two equations.
    let [a, b] = [given.flow[0], free.flow[0]];
    assert!((a.velocity - b.velocity).norm() < 1e-12 && (a.pressure - b.pressure).abs() < 1e-12);
    let exact = 20.0 / 3.0 * PI * RADIUS.powi(3) * flow.strain_rate();
    for answer in [given, free] {
        assert!((answer.body_flow.stresslet() - exact).amax() < 1e-12 * exact.amax());
    }
}
