//! Points that are anything but generic.

use std::sync::Arc;

use axistokes::body::flow::Side;
use axistokes::body::layers::Layers;
use axistokes::body::{Discretization, Flow, FlowError, FlowGradientAt, SurfaceModes};
use axistokes::*;
use nalgebra::{Point3, Vector3};

use super::places::{SIDES, off, places};

fn spheroid() -> Discretization {
    let curve = Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid"));
    let panels = Panels::equal_arcs(&*curve, 8).expect("panels");
    Discretization::new(curve, panels, 16).expect("nodes")
}

fn double(x: Vector3<f64>) -> Vector3<f64> {
    Vector3::new((x.x + x.z).sin(), x.y * x.z, (x.x - x.y).cos())
}

fn layers(nodes: &Discretization) -> Layers {
    let single = |x: Vector3<f64>| Vector3::new(x.z.cos(), (x.x + x.y).exp(), x.x * x.z);
    Layers {
        double: SurfaceModes::sample(nodes, 12, double).modes,
        single: SurfaceModes::sample(nodes, 12, single).modes,
    }
}

fn is_finite(at: &FlowGradientAt) -> bool {
    at.pressure.is_finite()
        && at.velocity.iter().all(|x| x.is_finite())
        && at.gradient.iter().all(|x| x.is_finite())
}

fn difference(a: &FlowGradientAt, b: &FlowGradientAt) -> f64 {
    ((a.velocity - b.velocity).norm())
        .max((a.pressure - b.pressure).abs())
        .max((a.gradient - b.gradient).norm())
}

/// Points where a formula has no direction (on the axis) or the surface is divided (at the ends of
/// panels), each with a point a little way off on the same side, where the fields are the same.
#[test]
fn degenerate_points_have_the_values_of_their_neighbours() {
    let nodes = spheroid();
    let end = nodes.panels().as_slice()[3].start;
    let (node, end) = (nodes.nodes()[37].s, nodes.curve().point(end));
    let node = nodes.curve().point(node);
    for side in SIDES {
        let flow = Flow::new(&nodes, layers(&nodes)).limit_from(side);
        let out = if side == Side::Exterior { 1.0 } else { -1.0 };
        for (name, x, away) in [
            ("upper pole", [0.0, 0.0, 1.0], [1e-9, 0.0, 1.0 + out * 1e-9]),
            (
                "lower pole",
                [0.0, 0.0, -1.0],
                [1e-9, 0.0, -1.0 - out * 1e-9],
            ),
            (
                "next to a pole",
                [1e-300, 0.0, 1.0],
                [1e-9, 0.0, 1.0 + out * 1e-9],
            ),
            (
                "subnormal",
                [0.0, 4e-324, -1.0],
                [0.0, 1e-9, -1.0 - out * 1e-9],
            ),
            (
                "1e-300 off the axis",
                [1e-300, 1e-300, 1.1],
                [1e-9, 1e-9, 1.1],
            ),
            (
                "close on the axis",
                [0.0, 0.0, 1.0 + 1e-7],
                [1e-10, 0.0, 1.0 + 1e-7],
            ),
            ("on the axis, inside", [0.0, 0.0, -0.9], [1e-9, 0.0, -0.9]),
            (
                "1e-300 off it, inside",
                [0.0, 1e-300, -0.99],
                [0.0, 1e-9, -0.99],
            ),
            ("centre", [0.0, 0.0, 0.0], [1e-9, 1e-9, 1e-9]),
            ("negative zeros", [-0.0, -0.0, 1.2], [1e-9, 0.0, 1.2]),
            ("far on the axis", [0.0, 0.0, 30.0], [1e-8, 0.0, 30.0]),
            ("equator", [0.5, 0.0, 0.0], [0.5 + out * 1e-9, 0.0, 0.0]),
            (
                "1e-300 from it",
                [0.0, -0.5, 1e-300],
                [0.0, -0.5 - out * 1e-9, 0.0],
            ),
            (
                "panel's end",
                [end.r, 0.0, end.z],
                [end.r * (1.0 + out * 1e-9), 0.0, end.z],
            ),
            (
                "node",
                [node.r, 0.0, node.z],
                [node.r * (1.0 + out * 1e-9), 0.0, node.z],
            ),
        ] {
            let points = [x, away].map(|x| Point3::from(Vector3::from(x)));
            let found = flow.gradient_at(&points, 1e-15).expect("a flow");
            let apart = difference(&found[0], &found[1]);
            println!("{name} {side:?}: {apart:.1e}");
            assert!(apart < 1e-6, "{name} {side:?}: {found:?}");
        }
    }
}

