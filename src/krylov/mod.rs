//! Krylov methods for linear systems that are known by their products only: GMRES and BiCGStab.
//!
//! They are made for products that take seconds and that are the cheaper the less exact they need be. Preconditioning is from
//! the right and the operator's own affair: it applies $A M^{-1}$, and start and solution are $M x$. The residual is then that of the
//! unpreconditioned system, and one basis is enough.
//!
//! *Inexact products.* With a residual of $\|r_k\|$ before step $k$, an error of $\sigma \epsilon \|b\| / \|r_k\|$ in that step's product moves the
//! final residual by about $\sigma \epsilon \|b\|$, for a target of $\epsilon \|b\|$ (V. Simoncini and D. B. Szyld, SIAM J. Sci. Comput. 25,
//! 2003; J. van den Eshof and G. L. G. Sleijpen, SIAM J. Matrix Anal. Appl. 26, 2004): products may get worse as the iteration gets better.
//! The bound has a factor of the smallest singular value of $A M^{-1}$, which nobody knows. So the residual that the iteration believes in
//! is never the answer: before it ends, and at restarts, the true residual is computed with a product at full tolerance, and the iteration goes on
//! from there if it is too large.
//!
//! *Why no library.* Of the crates that this one depends on, `faer` 0.24 has conjugate gradients, BiCGStab and LSMR but no GMRES, `nalgebra` has
//! none; neither knows of products to a tolerance, of products that fail, or of interruption.
//!
//! Sums over vectors are made in blocks of fixed length and added in their order: results are the same bits on any number of threads.
//!
//! ```
//! use axistokes::krylov::{Control, Method, Operator, Stop, solve};
//!
//! struct Diagonal(Vec<f64>);
//!
//! impl Operator for Diagonal {
//!     type Error = std::convert::Infallible;
//!
//!     fn apply(&mut self, x: &[f64], y: &mut [f64], _tolerance: f64) -> Result<(), Self::Error> {
//!         for ((y, x), d) in y.iter_mut().zip(x).zip(&self.0) {
//!             *y = d * x;
//!         }
//!         Ok(())
//!     }
//! }
//!
//! let mut operator = Diagonal(vec![1.0, 2.0, 4.0]);
//! let method = Method::Gmres { restart: 30 };
//! let outcome = solve(&mut operator, &[1.0, 1.0, 1.0], None, method, &Control::new(1e-12), &mut |_, _| Ok(()))?;
//! assert_eq!(outcome.stop, Stop::Converged);
//! assert!((outcome.solution[2] - 0.25).abs() < 1e-12);
//! # Ok::<(), axistokes::krylov::KrylovError<std::convert::Infallible>>(())
//! ```

mod bicgstab;
mod gmres;
mod session;
#[cfg(test)]
mod tests;
mod vectors;

use std::fmt;

use thiserror::Error;

use session::Session;

/// A linear operator, known by its products.
pub trait Operator {
    /// Why a product cannot be made.
    type Error;

    /// Writes the product with `x` to `y`, with an error of at most `tolerance` times the Euclidean norm of `x`.
    ///
    /// What is in `y` before has no meaning.
    ///
    /// # Errors
    /// Its own; they end the iteration.
    fn apply(&mut self, x: &[f64], y: &mut [f64], tolerance: f64) -> Result<(), Self::Error>;
}

/// How to iterate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The least residual in the Krylov space (Y. Saad and M. H. Schultz, 1986), one product per iteration; up to `restart + 1` vectors are kept.
    Gmres {
        /// After how many iterations the basis is thrown away; at least 1.
        restart: usize,
    },
    /// Stabilised biconjugate gradients (H. A. van der Vorst, 1992): two products per iteration, eight vectors in all.
    BiCgStab,
}

