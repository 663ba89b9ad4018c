//! What was solved can be looked at again, in the laboratory's frame.

use std::path::Path;

use axistokes::case::Case;
use axistokes::nalgebra::{Point3, Vector3};
use axistokes::output::vtk::Mesh as Surface;
use axistokes::progress::Silent;
use axistokes::solve::{Solved, solve};

fn solved(name: &str) -> (Case, Solved) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cases");
    let case = Case::read(folder.join(name)).expect("a case");
    let solved = solve(&case, &Silent).expect("an answer");
    (case, solved)
}

#[test]
fn the_flow_is_that_of_the_report_and_nothing_inside() {
    let (case, solved) = solved("oblique-spheroid.toml");
    let mut points: Vec<Point3<f64>> = case.probes.iter().map(|p| p.value.into()).collect();
    points.push(case.bodies[0].center.into());
    let flow = solved.answer.flow.at(&points).expect("a flow");
    assert_eq!(flow.len(), points.len());
    for (probe, at) in solved.report.probes.iter().zip(&flow) {
        let at = at.expect("outside");
        assert!((at.velocity - Vector3::from(probe.velocity)).norm() < 1e-14);
        assert!((at.pressure - probe.pressure).abs() < 1e-13);
    }
    assert_eq!(flow[points.len() - 1], None);
}

#[test]
fn the_surface_is_that_of_the_body_and_moves_with_it() {
    let (case, solved) = solved("oblique-spheroid.toml");
    let body = &case.bodies[0];
    let [center, axis] = [body.center, body.axis].map(Vector3::from);
    let surface = Surface::of(&solved.answer, |_| 8, &Silent).expect("a surface");
    let nodes = solved.answer.flow.bodies()[0]
        .disturbance
        .discretization()
        .nodes()
        .len();
    // The poles come last.
    assert_eq!(surface.points.len(), 8 * nodes + 2);
    for (k, point) in surface.points.iter().enumerate() {
        let x = point.coords - center;
        let (along, across) = (x.dot(&axis), x - axis * x.dot(&axis));
        let equation = along * along + across.norm_squared() / 0.25;
        assert!((equation - 1.0).abs() < 1e-14);
        let gradient = axis * along + across / 0.25;
        assert!((surface.normals[k] - gradient.normalize()).norm() < 1e-13);
        let velocity = Vector3::z() + Vector3::new(0.3, 0.0, -0.2).cross(&x);
        assert!((surface.velocity[k] - velocity).norm() < 1e-13);
    }
}

/// The traction of a sphere in translation is the same everywhere, $-3\mu U/2a$ (Stokes 1851).
#[test]
fn the_traction_of_a_sphere_is_uniform() {
    let (case, solved) = solved("sphere-drag.toml");
    let surface = Surface::of(&solved.answer, |_| 5, &Silent).expect("a surface");
    for traction in surface.traction {
        let exact: Vector3<f64> = -1.5 * case.viscosity * Vector3::z();
        assert!((traction - exact).norm() < 1e-11, "{traction}");
    }
    let power = solved.report.bodies[0].power.expect("a power");
    assert!((power - 6.0 * std::f64::consts::PI).abs() < 1e-11);
}
