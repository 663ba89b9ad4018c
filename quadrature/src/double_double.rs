//! Double-double numbers: unevaluated sums `hi + lo` of two doubles, about 31 digits.
//!
//! It has only what the rules need: the four operations, square root of a double, and the
//! logarithm. The error-free sum is Knuth's (1969), the error-free product uses the fused
//! multiply-add, and the algorithms for the operations are those of Joldes, Muller & Popescu
//! (2017). The crate `twofloat` (0.8) was tried: its `f64 / TwoFloat` and its `ln` keep only 17 to
//! 18 digits.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A double-double number.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub(crate) struct Dd {
    hi: f64,
    lo: f64,
}

/// `a + b` without rounding, for any magnitudes.
fn two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    let bb = hi - a;
    Dd {
        hi,
        lo: (a - (hi - bb)) + (b - bb),
    }
}

/// `a + b` without rounding, for `|a| >= |b|`.
fn fast_two_sum(a: f64, b: f64) -> Dd {
    let hi = a + b;
    Dd {
        hi,
        lo: b - (hi - a),
    }
}

/// `a * b` without rounding.
fn two_product(a: f64, b: f64) -> Dd {
    let hi = a * b;
    Dd {
        hi,
        lo: a.mul_add(b, -hi),
    }
}

impl Dd {
    pub(crate) const ZERO: Self = Self { hi: 0.0, lo: 0.0 };
    pub(crate) const ONE: Self = Self { hi: 1.0, lo: 0.0 };
    const LN_2: Self = Self {
        hi: std::f64::consts::LN_2,
        lo: 2.3190468138462996e-17,
    };

    /// The nearest double.
    pub(crate) fn to_f64(self) -> f64 {
        self.hi
    }

    /// The part beyond the nearest double.
    #[cfg(test)]
    pub(crate) fn low(self) -> f64 {
        self.lo
    }

    pub(crate) fn abs(self) -> Self {
        if self.hi < 0.0 { -self } else { self }
    }

    /// Exact multiplication by a power of two.
    fn scale(self, power: f64) -> Self {
        Self {
            hi: self.hi * power,
            lo: self.lo * power,
        }
    }

    /// The exponential, by Taylor's series of `x / 512` and nine squarings of `exp - 1`.
    fn exp(self) -> Self {
        let k = (self.hi / std::f64::consts::LN_2).round();
        let r = (self - Self::LN_2 * Self::from(k)).scale(1.0 / 512.0);
        let mut term = r;
        let mut sum = r;
        for n in 2..=9 {
            term = term * r / Self::from(n as f64);
            sum = sum + term;
        }
        for _ in 0..9 {
            sum = sum.scale(2.0) + sum * sum;
        }
        (sum + Self::ONE).scale(2f64.powi(k as i32))
    }

    /// The natural logarithm of a positive number: one step of third order of Newton's method for
    /// `exp`, from the double value.
    pub(crate) fn ln(self) -> Self {
        let y = Self::from(self.hi.ln());
        // With d = x exp(-y) - 1 of order 1e-16, ln(1 + d) = d - d^2/2 to 48 digits.
        let d = self * (-y).exp() - Self::ONE;
        y + d - (d * d).scale(0.5)
    }
}

impl From<f64> for Dd {
    fn from(hi: f64) -> Self {
        Self { hi, lo: 0.0 }
    }
}

impl Neg for Dd {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            hi: -self.hi,
            lo: -self.lo,
        }
    }
}

impl Add for Dd {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        let s = two_sum(self.hi, b.hi);
        let t = two_sum(self.lo, b.lo);
        let v = fast_two_sum(s.hi, s.lo + t.hi);
        fast_two_sum(v.hi, t.lo + v.lo)
    }
}

impl Sub for Dd {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for Dd {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let c = two_product(self.hi, b.hi);
        let cross = self.hi.mul_add(b.lo, self.lo * b.hi);
        fast_two_sum(c.hi, c.lo + cross)
    }
}

impl Div for Dd {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let q1 = self.hi / b.hi;
        let r = self - b * Self::from(q1);
        let q2 = r.hi / b.hi;
        let r = r - b * Self::from(q2);
        let q3 = r.hi / b.hi;
        fast_two_sum(q1, q2) + Self::from(q3)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn division_undoes_multiplication() {
        for k in 1..200 {
            let x = Dd::from(k as f64) / Dd::from(7.0);
            let y = Dd::from(1.0) / x * x - Dd::ONE;
            assert!(y.to_f64().abs() < 1e-31);
        }
    }

    /// ln 3 by mpmath with 50 digits, then identities.
    #[test]
    fn logarithm_has_thirty_digits() {
        let three = Dd::from(3.0).ln();
        assert_eq!(three.to_f64(), 1.0986122886681098);
        assert!((three.low() - -9.07129723500153e-17).abs() < 1e-31);
        // ln(a b) = ln a + ln b, over many magnitudes
        for k in -12..12 {
            let a = Dd::from(10f64.powi(k)) / Dd::from(3.0);
            let b = Dd::from(0.9) / Dd::from(k as f64 + 13.0);
            let error = ((a * b).ln() - a.ln() - b.ln()).to_f64();
            assert!(error.abs() < 1e-29, "{k}: {error:e}");
        }
        // ln(1 + h) = h - h^2/2 + h^3/3 for h = 2^-30
        let h = Dd::from(2f64.powi(-30));
        let series = h - (h * h).scale(0.5) + h * h * h / Dd::from(3.0);
        let error = (Dd::ONE + h).ln() - series + h * h * h * h.scale(0.25);
        assert!(error.to_f64().abs() < 1e-31);
    }
}
