//! Quadrature on panels: Gauss-Legendre rules, interpolation on their nodes, and generalised
//! Gaussian rules for logarithmic singularities.
//!
//! | what | where |
//! |---|---|
//! | smooth integrands on `[-1, 1]` | [`GaussLegendre`] |
//! | interpolation, differentiation, resolution | [`PanelBasis`] |
//! | a logarithm at a node of the panel or of its neighbour | [`KolmRokhlin`] |
//! | a logarithm at the end of an interval | [`LogEndpoint`] |
//! | Legendre series at real and complex points | [`legendre`] |
//! | integrals of Legendre polynomials against a logarithm | [`log_moments`](log_moments()) |
//! | the generator of the tables | [`generate`] |

pub mod error;
pub mod gauss_legendre;
pub mod generate;
pub mod kolm_rokhlin;
pub mod legendre;
pub mod log_endpoint;
pub mod panel;

mod double_double;
mod log_moments;
mod table;

#[doc(inline)]
pub use error::QuadratureError;
#[doc(inline)]
pub use gauss_legendre::GaussLegendre;
#[doc(inline)]
pub use kolm_rokhlin::KolmRokhlin;
#[doc(inline)]
pub use log_endpoint::LogEndpoint;
#[doc(inline)]
pub use log_moments::log_moments;
#[doc(inline)]
pub use panel::PanelBasis;

/// The examples of the README are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
