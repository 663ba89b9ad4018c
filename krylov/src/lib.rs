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
//! use inexact_krylov::{Control, Method, Operator, Stop, solve};
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
//! # Ok::<(), inexact_krylov::KrylovError<std::convert::Infallible>>(())
//! ```

mod bicgstab;
mod control;
mod error;
mod gmres;
mod operator;
mod outcome;
mod session;
mod solve;
#[cfg(test)]
mod tests;
mod vectors;

pub use control::{Control, Method};
pub use error::KrylovError;
pub use operator::Operator;
pub use outcome::{Outcome, Stop};
pub use solve::solve;
