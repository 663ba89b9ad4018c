//! Why a study stops.

use bodies_of_revolution::CurveError;
use panel_quadrature::QuadratureError;
use stokes_body::flow::FlowError;

/// Why a study stopped.
#[derive(Clone, Debug, thiserror::Error)]
pub enum StudyError {
    /// The spheroid cannot be cut into so many panels.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// There is no quadrature of this order.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
    /// The flow cannot be evaluated.
    #[error(transparent)]
    Flow(#[from] FlowError),
}
