//! Interpolation, differentiation and resolution on one panel of Gauss-Legendre nodes.

use faer::Mat;

use crate::error::{QuadratureError, Result, check_finite, check_length};
use crate::gauss_legendre::GaussLegendre;
use crate::legendre;

/// The polynomials of degree below `p` on `[-1, 1]`, known by their values at `p` Gauss-Legendre
/// nodes.
///
/// Interpolation is barycentric: `l_j(t) = (b_j / (t - x_j)) / sum_k b_k / (t - x_k)` with
/// `b_j = (-1)^j / |P'_p(x_j)|` (Berrut & Trefethen 2004; these weights: Wang & Xiang 2012). Beyond
/// the panel's ends that quotient loses digits, and `l_j(t) = P_p(t) / (P'_p(x_j) (t - x_j))` is
/// used (Webb, Trefethen & Gonnet 2012).
///
/// ```
/// let panel = panel_quadrature::PanelBasis::new(16)?;
/// let values: Vec<f64> = panel.nodes().iter().map(|x| x.exp()).collect();
/// let mut row = [0.0; 16];
/// panel.interpolation_row(0.3, &mut row)?;
/// let at: f64 = std::iter::zip(row, &values).map(|(l, f)| l * f).sum();
/// assert!((at - 0.3f64.exp()).abs() < 1e-14);
/// # Ok::<(), panel_quadrature::QuadratureError>(())
/// ```
#[derive(Debug, Clone)]
pub struct PanelBasis {
    rule: GaussLegendre,
    /// `1 / P'_p(x_j)`.
    barycentric: Vec<f64>,
}

impl PanelBasis {
    /// The panel with `order` nodes.
    ///
    /// # Errors
    /// [`QuadratureError::Order`] if `order` is zero or above [`crate::gauss_legendre::MAX_ORDER`].
    pub fn new(order: usize) -> Result<Self> {
        let rule = GaussLegendre::new(order)?;
        let barycentric = std::iter::zip(0..order, rule.inverse_slopes())
            // P'_p is positive at the last node and alternates.
            .map(|(j, b)| if (order - j) % 2 == 1 { *b } else { -b })
            .collect();
        Ok(Self { rule, barycentric })
    }

    /// Number of nodes.
    pub fn order(&self) -> usize {
        self.rule.order()
    }

    /// The Gauss-Legendre rule of the panel.
    pub fn rule(&self) -> &GaussLegendre {
        &self.rule
    }

    /// The nodes, ascending.
    pub fn nodes(&self) -> &[f64] {
        self.rule.nodes()
    }

    /// The Gauss-Legendre weights.
    pub fn weights(&self) -> &[f64] {
        self.rule.weights()
    }

    /// Fills `row[j]` with `l_j(t)`, so that `sum_j row[j] f(x_j)` interpolates `f` at `t`.
    /// Allocates nothing.
    ///
    /// `t` may lie somewhat outside `[-1, 1]`; errors grow like `(|t| + sqrt(t^2 - 1))^p` there.
    ///
    /// # Errors
    /// If `row` is not as long as the panel's order, or `t` is not finite.
    pub fn interpolation_row(&self, t: f64, row: &mut [f64]) -> Result<()> {
        check_length("the interpolation row", row.len(), self.order())?;
        check_finite("the interpolation point", t)?;
        if t.abs() > 1.0 {
            self.extrapolate(t, |j| t - self.nodes()[j], row);
        } else {
            self.quotient(0, |j| t - self.nodes()[j], row);
        }
        Ok(())
    }

    /// Fills `row[j]` with `l_j(x_node + offset)`, with full relative precision however small the
    /// offset.
    ///
    /// # Errors
    /// If there is no such node, `row` is not as long as the panel's order, or `offset` is not
    /// finite.
    pub fn interpolation_row_near(&self, node: usize, offset: f64, row: &mut [f64]) -> Result<()> {
        let x = self.check_near(node, offset, row.len())?;
        let t = x + offset;
        if t.abs() > 1.0 {
            self.extrapolate(t, |j| self.distance(node, offset, j), row);
        } else {
            self.quotient(node, |j| self.distance(node, offset, j), row);
        }
        Ok(())
    }

    /// Fills `row` so that `sum_j row[j] f(x_j) = (f(x_node + offset) - f(x_node)) / offset` for
    /// polynomials of degree below `p`: the divided difference, whose limit at `offset = 0` is the
    /// derivative.
    ///
    /// No nearly equal numbers are subtracted. So `offset` times this is a difference of curve
    /// points to full relative precision.
    ///
    /// # Errors
    /// If there is no such node, `row` is not as long as the panel's order, or `offset` is not
    /// finite.
    pub fn divided_difference_row(&self, node: usize, offset: f64, row: &mut [f64]) -> Result<()> {
        let x = self.check_near(node, offset, row.len())?;
        if (x + offset).abs() > 1.0 {
            self.extrapolate(x + offset, |j| self.distance(node, offset, j), row);
            row.iter_mut().for_each(|l| *l /= offset);
        } else {
            self.quotient(node, |j| self.distance(node, offset, j), row);
            // l_j / offset = (b_j / d_j) / (b_i + offset sum_k b_k / d_k) needs no division by
            // offset.
            let hit = (0..row.len()).find(|&j| j != node && self.distance(node, offset, j) == 0.0);
            if let Some(j) = hit {
                row[j] = 1.0 / offset;
            } else {
                let scale = row[node] / self.barycentric[node];
                for (j, l) in row.iter_mut().enumerate().filter(|(j, _)| *j != node) {
                    *l = scale * self.barycentric[j] / self.distance(node, offset, j);
                }
            }
        }
        row[node] = 0.0;
        row[node] = -row.iter().sum::<f64>();
        Ok(())
    }

