//! Integrals over a curve's parameter, and the length of an arc, by quadrature.

use super::generating_curve::GeneratingCurve;
use super::legendre::SIXTEEN;
use super::panel::Panel;

/// The length of the part of the curve between the parameters `start` and `end` (ascending, on one
/// piece), in the units of the curve: 16 equal panels of 16 nodes.
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
    integral(panels, |s| {
        let t = curve.tangent(s);
        t.r.hypot(t.z)
    })
}

/// The integral of `f` over the parameter on the `panels`, by 16 Gauss-Legendre nodes on each.
pub(super) fn integral(panels: impl Iterator<Item = Panel>, f: impl Fn(f64) -> f64) -> f64 {
    panels
        .map(|panel| {
            let sum: f64 = SIXTEEN.iter().map(|(x, w)| w * f(panel.at(x))).sum();
            0.5 * panel.length() * sum
        })
        .sum()
}
