//! Closed-form integrals of Legendre polynomials against a logarithm.

use crate::error::{Result, check_finite};

/// Fills `moments[k]` with `int_{-1}^{1} P_k(x) log|x - y| dx`, for any finite `y`.
///
/// Writing `P_k = (P'_{k+1} - P'_{k-1}) / (2k + 1)` and integrating by parts gives
/// `2 (Q_{k+1}(y) - Q_{k-1}(y)) / (2k + 1)` for `k >= 1`, by Neumann's integral
/// `Q_k(y) = (1/2) int P_k(x) / (y - x) dx` (Abramowitz & Stegun 1964, 8.8.3); principal values
/// and Legendre functions on the cut for `|y| < 1`. For `k = 0` it is elementary. The `Q_k` are
/// recurred upwards on the cut and near it, downwards where they decay.
///
/// # Errors
/// If `y` is not finite.
pub fn log_moments(y: f64, moments: &mut [f64]) -> Result<()> {
    check_finite("the singular point", y)?;
    let Some((first, rest)) = moments.split_first_mut() else {
        return Ok(());
    };
    let a = y.abs();
    // P_k has the parity of k.
    let sign = |k: usize| if y < 0.0 && k % 2 == 1 { -1.0 } else { 1.0 };
    *first = zeroth(a);
    if a == 1.0 {
        for (k, moment) in (1..).zip(rest) {
            *moment = -sign(k) * 2.0 / (k as f64 * (k + 1) as f64);
        }
        return Ok(());
    }
    let q = second_kind(a, rest.len() + 2);
    for (k, moment) in (1..).zip(rest) {
        *moment = sign(k) * 2.0 * (q[k + 1] - q[k - 1]) / (2.0 * k as f64 + 1.0);
    }
    Ok(())
}

/// `int log|x - a| dx = (1 - a) log|1 - a| + (1 + a) log(1 + a) - 2`.
fn zeroth(a: f64) -> f64 {
    if a == 1.0 {
        2.0 * std::f64::consts::LN_2 - 2.0
    } else if a > 4.0 {
        // 2 log a - 2 sum_j a^(-2j) / (2j (2j + 1)), without the cancellation.
        let s = 1.0 / (a * a);
        let sum = (1..=14).rev().fold(0.0, |sum, j| {
            let n = f64::from(2 * j);
            s * (sum + 1.0 / (n * (n + 1.0)))
        });
        2.0 * a.ln() - 2.0 * sum
    } else {
        (1.0 - a) * (1.0 - a).abs().ln() + (1.0 + a) * a.ln_1p() - 2.0
    }
}

/// `Q_0(a), ..., Q_{count-1}(a)` for `a >= 0`, `a != 1`; `count >= 2`.
fn second_kind(a: f64, count: usize) -> Vec<f64> {
    let zero = if a < 1.0 {
        a.atanh()
    } else {
        0.5 * (2.0 / (a - 1.0)).ln_1p()
    };
    let mut q = vec![zero; count];
    let decay = if a > 1.0 { a.acosh() } else { 0.0 };
    if decay * (count as f64) < 1.0 {
        q[1] = a * zero - 1.0;
        for k in 1..count - 1 {
            let n = k as f64;
            q[k + 1] = ((2.0 * n + 1.0) * a * q[k] - n * q[k - 1]) / (n + 1.0);
        }
    } else {
        // Ratios Q_k / Q_{k-1} = k / ((2k + 1) a - (k + 1) Q_{k+1} / Q_k), from far enough up.
        let top = count + (20.0 / decay).ceil() as usize;
        let mut ratio = 0.0;
        for k in (1..top).rev() {
            let n = k as f64;
            ratio = n / ((2.0 * n + 1.0) * a - (n + 1.0) * ratio);
            if k < count {
                q[k] = ratio;
            }
        }
        for k in 1..count {
            q[k] *= q[k - 1];
        }
    }
    q
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{GaussLegendre, LogEndpoint, legendre};

    /// The same integrals by quadrature that has nothing to do with the `Q_k`.
    fn numerical(y: f64, k: usize) -> f64 {
        let mut p = vec![0.0; k + 1];
        let mut at = |x: f64| {
            legendre::values(x, &mut p);
            p[k]
        };
        if y.abs() < 1.0 {
            let rule = LogEndpoint::new(24).unwrap();
            let side = |length: f64, sign: f64, at: &mut dyn FnMut(f64) -> f64| {
                rule.iter()
                    .map(|(d, w)| length * w * (length * d).ln() * at(y + sign * length * d))
                    .sum::<f64>()
            };
            return side(1.0 - y, 1.0, &mut at) + side(1.0 + y, -1.0, &mut at);
        }
        let rule = GaussLegendre::new(400).unwrap();
        rule.iter()
            .map(|(x, w)| w * at(x) * (x - y).abs().ln())
            .sum()
    }

    #[test]
    fn agree_with_quadrature() {
        for y in [
            -0.999, -0.3, 0.0, 0.5, 0.9, 1.01, -1.3, 2.0, 2.98, 4.1, -60.0,
        ] {
            let mut moments = [0.0; 24];
            log_moments(y, &mut moments).unwrap();
            for (k, moment) in moments.iter().enumerate() {
                let error = moment - numerical(y, k);
                let scale = if k == 0 { moment.abs().max(1.0) } else { 1.0 };
                assert!(error.abs() < 2e-14 * scale, "y = {y}, k = {k}: {error:e}");
            }
        }
    }

    #[test]
    fn continuous_at_the_end() {
        let (mut at, mut beside) = ([0.0; 12], [0.0; 12]);
        for (y, near) in [(1.0, 1.0 + 1e-14), (1.0, 1.0 - 1e-14), (-1.0, -1.0 - 1e-14)] {
            log_moments(y, &mut at).unwrap();
            log_moments(near, &mut beside).unwrap();
            assert!((0..12).all(|k| (at[k] - beside[k]).abs() < 1e-12));
        }
    }

    #[test]
    fn odd_input() {
        assert!(log_moments(f64::NAN, &mut [0.0]).is_err());
        log_moments(0.3, &mut []).unwrap();
        let mut far = [0.0; 3];
        log_moments(1e300, &mut far).unwrap();
        assert!(far.iter().all(|m| m.is_finite()));
    }
}
