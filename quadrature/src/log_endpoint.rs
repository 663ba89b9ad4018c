//! Rules for a logarithm at the end of an interval.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::error::{QuadratureError, Result};
use crate::table::{self, Columns};

/// The numbers of nodes there are rules for.
pub const ORDERS: &[usize] = &[10, 16, 20, 24];

const NAME: &str = "log_endpoint.txt";

static RULES: LazyLock<Result<BTreeMap<usize, Columns>>> =
    LazyLock::new(|| table::parse(NAME, include_str!("../data/log_endpoint.txt")));

/// A generalised Gaussian rule on `[0, 1]` for `phi(x) + psi(x) log x`, singular at 0.
///
/// With `m` nodes it is exact for polynomials `phi` and `psi` of degree up to `m - 1`. These are
/// `2m` functions that form a Chebyshev system, so such a rule exists, with nodes inside and
/// positive weights (Ma, Rokhlin & Wandzura 1996). To integrate over a panel cut at a target, scale
/// one rule to each side: an interval of length `L` has nodes at distances `L x_j` from the target
/// and weights `L w_j`.
///
/// ```
/// let rule = panel_quadrature::LogEndpoint::new(10)?;
/// let integral: f64 = rule.iter().map(|(x, w)| w * x * x * x.ln()).sum();
/// assert!((integral + 1.0 / 9.0).abs() < 1e-15);
/// # Ok::<(), panel_quadrature::QuadratureError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LogEndpoint {
    /// Nodes, as distances from the singular end: ascending in `(0, 1)`, to full relative
    /// precision.
    pub distances: &'static [f64],
    /// Weights, positive, summing to 1.
    pub weights: &'static [f64],
}

impl LogEndpoint {
    /// The rule with `order` nodes, one of [`ORDERS`].
    ///
    /// # Errors
    /// [`QuadratureError::NotTabulated`] for another number of nodes.
    pub fn new(order: usize) -> Result<Self> {
        let rules = RULES.as_ref().map_err(Clone::clone)?;
        let rule = rules.get(&order).ok_or(QuadratureError::NotTabulated {
            family: "logarithmic endpoint",
            order,
            available: ORDERS,
        })?;
        Ok(Self {
            distances: &rule.offsets,
            weights: &rule.weights,
        })
    }

    /// Number of nodes.
    pub fn order(&self) -> usize {
        self.distances.len()
    }

    /// Pairs of distance from the singular end and weight.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + 'static {
        std::iter::zip(self.distances.iter().copied(), self.weights.iter().copied())
    }
}

/// Makes the data file of this module anew, with the [generator](crate::generate).
///
/// # Errors
/// If the generator fails.
pub fn generate_table() -> Result<String> {
    let mut rules = Vec::new();
    for &order in ORDERS {
        rules.push((order, crate::generate::log_endpoint(order)?));
    }
    let comment = "Generalised Gaussian rules on [0, 1] for phi(x) + psi(x) log x.\n\
                   The rule's number is its number of nodes m; exact for phi, psi of degree < m.\n\
                   Columns: distance from the singular end, weight.\n\
                   Made by: cargo run --release -p panel-quadrature --example generate_tables";
    let columns = rules
        .iter()
        .map(|(order, rule)| (*order, &rule.offsets[..], &rule.weights[..]));
    Ok(table::write(comment, columns))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::legendre;

    /// Largest error in the moments of shifted Legendre polynomials without and with the logarithm:
    /// `int_0^1 P_k(2x - 1) log x dx = (-1)^(k+1) / (k (k + 1))`, and -1 for k = 0.
    fn moment_error(rule: &LogEndpoint) -> f64 {
        let m = rule.order();
        let mut p = vec![0.0; m];
        let mut sums = vec![0.0; 2 * m];
        for (x, w) in rule.iter() {
            legendre::values(2.0 * x - 1.0, &mut p);
            for k in 0..m {
                sums[k] += w * p[k];
                sums[m + k] += w * p[k] * x.ln();
            }
        }
        sums[0] -= 1.0;
        sums[m] += 1.0;
        for k in 1..m {
            let moment = 1.0 / (k * (k + 1)) as f64;
            sums[m + k] -= if k % 2 == 0 { -moment } else { moment };
        }
        sums.iter().fold(0.0, |worst: f64, s| worst.max(s.abs()))
    }

    #[test]
    fn moments_are_exact() {
        for &order in ORDERS {
            let rule = LogEndpoint::new(order).unwrap();
            assert_eq!(rule.order(), order);
            let error = moment_error(&rule);
            println!(
                "log endpoint {order}: error {error:.1e}, nearest node {:.1e}, smallest weight {:.1e}",
                rule.distances[0], rule.weights[0]
            );
            assert!(error < 2e-15, "{order}: {error:e}");
            assert!(rule.weights.iter().all(|w| *w > 0.0));
            assert!(rule.distances.is_sorted());
            assert!(rule.distances.iter().all(|x| *x > 0.0 && *x < 1.0));
        }
    }

    /// `int_0^1 cos(3x) log x + exp(x) dx = e - 1 - Si(3) / 3`.
    #[test]
    fn converges_for_analytic_factors() {
        let exact = std::f64::consts::E - 1.0 - 1.848_652_527_999_468_3 / 3.0;
        for (order, bar) in [(10, 2e-12), (16, 2e-15), (20, 2e-15), (24, 2e-15)] {
            let rule = LogEndpoint::new(order).unwrap();
            let f = |x: f64| (3.0 * x).cos() * x.ln() + x.exp();
            let error = rule.iter().map(|(x, w)| w * f(x)).sum::<f64>() - exact;
            assert!(error.abs() < bar, "{order}: {error:e}");
        }
    }

    #[test]
    fn generator_repeats_the_table() {
        let rule = LogEndpoint::new(10).unwrap();
        let made = crate::generate::log_endpoint(10).unwrap();
        for j in 0..10 {
            assert!((made.offsets[j] / rule.distances[j] - 1.0).abs() < 1e-14);
            assert!((made.weights[j] / rule.weights[j] - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn other_orders_are_refused() {
        let error = LogEndpoint::new(11).unwrap_err().to_string();
        assert!(error.contains("11") && error.contains("16"), "{error}");
    }
}
