//! Where a plane cuts a body of revolution.

use std::f64::consts::PI;

use nalgebra::Point3;

use super::grid::Plane;
use bodies_of_revolution::Frame;
use bodies_of_revolution::{CurveError, GeneratingCurve, Outline, Topology};
use stokes_suspension::Flow;

/// Points on a stretch of the curve that the plane cuts, beside the outline's own corners.
const POINTS: usize = 128;
/// Least sine of the angle between axis and normal: a smaller one is taken for this.
const LEAST_TILT: f64 = 1e-9;

/// The sections of all bodies in a flow, as [`section`] gives them.
///
/// # Errors
/// As [`section`].
pub fn sections(flow: &Flow, plane: &Plane) -> Result<Vec<Vec<[f64; 2]>>, CurveError> {
    let mut sections = Vec::new();
    for body in flow.bodies() {
        sections.extend(section(&**body.shape(), &body.frame, plane)?);
    }
    Ok(sections)
}

/// The closed curves, in the coordinates of the plane, in which it cuts the surface of a body; a
/// point is inside the body if they go around it an odd number of times.
///
/// In the body's frame, turned about its axis, the plane is $a x + c z = d$. It meets the ring of
/// the generating curve's point $(r, z)$ at the azimuths $\pm\theta$ with $\cos\theta = (d - c z)/a
/// r$, if that is at most 1 in magnitude; stretches of the curve where it is give one closed curve
/// each, and a whole loop two.
///
/// # Errors
/// If a point of the curve is not finite.
pub fn section(
    curve: &dyn GeneratingCurve,
    frame: &Frame,
    plane: &Plane,
) -> Result<Vec<Vec<[f64; 2]>>, CurveError> {
    let outline = Outline::new(curve)?;
    let normal = frame.vector_to_body(plane.normal());
    let a = normal.x.hypot(normal.y).max(LEAST_TILT);
    let [cos, sin] = if normal.x == 0.0 && normal.y == 0.0 {
        [1.0, 0.0]
    } else {
        let length = normal.x.hypot(normal.y);
        [normal.x / length, normal.y / length]
    };
    let d = frame.point_to_body(plane.center).coords.dot(&normal);
    // How far beyond the ring, on either side, the plane meets its own plane.
    let beyond = |s: f64, side: f64| {
        let point = curve.point(s);
        d - normal.z * point.z + side * a * point.r
    };
    let cut = |s: f64| beyond(s, 1.0) >= 0.0 && beyond(s, -1.0) <= 0.0;

    let mut stops = outline.parameters().to_vec();
    let mut ends = Vec::new();
    for pair in outline.parameters().windows(2) {
        for side in [1.0, -1.0] {
            let (from, to) = (beyond(pair[0], side), beyond(pair[1], side));
            if (from > 0.0) != (to > 0.0) {
                ends.push(root(pair[0], pair[1], |s| beyond(s, side)));
            }
        }
    }
    ends.sort_by(f64::total_cmp);
    let (first, last) = (stops[0], stops[stops.len() - 1]);
    let stretches: Vec<[f64; 2]> = match (curve.topology(), &ends[..]) {
        (Topology::Loop, [start, .., _]) => {
            // Around the loop from one end to the same.
            let period = last - first;
            stops.extend(outline.parameters().iter().map(|s| s + period));
            let around = ends.iter().copied().chain([start + period]);
            pairs(around)
        }
        _ => pairs(
            [first]
                .into_iter()
                .chain(ends.iter().copied())
                .chain([last]),
        ),
    };
    let wrapped = |s: f64| if s > last { s - (last - first) } else { s };
    let place = |s: f64, side: f64| {
        let point = curve.point(wrapped(s));
        let x = if a * point.r > 0.0 {
            ((d - normal.z * point.z) / (a * point.r)).clamp(-1.0, 1.0)
        } else {
            0.0
        };
        let y = side * (1.0 - x * x).sqrt();
        let (x, y) = (point.r * x, point.r * y);
        let at = Point3::new(cos * x - sin * y, sin * x + cos * y, point.z);
        plane.coordinates(frame.point_to_lab(at))
    };
    let mut curves = Vec::new();
    for [start, end] in stretches {
        if end <= start || !cut(wrapped(0.5 * (start + end))) {
            continue;
        }
        // Crowded towards the ends, where the azimuth goes as the root of the parameter.
        let crowded = (0..=POINTS).map(|k| {
            0.5 * (start + end) - 0.5 * (end - start) * (PI * k as f64 / POINTS as f64).cos()
        });
        let inner = stops.iter().copied().filter(|s| (start..=end).contains(s));
        let mut parameters: Vec<f64> = crowded.chain(inner).collect();
        parameters.sort_by(f64::total_cmp);
        let [one, other] = [1.0, -1.0].map(|side| {
            let places = parameters.iter().map(move |&s| (s, side));
            places.map(|(s, side)| place(s, side)).collect::<Vec<_>>()
        });
        if curve.topology() == Topology::Loop && ends.is_empty() {
            curves.extend([one, other]);
        } else {
            curves.push(one.into_iter().chain(other.into_iter().rev()).collect());
        }
    }
    Ok(curves)
}

