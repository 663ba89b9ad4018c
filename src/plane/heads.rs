//! Where the heads of swimmers are: the end of the axis that their slip is counted from.

use nalgebra::Point3;

use super::grid::Plane;
use stokes_suspension::{BodyFlow, Flow};

/// Where an arrow along the axis begins and ends, as parts of the way from the centre to the lower
/// and the upper end of the body.
const ARROW: [f64; 2] = [0.35, 0.65];
/// An axis that is seen shorter than this part of itself points at the viewer or away.
const SEEN: f64 = 0.3;

/// Arrows inside all bodies that have a slip, from tail to head, in the coordinates of the plane;
/// none for a body whose axis is seen almost from above, or whose arrow is farther from the plane
/// than it is long.
pub fn heads(flow: &Flow, plane: &Plane) -> Vec<[[f64; 2]; 2]> {
    let swimmers = flow.bodies().iter().filter(|body| body.slip.is_some());
    swimmers.filter_map(|body| head(body, plane)).collect()
}

fn head(body: &BodyFlow, plane: &Plane) -> Option<[[f64; 2]; 2]> {
    let nodes = body.disturbance.discretization().nodes();
    let along = nodes.iter().map(|node| node.z);
    let [lower, upper] = along.fold([0.0f64; 2], |[a, b], z| [a.min(z), b.max(z)]);
    let ends = [ARROW[0] * lower, ARROW[1] * upper];
    let ends = ends.map(|z| body.frame.point_to_lab(Point3::new(0.0, 0.0, z)));
    let length = (ends[1] - ends[0]).norm();
    let [tail, tip] = ends.map(|end| plane.coordinates(end));
    let seen = (tip[0] - tail[0]).hypot(tip[1] - tail[1]);
    let away = (body.frame.center() - plane.center).dot(&plane.normal());
    (seen > SEEN * length && away.abs() < length).then_some([tail, tip])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plane::PlaneOptions;
    use bodies_of_revolution::{GeneratingCurve, Spheroid};
    use nalgebra::Vector3;
    use stokes_suspension::{Accuracy, Body, Options, Slip, Solver, Suspension};

    #[test]
    fn along_the_axis_of_bodies_with_slip() {
        let ball = Spheroid::new(1.0, 1.0).unwrap().shape();
        let swimmer = |axis: [f64; 3]| {
            let slip = Slip::squirmer(vec![1.0]);
            Body::free(&ball).along(axis).with_slip(slip)
        };
        let suspension = Suspension::new([
            swimmer([1.0, 0.0, 1.0]),
            swimmer([0.0, 1.0, 0.0]).at([4.0, 0.0, 0.0]),
            Body::held(&ball).at([8.0, 0.0, 0.0]),
        ]);
        let flow = Solver::new(Options::new(Accuracy::Tolerance(1e-2)))
            .solve(&suspension)
            .unwrap()
            .flow;
        let plane = Plane::of(
            &suspension,
            &PlaneOptions {
                center: Some(Point3::origin()),
                orientation: Some(crate::plane::PlaneOrientation::Normal(Vector3::y())),
                ..PlaneOptions::default()
            },
        );
        let heads = heads(&flow, &plane);
        assert_eq!(heads.len(), 1);
        let [tail, tip] = heads[0];
        let [x, z] = [tip[0] - tail[0], tip[1] - tail[1]];
        assert!(
            (x - z).abs() < 1e-12 && (0.6..0.8).contains(&z),
            "{heads:?}"
        );
    }
}
