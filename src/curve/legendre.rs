//! Gauss-Legendre nodes and Legendre coefficients, as far as curves need them.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// Nodes on [-1, 1], ascending, and weights of a Gauss-Legendre rule.
#[derive(Clone, Debug)]
pub(super) struct Rule {
    pub nodes: Vec<f64>,
    pub weights: Vec<f64>,
}

/// The 16-point rule, exact for polynomials up to degree 31.
pub(super) static SIXTEEN: LazyLock<Rule> = LazyLock::new(|| Rule::new(16));

impl Rule {
    /// The rule with `count` nodes, by Newton's method from the asymptotic nodes (Abramowitz & Stegun 22.16.6).
    pub fn new(count: usize) -> Self {
        let mut nodes = vec![0.0; count];
        let mut weights = vec![0.0; count];
        for i in 0..count.div_ceil(2) {
            let mut x = (PI * (i as f64 + 0.75) / (count as f64 + 0.5)).cos();
            if 2 * i + 1 == count {
                x = 0.0;
            }
            for _ in 0..6 {
                let (p, dp) = polynomial(count, x);
                x -= p / dp;
            }
            let (_, dp) = polynomial(count, x);
            let weight = 2.0 / ((1.0 - x) * (1.0 + x) * dp * dp);
            (nodes[i], nodes[count - 1 - i]) = (-x, x);
            (weights[i], weights[count - 1 - i]) = (weight, weight);
        }
        Self { nodes, weights }
    }
}

/// P_n(x) and its derivative, |x| < 1.
fn polynomial(n: usize, x: f64) -> (f64, f64) {
    let (mut previous, mut value) = (1.0, x);
    for k in 1..n {
        let k = k as f64;
        (previous, value) = (
            value,
            ((2.0 * k + 1.0) * x * value - k * previous) / (k + 1.0),
        );
    }
    (
        value,
        n as f64 * (previous - x * value) / ((1.0 - x) * (1.0 + x)),
    )
}

/// Values at Gauss-Legendre nodes to Legendre coefficients.
#[derive(Clone, Debug)]
pub(super) struct Transform {
    pub rule: Rule,
    /// Row k: (k + 1/2) w_j P_k(x_j).
    rows: Vec<Vec<f64>>,
}

impl Transform {
    pub fn new(count: usize) -> Self {
        let rule = Rule::new(count);
        let mut rows = vec![vec![0.0; count]; count];
        for (j, (&x, &w)) in rule.nodes.iter().zip(&rule.weights).enumerate() {
            let (mut previous, mut value) = (0.0, 1.0);
            for (k, row) in rows.iter_mut().enumerate() {
                let degree = k as f64;
                row[j] = (degree + 0.5) * w * value;
                (previous, value) = (
                    value,
                    ((2.0 * degree + 1.0) * x * value - degree * previous) / (degree + 1.0),
                );
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
    fn rules_integrate_monomials() {
        for count in [1, 2, 5, 16, 33] {
            let rule = Rule::new(count);
            for degree in 0..2 * count {
                let sum: f64 = rule
                    .nodes
                    .iter()
                    .zip(&rule.weights)
                    .map(|(x, w)| w * x.powi(degree as i32))
                    .sum();
                let exact = if degree % 2 == 0 {
                    2.0 / (degree as f64 + 1.0)
                } else {
                    0.0
                };
                assert!(
                    (sum - exact).abs() < 1e-14,
                    "{count} nodes, degree {degree}: {sum}"
                );
            }
        }
    }

    #[test]
    fn coefficients_of_a_legendre_series() {
        let transform = Transform::new(6);
        let values: Vec<f64> = transform
            .rule
            .nodes
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
