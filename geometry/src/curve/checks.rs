//! What every generating curve has to obey, for the tests beside each.

use super::*;

/// A grid of exactly representable parameters, away from the breakpoints by at least `margin`.
fn grid(curve: &dyn GeneratingCurve, margin: f64) -> Vec<f64> {
    let mut grid = Vec::new();
    for ends in curve.breakpoints().windows(2) {
        let width = ends[1] - ends[0];
        for k in 0..=40 {
            let s = ends[0] + width * (0.001 + 0.998 * f64::from(k) / 40.0);
            let s = (s * 1048576.0).round() / 1048576.0;
            if s - ends[0] > margin && ends[1] - s > margin {
                grid.push(s);
            }
        }
    }
    grid
}

fn norm(v: Meridian) -> f64 {
    v.r.hypot(v.z)
}

fn minus(a: Meridian, b: Meridian) -> Meridian {
    Meridian {
        r: a.r - b.r,
        z: a.z - b.z,
    }
}

/// Checks [`contract_to`] with few roundings for the chord.
pub fn contract(curve: &dyn GeneratingCurve) {
    contract_to(curve, 2e-15);
}

/// Checks the trait's promises; `relative` is the precision asked of short chords.
pub fn contract_to(curve: &dyn GeneratingCurve, relative: f64) {
    let ends = curve.breakpoints();
    let (first, last) = (ends[0], ends[ends.len() - 1]);
    let domain = last - first;
    assert!(ends.windows(2).all(|w| w[0] < w[1]));
    let scale = ends
        .iter()
        .map(|&s| norm(curve.point(s)))
        .fold(0.0, f64::max);

    // Ends.
    let (from, to) = (curve.point(first), curve.point(last));
    match curve.topology() {
        Topology::PoleToPole => {
            assert!(
                from.r.abs() < 1e-15 * scale && to.r.abs() < 1e-15 * scale.max(domain),
                "{curve:?}"
            );
            assert!(from.z > to.z);
            let (t0, t1) = (curve.tangent(first), curve.tangent(last));
            assert!(
                t0.z.abs() < 1e-9 * t0.r && t1.z.abs() < 1e-9 * -t1.r,
                "{curve:?}: {t0:?} {t1:?}"
            );
        }
        Topology::Loop => assert!(norm(minus(from, to)) < 1e-14 * scale),
    }

    // The tangent against central differences of the points.
    let h = 1e-5 * domain;
    for s in grid(curve, 2.0 * h) {
        let tangent = curve.tangent(s);
        let difference = minus(curve.point(s + h), curve.point(s - h));
        let error =
            (difference.r / (2.0 * h) - tangent.r).hypot(difference.z / (2.0 * h) - tangent.z);
        assert!(
            error < 1e-6 * (norm(tangent) + scale / domain),
            "{curve:?} at {s}: tangent off by {error}"
        );
    }

    // A short chord is ds times the tangent in its middle, up to ds^3; the middle is representable.
    let ds = 2f64.powi(-29);
    for s in grid(curve, 2.0 * ds) {
        for ds in [ds, -ds, 2f64.powi(-30)] {
            let (chord, tangent) = (curve.chord(s, ds), curve.tangent(s + 0.5 * ds));
            let error = (chord.r - ds * tangent.r).hypot(chord.z - ds * tangent.z) / norm(chord);
            assert!(error < relative, "{curve:?} at {s}: chord off by {error:e}");
        }
    }

    // Long chords are differences of points, and chords add up, also across joints and seams.
    let parameters = grid(curve, 0.0);
    for (i, &s) in parameters.iter().enumerate().step_by(3) {
        for &other in parameters.iter().step_by(5) {
            let chord = curve.chord(s, other - s);
            let error = norm(minus(chord, minus(curve.point(other), curve.point(s))));
            assert!(
                error < 4e-15 * (scale + domain * norm(curve.tangent(s))),
                "{curve:?} {s} {other}: {error:e}"
            );
        }
        let Some(&next) = parameters.get(i + 1) else {
            break;
        };
        let parts = [
            curve.chord(s, 0.25 * (next - s)),
            curve.chord(s + 0.25 * (next - s), 0.75 * (next - s)),
        ];
        let whole = curve.chord(s, next - s);
        let error = (parts[0].r + parts[1].r - whole.r).hypot(parts[0].z + parts[1].z - whole.z);
        assert!(
            error < 1e-14 * scale,
            "{curve:?} at {s}: parts off by {error:e}"
        );
    }

    // Outward normals enclose a positive volume.
    let panels = Panels::resolving(curve, 16, 1e-9).unwrap();
    assert!(volume(curve, &panels) > 0.0);
    assert_eq!(check_simple(curve), Ok(()), "{curve:?}");
}

/// Checks area and volume to 1e-12.
pub fn measures(curve: &dyn GeneratingCurve, area: f64, volume: f64) {
    let panels = Panels::resolving(curve, 16, 1e-13).unwrap();
    let (a, v) = (surface_area(curve, &panels), super::volume(curve, &panels));
    assert!(
        (a / area - 1.0).abs() < 1e-12,
        "{curve:?}: area {a}, not {area}"
    );
    assert!(
        (v / volume - 1.0).abs() < 1e-12,
        "{curve:?}: volume {v}, not {volume}"
    );
}
