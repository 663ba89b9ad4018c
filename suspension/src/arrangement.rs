//! How bodies lie: the gaps between them, and the axes that are chosen for spheres.
//!
//! A sphere looks the same from all sides, so the axis of its modes may point anywhere. It is
//! aligned with the nearest neighbour: then the traction that gathers in the gap is around the
//! axis, where panels and a few modes resolve it.

use nalgebra::{Unit, Vector3};

use bodies_of_revolution::{ContactError, Frame, Gap, GeneratingCurve, Placed, gaps};

use super::error::SuspensionError;
use super::suspension::Body;

/// Relative differences of radii, and of directions, that are rounding.
const ROUNDING: f64 = 1e-14;
/// The sine of the angle up to which the nearest point is on the line of centres: it is known no
/// better.
const ON_LINE: f64 = 1e-6;

/// The sine of the angle between axes and lines of centres up to which bodies are coaxial.
const COAXIAL: f64 = 1e-14;
/// Gaps of so many sizes of a body matter to its resolution.
pub(crate) const REACH: f64 = 1.0;
/// Gaps below so many sizes of the smaller body are narrow.
const NARROW: f64 = 0.2;

/// The gaps between bodies that are no farther apart than `reach` sizes; an error if any are not
/// apart.
pub(crate) fn gaps_within(bodies: &[Body], reach: f64) -> Result<Vec<Gap>, SuspensionError> {
    let gaps = gaps_of(bodies, |body| reach * body.size())?;
    gaps.iter().try_for_each(|gap| gap.check(0.0))?;
    Ok(gaps)
}

/// The gaps between pairs of bodies that are no farther apart than the larger of their reaches.
pub(crate) fn gaps_of(
    bodies: &[Body],
    reach: impl Fn(&Body) -> f64,
) -> Result<Vec<Gap>, ContactError> {
    let placed = bodies.iter().map(|body| Placed {
        curve: &*body.shape,
        frame: body.frame,
        reach: reach(body),
    });
    gaps(&placed.collect::<Vec<_>>())
}

/// Whether a gap between bodies is narrow.
pub(crate) fn is_narrow(bodies: &[Body], gaps: &[Gap]) -> bool {
    gaps.iter().any(|gap| {
        let sizes = gap.bodies.map(|body| bodies[body].size());
        gap.distance < NARROW * sizes[0].min(sizes[1])
    })
}

/// Whether all bodies have one axis: their modes do not mix.
pub(crate) fn are_coaxial(bodies: &[Body]) -> bool {
    let axis = bodies[0].frame.axis();
    let origin = bodies[0].frame.center();
    bodies.iter().all(|body| {
        let apart: Vector3<f64> = body.frame.center() - origin;
        body.frame.axis().cross(&axis).norm() <= COAXIAL
            && apart.cross(&axis).norm() <= COAXIAL * apart.norm()
    })
}

/// The bodies with the axes of spheres towards the nearest neighbour; those with a slip stay, for
/// it is given in their frame.
pub(crate) fn facing_neighbours(bodies: &[Body], gaps: &[Gap]) -> Vec<Body> {
    let mut facing = bodies.to_vec();
    if are_coaxial(bodies) {
        return facing;
    }
    for (index, body) in facing.iter_mut().enumerate() {
        if body.slip.is_some() || !is_sphere(&*body.shape) {
            continue;
        }
        let mine = gaps.iter().filter(|gap| gap.bodies.contains(&index));
        if let Some(gap) = mine.min_by(|a, b| a.distance.total_cmp(&b.distance)) {
            let axis = direction(bodies, gap, index);
            // An axis that is right already keeps bodies coaxial to the last digit.
            if axis.cross(&body.frame.axis()).norm() > ROUNDING {
                body.frame = Frame::along(body.frame.center(), axis).scaled(body.frame.scale());
            }
        }
    }
    facing
}

/// From a body's centre to the point nearest to its neighbour.
fn direction(bodies: &[Body], gap: &Gap, index: usize) -> Unit<Vector3<f64>> {
    let side = usize::from(gap.bodies[1] == index);
    let center = bodies[index].frame.center();
    let between = Unit::new_normalize(bodies[gap.bodies[1 - side]].frame.center() - center);
    let nearest = Unit::new_normalize(gap.points[side] - center);
    if between.cross(&nearest).norm() < ON_LINE {
        between
    } else {
        nearest
    }
}

pub(crate) fn is_sphere(curve: &dyn GeneratingCurve) -> bool {
    let ends = curve.breakpoints();
    let (first, last) = (ends[0], ends[ends.len() - 1]);
    let radius = |k: u32| {
        let point = curve.point(first + (last - first) * f64::from(k) / 16.0);
        point.r.hypot(point.z)
    };
    let of_pole = radius(0);
    (1..=16).all(|k| (radius(k) - of_pole).abs() <= ROUNDING * of_pole)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use nalgebra::Point3;

    use super::*;
    use crate::slip::Slip;
    use bodies_of_revolution::Spheroid;

    #[test]
    fn axes_of_spheres_are_free() {
        let shapes = [[1.0, 1.0], [0.7, 0.7], [1.0, 0.5]].map(|[along, across]| {
            Arc::new(Spheroid::new(along, across).unwrap()) as Arc<dyn GeneratingCurve>
        });
        assert_eq!(
            shapes.each_ref().map(|s| is_sphere(&**s)),
            [true, true, false]
        );
        let axis = Unit::new_normalize(Vector3::new(0.3, -0.5, 0.2));
        let at = |shape: usize, distance: f64| {
            let center = Point3::origin() + distance * Vector3::new(2.0, 1.0, -2.0) / 3.0;
            Body::new(shapes[shape].clone(), Frame::along(center, axis))
        };
        let gaps = |bodies: &[Body]| gaps_within(bodies, 1.0).unwrap();
        let pair = [at(0, 0.0), at(1, 1.8)];
        assert!(!are_coaxial(&pair));
        let turned = facing_neighbours(&pair, &gaps(&pair));
        assert!(are_coaxial(&turned));
        // The rod stays as it is, and so does a sphere that is told how to slip.
        let mut mixed = [at(2, 0.0), at(1, 2.0), at(0, -2.5)];
        mixed[2].slip = Some(Slip::new(|x: Vector3<f64>| x.cross(&Vector3::z())));
        let turned = facing_neighbours(&mixed, &gaps(&mixed));
        let stays = |i: usize| turned[i].frame == mixed[i].frame;
        assert_eq!([stays(0), stays(1), stays(2)], [true, false, true]);
    }
}
