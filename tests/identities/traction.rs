//! Tractions of whole flows: what they integrate to, and the reciprocal theorem.

use std::sync::Arc;

use axistokes::body::flow::Side;
use axistokes::body::layers::Layers;
use axistokes::body::matrix::{LayerPotential, ModalMatrices};
use axistokes::body::{Discretization, Flow, SurfaceModes};
use axistokes::nalgebra::{Matrix3, Vector3};
use axistokes::{
    Answer, Body, GeneratingCurve, LinearFlow, Motion, Panels, Polar, Resolution, RigidMotion,
    Shape, Silent, Slip, Spheroid, Suspension, Torus, Wrench,
};
use fastrand::Rng;

use super::ask::{given, try_with};

fn random_vector(rng: &mut Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| 2.0 * rng.f64() - 1.0)
}

fn random_motion(rng: &mut Rng) -> RigidMotion {
    RigidMotion {
        velocity: random_vector(rng),
        angular_velocity: random_vector(rng),
    }
}

fn curves() -> [Shape; 3] {
    [
        Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid")),
        Arc::new(Polar::new(&[1.0, 0.2, 0.1, 0.1]).expect("a pear")),
        Arc::new(Torus::new(1.0, 0.4).expect("a torus")),
    ]
}

fn solved(body: Body, background: LinearFlow) -> (Answer, SurfaceModes) {
    // Tractions take a derivative of the density: panels that serve velocities to 1e-12 are not
    // enough.
    let resolution = Resolution {
        panels: Panels::equal_arcs(&*body.shape, 10).expect("panels"),
        order: 16,
        modes: 24,
    };
    let answer = at(body, background, resolution);
    let traction = traction_of(&answer);
    (answer, traction)
}

fn at(body: Body, background: LinearFlow, resolution: Resolution) -> Answer {
    let suspension = Suspension::new([body]).in_flow(background);
    try_with(&suspension, &given(&[Arc::new(resolution)], 1e-14)).expect("an answer")
}

fn traction_of(answer: &Answer) -> SurfaceModes {
    let stresses = answer.flow.surface_stresses(&[0], &Silent);
    stresses.expect("a traction")[0].traction.clone()
}

fn nodes_of(answer: &Answer) -> &Discretization {
    answer.flow.bodies()[0].disturbance.discretization()
}

/// The largest difference of a traction from a function of the place, at a few azimuths of every
/// node.
fn error(answer: &Answer, exact: impl Fn(Vector3<f64>) -> Vector3<f64>) -> f64 {
    let traction = traction_of(answer);
    let mut most = 0.0f64;
    for (k, node) in nodes_of(answer).nodes().iter().enumerate() {
        for theta in [0.3f64, 1.7, 4.0] {
            let (sin, cos) = theta.sin_cos();
            let [r, t, z] = traction.at(k, theta);
            let found = Vector3::new(r * cos - t * sin, r * sin + t * cos, z);
            most =
                most.max((found - exact(Vector3::new(node.r * cos, node.r * sin, node.z))).norm());
        }
    }
    most
}

/// Kim and Karrila 1991, chapter 4: -3 U/2a, -3 Omega x n, and 5 E n with the background's 2 E n.
#[test]
fn of_spheres_is_exact() {
    let (u, omega) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(-0.5, 0.2, 1.0));
    let sphere: Arc<dyn GeneratingCurve> = Arc::new(Spheroid::sphere(1.0).expect("a sphere"));
    let motion = Motion::Given(RigidMotion {
        velocity: u,
        angular_velocity: omega,
    });
    let body = Body::held(&sphere).with_motion(motion);
    let (moving, _) = solved(body, LinearFlow::rest());
    let found = error(&moving, |n| -1.5 * u - 3.0 * omega.cross(&n));
    println!("sphere that moves and turns: {found:.1e}");
    assert!(found < 1e-11);
    let strain = Matrix3::new(1.0, 0.3, 0.0, 0.3, -0.4, 0.1, 0.0, 0.1, -0.6);
    let background = LinearFlow {
        velocity: Vector3::zeros(),
        gradient: strain,
    };
    let (strained, _) = solved(Body::held(&sphere), background);
    let found = error(&strained, |n| 5.0 * strain * n);
    println!("sphere in strain: {found:.1e}");
    assert!(found < 1e-11);
}

