//! What both methods share: products and their tolerances, true residuals, the history.

use super::vectors::{Sums, not_finite, scale};
use super::{Control, KrylovError, Operator, Outcome, Stop};

/// A system being solved. Vectors are those of the user times [`Session::scale`], a power of two
/// that keeps squares from underflow and overflow.
pub(super) struct Session<'a, O: Operator> {
    operator: &'a mut O,
    right_hand_side: &'a [f64],
    report: &'a mut dyn FnMut(usize, f64) -> Result<(), O::Error>,
    control: Control,
    scale: f64,
    /// Norm of the scaled right-hand side.
    unit: f64,
    /// Share of the tolerance that a product's error may take. It is lowered when the recurrences'
    /// residual was far from the true one.
    safety: f64,
    /// Whether all products are made at full tolerance from now on.
    exact: bool,
    products: usize,
    history: Vec<f64>,
    pub(super) sums: Sums,
}

impl<'a, O: Operator> Session<'a, O> {
    /// For a right-hand side that is finite and not zero.
    pub(super) fn new(
        operator: &'a mut O,
        right_hand_side: &'a [f64],
        control: Control,
        report: &'a mut dyn FnMut(usize, f64) -> Result<(), O::Error>,
    ) -> Self {
        let largest = right_hand_side.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        Self {
            operator,
            right_hand_side,
            report,
            control,
            scale: (-largest.log2().floor()).clamp(-1000.0, 1000.0).exp2(),
            unit: 1.0,
            safety: control.safety,
            exact: control.loosest == 0.0,
            products: 0,
            history: Vec::new(),
            sums: Sums::new(right_hand_side.len()),
        }
    }

    pub(super) fn unknowns(&self) -> usize {
        self.right_hand_side.len()
    }

    /// The start, its residual to `r`, and the residual's norm over that of the right-hand side.
    pub(super) fn start(
        &mut self,
        start: Option<&[f64]>,
        r: &mut [f64],
    ) -> Result<(Vec<f64>, f64), KrylovError<O::Error>> {
        self.unit = self.sums.residual(r, self.scale, self.right_hand_side);
        let mut x = vec![0.0; self.unknowns()];
        let mut residual = 1.0;
        if let Some(start) = start.filter(|start| start.iter().any(|&x| x != 0.0)) {
            x.copy_from_slice(start);
            scale(&mut x, self.scale);
            residual = self.true_residual(&x, r)?;
        }
        self.history.push(residual);
        Ok((x, residual))
    }

    pub(super) fn iterations(&self) -> usize {
        self.history.len() - 1
    }

    pub(super) fn exhausted(&self) -> bool {
        self.iterations() >= self.control.max_iterations
    }

    /// Whether a true residual is small enough.
    pub(super) fn converged(&self, residual: f64) -> bool {
        residual <= self.control.tolerance
    }

    /// Norm that the recurrences' residual must reach so that the true residual, with the errors of
    /// the products, is still within the tolerance.
    pub(super) fn target(&self) -> f64 {
        self.control.tolerance * (1.0 - self.control.safety) * self.unit
    }

    /// The norm of the right-hand side, to which residuals are relative.
    pub(super) fn unit(&self) -> f64 {
        self.unit
    }

    /// The product of the operator with `x`, only as exact as a residual of this norm needs.
    pub(super) fn product(
        &mut self,
        x: &[f64],
        y: &mut [f64],
        residual: f64,
    ) -> Result<(), KrylovError<O::Error>> {
        let full = self.control.safety * self.control.tolerance;
        let tolerance = if self.exact {
            full
        } else {
            let enough = self.safety * self.control.tolerance * self.unit / residual;
            enough.min(self.control.loosest).max(full)
        };
        self.products += 1;
        Ok(self.operator.apply(x, y, tolerance)?)
    }

    /// Writes the residual of `x` to `r` and gives its norm, over that of the right-hand side.
    pub(super) fn true_residual(
        &mut self,
        x: &[f64],
        r: &mut [f64],
    ) -> Result<f64, KrylovError<O::Error>> {
        let norm = self.sums.norm(x);
        if !norm.is_finite() {
            return Err(not_finite("the solution", x));
        }
        // The product's error is relative to x, the residual to the right-hand side.
        let share = if norm > self.unit {
            self.unit / norm
        } else {
            1.0
        };
        self.products += 1;
        let tolerance = self.control.safety * self.control.tolerance * share;
        self.operator.apply(x, r, tolerance)?;
        let norm = self.sums.residual(r, self.scale, self.right_hand_side);
        if norm.is_finite() {
            Ok(norm / self.unit)
        } else {
            Err(not_finite("a product of the operator", r))
        }
    }

    /// Ends an iteration with the residual that is believed, as a norm.
    pub(super) fn record(&mut self, residual: f64) -> Result<(), KrylovError<O::Error>> {
        let relative = residual / self.unit;
        self.history.push(relative);
        let iteration = self.iterations();
        Ok((self.report)(iteration, relative)?)
    }

    /// The true residual stayed above what was believed: the next products are to be better.
    pub(super) fn distrust(&mut self) {
        self.safety = (0.1 * self.safety).max(1e-3 * self.control.safety);
    }

    /// The residual does not fall: have all products at full tolerance; false if they are already.
    pub(super) fn insist(&mut self) -> bool {
        !std::mem::replace(&mut self.exact, true)
    }

    pub(super) fn finish(
        self,
        mut solution: Vec<f64>,
        mut residual_vector: Vec<f64>,
        residual: f64,
        stop: Stop,
    ) -> Outcome {
        scale(&mut solution, 1.0 / self.scale);
        scale(&mut residual_vector, 1.0 / self.scale);
        Outcome {
            solution,
            iterations: self.iterations(),
            products: self.products,
            residual,
            residual_vector,
            stop,
            history: self.history,
        }
    }
}
