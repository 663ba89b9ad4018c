//! What an iteration came to.

use std::fmt;

/// Why the iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The true residual is within the tolerance.
    Converged,
    /// As many iterations as were allowed have been made.
    MaxIterations,
    /// The true residual no longer falls: the system is singular, or the tolerance is below what
    /// the rounding of the products allows.
    Stagnated,
    /// A coefficient of BiCGStab's recurrences is a quotient of zeros, also after a new start.
    Breakdown,
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Converged => "it converged",
            Self::MaxIterations => "no more were allowed",
            Self::Stagnated => "it no longer fell",
            Self::Breakdown => "the method broke down",
        })
    }
}

/// What the iteration came to. Whoever needs a solution must look at [`Outcome::stop`].
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct Outcome {
    /// The iterate of least true residual. It solves the system with the operator as given: if the
    /// operator is $A M^{-1}$, it is $M x$, and $M^{-1}$ is still to be applied.
    pub solution: Vec<f64>,
    /// Iterations made.
    pub iterations: usize,
    /// Products made, those for true residuals among them.
    pub products: usize,
    /// Norm of the residual of the solution, computed with a product at full tolerance, relative to
    /// that of the right-hand side.
    pub residual: f64,
    /// That residual itself.
    pub residual_vector: Vec<f64>,
    /// Why the iteration ended.
    pub stop: Stop,
    /// Norm of the residual as the recurrences give it, relative to that of the right-hand side:
    /// before the first iteration and after each one.
    pub history: Vec<f64>,
}
