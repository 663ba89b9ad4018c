//! Quadrature on panels: Gauss-Legendre rules, interpolation on their nodes, and generalised Gaussian
//! rules for logarithmic singularities.
//!
//! | what | where |
//! |---|---|
//! | smooth integrands on `[-1, 1]` | [`GaussLegendre`] |
//! | interpolation, differentiation, resolution | [`PanelBasis`] |
//! | Legendre series at real and complex points | [`legendre`] |

pub mod error;
pub mod gauss_legendre;
pub mod legendre;
pub mod panel;

mod double_double;

#[doc(inline)]
pub use error::QuadratureError;
#[doc(inline)]
pub use gauss_legendre::GaussLegendre;
#[doc(inline)]
pub use panel::PanelBasis;
