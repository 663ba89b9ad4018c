//! Legendre coefficients of functions on a panel, as far as curves need them.

use std::sync::LazyLock;

use panel_quadrature::{GaussLegendre, legendre};

/// The 16-point rule, exact for polynomials up to degree 31.
pub(super) static SIXTEEN: LazyLock<GaussLegendre> = LazyLock::new(|| rule(16));

/// The rule with `count` nodes, which callers keep between 1 and 64.
fn rule(count: usize) -> GaussLegendre {
    GaussLegendre::new(count).expect("there is a Gauss-Legendre rule of every order up to 1000")
}

/// Values at Gauss-Legendre nodes to Legendre coefficients.
#[derive(Clone, Debug)]
pub(super) struct Transform {
    pub rule: GaussLegendre,
    /// Row k: (k + 1/2) w_j P_k(x_j).
    rows: Vec<Vec<f64>>,
}

impl Transform {
    pub fn new(count: usize) -> Self {
        let rule = rule(count);
        let mut rows = vec![vec![0.0; count]; count];
        let mut polynomials = vec![0.0; count];
        for (j, (x, w)) in rule.iter().enumerate() {
            legendre::values(x, &mut polynomials);
            for (k, (row, p)) in rows.iter_mut().zip(&polynomials).enumerate() {
                row[j] = (k as f64 + 0.5) * w * p;
            }
        }
        Self { rule, rows }
    }

    /// All coefficients of the interpolant of `values`.
    pub fn coefficients(&self, values: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| dot(row, values)).collect()
    }

    /// The larger of the last two coefficients: two, because one may vanish by symmetry.
    pub fn tail(&self, values: &[f64]) -> f64 {
        // `f64::max` would drop a NaN, so add instead.
        self.rows
            .iter()
            .rev()
            .take(2)
            .map(|row| dot(row, values).abs())
            .sum()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_of_a_legendre_series() {
        let transform = Transform::new(6);
        let values: Vec<f64> = transform
            .rule
            .nodes()
            .iter()
            .map(|x| 2.0 - x + 3.0 * (1.5 * x * x - 0.5))
            .collect();
        let coefficients = transform.coefficients(&values);
        for (got, expected) in coefficients.iter().zip([2.0, -1.0, 3.0, 0.0, 0.0, 0.0]) {
            assert!((got - expected).abs() < 1e-14);
        }
        assert!(transform.tail(&values) < 1e-14);
    }
}
