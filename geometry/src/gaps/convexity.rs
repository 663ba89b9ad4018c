//! Whether a body of revolution is convex.

use crate::curve::{GeneratingCurve, Meridian, Topology};

/// How far, in radians, the tangent may turn back: rounding of it, and errors of interpolation.
const TURNED_BACK: f64 = 1e-10;
/// How far, in radians, the tangent may turn between two neighbouring samples of a smooth curve.
const CORNER: f64 = 0.2;
/// How far, in radians, the tangent at a pole may be off the plane normal to the axis.
const POLE: f64 = 1e-6;

/// Whether the body is convex and its surface smooth, by the tangents at the ascending `parameters`
/// and in the middle between each two of them.
///
/// A body of revolution is convex if and only if its generating curve goes from pole to pole and
/// turns one way. The tangent leaves the upper pole outward, turns by half a turn, and comes to the
/// lower pole inward. It does not turn on straight pieces, where rounding makes it turn back by
/// about 1e-16; all that turns back is summed up, so that a dent counts however finely it is
/// sampled. A dent that is not seen is at most [`TURNED_BACK`] times its length deep.
///
/// A curve with a corner is not counted as convex, because there is no normal at the corner.
pub(super) fn is_convex(curve: &dyn GeneratingCurve, parameters: &[f64]) -> bool {
    if curve.topology() == Topology::Loop {
        return false;
    }
    let turn = |from: Meridian, to: Meridian| {
        (from.z * to.r - from.r * to.z).atan2(from.r * to.r + from.z * to.z)
    };
    let mut last = Meridian { r: 1.0, z: 0.0 };
    let (mut turned, mut most) = (0.0_f64, 0.0_f64);
    let middles = parameters
        .windows(2)
        .flat_map(|ends| [0.5 * (ends[0] + ends[1]), ends[1]]);
    for (k, s) in parameters
        .iter()
        .copied()
        .take(1)
        .chain(middles)
        .enumerate()
    {
        let tangent = curve.tangent(s);
        let step = turn(last, tangent);
        let allowed = if k == 0 { POLE } else { CORNER };
        if step.is_nan() || step.abs() > allowed {
            return false;
        }
        turned += step;
        most = if k == 0 { turned } else { most.max(turned) };
        if turned < most - TURNED_BACK {
            return false;
        }
        last = tangent;
    }
    (turned - std::f64::consts::PI).abs() <= POLE
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curve::{Biconcave, Capsule, Outline, Polar, Spheroid, Torus};

    fn convex(curve: &dyn GeneratingCurve) -> bool {
        is_convex(curve, Outline::new(curve).unwrap().parameters())
    }

    #[test]
    fn convex_bodies_and_others() {
        for radius in [1e-3, 1.0, 0.3, 7e5] {
            assert!(convex(&Spheroid::sphere(radius).unwrap()));
        }
        for aspect in [1e-5, 0.01, 0.3, 3.0, 100.0, 1e5] {
            assert!(convex(&Spheroid::new(aspect, 1.0).unwrap()), "{aspect}");
        }
        for length in [0.0, 1e-3, 0.1, 1.0, 30.0, 1e4] {
            assert!(convex(&Capsule::new(1.0, length).unwrap()), "{length}");
        }
        assert!(!convex(&Torus::new(2.0, 0.5).unwrap()));
        assert!(!convex(&Biconcave::new(1.0).unwrap()));
        // The curve at the distance d = 1 + c cos(2 theta) from the centre turns back where
        // d^2 + 2 d'^2 - d d'' < 0; at the equator, d = 1 - c and d'' = 4 c, that is for c > 0.2.
        assert!(convex(&Polar::new(&[1.0, 0.0, 0.199]).unwrap()));
        assert!(!convex(&Polar::new(&[1.0, 0.0, 0.201]).unwrap()));
    }
}