fn pairs(values: impl Iterator<Item = f64>) -> Vec<[f64; 2]> {
    let values: Vec<f64> = values.collect();
    values.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The zero between two parameters at which a function has different signs, by bisection to
/// rounding.
fn root(mut from: f64, mut to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let positive = f(from) > 0.0;
    for _ in 0..80 {
        let middle = 0.5 * (from + to);
        if (f(middle) > 0.0) == positive {
            from = middle;
        } else {
            to = middle;
        }
    }
    0.5 * (from + to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bodies_of_revolution::{Spheroid, Torus};
    use nalgebra::{Unit, Vector3};

    fn plane(center: [f64; 3], normal: [f64; 3]) -> Plane {
        let normal = Unit::new_normalize(Vector3::from(normal));
        let side = if normal.x.abs() < 0.9 {
            Vector3::x()
        } else {
            Vector3::y()
        };
        let across = Unit::new_normalize(normal.cross(&side));
        Plane {
            center: center.into(),
            across,
            up: Unit::new_normalize(normal.cross(&across)),
            size: [4.0; 2],
            points: [2; 2],
        }
    }

    fn area(curve: &[[f64; 2]]) -> f64 {
        let closed = curve.iter().zip(curve.iter().cycle().skip(1));
        0.5 * closed
            .map(|(a, b)| a[0] * b[1] - a[1] * b[0])
            .sum::<f64>()
            .abs()
    }

    #[test]
    fn of_a_spheroid_is_an_ellipse() {
        let curve = Spheroid::new(1.0, 0.5).unwrap();
        let frame = Frame::along(
            Point3::new(0.1, 0.2, 0.3),
            Unit::new_normalize(Vector3::new(1.0, 2.0, 3.0)),
        );
        for (center, normal) in [
            ([0.1, 0.2, 0.3], [0.0, 0.0, 1.0]),
            ([0.1, 0.2, 0.3], [1.0, 2.0, 3.0]),
            ([0.2, 0.1, 0.5], [1.0, 2.0, 3.0]),
            ([0.1, 0.2, 0.3], [3.0, 0.0, -1.0]),
            ([0.0, 0.0, 0.1], [1.0, 1.0, 1.0]),
        ] {
            let plane = plane(center, normal);
            let curves = section(&curve, &frame, &plane).unwrap();
            assert_eq!(curves.len(), 1, "{normal:?}");
            for &point in &curves[0] {
                let x = frame.point_to_body(plane.point(point));
                let on = (x.x * x.x + x.y * x.y) / 0.25 + x.z * x.z;
                assert!((on - 1.0).abs() < 1e-6, "{normal:?}: {on}");
            }
            // The section of (x/a)^2 + (y/a)^2 + (z/b)^2 = 1 by n . x = d: area pi a^2 b (1 -
            // d^2/m^2)/m, m^2 = a^2 (n_x^2 + n_y^2) + b^2 n_z^2.
            let n = frame.vector_to_body(plane.normal());
            let d = frame.point_to_body(plane.center).coords.dot(&n);
            let m2 = 0.25 * (n.x * n.x + n.y * n.y) + n.z * n.z;
            let exact = PI * 0.25 * (1.0 - d * d / m2) / m2.sqrt();
            assert!((area(&curves[0]) / exact - 1.0).abs() < 2e-3, "{normal:?}");
        }
        let beside = plane([3.0, 3.0, 3.0], [1.0, 1.0, 1.0]);
        assert!(section(&curve, &frame, &beside).unwrap().is_empty());
    }

    #[test]
    fn of_a_torus_is_two_discs_a_ring_or_an_oval() {
        let curve = Torus::new(1.0, 0.25).unwrap();
        let frame = Frame::along(Point3::origin(), Vector3::z_axis());
        let discs = section(&curve, &frame, &plane([0.0; 3], [0.0, 1.0, 0.0])).unwrap();
        assert_eq!(discs.len(), 2);
        let ring = section(&curve, &frame, &plane([0.0; 3], [0.0, 0.0, 1.0])).unwrap();
        let mut areas: Vec<f64> = ring.iter().map(|curve| area(curve)).collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas.len(), 2);
        for (area, radius) in areas.iter().zip([0.75, 1.25]) {
            assert!(
                (area / (PI * radius * radius) - 1.0).abs() < 2e-3,
                "{areas:?}"
            );
        }
        for disc in discs {
            assert!((area(&disc) / (PI * 0.0625) - 1.0).abs() < 2e-3);
        }
        let oval = section(&curve, &frame, &plane([1.1, 0.0, 0.0], [1.0, 0.0, 0.0])).unwrap();
        assert_eq!(oval.len(), 1);
    }
}
