//! The plane of a case: as `[plane]` asks, and where it leaves things open the plane in which most
//! is to be seen.

use std::cmp::Ordering;

use nalgebra::{Matrix3, Point3, Unit, Vector3};

use super::grid::Plane;
use bodies_of_revolution::Wrench;
use stokes_body::linear_flow::LinearFlow;
use stokes_suspension::{Body, Motion, Suspension};

/// Width and height in lengths of the first body, where `[plane]` does not say.
const EXTENT: f64 = 3.5;
/// Grid points in each direction, where `[plane]` does not say.
const POINTS: usize = 201;
/// Directions that are nearer than this to each other, as a sine, count as the same.
const PARALLEL: f64 = 1e-9;
/// Largest ratio of width and height around many bodies.
const SLIMMEST: f64 = 4.0;
/// What directions differ by in how they are liked, as a part of the spread of the centres.
const LIKING: f64 = 1e-6;

/// What is asked of a plane; what is `None` is chosen.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlaneOptions {
    /// The middle; if not given, the only body's centre or that of all.
    pub center: Option<Point3<f64>>,
    /// How it lies in space.
    pub orientation: Option<PlaneOrientation>,
    /// Width and height.
    pub size: Option<[f64; 2]>,
    /// Grid points across and up, at least two each.
    pub points: Option<[usize; 2]>,
}

/// How a plane lies in space; directions may have any length but zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlaneOrientation {
    /// Orthogonal to a direction.
    Normal(Vector3<f64>),
    /// Two orthogonal directions in it, which a picture shows to the right and upwards.
    Directions {
        /// To the right.
        across: Vector3<f64>,
        /// Upwards.
        up: Vector3<f64>,
    },
}

impl Plane {
    /// The plane in which most of the flow around some bodies is to be seen, as far as the options
    /// leave it open.
    ///
    /// Of one body: through its centre; containing its symmetry axis and whatever acts across the
    /// axis, be it velocity, force or undisturbed flow, or else orthogonal to what turns the body;
    /// square, 3.5 lengths wide, with 201 x 201 points. Upwards is z as far as possible, or else y.
    ///
    /// Of many: containing the direction that most bodies are moved or pushed along, or the
    /// undisturbed flow, and from it the longest extent of their centres; through the centre of
    /// all, moved across itself to the nearest centre of a body; as large as all of them with a
    /// margin of the largest one's length.
    pub fn of(suspension: &Suspension, options: &PlaneOptions) -> Self {
        let chosen = || match &suspension.bodies[..] {
            [body] => normal(suspension, body),
            _ => normal_of_many(suspension),
        };
        let (across, up) = match options.orientation {
            Some(PlaneOrientation::Directions { across, up }) => {
                (Unit::new_normalize(across), Unit::new_normalize(up))
            }
            Some(PlaneOrientation::Normal(normal)) => directions(Unit::new_normalize(normal)),
            None => directions(chosen()),
        };
        let (center, size, points) = match &suspension.bodies[..] {
            [body] => (
                body.frame.center(),
                [EXTENT * 2.0 * size(body); 2],
                [POINTS; 2],
            ),
            bodies => around(bodies, [across, up]),
        };
        Self {
            center: options.center.unwrap_or(center),
            across,
            up,
            size: options.size.unwrap_or(size),
            points: options.points.unwrap_or(match options.size {
                Some(_) => [POINTS; 2],
                None => points,
            }),
        }
    }
}

/// Half the largest extent of a body.
fn size(body: &Body) -> f64 {
    body.frame.scale() * body.shape.extent()
}

