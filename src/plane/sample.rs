//! Evaluating the flow in a plane.

use super::{Plane, PlaneFlow};
use crate::solve::{SolveError, Solved};
use stokes_body::progress::Progress;

/// Relative accuracy of what is drawn.
const TOLERANCE: f64 = 1e-6;

impl PlaneFlow {
    /// The flow of a solved case at the grid points of a plane, relative to the laboratory, to about six digits.
    ///
    /// # Errors
    /// If the flow cannot be evaluated.
    pub fn sample(
        solved: &Solved,
        plane: Plane,
        progress: &dyn Progress,
    ) -> Result<Self, SolveError> {
        let values = solved.evaluate(&plane.grid(), TOLERANCE, progress)?;
        Ok(Self { plane, values })
    }
}
