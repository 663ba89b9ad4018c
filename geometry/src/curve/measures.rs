//! Length, surface area and volume by quadrature.

use std::f64::consts::{PI, TAU};

use panel_quadrature::GaussLegendre;

use super::legendre::SIXTEEN;
use super::{GeneratingCurve, Panel, Panels};

/// The length of the part of the curve between the parameters `start` and `end` (ascending, on one piece):
/// 16 equal panels of 16 nodes.
pub fn arc_length(curve: &(impl GeneratingCurve + ?Sized), start: f64, end: f64) -> f64 {
    let parts = 16;
    let width = (end - start) / f64::from(parts);
    let panels = (0..parts).map(|k| {
        let start = start + width * f64::from(k);
        Panel {
            start,
            end: start + width,
            piece: 0,
        }
    });
    integral(panels, &SIXTEEN, |s| {
        let t = curve.tangent(s);
        t.r.hypot(t.z)
    })
}

/// The area of the body's surface, `2 pi int r |dgamma/ds| ds`, with 16 nodes on each panel.
pub fn surface_area(curve: &(impl GeneratingCurve + ?Sized), panels: &Panels) -> f64 {
    let area = integral(panels.iter().copied(), &SIXTEEN, |s| {
        let t = curve.tangent(s);
        curve.point(s).r * t.r.hypot(t.z)
    });
    TAU * area
}

/// The volume of the body, `-pi int r^2 (dz/ds) ds`, with 16 nodes on each panel; negative if the curve is
/// traversed backwards.
pub fn volume(curve: &(impl GeneratingCurve + ?Sized), panels: &Panels) -> f64 {
    let volume = integral(panels.iter().copied(), &SIXTEEN, |s| {
        let r = curve.point(s).r;
        -r * r * curve.tangent(s).z
    });
    PI * volume
}

fn integral(
    panels: impl Iterator<Item = Panel>,
    rule: &GaussLegendre,
    f: impl Fn(f64) -> f64,
) -> f64 {
    panels
        .map(|panel| {
            let sum: f64 = rule.iter().map(|(x, w)| w * f(panel.at(x))).sum();
            0.5 * panel.length() * sum
        })
        .sum()
}
