//! Polynomials on $[-1, 1]$ that are right to what is allowed.

use std::f64::consts::PI;

use faer::Mat;
use faer::linalg::solvers::SolveLstsq;

/// A value that a polynomial shall take at `s` within `allowed`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sample {
    pub s: f64,
    pub value: f64,
    pub allowed: f64,
}

/// Zero number `i` of the Chebyshev polynomial of degree `count`: where to sample.
pub(crate) fn node(i: usize, count: usize) -> f64 {
    (PI * (i as f64 + 0.5) / count as f64).cos()
}

/// The polynomial that fits the samples in the sense of least squares, with errors relative to what
/// is allowed, and the largest of these errors. Coefficients of powers of $s$ are highest power
/// first.
pub(crate) fn fit(samples: &[Sample], degree: usize) -> (Vec<f64>, f64) {
    let chebyshev = |s: f64, j: usize| (j as f64 * s.acos()).cos();
    let design = Mat::from_fn(samples.len(), degree + 1, |i, j| {
        chebyshev(samples[i].s, j) / samples[i].allowed
    });
    let values = Mat::from_fn(samples.len(), 1, |i, _| {
        samples[i].value / samples[i].allowed
    });
    let series = design.qr().solve_lstsq(&values);
    let error = (&design * &series - &values).norm_max();
    let series: Vec<f64> = series.col(0).iter().copied().collect();
    (powers(&series), error)
}

/// Coefficients of a Chebyshev series in powers of $s$, highest power first, by
/// $T_{k+1} = 2sT_k - T_{k-1}$.
fn powers(series: &[f64]) -> Vec<f64> {
    let count = series.len();
    let mut sum = vec![0.0; count];
    let (mut below, mut current) = (vec![0.0; count], vec![0.0; count]);
    current[0] = 1.0;
    for (k, coefficient) in series.iter().enumerate() {
        for (sum, power) in sum.iter_mut().zip(&current) {
            *sum += coefficient * power;
        }
        let doubling = if k == 0 { 1.0 } else { 2.0 };
        let next = (0..count)
            .map(|i| doubling * if i > 0 { current[i - 1] } else { 0.0 } - below[i])
            .collect();
        below = std::mem::replace(&mut current, next);
    }
    sum.reverse();
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recovers_a_polynomial() {
        let samples: Vec<Sample> = (0..20)
            .map(|i| {
                let s = node(i, 20);
                Sample {
                    s,
                    value: 3.0 * s * s * s - s + 0.5,
                    allowed: 1.0 + s * s,
                }
            })
            .collect();
        let (polynomial, error) = fit(&samples, 4);
        assert!(error < 1e-14);
        for (found, expected) in polynomial.iter().zip([0.0, 3.0, 0.0, -1.0, 0.5]) {
            assert!((found - expected).abs() < 1e-13, "{polynomial:?}");
        }
    }

    #[test]
    fn parabola_by_a_line() {
        // s^2 = 1/2 + T_2/2: over Chebyshev points the closest line is the constant 1/2, with
        // errors of at most 1/2.
        let samples: Vec<Sample> = (0..16)
            .map(|i| {
                let s = node(i, 16);
                Sample {
                    s,
                    value: s * s,
                    allowed: 1.0,
                }
            })
            .collect();
        let (polynomial, error) = fit(&samples, 1);
        assert!(polynomial[0].abs() < 1e-14 && (polynomial[1] - 0.5).abs() < 1e-14);
        assert!(error < 0.5 && error > 0.49);
    }
}
