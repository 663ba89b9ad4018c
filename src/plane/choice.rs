//! The plane of a case: as `[plane]` asks, and where it leaves things open the plane in which most is to be seen.

use nalgebra::{Point3, Unit, Vector3};

use super::Plane;
use crate::case::{Background, Body, Case, Motion, Orientation};

/// Width and height in lengths of the first body, where `[plane]` does not say.
const EXTENT: f64 = 3.5;
/// Grid points in each direction, where `[plane]` does not say.
const POINTS: usize = 201;
/// Directions that are nearer than this to each other, as a sine, count as the same.
const PARALLEL: f64 = 1e-9;

impl Plane {
    /// The plane of a case whose first body is `length` long.
    ///
    /// Where `[plane]` leaves it open: through the body's centre; containing its symmetry axis and whatever acts across the axis, be it
    /// velocity, force or background flow, or else orthogonal to what turns the body; square, 3.5 lengths wide, with 201 x 201 points.
    /// Upwards is z as far as possible, or else y.
    pub fn of_case(case: &Case, length: f64) -> Self {
        let options = &case.plane;
        let body = &case.bodies[0];
        let (across, up) = match options.orientation {
            Some(Orientation::Directions { across, up }) => (
                Unit::new_normalize(across.into()),
                Unit::new_normalize(up.into()),
            ),
            Some(Orientation::Normal(normal)) => directions(Unit::new_normalize(normal.into())),
            None => directions(normal(case, body)),
        };
        Self {
            center: Point3::from(options.center.unwrap_or(body.center)),
            across,
            up,
            size: options.size.unwrap_or([EXTENT * length; 2]),
            points: options.points.unwrap_or([POINTS; 2]),
        }
    }
}

/// The normal of the plane in which the flow around a body is best seen.
fn normal(case: &Case, body: &Body) -> Unit<Vector3<f64>> {
    let axis = Vector3::from(body.axis);
    let across = |v: Vector3<f64>| {
        let off = v - axis * axis.dot(&v);
        (off.norm() > PARALLEL * v.norm()).then_some(off)
    };
    let (acting, turning) = match body.motion.value {
        Motion::Rigid {
            velocity,
            angular_velocity,
        } => (velocity, angular_velocity),
        Motion::Free { force, torque } => (force, torque),
    };
    let background: Vec<Vector3<f64>> = match case.background.as_deref() {
        Some(Background::Uniform { velocity }) => vec![Vector3::from(*velocity)],
        Some(Background::Shear { flow, gradient, .. }) => {
            vec![Vector3::from(*flow), Vector3::from(*gradient)]
        }
        _ => Vec::new(),
    };
    let straight = std::iter::once(Vector3::from(acting)).chain(background.iter().copied());
    if let Some(off) = straight.clone().find_map(across) {
        return Unit::new_normalize(axis.cross(&off));
    }
    let turning = Vector3::from(turning);
    if let Some(off) = across(turning) {
        return Unit::new_normalize(off);
    }
    let still = straight.into_iter().all(|v| v == Vector3::zeros()) && case.background.is_none();
    if turning != Vector3::zeros() && still && body.slip.is_none() {
        // A spin about the axis is seen from above.
        return Unit::new_normalize(axis);
    }
    // The same flow in every plane through the axis: the one that leaves x or y to the right.
    let sideways = [Vector3::x(), Vector3::y(), Vector3::z()]
        .into_iter()
        .min_by(|a, b| a.dot(&axis).abs().total_cmp(&b.dot(&axis).abs()))
        .unwrap_or(Vector3::x());
    Unit::new_normalize(axis.cross(&sideways))
}

/// To the right and upwards in the plane with this normal, which may be turned around.
fn directions(normal: Unit<Vector3<f64>>) -> (Unit<Vector3<f64>>, Unit<Vector3<f64>>) {
    let above = if normal.z.abs() < 0.99 {
        Vector3::z()
    } else {
        Vector3::y()
    };
    let up = Unit::new_normalize(above - *normal * normal.dot(&above));
    let across = up.cross(&normal);
    let sign = across[across.iamax()].signum();
    (Unit::new_normalize(sign * across), up)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The plane of a rod with these lines, and of a case with those.
    fn plane(body: &str, case: &str) -> Plane {
        let text = format!(
            "[shapes.rod]\nkind = 'spheroid'\npolar = 1\nequatorial = 0.5\n[[bodies]]\nshape = 'rod'\n{body}\n{case}"
        );
        let case = Case::parse(&text, "rod.toml").unwrap();
        Plane::of_case(&case, 2.0)
    }

    fn along(plane: &Plane, axes: [Vector3<f64>; 2]) {
        let [across, up] = axes;
        assert!((*plane.across - across).norm() < 1e-14, "{plane:?}");
        assert!((*plane.up - up).norm() < 1e-14, "{plane:?}");
    }

    #[test]
    fn shows_what_acts_across_the_axis() {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        along(&plane("", ""), [x, z]);
        along(&plane("velocity = [0, 0, 2]", ""), [x, z]);
        along(&plane("velocity = [0, 1, 2]", ""), [y, z]);
        along(&plane("force = [0, -1, 0]", ""), [y, z]);
        along(&plane("angular_velocity = [1, 0, 0]", ""), [y, z]);
        along(&plane("angular_velocity = [0, 0, 1]", ""), [x, y]);
        along(
            &plane("velocity = [0, 0, 1]\nangular_velocity = [0, 0, 1]", ""),
            [x, z],
        );
        along(
            &plane("axis = [1, 0, 1]\nvelocity = [0, 0, -1]", ""),
            [x, z],
        );
        let shear =
            "[background]\nkind = 'shear'\nrate = 1\nflow = [0, 0, 1]\ngradient = [0, 1, 0]";
        along(&plane("", shear), [y, z]);
    }

    #[test]
    fn does_as_told() {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        let default = plane("center = [1, 2, 3]", "");
        assert_eq!(default.center, Point3::new(1.0, 2.0, 3.0));
        assert_eq!((default.size, default.points), ([7.0; 2], [201; 2]));
        let asked = plane(
            "",
            "[plane]\ncenter = [0, 0, 1]\nnormal = [0, 0, -2]\nsize = [4, 3]\npoints = [41, 31]",
        );
        along(&asked, [x, y]);
        assert_eq!(asked.center, Point3::new(0.0, 0.0, 1.0));
        assert_eq!((asked.size, asked.points), ([4.0, 3.0], [41, 31]));
        along(
            &plane("", "[plane]\nacross = [0, 0, 2]\nup = [-1, 0, 0]"),
            [z, -x],
        );
    }
}
