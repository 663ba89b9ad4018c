//! What happens across the surface, for densities that solve nothing.

use axistokes::body::flow::Side;
use axistokes::body::layers::Layers;
use axistokes::body::{Discretization, Flow, FlowGradientAt, SurfaceModes};
use nalgebra::{Matrix3, Point3, Vector3};

use super::bodies::bodies;
use super::gauss::none;
use super::places::{Place, off, places};

/// Modes of the densities, down to rounding.
const N_MAX: usize = 24;

/// Two smooth functions of the place.
fn densities() -> [fn(Vector3<f64>) -> Vector3<f64>; 2] {
    [
        |x| Vector3::new((2.0 * x.x + x.z).sin(), x.y * x.z, (x.x - x.y).cos()),
        |x| Vector3::new((x.y - x.z).exp(), (1.5 * x.x).cos(), x.x * x.y + x.z),
    ]
}

/// The two limits on the surface, outside first.
fn limits(
    nodes: &Discretization,
    layers: &Layers,
    points: &[Point3<f64>],
) -> [Vec<FlowGradientAt>; 2] {
    [Side::Exterior, Side::Interior].map(|side| {
        let flow = Flow::new(nodes, layers.clone()).limit_from(side);
        flow.gradient_at(points, 1e-15).expect("a flow")
    })
}

/// The outward normal at a place.
fn normal(nodes: &Discretization, place: &Place) -> Vector3<f64> {
    let t = nodes.curve().tangent(place.s);
    let (sin, cos) = place.azimuth.sin_cos();
    Vector3::new(-t.z * cos, -t.z * sin, t.r).normalize()
}

/// From inside to outside, the double layer's velocity jumps by the density and its traction does
/// not; the single layer's velocity does not jump, its traction does by minus the density, its
/// pressure by the density's normal component.
#[test]
fn across_the_surface_are_those_of_potential_theory() {
    for body in bodies() {
        let nodes = body.nodes(body.panels(16).bisected(|_| true), 16);
        let places = places(&nodes, 24, 3);
        let points: Vec<Point3<f64>> = (places.iter())
            .map(|&place| off(&nodes, place, 0.0))
            .collect();
        let normals: Vec<Vector3<f64>> = places.iter().map(|place| normal(&nodes, place)).collect();
        let [of_double, of_single] = densities();
        let sampled = |density| SurfaceModes::sample(&nodes, N_MAX, density).modes;
        let double = Layers {
            double: sampled(of_double),
            single: none(&nodes),
        };
        let single = Layers {
            double: none(&nodes),
            single: sampled(of_single),
        };
        let mut worst = [0.0f64; 5];
        let mut error = |which: usize, error: f64| {
            worst[which] = worst[which].max(if error.is_nan() { f64::INFINITY } else { error });
        };
        let [outside, inside] = limits(&nodes, &double, &points);
        for (k, (out, within)) in outside.iter().zip(&inside).enumerate() {
            let jump = out.velocity - within.velocity;
            error(0, (jump - of_double(points[k].coords)).norm());
            error(1, ((out.stress() - within.stress()) * normals[k]).norm());
        }
        let [outside, inside] = limits(&nodes, &single, &points);
        for (k, (out, within)) in outside.iter().zip(&inside).enumerate() {
            let density = of_single(points[k].coords);
            error(2, (out.velocity - within.velocity).norm());
            let traction = (out.stress() - within.stress()) * normals[k];
            error(3, (traction + density).norm());
            let pressure = out.pressure - within.pressure;
            error(4, (pressure - density.dot(&normals[k])).abs());
        }
        println!(
            "{}: D velocity {:.1e}, traction {:.1e}; S velocity {:.1e}, traction {:.1e}, pressure {:.1e}",
            body.name, worst[0], worst[1], worst[2], worst[3], worst[4]
        );
        for (error, bar) in worst.into_iter().zip([1e-12, 1e-10, 1e-12, 1e-10, 1e-10]) {
            assert!(error < bar);
        }
    }
}

/// The trace of the gradient vanishes, and what is called gradient is that of the velocity: against
/// central differences of fourth order.
#[test]
fn off_the_surface_the_gradient_is_that_of_the_velocity() {
    const STEP: f64 = 1e-3;
    for body in bodies() {
        let nodes = body.nodes(body.panels(16).bisected(|_| true), 16);
        let [of_double, of_single] = densities();
        let sampled = |density| SurfaceModes::sample(&nodes, N_MAX, density).modes;
        let layers = Layers {
            double: sampled(of_double),
            single: sampled(of_single),
        };
        let flow = Flow::new(&nodes, layers);
        let (mut gradient, mut divergence, mut force) = (0.0f64, 0.0f64, 0.0f64);
        for place in places(&nodes, 6, 4) {
            let x = off(&nodes, place, 0.05);
            let along = |axis: usize| {
                [-2.0, -1.0, 1.0, 2.0].map(|k| {
                    let mut y = x;
                    y[axis] += k * STEP;
                    y
                })
            };
            let points: Vec<Point3<f64>> = (0..3).flat_map(along).chain([x]).collect();
            let found = flow.gradient_at(&points, 1e-15).expect("a flow");
            let at = &found[12];
            let mut differences = Matrix3::zeros();
            let mut of_stress = Vector3::<f64>::zeros();
            for axis in 0..3 {
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| found[4 * axis + k]);
                let slope =
                    |a: f64, b: f64, c: f64, d: f64| ((a - d) + 8.0 * (c - b)) / (12.0 * STEP);
                for i in 0..3 {
                    let velocity = |at: FlowGradientAt| at.velocity[i];
                    let [a, b, c, d] = [a, b, c, d].map(velocity);
                    differences[(i, axis)] = slope(a, b, c, d);
                }
                for i in 0..3 {
                    let [a, b, c, d] = [a, b, c, d].map(|at| at.stress()[(i, axis)]);
                    of_stress[i] += slope(a, b, c, d);
                }
            }
            gradient = gradient.max((at.gradient - differences).norm());
            divergence = divergence.max(at.gradient.trace().abs());
            force = force.max(of_stress.norm());
        }
        println!(
            "{}: gradient {gradient:.1e}, its trace {divergence:.1e}, divergence of the stress {force:.1e}",
            body.name
        );
        assert!(gradient < 1e-7 && divergence < 1e-12 && force < 1e-5);
    }
}
