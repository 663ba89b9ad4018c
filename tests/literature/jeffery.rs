//! Free spheroids in linear flows (Jeffery 1922): $\Omega = \omega + \Lambda\, d \times E d$ with
//! $\Lambda = (q^2 - 1)/(q^2 + 1)$ for aspect ratio $q$.

use std::sync::Arc;

use axistokes::body::discretization::Discretization;
use axistokes::body::mobility::MobilitySolver;
use axistokes::body::surface::SurfaceModes;
use axistokes::nalgebra::{Matrix3, Point3, Unit, Vector3};
use axistokes::{
    Body, Frame, GeneratingCurve, LinearFlow, Panels, Silent, Spheroid, Suspension, Wrench,
};
use fastrand::Rng;

use super::ask::answer;

fn random_vector(rng: &mut Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| 2.0 * rng.f64() - 1.0)
}

/// The largest errors of velocity and angular velocity at random places and orientations, in the
/// laboratory.
fn errors(solver: &MobilitySolver, aspect: f64, flow: &LinearFlow, rng: &mut Rng) -> f64 {
    let mut worst = 0.0f64;
    for _ in 0..20 {
        let center = Point3::from(random_vector(rng));
        let axis = Unit::new_normalize(random_vector(rng));
        let frame = Frame::along(center, axis);
        let background = flow.in_frame(&frame).on(solver.discretization()).modes;
        let rest = SurfaceModes::zero(0, background.nodes());
        let (motion, _) = solver.solve(Wrench::zero(), rest.plus(-1.0, &background));
        let lambda = (aspect * aspect - 1.0) / (aspect * aspect + 1.0);
        let turning = axis.cross(&(flow.strain_rate() * *axis));
        let exact = flow.angular_velocity() + lambda * turning;
        let [velocity, angular_velocity] =
            [motion.velocity, motion.angular_velocity].map(|v| frame.vector_to_lab(v));
        worst = worst
            .max((velocity - flow.at(center.coords)).norm())
            .max((angular_velocity - exact).norm());
    }
    worst
}

#[test]
fn every_aspect_and_orientation_turns_as_in_closed_form() {
    let mut rng = Rng::with_seed(2);
    let shear = LinearFlow::shear(1.0, Vector3::x(), Vector3::z());
    for (polar, equatorial) in [
        (0.1, 1.0),
        (0.2, 1.0),
        (0.5, 1.0),
        (1.0, 1.0),
        (2.0, 1.0),
        (1.0, 0.25),
        (1.0, 0.1),
    ] {
        let curve = Arc::new(Spheroid::new(polar, equatorial).expect("a spheroid"));
        let panels = Panels::resolving(&*curve, 16, 1e-10).expect("panels");
        let nodes = Discretization::new(curve, panels, 16).expect("nodes");
        let solver = MobilitySolver::new(nodes, 2, &Silent).expect("a solver");
        let mut gradient = Matrix3::from_fn(|_, _| 2.0 * rng.f64() - 1.0);
        gradient -= Matrix3::from_diagonal_element(gradient.trace() / 3.0);
        let linear = LinearFlow {
            velocity: random_vector(&mut rng),
            gradient,
        };
        let [in_shear, in_linear] =
            [shear, linear].map(|flow| errors(&solver, polar / equatorial, &flow, &mut rng));
        println!(
            "{polar} : {equatorial}: in shear {in_shear:.1e}, in a linear flow {in_linear:.1e}"
        );
        assert!(in_shear <= 2e-14 && in_linear <= 3e-14);
    }
}

/// The same question asked as a problem, with its error estimate.
#[test]
fn a_tilted_rod_in_shear() {
    let rod = Spheroid::new(1.0, 0.25).expect("a spheroid").shape();
    let flow = LinearFlow::shear(1.0, Vector3::x(), Vector3::z());
    let tilted = Body::free(&rod).along([0.8, 0.0, 0.6]);
    let answer = answer(&Suspension::new([tilted]).in_flow(flow), 1e-11);
    let exact: f64 = 0.5 - 15.0 / 17.0 * 0.5 * (0.8 * 0.8 - 0.6 * 0.6);
    let exact = exact * Vector3::y();
    let found = answer.bodies[0].motion.angular_velocity;
    assert!((found - exact).norm() <= 1e-11);
    assert!(answer.error_estimate <= 1e-11 && answer.largest_speed > 0.5);
}
