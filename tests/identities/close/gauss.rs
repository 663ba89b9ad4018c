//! Identities of the layer potentials that hold off the surface and on it, for densities that are
//! known without solving anything.

use axistokes::body::flow::Side;
use axistokes::body::layers::Layers;
use axistokes::body::matrix::{LayerPotential, ModalMatrices};
use axistokes::body::{Discretization, Flow, FlowGradientAt, SurfaceModes};
use nalgebra::{Matrix3, Vector3};

use super::bodies::bodies;
use super::exact::{Errors, Stokeslets};
use super::places::{SIDES, places, targets};

const DISTANCES: [f64; 9] = [1e-1, 1e-2, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 0.0];

pub fn none(nodes: &Discretization) -> SurfaceModes {
    SurfaceModes::zero(0, nodes.nodes().len())
}

/// The worst errors over distances.
fn worst(
    nodes: &Discretization,
    layers: &Layers,
    side: Side,
    count: usize,
    exact: impl Fn(Vector3<f64>) -> FlowGradientAt,
) -> Errors {
    let flow = Flow::new(nodes, layers.clone()).limit_from(side);
    let mut worst = Errors::default();
    for (k, distance) in DISTANCES.into_iter().enumerate() {
        // The thinnest body and the smallest hole have a tenth of room.
        let distance = 0.4 * distance;
        let targets = targets(nodes, &places(nodes, count, k as u64), side, distance);
        let found = flow.gradient_at(&targets, 1e-15).expect("a flow");
        worst = worst.and(Errors::of(&targets, &found, &exact));
    }
    worst
}

/// $D[U + \Omega \times x]$ is minus the motion inside, nothing outside, and half of that as a
/// principal value.
#[test]
fn the_double_layer_of_a_rigid_motion_is_that_motion_inside() {
    let (u, omega) = (Vector3::new(0.6, -0.3, 0.8), Vector3::new(-0.5, 0.7, 0.4));
    for body in bodies() {
        let nodes = body.nodes(body.panels(16), 16);
        let motion = |x: Vector3<f64>| u + omega.cross(&x);
        let double = SurfaceModes::sample(&nodes, 2, motion).modes;
        let matrices = ModalMatrices::of(LayerPotential::Double, &nodes, 2).expect("D");
        let principal = matrices.apply(&nodes, &double);
        let principal = principal.plus(0.5, &double);
        let principal = (0..=2).map(|n| principal.amplitude(n)).fold(0.0, f64::max);
        println!("{}: principal value {principal:.1e}", body.name);
        assert!(principal < 1e-12);
        let layers = Layers {
            single: none(&nodes),
            double,
        };
        for side in SIDES {
            let found = worst(&nodes, &layers, side, 16, |x| match side {
                Side::Exterior => FlowGradientAt::default(),
                Side::Interior => FlowGradientAt {
                    velocity: -motion(x),
                    pressure: 0.0,
                    gradient: -Matrix3::new(
                        0.0, -omega.z, omega.y, omega.z, 0.0, -omega.x, -omega.y, omega.x, 0.0,
                    ),
                },
            });
            println!("{} {side:?}: {found}", body.name);
            assert!(found.are_below([1e-12, 1e-9, 1e-9]));
        }
    }
}

/// Green's formula: $S[\sigma\nu] - D[u]$ is a flow $u$ with no singularity inside the body there,
/// and nothing outside; for a flow with no singularity outside it is nothing inside and $-u$ there.
/// Pressures included, with no constant left open.
#[test]
fn layers_of_a_flow_give_it_back() {
    for body in bodies() {
        let nodes = body.nodes(body.panels_for(16, 0.4), 16);
        for (regular_on, flow) in [
            (Side::Interior, &body.outside),
            (Side::Exterior, &body.inside),
        ] {
            let layers = greens_layers(&nodes, body.n_max, flow);
            for side in SIDES {
                let sign = match side {
                    Side::Interior => 1.0,
                    Side::Exterior => -1.0,
                };
                let exact = |x: Vector3<f64>| {
                    if side != regular_on {
                        return FlowGradientAt::default();
                    }
                    let at = flow.flow(x);
                    FlowGradientAt {
                        velocity: sign * at.velocity,
                        pressure: sign * at.pressure,
                        gradient: sign * at.gradient,
                    }
                };
                let found = worst(&nodes, &layers, side, 8, exact);
                println!(
                    "{}, regular on {regular_on:?}, {side:?}: {found}",
                    body.name
                );
                assert!(found.are_below([5e-12, 5e-9, 5e-9]));
            }
        }
    }
}

fn greens_layers(nodes: &Discretization, n_max: usize, flow: &Stokeslets) -> Layers {
    let traction = |x, nu: Vector3<f64>| flow.flow(x).stress() * nu;
    Layers {
        single: SurfaceModes::sample_with_normal(nodes, n_max, traction).modes,
        double: SurfaceModes::sample(nodes, n_max, |x| -flow.velocity(x)).modes,
    }
}
