//! What an iteration came to.

use std::fmt;

/// Why the iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The true residual is within the tolerance.
    Converged,
    /// As many iterations as were allowed have been made.
    MaxIterations,
    /// The true residual no longer falls: the system is singular, or the tolerance is below what the products' rounding allows.
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
    /// The solution of the system with the operator as given, that is before `M^{-1}` if the operator is $A M^{-1}$; the one of least true residual seen.
    pub solution: Vec<f64>,
    /// Iterations made.
    pub iterations: usize,
    /// Products made, those for true residuals among them.
    pub products: usize,
    /// Norm of the solution's residual, by a product at full tolerance, over that of the right-hand side.
    pub residual: f64,
    /// That residual itself.
    pub residual_vector: Vec<f64>,
    /// Why the iteration ended.
    pub stop: Stop,
    /// The residual that the iteration believed in, before it began and after each iteration, over the norm of the right-hand side.
    pub history: Vec<f64>,
}
