//! Whether a curve bounds a body.

use super::error::CurveError;
use super::outline::Outline;
use super::polygon::{first_crossing, signed_volume};
use super::{GeneratingCurve, Topology};

/// How far, over the curve's size, an end may miss the axis or the other end.
pub(super) const CLOSURE: f64 = 1e-9;
/// Largest slope of the curve against the plane normal to the axis at a pole.
const POLE_SLOPE: f64 = 1e-6;

/// Checks that the curve bounds a body: finite and regular, ends on the axis at right angles or
/// closed off the axis, `r > 0` between, not meeting itself, and traversed with the normal outward.
///
/// The check is made on a polygon within 1e-6 of the curve's size; finer contact escapes it.
///
/// # Errors
/// What is wrong, and where.
pub fn check_simple(curve: &(impl GeneratingCurve + ?Sized)) -> Result<(), CurveError> {
    let outline = Outline::new(curve)?;
    let (corners, parameters) = (outline.corners(), outline.parameters());
    let last = corners.len() - 1;
    let (from, to) = (corners[0], corners[last]);
    let size = corners
        .iter()
        .map(|p| (p.r - from.r).hypot(p.z - from.z))
        .fold(0.0, f64::max);
    let closed = curve.topology() == Topology::Loop;
    let closes = if closed {
        (from.r - to.r).hypot(from.z - to.z) <= CLOSURE * size
    } else {
        from.r.abs().max(to.r.abs()) <= CLOSURE * size
    };
    if !closes {
        return Err(CurveError::Open {
            r0: from.r,
            z0: from.z,
            r1: to.r,
            z1: to.z,
        });
    }
    let off_axis = if closed { 0..=last } else { 1..=last - 1 };
    for i in off_axis {
        if corners[i].r <= 0.0 {
            return Err(CurveError::CrossesAxis {
                s: parameters[i],
                r: corners[i].r,
            });
        }
    }
    if !closed {
        for s in [parameters[0], parameters[last]] {
            let tangent = curve.tangent(s);
            if tangent.z.abs() > POLE_SLOPE * tangent.r.abs() {
                return Err(CurveError::ConicalPole { s });
            }
        }
    }
    if let Some(place) = first_crossing(corners, closed) {
        return Err(CurveError::SelfIntersection {
            r: place.r,
            z: place.z,
        });
    }
    if signed_volume(corners) <= 0.0 {
        return Err(CurveError::Backwards);
    }
    Ok(())
}
