//! Why a body has no answer.

use bodies_of_revolution::CurveError;
use panel_quadrature::QuadratureError;

/// Why a body has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BodyError {
    /// The curve cannot be divided into panels as asked.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// There is no quadrature of the order asked for.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
    /// Cancelled by the caller.
    #[error("interrupted")]
    Interrupted,
}
