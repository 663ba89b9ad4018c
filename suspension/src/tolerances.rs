//! What a tolerance means for the parts of a solution.

/// Residuals and products are better than the tolerance by these factors.
const RESIDUAL: f64 = 0.1;
const PRODUCT: f64 = 0.04;
/// Least relative residual and product.
const LEAST: f64 = 1e-13;
/// The best that a flow can be evaluated to.
const BEST_EVALUATION: f64 = 1e-15;

/// How well the parts of a solution are made.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tolerances {
    /// Target relative error.
    pub target: f64,
    /// Relative residual of the iteration.
    pub residual: f64,
    /// Tolerance of the products at their best, and of the corrections near bodies.
    pub product: f64,
    /// Tolerance of the flow at the probes, relative to the largest speed.
    pub evaluation: f64,
    /// Modes that the samples of a slip determine, over those kept: the others are aliased.
    pub oversampling: f64,
}

impl Tolerances {
    /// What a target takes; the residual if it is given.
    pub fn new(target: f64, residual: Option<f64>) -> Self {
        let residual = residual.unwrap_or(RESIDUAL * target);
        Self {
            target,
            residual: residual.max(LEAST),
            product: (PRODUCT * target).min(0.4 * residual).max(LEAST),
            evaluation: (1e-3 * target).max(BEST_EVALUATION),
            oversampling: 1.5,
        }
    }

    /// Those of a solution that another one is compared with: it samples slips and evaluates flows
    /// otherwise, so that errors made there show in the difference.
    pub fn of_comparison(target: f64) -> Self {
        Self {
            evaluation: BEST_EVALUATION,
            oversampling: 2.5,
            ..Self::new(target, None)
        }
    }

    /// A residual that is smaller by this factor.
    pub fn tighten(&mut self, factor: f64) {
        self.residual = (factor * self.residual).max(LEAST);
    }
}