#[test]
fn the_flow_vanishes_far_away_however_far() {
    let nodes = spheroid();
    let flow = Flow::new(&nodes, layers(&nodes));
    for size in [1e3, 1e10, 1e75, 1e100, 1e150, 1e155, 1e200, 1e300] {
        for direction in [
            [1.0, 0.0, 0.0],
            [0.0, 0.0, -1.0],
            [1.0, 1.0, 1.0],
            [1.0, -1e-200, 0.0],
        ] {
            let x = Point3::from(Vector3::from(direction) * size);
            let at = flow.gradient_at(&[x], 1e-15).expect("a flow")[0];
            assert!(is_finite(&at), "{x}: {at:?}");
            // The force is less than 20, the kernel 1/8 pi times 2/|x|.
            assert!(at.velocity.norm() * size < 2.0 && at.pressure.abs() * size < 2.0);
            assert!(at.gradient.norm() * size < 2.0);
            let plain = flow.at(&[x], 1e-15).expect("a flow")[0];
            assert_eq!((plain.velocity, plain.pressure), (at.velocity, at.pressure));
        }
    }
}

#[test]
fn coordinates_that_are_no_numbers_are_refused_by_place() {
    let nodes = spheroid();
    let flow = Flow::new(&nodes, layers(&nodes));
    for bad in [f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
        for axis in 0..3 {
            let mut targets = vec![Point3::new(0.0, 0.0, 2.0); 4];
            targets[2][axis] = bad;
            let expected = FlowError::Target {
                index: 2,
                value: bad,
            };
            assert_eq!(flow.at(&targets, 1e-12), Err(expected.clone()));
            assert_eq!(flow.gradient_at(&targets, 1e-12), Err(expected));
        }
    }
    let nowhere = [Point3::new(0.0, f64::NAN, 0.0)];
    assert!(matches!(
        flow.at(&nowhere, 1e-12),
        Err(FlowError::Target { index: 0, value }) if value.is_nan()
    ));
    assert_eq!(flow.at(&[], 1e-12), Ok(Vec::new()));
    assert_eq!(flow.gradient_at(&[], 1e-12), Ok(Vec::new()));
}

/// Where a closed curve begins and ends is a place like any other: what is seen there is the limit.
#[test]
fn the_seam_of_a_torus_is_not_to_be_seen() {
    for minor in [0.4, 0.9] {
        let torus = Arc::new(Torus::new(1.0, minor).expect("a torus"));
        let panels = Panels::equal_arcs(&*torus, 16).expect("panels");
        let nodes = Discretization::new(torus, panels, 16).expect("nodes");
        let layers = layers(&nodes);
        let points: Vec<Point3<f64>> = [-1e-3, -1e-9, -1e-16, 0.0, 1e-16, 1e-9, 1e-3]
            .map(|s: f64| Point3::new(0.0, 1.0 + minor * s.sin(), minor * s.cos()))
            .into();
        let [outside, inside] = SIDES.map(|side| {
            let flow = Flow::new(&nodes, layers.clone()).limit_from(side);
            flow.gradient_at(&points, 1e-15).expect("a flow")
        });
        for (x, (outside, inside)) in points.iter().zip(outside.iter().zip(&inside)) {
            let jump = outside.velocity - inside.velocity - double(x.coords);
            assert!(jump.norm() < 1e-12, "{x}: {jump}");
        }
    }
}

/// Points far, close, on the surface, alone on their ring and in company.
fn crowd(nodes: &Discretization) -> Vec<Point3<f64>> {
    let mut points = Vec::new();
    for (k, distance) in [1.0, 0.1, 1e-3, 1e-9, 0.0, -1e-2].into_iter().enumerate() {
        points.extend(
            places(nodes, 6, k as u64)
                .into_iter()
                .map(|place| off(nodes, place, distance)),
        );
    }
    // Turned by right angles these are on the same ring exactly.
    let ring = off(nodes, places(nodes, 6, 9)[5], 1e-4);
    points.extend([
        ring,
        Point3::new(-ring.y, ring.x, ring.z),
        Point3::new(-ring.x, -ring.y, ring.z),
        Point3::new(ring.y, -ring.x, ring.z),
        ring,
    ]);
    points
}

#[test]
fn a_point_has_its_flow_in_any_company_on_any_number_of_threads() {
    let nodes = spheroid();
    let flow = Flow::new(&nodes, layers(&nodes));
    let points = crowd(&nodes);
    let together = flow.gradient_at(&points, 1e-13).expect("a flow");
    for (point, at) in points.iter().zip(&together) {
        let alone = flow.gradient_at(&[*point], 1e-13).expect("a flow")[0];
        assert_eq!(*at, alone, "{point}");
    }
    let backwards: Vec<Point3<f64>> = points.iter().rev().copied().collect();
    let backwards = flow.gradient_at(&backwards, 1e-13).expect("a flow");
    assert!(backwards.iter().rev().eq(&together));
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("a pool");
        let fresh = Flow::new(&nodes, layers(&nodes));
        let found = pool
            .install(|| fresh.gradient_at(&points, 1e-13))
            .expect("a flow");
        assert_eq!(found, together, "{threads} threads");
    }
}
