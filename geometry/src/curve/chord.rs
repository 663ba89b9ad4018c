//! Chords of curves without product formulas.

use super::legendre::SIXTEEN;
use super::{GeneratingCurve, Meridian, Topology};

/// Longest step, as a fraction of the domain, for which the tangent is integrated.
const LONGEST_STEP: f64 = 0.125;

/// The chord `gamma(s + ds) - gamma(s)` as the integral of the tangent, by 16 Gauss-Legendre nodes
/// on each part between two of the ascending `splits`, whose first and last are the ends of the
/// domain.
///
/// This keeps full relative precision however small `ds` is, provided that the tangent is a
/// polynomial of degree 31 to rounding between two splits. Steps beyond an eighth of the domain are
/// plain differences. On loops `s + ds` may pass the seam.
pub fn chord_by_quadrature(
    curve: &(impl GeneratingCurve + ?Sized),
    splits: &[f64],
    s: f64,
    ds: f64,
) -> Meridian {
    let (Some(&first), Some(&last)) = (splits.first(), splits.last()) else {
        return Meridian { r: 0.0, z: 0.0 };
    };
    let period = last - first;
    let closed = curve.topology() == Topology::Loop;
    // The same point in the domain, and how far the domain was shifted.
    let wrap = |s: f64| {
        if closed {
            s - period * ((s - first) / period).floor()
        } else {
            s.max(first).min(last)
        }
    };
    let s = if (first..=last).contains(&s) {
        s
    } else {
        wrap(s)
    };
    if ds.abs() > LONGEST_STEP * period {
        let end = if (first..=last).contains(&(s + ds)) {
            s + ds
        } else {
            wrap(s + ds)
        };
        let (from, to) = (curve.point(s), curve.point(end));
        return Meridian {
            r: to.r - from.r,
            z: to.z - from.z,
        };
    }
    let mut sum = Meridian { r: 0.0, z: 0.0 };
    let (mut s, mut left) = (s, ds);
    // From split to split, without forming s + ds.
    while left != 0.0 {
        let split = if ds > 0.0 {
            splits.get(splits.partition_point(|&x| x <= s)).copied()
        } else {
            splits
                .get(splits.partition_point(|&x| x < s).wrapping_sub(1))
                .copied()
        };
        let Some(split) = split else {
            // At the seam of a loop, or past the end of an open curve by a rounding.
            if !closed || !left.is_finite() {
                let tangent = curve.tangent(s);
                return Meridian {
                    r: sum.r + left * tangent.r,
                    z: sum.z + left * tangent.z,
                };
            }
            s = if ds > 0.0 { first } else { last };
            continue;
        };
        let to_split = split - s;
        let step = if to_split.abs() < left.abs() {
            to_split
        } else {
            left
        };
        let part = integral(curve, s, step);
        sum = Meridian {
            r: sum.r + part.r,
            z: sum.z + part.z,
        };
        (s, left) = (split, left - step);
    }
    sum
}

/// The integral of the tangent from `s` to `s + step`.
fn integral(curve: &(impl GeneratingCurve + ?Sized), s: f64, step: f64) -> Meridian {
    let half = 0.5 * step;
    let (mut r, mut z) = (0.0, 0.0);
    for (x, w) in SIXTEEN.iter() {
        let tangent = curve.tangent(s + half * (1.0 + x));
        r += w * tangent.r;
        z += w * tangent.z;
    }
    Meridian {
        r: half * r,
        z: half * z,
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::super::{Spheroid, Torus};
    use super::*;

    fn close(a: Meridian, b: Meridian, relative: f64) {
        let error = (a.r - b.r).hypot(a.z - b.z);
        assert!(
            error <= relative * a.r.hypot(a.z),
            "{a:?} against {b:?}: {error:e}"
        );
    }

    #[test]
    fn agrees_with_product_formulas() {
        let spheroid = Spheroid::new(1.0, 0.5).unwrap();
        for s in [0.0, 0.3, 1.5, 3.0, PI] {
            for ds in [1e-300, 1e-12, 1e-3, 0.09, -1e-13, -0.2, 1.0, -2.0] {
                if (0.0..=PI).contains(&(s + ds)) {
                    let splits = [0.0, 1.0, 1.55, 3.05, PI];
                    close(
                        spheroid.chord(s, ds),
                        chord_by_quadrature(&spheroid, &splits, s, ds),
                        3e-15,
                    );
                }
            }
        }
    }

    #[test]
    fn passes_the_seam_of_a_loop() {
        let torus = Torus::new(2.0, 1.0).unwrap();
        for (s, ds) in [
            (6.2, 0.3),
            (0.1, -0.4),
            (TAU, 1e-9),
            (0.0, -1e-9),
            (6.0, 3.0),
            (0.5, -3.0),
        ] {
            close(
                torus.chord(s, ds),
                chord_by_quadrature(&torus, &[0.0, TAU], s, ds),
                3e-15,
            );
        }
    }

    #[test]
    fn no_input_hangs_or_panics() {
        let torus = Torus::new(2.0, 1.0).unwrap();
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e300] {
            chord_by_quadrature(&torus, &[0.0, TAU], bad, 0.1);
            chord_by_quadrature(&torus, &[0.0, TAU], 0.1, bad);
            chord_by_quadrature(&torus, &[], 0.1, 0.2);
            chord_by_quadrature(&torus, &[1.0, bad, 0.0], 0.1, 0.2);
            chord_by_quadrature(&Spheroid::sphere(1.0).unwrap(), &[PI, 0.0], bad, 0.2);
        }
    }
}
