//! The kernels, pair by pair: lanes are targets, sources are broadcast.
//!
//! Every kernel is algebra on the radial chain of $B = r / 8\pi$, and the algebra of a full kernel and of its
//! residual is the same: only the chain differs. It is kept in the units in which the full chain is
//! $B_n = r^{1-2n}$, so $\beta_n = (\frac1r \frac{d}{dr})^n B = \kappa_n B_n$ with [`UNITS`] $\kappa_n$.

mod chain;
mod laplace;
mod pair;
mod stokes;
mod vector;

pub(crate) use chain::{Chain, UNITS};
pub(crate) use laplace::Laplace;
pub(crate) use pair::{MOST, Pair};
pub(crate) use stokes::Stokes;
pub(crate) use vector::dot;

#[cfg(test)]
mod tests;
