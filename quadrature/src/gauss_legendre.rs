//! Gauss-Legendre rules: `n` nodes on `[-1, 1]`, exact for polynomials of degree `2n - 1`.

use crate::double_double::Dd;
use crate::error::{QuadratureError, Result};

/// The largest order offered. The cost of a rule is `O(order^2)`.
pub const MAX_ORDER: usize = 1000;

/// A Gauss-Legendre rule.
///
/// Nodes are the zeros `x_i` of `P_n`, weights are `2 / ((1 - x_i^2) P'_n(x_i)^2)` (Abramowitz &
/// Stegun 1964, 25.4.29). Newton's method in doubles on the three-term recurrence starts from
/// Tricomi's guess (1950); one step in double-double follows, and nodes and weights are rounded
/// from its result. Every node and weight is right to about one ulp, at any order.
///
/// ```
/// let rule = panel_quadrature::GaussLegendre::new(5)?;
/// let integral: f64 = rule.iter().map(|(x, w)| w * x.powi(8)).sum();
/// assert!((integral - 2.0 / 9.0).abs() < 1e-15);
/// # Ok::<(), panel_quadrature::QuadratureError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GaussLegendre {
    nodes: Vec<f64>,
    weights: Vec<f64>,
    /// `|1 / P'_n(x_i)|`, the size of the barycentric weights.
    inverse_slopes: Vec<f64>,
}

impl GaussLegendre {
    /// The rule with `order` nodes.
    ///
    /// # Errors
    /// [`QuadratureError::Order`] if `order` is zero or above [`MAX_ORDER`].
    pub fn new(order: usize) -> Result<Self> {
        if order == 0 || order > MAX_ORDER {
            return Err(QuadratureError::Order {
                order,
                max: MAX_ORDER,
            });
        }
        let mut rule = Self {
            nodes: vec![0.0; order],
            weights: vec![0.0; order],
            inverse_slopes: vec![0.0; order],
        };
        for i in 0..order.div_ceil(2) {
            let (node, slope) = zero(order, i);
            let weight = Dd::from(2.0) / ((Dd::ONE - node * node) * slope * slope);
            let mirror = order - 1 - i;
            rule.nodes[mirror] = node.to_f64();
            rule.nodes[i] = -node.to_f64();
            for k in [i, mirror] {
                rule.weights[k] = weight.to_f64();
                rule.inverse_slopes[k] = (Dd::ONE / slope).abs().to_f64();
            }
        }
        if order % 2 == 1 {
            rule.nodes[order / 2] = 0.0;
        }
        Ok(rule)
    }

    /// Number of nodes.
    pub fn order(&self) -> usize {
        self.nodes.len()
    }

    /// The nodes, ascending in `(-1, 1)`, exactly antisymmetric about 0.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// The weights, positive, summing to 2.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Pairs of node and weight.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + '_ {
        std::iter::zip(self.nodes.iter().copied(), self.weights.iter().copied())
    }

    /// Barycentric weights of the nodes, `1 / P'_n(x_i)`, up to a common factor: positive sizes.
    pub(crate) fn inverse_slopes(&self) -> &[f64] {
        &self.inverse_slopes
    }
}

/// Node `i` and its weight in double-double; needs `i < order`, `order > 0`.
pub(crate) fn node_and_weight(order: usize, i: usize) -> (Dd, Dd) {
    let from_right = order - 1 - i;
    let left = i < from_right;
    let (node, slope) = zero(order, if left { i } else { from_right });
    let weight = Dd::from(2.0) / ((Dd::ONE - node * node) * slope * slope);
    (if left { -node } else { node }, weight)
}

/// The `i`-th zero of `P_n` counted from the right, and `P'_n` there.
fn zero(n: usize, i: usize) -> (Dd, Dd) {
    let order = n as f64;
    let angle = std::f64::consts::PI * (i as f64 + 0.75) / (order + 0.5);
    let mut x = (1.0 - (order - 1.0) / (8.0 * order.powi(3))) * angle.cos();
    for _ in 0..8 {
        let (p, slope) = value_and_slope(n, Dd::from(x));
        let step = p.to_f64() / slope.to_f64();
        x -= step;
        if step.abs() < 1e-12 {
            break;
        }
    }
    if 2 * i + 1 == n {
        x = 0.0;
    }
    let (p, slope) = value_and_slope(n, Dd::from(x));
    let node = Dd::from(x) - p / slope;
    (node, value_and_slope(n, node).1)
}

/// `P_n` and `P'_n = n (P_{n-1} - x P_n) / (1 - x^2)`.
fn value_and_slope(n: usize, x: Dd) -> (Dd, Dd) {
    let (mut below, mut p) = (Dd::ONE, x);
    for k in 1..n {
        let k = k as f64;
        let next = (Dd::from(2.0 * k + 1.0) * x * p - Dd::from(k) * below) / Dd::from(k + 1.0);
        (below, p) = (p, next);
    }
    let slope = Dd::from(n as f64) * (below - x * p) / (Dd::ONE - x * x);
    (p, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_high_precision_values() {
        let table = include_str!("../data/gauss_legendre_reference.txt");
        let mut checked = 0;
        for line in table.lines().filter(|line| !line.starts_with('#')) {
            let fields: Vec<f64> = line.split(' ').map(|s| s.parse().unwrap()).collect();
            let rule = GaussLegendre::new(fields[0] as usize).unwrap();
            let i = fields[1] as usize;
            // The table lists nodes ascending.
            assert!((rule.nodes()[i] - fields[2]).abs() <= f64::EPSILON * fields[2].abs());
            assert!((rule.weights()[i] - fields[3]).abs() <= f64::EPSILON * fields[3]);
            checked += 1;
        }
        assert!(checked > 30);
    }

    #[test]
    fn exact_to_twice_the_order() {
        for order in [1, 2, 3, 7, 10, 16, 40, 100, 200, MAX_ORDER] {
            let rule = GaussLegendre::new(order).unwrap();
            assert!(rule.nodes().is_sorted());
            let mut p = vec![0.0; 2 * order];
            let mut sums = vec![0.0; 2 * order];
            for (x, w) in rule.iter() {
                crate::legendre::values(x, &mut p);
                std::iter::zip(&mut sums, &p).for_each(|(s, p)| *s += w * p);
            }
            sums[0] -= 2.0;
            let worst = sums.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
            assert!(worst < 3e-15, "order {order}: {worst:e}");
        }
    }

    #[test]
    fn refuses_silly_orders() {
        for order in [0, MAX_ORDER + 1, usize::MAX] {
            let error = GaussLegendre::new(order).unwrap_err();
            assert!(error.to_string().contains(&order.to_string()));
        }
    }
}
