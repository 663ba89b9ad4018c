//! Tractions of whole flows: what they integrate to, and the reciprocal theorem.

use std::sync::Arc;

use axistokes::nalgebra::{Matrix3, Vector3};
use axistokes::{
    Answer, GeneratingCurve, LinearFlow, Motion, Panels, Polar, Problem, Resolution, RigidMotion,
    Silent, Spheroid, SurfaceModes, Torus, Wrench,
};
use fastrand::Rng;

fn random_vector(rng: &mut Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| 2.0 * rng.f64() - 1.0)
}

fn random_motion(rng: &mut Rng) -> RigidMotion {
    RigidMotion {
        velocity: random_vector(rng),
        angular_velocity: random_vector(rng),
    }
}

fn curves() -> [Arc<dyn GeneratingCurve>; 3] {
    [
        Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid")),
        Arc::new(Polar::new(&[1.0, 0.2, 0.1, 0.1]).expect("a pear")),
        Arc::new(Torus::new(1.0, 0.4).expect("a torus")),
    ]
}

fn solved(problem: Problem<'_>) -> (Answer, SurfaceModes) {
    // Tractions take a derivative of the density: panels that serve velocities to 1e-12 are not enough.
    let resolution = Resolution {
        panels: Panels::equal_arcs(&*problem.curve, 10).expect("panels"),
        order: 16,
        modes: 24,
    };
    let answer = problem
        .at_resolution(resolution, &Silent)
        .expect("an answer");
    let traction = answer.body_flow.traction().expect("a traction");
    (answer, traction)
}

/// Against the force and torque of the density, in a linear flow and for free bodies too.
#[test]
fn integrates_to_force_and_torque() {
    let mut rng = Rng::with_seed(5);
    for curve in curves() {
        let background = LinearFlow {
            velocity: random_vector(&mut rng),
            gradient: Matrix3::new(0.3, 0.5, -0.2, 0.1, -0.7, 0.6, 0.8, -0.4, 0.4),
        };
        let free = Wrench {
            force: random_vector(&mut rng),
            torque: random_vector(&mut rng),
        };
        for motion in [Motion::Given(random_motion(&mut rng)), Motion::Free(free)] {
            let (answer, traction) = solved(Problem {
                motion,
                background,
                ..Problem::new(curve.clone())
            });
            let found = Wrench::of(&answer.body_flow.discretization, &traction);
            let scale = answer.wrench.force.norm().max(answer.wrench.torque.norm());
            let force = (found.force + answer.wrench.force).norm() / scale;
            let torque = (found.torque + answer.wrench.torque).norm() / scale;
            println!("{curve:?} {motion:?}: force {force:.1e}, torque {torque:.1e}");
            assert!(force <= 1e-10 && torque <= 1e-10);
        }
    }
}

/// Lorentz: $\int u \cdot \sigma'\nu = \int u' \cdot \sigma\nu$, for rigid motions with slip.
#[test]
fn two_motions_are_reciprocal() {
    let mut rng = Rng::with_seed(6);
    for curve in curves() {
        let [a, b] = [(); 2].map(|()| {
            let (wave, amplitude) = (random_vector(&mut rng), random_vector(&mut rng));
            let slip = |x: Vector3<f64>| wave.dot(&x).sin() * amplitude;
            let motion = Motion::Given(random_motion(&mut rng));
            solved(Problem {
                motion,
                slip: Some(&slip),
                ..Problem::new(curve.clone())
            })
        });
        let nodes = &a.0.body_flow.discretization;
        let (here, there) = (
            a.0.body_flow.surface_velocity(),
            b.0.body_flow.surface_velocity(),
        );
        let forth = here.inner_product(nodes, &b.1);
        let back = there.inner_product(nodes, &a.1);
        let power = -here.inner_product(nodes, &a.1);
        let error = (forth - back).abs() / power;
        let direct = a.0.body_flow.power().expect("a power");
        println!(
            "{curve:?}: {forth} and {back}, {error:.1e} of the power; powers {power} and {direct}"
        );
        assert!(error <= 1e-10 && (power / direct - 1.0).abs() <= 1e-10);
    }
}
