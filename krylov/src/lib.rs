//! GMRES and BiCGStab for linear systems $A x = b$ whose operator is known only by its products
//! with vectors.
//!
//! The crate is made for products that take seconds, and that take less time the less exact they
//! need to be. An [`Operator`] gives the products, [`Control`] and [`Method`] say how to iterate,
//! [`solve`] iterates, and an [`Outcome`] has the solution and why the iteration ended.
//!
//! *Preconditioning* is from the right and is left to the operator: it applies $A M^{-1}$, and
//! start and solution are $M x$. The residual is then that of the unpreconditioned system, and one
//! basis is enough.
//!
//! *Inexact products.* Let $r_k$ be the residual before step $k$, and let the final residual be
//! required to be below $\epsilon \|b\|$. Then an error of $\sigma \epsilon \|b\| / \|r_k\|$ in the
//! product of step $k$ changes the final residual by about $\sigma \epsilon \|b\|$ (V. Simoncini
//! and D. B. Szyld, SIAM J. Sci. Comput. 25, 2003; J. van den Eshof and G. L. G. Sleijpen, SIAM J.
//! Matrix Anal. Appl. 26, 2004). So products may become less exact as the residual falls. The bound
//! contains the smallest singular value of $A M^{-1}$, which is not known. Therefore the residual
//! of the recurrences is never taken for the result: at restarts and before the iteration ends, the
//! true residual is computed with a product at full tolerance, and the iteration continues from it
//! if it is too large.
//!
//! *Reproducibility.* Sums over vectors are made in blocks of fixed length that are added in their
//! order: results are the same bits on any number of threads.
//!
//! *Other crates.* `faer` 0.24 has conjugate gradients, BiCGStab and LSMR but no GMRES, and
//! `nalgebra` has none of these. Neither has products to a tolerance, products that fail, or
//! interruption.
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
//! let control = Control::new(1e-12);
//! let mut report = |_iteration, _residual| Ok(());
//! let b = [1.0, 1.0, 1.0];
//! let outcome = solve(&mut operator, &b, None, method, &control, &mut report)?;
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