/// Middle, size and grid of a rectangle along two directions around many bodies.
fn around(
    bodies: &[Body],
    [across, up]: [Unit<Vector3<f64>>; 2],
) -> (Point3<f64>, [f64; 2], [usize; 2]) {
    let normal = across.cross(&up);
    let sizes: Vec<f64> = bodies.iter().map(size).collect();
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    // From where to where all bodies are, along each direction.
    let [width, height, depth] = [*across, *up, normal].map(|direction| {
        let along = bodies.iter().zip(&sizes).map(|(body, size)| {
            let center = body.frame.center().coords.dot(&direction);
            [center - size, center + size]
        });
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [from, to]| {
            [a.min(from), b.max(to)]
        })
    });
    let middle = |[from, to]: [f64; 2]| 0.5 * (from + to);
    let depths = bodies
        .iter()
        .map(|body| body.frame.center().coords.dot(&normal));
    let nearest = depths.min_by(|a, b| {
        let [a, b] = [a, b].map(|depth_of_body| (depth_of_body - middle(depth)).abs());
        // Of two as far on either side the first one, whatever rounding says.
        if (a - b).abs() <= PARALLEL * largest {
            Ordering::Equal
        } else {
            a.total_cmp(&b)
        }
    });
    let center = *across * middle(width) + *up * middle(height) + normal * nearest.unwrap_or(0.0);
    let size = [width, height].map(|[from, to]| to - from + 4.0 * largest);
    let longest = size[0].max(size[1]);
    let size = size.map(|length| length.max(longest / SLIMMEST));
    let points = size.map(|length| (POINTS as f64 * length / longest).round() as usize);
    (center.into(), size, points)
}

/// The normal of the plane in which the flow around many bodies is best seen.
fn normal_of_many(suspension: &Suspension) -> Unit<Vector3<f64>> {
    let background = background(suspension);
    let acting: Vec<Vector3<f64>> = suspension
        .bodies
        .iter()
        .map(|body| acting(body)[0])
        .collect();
    let mean = acting.iter().sum::<Vector3<f64>>() / acting.len() as f64;
    let largest = acting
        .iter()
        .copied()
        .max_by(|a, b| a.norm().total_cmp(&b.norm()));
    let largest = largest.unwrap_or_default();
    // Forces that cancel still act.
    let mean = if mean.norm() > PARALLEL * largest.norm() {
        mean
    } else {
        largest
    };
    let mut straight = std::iter::once(mean)
        .chain(background)
        .filter(|v| *v != Vector3::zeros());
    let first = straight.next().map(Unit::new_normalize);
    if let Some(first) = first {
        let across = |v: Vector3<f64>| {
            let off = v - *first * first.dot(&v);
            (off.norm() > PARALLEL * v.norm()).then_some(off)
        };
        if let Some(off) = straight.find_map(across) {
            return Unit::new_normalize(first.cross(&off));
        }
    }
    flattest(suspension, first)
}

/// The direction, orthogonal to another if there is one, along which the centres are spread least;
/// of directions that are as good, one that leaves z and x in the plane.
fn flattest(suspension: &Suspension, orthogonal: Option<Unit<Vector3<f64>>>) -> Unit<Vector3<f64>> {
    let centers: Vec<Vector3<f64>> = suspension
        .bodies
        .iter()
        .map(|b| b.frame.center().coords)
        .collect();
    let middle = centers.iter().sum::<Vector3<f64>>() / centers.len() as f64;
    let project = |v: Vector3<f64>| match orthogonal {
        Some(n) => v - *n * n.dot(&v),
        None => v,
    };
    let spread: Matrix3<f64> = centers
        .iter()
        .map(|c| (c - middle) * (c - middle).transpose())
        .sum();
    let scale = spread.trace().max(f64::MIN_POSITIVE);
    // A little is added where a direction is liked less, and much along the one that is ruled out.
    let liking = Matrix3::from_diagonal(&Vector3::new(2.0, 0.0, 1.0)) * (LIKING * scale);
    let mut total = spread + liking;
    if let Some(n) = orthogonal {
        let projector = Matrix3::identity() - *n * n.transpose();
        total = projector * total * projector + *n * n.transpose() * (4.0 * scale);
    }
    let eigen = total.symmetric_eigen();
    let least = eigen.eigenvalues.imin();
    let direction = project(eigen.eigenvectors.column(least).into_owned());
    let sign = direction[direction.iamax()].signum();
    Unit::new_normalize(sign * direction)
}

/// Velocity or force of a body, and what turns it.
fn acting(body: &Body) -> [Vector3<f64>; 2] {
    match body.motion {
        Motion::Given(motion) => [motion.velocity, motion.angular_velocity],
        Motion::Free(Wrench { force, torque }) => [force, torque],
        Motion::Mixed(mixed) => {
            let (motion, load) = (mixed.given(), mixed.load());
            let either = |a: Vector3<f64>, b: Vector3<f64>| if a.norm() > 0.0 { a } else { b };
            [
                either(motion.velocity, load.force),
                either(motion.angular_velocity, load.torque),
            ]
        }
    }
}

