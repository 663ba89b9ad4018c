//! The kernels, pair by pair. Lanes are targets; sources are broadcast.
//!
//! Every kernel is algebra on the radial chain of $B = r / 8\pi$. The algebra is the same for a
//! full kernel and for its residual: only the chain differs. The chain is kept in the units in
//! which the full chain is $B_n = r^{1-2n}$, so
//! $\beta_n = (\frac1r \frac{d}{dr})^n B = \kappa_n B_n$ with [`UNITS`] $\kappa_n$.

mod chain;
mod laplace;
mod pair;
mod stokes;
mod vector;

pub(crate) use chain::{Chain, UNITS};
pub(crate) use laplace::Laplace;
pub(crate) use pair::{MOST, Numbers, Pair};
pub(crate) use stokes::Stokes;
pub(crate) use vector::dot;

#[cfg(test)]
mod tests;