/// -(F/4 pi a b c) times the distance of the tangent plane from the centre (Brenner 1964).
///
/// The density is analytic as far as the foci of the meridian. From the end of a panel at the
/// slender one's pole these are only 0.64 half lengths away with 10 panels, 1.3 with 20: 16 nodes
/// then gain a factor of a hundred or so, until rounding is left.
#[test]
fn of_spheroids_under_a_force_converges_to_the_exact_one() {
    for (polar, equatorial, panels, floor) in [
        (1.0, 0.25, [10, 20, 40], 1e-10),
        (0.4, 1.0, [5, 10, 20], 2e-12),
    ] {
        let curve: Arc<dyn GeneratingCurve> =
            Arc::new(Spheroid::new(polar, equatorial).expect("a spheroid"));
        let force = Vector3::new(0.3, -1.0, 0.7);
        let size = 4.0 * std::f64::consts::PI * polar * equatorial * equatorial;
        let (a2, c2) = (equatorial * equatorial, polar * polar);
        let exact = |x: Vector3<f64>| {
            let plane =
                (x.x * x.x / (a2 * a2) + x.y * x.y / (a2 * a2) + x.z * x.z / (c2 * c2)).sqrt();
            -force / (size * plane)
        };
        let errors = panels.map(|panels| {
            let resolution = Resolution {
                panels: Panels::equal_arcs(&*curve, panels).expect("panels"),
                order: 16,
                modes: 1,
            };
            let free = at(
                Body::free(&curve).pushed(force),
                LinearFlow::rest(),
                resolution,
            );
            let found = error(&free, exact);
            println!("spheroid {polar} x {equatorial} under a force, {panels} panels: {found:.1e}");
            found
        });
        let [coarse, fine, finest] = errors;
        assert!(fine < 0.02 * coarse && finest < fine && finest < floor);
    }
}

/// Of a single layer, by close evaluation against the adjoint of the double layer: the limits are
/// -1/2 and +1/2 of the density plus the principal value, from outside and inside.
#[test]
fn of_a_single_layer_jumps_by_the_density() {
    for curve in curves() {
        let panels = Panels::equal_arcs(&*curve, 12).expect("panels");
        let nodes = Discretization::new(curve, panels, 16).expect("nodes");
        let density = SurfaceModes::sample(&nodes, 12, |x| {
            Vector3::new((2.0 * x.x + x.z).sin(), x.y * x.z, (x.x - x.y).cos())
        })
        .modes;
        let matrices = ModalMatrices::of(LayerPotential::SingleTraction, &nodes, 12).expect("T");
        let principal = matrices.apply(&nodes, &density);
        let flow = Flow::new(
            &nodes,
            Layers {
                double: SurfaceModes::zero(0, nodes.nodes().len()),
                single: density.clone(),
            },
        );
        for (side, jump) in [(Side::Exterior, -0.5), (Side::Interior, 0.5)] {
            let found = flow.traction(side).expect("a traction");
            let error = found.plus(-1.0, &principal.clone().plus(jump, &density));
            let error = (0..=12).map(|n| error.amplitude(n)).fold(0.0, f64::max);
            println!("{:?} {side:?}: {error:.1e}", nodes.curve());
            assert!(error < 1e-12);
        }
    }
}

/// The traction of a double layer is the same on both sides (Lyapunov and Tauber), and its
/// integrals vanish.
#[test]
fn of_a_double_layer_does_not_jump() {
    for curve in curves() {
        let panels = Panels::equal_arcs(&*curve, 12).expect("panels");
        let nodes = Discretization::new(curve, panels, 16).expect("nodes");
        let density = SurfaceModes::sample(&nodes, 12, |x| {
            Vector3::new((2.0 * x.x + x.z).sin(), x.y * x.z, (x.x - x.y).cos())
        })
        .modes;
        let flow = Flow::new(
            &nodes,
            Layers {
                single: SurfaceModes::zero(0, nodes.nodes().len()),
                double: density.clone(),
            },
        );
        let outside = flow.traction(Side::Exterior).expect("a traction");
        let inside = flow.traction(Side::Interior).expect("a traction");
        let jump = outside.clone().plus(-1.0, &inside);
        let jump = (0..=12).map(|n| jump.amplitude(n)).fold(0.0, f64::max);
        let Wrench { force, torque } = outside.wrench(&nodes);
        println!(
            "{:?}: jump {jump:.1e}, force {:.1e}, torque {:.1e}",
            nodes.curve(),
            force.norm(),
            torque.norm()
        );
        assert!(jump < 4e-12 && force.norm() < 2e-13 && torque.norm() < 9e-14);
    }
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
            let (answer, traction) = solved(Body::held(&curve).with_motion(motion), background);
            let found = traction.wrench(nodes_of(&answer));
            let wrench = answer.bodies[0].wrench;
            let scale = wrench.force.norm().max(wrench.torque.norm());
            let force = (found.force + wrench.force).norm() / scale;
            let torque = (found.torque + wrench.torque).norm() / scale;
            println!("{curve:?} {motion:?}: force {force:.1e}, torque {torque:.1e}");
            assert!(force <= 8e-13 && torque <= 1e-12);
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
            let slip = Slip::new(move |x| wave.dot(&x).sin() * amplitude);
            let motion = Motion::Given(random_motion(&mut rng));
            let body = Body::held(&curve).with_motion(motion).with_slip(slip);
            solved(body, LinearFlow::rest())
        });
        let nodes = nodes_of(&a.0);
        let [here, there] = [&a.0, &b.0].map(|it| it.flow.bodies()[0].surface_velocity());
        let forth = here.inner_product(nodes, &b.1);
        let back = there.inner_product(nodes, &a.1);
        let power = -here.inner_product(nodes, &a.1);
        let error = (forth - back).abs() / power;
        let direct = a.0.flow.powers(&Silent).expect("a power")[0];
        println!(
            "{curve:?}: {forth} and {back}, {error:.1e} of the power; powers {power} and {direct}"
        );
        assert!(error <= 6e-15 && (power / direct - 1.0).abs() <= 5e-13);
    }
}
