//! Legendre polynomials and series of them, at real and complex points.
//!
//! Everything runs on the three-term recurrence
//! `(k + 1) P_{k+1}(t) = (2k + 1) t P_k(t) - k P_{k-1}(t)` (Abramowitz & Stegun 1964, 8.5.3)
//! and on `P'_{k+1} = P'_{k-1} + (2k + 1) P_k` for derivatives (the same, 8.5.4 combined with it).

use std::ops::{Add, Mul, Sub};

use num_complex::Complex64;

/// Fills `values[k]` with `P_k(t)`.
///
/// ```
/// let mut p = [0.0; 3];
/// panel_quadrature::legendre::values(0.5, &mut p);
/// assert_eq!(p, [1.0, 0.5, -0.125]);
/// ```
pub fn values(t: f64, values: &mut [f64]) {
    let (mut p, mut next) = (1.0, t);
    for (k, value) in values.iter_mut().enumerate() {
        *value = p;
        let k = k as f64;
        (p, next) = (
            next,
            ((2.0 * k + 3.0) * t * next - (k + 1.0) * p) / (k + 2.0),
        );
    }
}

/// The series `sum_k c_k P_k(t)`, by Clenshaw's recurrence (1955). Zero for no coefficients.
pub fn series(coefficients: &[f64], t: f64) -> f64 {
    clenshaw(coefficients, t, 0.0)
}

/// The series `sum_k c_k P_k(z)` at a complex point: the analytic continuation of [`series`].
pub fn series_complex(coefficients: &[f64], z: Complex64) -> Complex64 {
    clenshaw(coefficients, z, Complex64::ZERO)
}

/// The series and its derivative, `(sum_k c_k P_k(t), sum_k c_k P'_k(t))`.
pub fn series_with_derivative(coefficients: &[f64], t: f64) -> (f64, f64) {
    forward(coefficients, t, 0.0, 1.0)
}

/// The series and its derivative at a complex point, for Newton's method there.
pub fn series_with_derivative_complex(
    coefficients: &[f64],
    z: Complex64,
) -> (Complex64, Complex64) {
    forward(coefficients, z, Complex64::ZERO, Complex64::ONE)
}

/// Clenshaw's recurrence `b_k = c_k + (2k+1)/(k+1) t b_{k+1} - (k+1)/(k+2) b_{k+2}`; the sum is
/// `b_0`.
fn clenshaw<T>(coefficients: &[f64], t: T, zero: T) -> T
where
    T: Copy + Add<f64, Output = T> + Mul<f64, Output = T> + Mul<Output = T> + Sub<Output = T>,
{
    let (mut b1, mut b2) = (zero, zero);
    for (k, &c) in coefficients.iter().enumerate().rev() {
        let k = k as f64;
        let b0 = t * b1 * ((2.0 * k + 1.0) / (k + 1.0)) - b2 * ((k + 1.0) / (k + 2.0)) + c;
        (b1, b2) = (b0, b1);
    }
    b1
}

/// Sums values and derivatives while running the recurrences upwards.
fn forward<T>(coefficients: &[f64], t: T, zero: T, one: T) -> (T, T)
where
    T: Copy + Add<Output = T> + Mul<f64, Output = T> + Mul<Output = T> + Sub<Output = T>,
{
    let (mut sum, mut slope) = (zero, zero);
    // (P_k, P_{k-1}) and (P'_k, P'_{k-1})
    let (mut p, mut below) = (one, zero);
    let (mut dp, mut dbelow) = (zero, zero);
    for (k, &c) in coefficients.iter().enumerate() {
        sum = sum + p * c;
        slope = slope + dp * c;
        let k = k as f64;
        let next = (t * p * (2.0 * k + 1.0) - below * k) * (1.0 / (k + 1.0));
        let dnext = dbelow + p * (2.0 * k + 1.0);
        (p, below) = (next, p);
        (dp, dbelow) = (dnext, dp);
    }
    (sum, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1 - 2 P_1 + 3 P_2 - P_3 written out in powers of t.
    fn cubic(t: Complex64) -> (Complex64, Complex64) {
        let t2 = t * t;
        (
            1.0 - 2.0 * t + 3.0 * (1.5 * t2 - 0.5) - (2.5 * t2 * t - 1.5 * t),
            -2.0 + 9.0 * t - (7.5 * t2 - 1.5),
        )
    }

    #[test]
    fn series_agree_with_powers() {
        let c = [1.0, -2.0, 3.0, -1.0];
        for z in [
            Complex64::new(0.3, 0.0),
            Complex64::new(-1.1, 0.4),
            Complex64::new(0.0, 2.0),
        ] {
            let (value, slope) = cubic(z);
            assert!((series_complex(&c, z) - value).norm() < 1e-14);
            let (v, d) = series_with_derivative_complex(&c, z);
            assert!((v - value).norm() < 1e-14 && (d - slope).norm() < 1e-14);
        }
        let (value, slope) = cubic(Complex64::new(0.7, 0.0));
        let (v, d) = series_with_derivative(&c, 0.7);
        assert!((v - value.re).abs() < 1e-15 && (d - slope.re).abs() < 1e-14);
        assert!((series(&c, 0.7) - value.re).abs() < 1e-15);
    }

    #[test]
    fn empty_series_is_zero() {
        assert_eq!(series(&[], 0.2), 0.0);
        assert_eq!(series_with_derivative(&[], 0.2), (0.0, 0.0));
    }
}
