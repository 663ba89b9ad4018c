//! Surface area and volume of the body, by quadrature.

use std::f64::consts::{PI, TAU};

use super::arc_length::integral;
use super::generating_curve::GeneratingCurve;
use super::panels::Panels;

/// The area of the body's surface, `2 pi int r |dgamma/ds| ds`, with 16 nodes on each panel.
pub fn surface_area(curve: &(impl GeneratingCurve + ?Sized), panels: &Panels) -> f64 {
    let area = integral(panels.iter().copied(), |s| {
        let t = curve.tangent(s);
        curve.point(s).r * t.r.hypot(t.z)
    });
    TAU * area
}

/// The volume of the body, `-pi int r^2 (dz/ds) ds`, with 16 nodes on each panel; negative if the
/// curve is traversed backwards.
pub fn volume(curve: &(impl GeneratingCurve + ?Sized), panels: &Panels) -> f64 {
    let volume = integral(panels.iter().copied(), |s| {
        let r = curve.point(s).r;
        -r * r * curve.tangent(s).z
    });
    PI * volume
}