/// Directions of the undisturbed flow: its velocity at the origin or, of a simple shear, flow and
/// gradient.
fn background(suspension: &Suspension) -> Vec<Vector3<f64>> {
    let flow = &suspension.background;
    if flow.velocity != Vector3::zeros() {
        return vec![flow.velocity];
    }
    let svd = flow.gradient.svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else {
        return Vec::new();
    };
    let [largest, second] = [svd.singular_values[0], svd.singular_values[1]];
    if largest > 0.0 && second <= PARALLEL * largest {
        vec![u.column(0).into_owned(), v.row(0).transpose()]
    } else {
        Vec::new()
    }
}

/// The normal of the plane in which the flow around a body is best seen.
fn normal(suspension: &Suspension, body: &Body) -> Unit<Vector3<f64>> {
    let axis = *body.frame.axis();
    let across = |v: Vector3<f64>| {
        let off = v - axis * axis.dot(&v);
        (off.norm() > PARALLEL * v.norm()).then_some(off)
    };
    let [acting, turning] = acting(body);
    let background = background(suspension);
    let straight = std::iter::once(acting).chain(background.iter().copied());
    if let Some(off) = straight.clone().find_map(across) {
        return Unit::new_normalize(axis.cross(&off));
    }
    if let Some(off) = across(turning) {
        return Unit::new_normalize(off);
    }
    let still = straight.into_iter().all(|v| v == Vector3::zeros())
        && suspension.background == LinearFlow::rest();
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
    use crate::case::Case;
    use crate::solve::plane_of;

    /// The plane of a rod with these lines, and of a case with those.
    fn plane(body: &str, case: &str) -> Plane {
        let text = format!(
            "[shapes.rod]\nkind = 'spheroid'\npolar = 1\nequatorial = 0.5\n[[bodies]]\nshape = 'rod'\n{body}\n{case}"
        );
        let case = Case::parse(&text, "rod.toml").unwrap();
        plane_of(&case).unwrap()
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

    /// The plane of unit spheres at these centres, each with these lines.
    fn of_many(bodies: &[([f64; 3], &str)], case: &str) -> Plane {
        let mut text = format!("[shapes.ball]\nkind = 'sphere'\nradius = 1\n{case}\n");
        for (center, lines) in bodies {
            text += &format!("[[bodies]]\nshape = 'ball'\ncenter = {center:?}\n{lines}\n");
        }
        let case = Case::parse(&text, "many.toml").unwrap();
        plane_of(&case).unwrap()
    }

    #[test]
    fn of_many_bodies_shows_them_and_what_acts() {
        let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
        let down = "force = [0, 0, -1]";
        // Side by side along y, sinking.
        let pair = of_many(&[([0.0, 0.0, 1.0], down), ([0.0, 4.0, 1.0], down)], "");
        along(&pair, [y, z]);
        assert!((pair.center - Point3::new(0.0, 2.0, 1.0)).norm() < 1e-14);
        assert!((pair.size[0] - 10.0).abs() < 1e-14 && (pair.size[1] - 6.0).abs() < 1e-14);
        assert_eq!(pair.points, [201, 121]);
        // Pushed together: forces that cancel still give a direction, and nothing else does.
        let [up, back] = ["velocity = [0, 0, 1]", "velocity = [0, 0, -1]"];
        let pushed = of_many(&[([0.0, 0.0, -1.05], up), ([0.0, 0.0, 1.05], back)], "");
        along(&pushed, [x, z]);
        // A cube: the plane passes through a layer of bodies, not between two.
        let corners = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|bit| 3.0 * f64::from(bit)));
        let cube: Vec<_> = corners.map(|corner| (corner, down)).collect();
        let cube = of_many(&cube, "");
        along(&cube, [x, z]);
        assert!(
            (cube.center - Point3::new(1.5, 0.0, 1.5)).norm() < 1e-14,
            "{cube:?}"
        );
        // In a shear flow, the plane of shear.
        let shear =
            "[background]\nkind = 'shear'\nrate = 1\nflow = [0, 0, 1]\ngradient = [0, 1, 0]";
        let sheared = of_many(&[([0.0; 3], ""), ([3.0, 0.0, 0.0], "")], shear);
        along(&sheared, [y, z]);
    }
}