    /// The matrix from node values to values at `points`: one [row](Self::interpolation_row) per
    /// point.
    ///
    /// # Errors
    /// If a point is not finite.
    pub fn interpolation_matrix(&self, points: &[f64]) -> Result<Mat<f64>> {
        let mut matrix = Mat::zeros(points.len(), self.order());
        let mut row = vec![0.0; self.order()];
        for (i, &t) in points.iter().enumerate() {
            self.interpolation_row(t, &mut row)?;
            row.iter()
                .enumerate()
                .for_each(|(j, l)| matrix[(i, j)] = *l);
        }
        Ok(matrix)
    }

    /// The matrix from node values to values of the derivative at the nodes,
    /// `D_ij = (b_j / b_i) / (x_i - x_j)`, with rows that sum to zero (Berrut & Trefethen 2004,
    /// section 9.3).
    pub fn differentiation_matrix(&self) -> Mat<f64> {
        let (x, b) = (self.nodes(), &self.barycentric);
        let mut matrix = Mat::from_fn(self.order(), self.order(), |i, j| {
            if i == j {
                0.0
            } else {
                (b[j] / b[i]) / (x[i] - x[j])
            }
        });
        for i in 0..self.order() {
            matrix[(i, i)] = -(0..self.order()).map(|j| matrix[(i, j)]).sum::<f64>();
        }
        matrix
    }

    /// Legendre coefficients of the interpolant, `c_k = (k + 1/2) sum_j w_j P_k(x_j) f_j`.
    /// Evaluate them with [`legendre::series`] and its companions.
    ///
    /// # Errors
    /// If `values` is not as long as the panel's order.
    pub fn coefficients(&self, values: &[f64]) -> Result<Vec<f64>> {
        check_length("the node values", values.len(), self.order())?;
        let mut coefficients = vec![0.0; self.order()];
        let mut p = vec![0.0; self.order()];
        for ((x, w), f) in self.rule.iter().zip(values) {
            legendre::values(x, &mut p);
            std::iter::zip(&mut coefficients, &p).for_each(|(c, p)| *c += w * f * p);
        }
        for (k, c) in coefficients.iter_mut().enumerate() {
            *c *= k as f64 + 0.5;
        }
        Ok(coefficients)
    }

    /// How well the panel resolves a function: the larger of its last two Legendre coefficients,
    /// relative to the largest of all. Two are needed because every second coefficient of an even
    /// or odd function is zero.
    ///
    /// The value is near 1e-16 for a function resolved to rounding, near 1 for one that is not
    /// resolved, 0 for the zero function, and infinity if a value is not finite. Panels of one or
    /// two nodes cannot tell, and the value is 1.
    ///
    /// # Errors
    /// If `values` is not as long as the panel's order.
    pub fn tail(&self, values: &[f64]) -> Result<f64> {
        let coefficients = self.coefficients(values)?;
        if coefficients.iter().any(|c| !c.is_finite()) {
            return Ok(f64::INFINITY);
        }
        let largest = |c: &[f64]| c.iter().fold(0.0, |m: f64, c| m.max(c.abs()));
        let all = largest(&coefficients);
        let last = largest(&coefficients[self.order().saturating_sub(2)..]);
        Ok(if all == 0.0 { 0.0 } else { last / all })
    }

    /// `x_node + offset - x_j`.
    fn distance(&self, node: usize, offset: f64, j: usize) -> f64 {
        if j == node {
            offset
        } else {
            (self.nodes()[node] - self.nodes()[j]) + offset
        }
    }

    /// The barycentric quotient for given distances from the nodes. There is no division by the
    /// distance of `pivot`, so it may be anything, zero included.
    fn quotient(&self, pivot: usize, distance: impl Fn(usize) -> f64, row: &mut [f64]) {
        let to_pivot = distance(pivot);
        let mut sum = 0.0;
        for (j, l) in row.iter_mut().enumerate() {
            let d = distance(j);
            if d == 0.0 {
                row.fill(0.0);
                row[j] = 1.0;
                return;
            }
            // Multiplied through by the pivot's distance.
            let ratio = if j == pivot { 1.0 } else { to_pivot / d };
            *l = self.barycentric[j] * ratio;
            sum += *l;
        }
        row.iter_mut().for_each(|l| *l /= sum);
    }

    /// The first barycentric form, for a point `t` outside, at given distances from the nodes.
    fn extrapolate(&self, t: f64, distance: impl Fn(usize) -> f64, row: &mut [f64]) {
        let p = self.node_polynomial(t);
        for (j, l) in row.iter_mut().enumerate() {
            *l = p * self.barycentric[j] / distance(j);
        }
    }

    /// `P_p(t)`, whose zeros are the nodes.
    fn node_polynomial(&self, t: f64) -> f64 {
        let (mut p, mut next) = (1.0, t);
        for k in 1..=self.order() {
            let k = k as f64;
            (p, next) = (next, ((2.0 * k + 1.0) * t * next - k * p) / (k + 1.0));
        }
        p
    }

    fn check_near(&self, node: usize, offset: f64, row: usize) -> Result<f64> {
        check_length("the interpolation row", row, self.order())?;
        check_finite("the offset from the node", offset)?;
        let x = self.nodes().get(node).ok_or(QuadratureError::Node {
            index: node,
            order: self.order(),
        })?;
        Ok(*x)
    }
}

#[cfg(test)]
mod tests;