/// When to end, and how exact the products are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Norm of the residual, over that of the right-hand side, to reach; between 0 and 1.
    pub tolerance: f64,
    /// Iterations after which the method gives up.
    pub max_iterations: usize,
    /// Share of the tolerance that one product's error may take; between 0 and 1.
    pub safety: f64,
    /// Largest tolerance asked of a product; 0 has all products at full tolerance, which is `safety` times `tolerance`.
    pub loosest: f64,
}

impl Control {
    /// A thousand iterations, all products at a tenth of the tolerance.
    pub fn new(tolerance: f64) -> Self {
        Self {
            tolerance,
            max_iterations: 1000,
            safety: 0.1,
            loosest: 0.0,
        }
    }

    fn validate<E>(&self, method: Method) -> Result<(), KrylovError<E>> {
        let bad = |quantity, value, expected| KrylovError::Control {
            quantity,
            value,
            expected,
        };
        let open = "a number above 0 and below 1";
        if !(self.tolerance > 0.0 && self.tolerance < 1.0) {
            return Err(bad("tolerance", self.tolerance, open));
        }
        if !(self.safety > 0.0 && self.safety < 1.0) {
            return Err(bad("safety", self.safety, open));
        }
        if !(self.loosest >= 0.0 && self.loosest < 1.0) {
            return Err(bad(
                "loosest",
                self.loosest,
                "a number from 0 to less than 1",
            ));
        }
        if method == (Method::Gmres { restart: 0 }) {
            return Err(bad("restart", 0.0, "at least 1"));
        }
        Ok(())
    }
}

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

/// Why there is no outcome.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum KrylovError<E> {
    /// A product failed, or the report asked to stop.
    #[error(transparent)]
    Operator(#[from] E),
    /// A number that is not finite, or so large that its square is not.
    #[error("entry {index} of {quantity} must be a finite number, got {value}")]
    NotFinite {
        /// Of which vector.
        quantity: &'static str,
        /// Which entry, from 0.
        index: usize,
        /// What it is.
        value: f64,
    },
    /// Start and right-hand side of different lengths.
    #[error("the start must have as many entries as the right-hand side, {expected}, got {found}")]
    Length {
        /// The length of the right-hand side.
        expected: usize,
        /// That of the start.
        found: usize,
    },
    /// A setting out of range.
    #[error("{quantity} must be {expected}, got {value}")]
    Control {
        /// Which one.
        quantity: &'static str,
        /// What was given.
        value: f64,
        /// What is accepted.
        expected: &'static str,
    },
}

/// Solves a linear system, from zero or from `start`; `report` is called with each iteration's number, from 1, and the residual it believes in,
/// relative to the right-hand side. An error of `report` ends the iteration.
///
/// The tolerance is relative to the right-hand side for any start, so a good one saves iterations. Whether the system was solved
/// is told by [`Outcome::stop`], never by an error.
///
/// # Errors
/// Errors of the operator and of the report; vectors that are not finite or differ in length; settings out of range.
pub fn solve<O: Operator>(
    operator: &mut O,
    right_hand_side: &[f64],
    start: Option<&[f64]>,
    method: Method,
    control: &Control,
    report: &mut dyn FnMut(usize, f64) -> Result<(), O::Error>,
) -> Result<Outcome, KrylovError<O::Error>> {
    control.validate(method)?;
    let expected = right_hand_side.len();
    if let Some(found) = start.map(<[f64]>::len).filter(|&found| found != expected) {
        return Err(KrylovError::Length { expected, found });
    }
    vectors::check("the right-hand side", right_hand_side)?;
    vectors::check("the start", start.unwrap_or(&[]))?;
    if right_hand_side.iter().all(|&x| x == 0.0) {
        return Ok(Outcome {
            solution: vec![0.0; expected],
            iterations: 0,
            products: 0,
            residual: 0.0,
            residual_vector: vec![0.0; expected],
            stop: Stop::Converged,
            history: vec![0.0],
        });
    }
    let session = Session::new(operator, right_hand_side, *control, report);
    match method {
        Method::Gmres { restart } => gmres::iterate(session, start, restart),
        Method::BiCgStab => bicgstab::iterate(session, start),
    }
}
