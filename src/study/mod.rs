//! The thesis's numerical study of one body (section 3.6.1), repeated.
//!
//! The flow of random Stokeslets inside a prolate spheroid is found again from its values on the surface, under a random
//! rotation, and compared with the exact flow on a grid around the body. Nothing here reads or writes files.
//!
//! | module | what |
//! |---|---|
//! | [`setup`] | the known flow, its targets, and the errors of equations 3.140 and 3.141 |
//! | [`errors`] | errors over panels and modes (figure 3.2), observed order in panels |
//! | [`timing`] | time of each stage against unknowns (figure 3.3) |
//! | [`power_law`] | least-squares exponents |
//! | [`plan`] | how much of it to do |

pub mod errors;
pub mod plan;
pub mod power_law;
pub mod setup;
pub mod timing;

use std::sync::Arc;

use panel_quadrature::QuadratureError;

use bodies_of_revolution::{CurveError, Panels, Spheroid};
use stokes_body::discretization::Discretization;
use stokes_body::flow::FlowError;

/// The spheroid's half axis along its axis of symmetry.
pub const POLAR: f64 = 1.0;
/// The spheroid's half axis across.
pub const EQUATORIAL: f64 = 0.5;

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

/// The spheroid in `panels` equal panels of `order` nodes.
fn spheroid(panels: usize, order: usize) -> Result<Discretization, StudyError> {
    let curve = Arc::new(Spheroid::new(POLAR, EQUATORIAL)?);
    let panels = Panels::equal_arcs(&*curve, panels)?;
    Ok(Discretization::new(curve, panels, order)?)
}

/// $N$: the nodes along the curve times the azimuthal degrees of freedom, $p\\, n_p (2 n_f + 1)$.
pub fn points(order: usize, panels: usize, modes: usize) -> usize {
    order * panels * (2 * modes + 1)
}

/// Bytes of the matrices of modes up to `modes`, with their factors.
pub fn bytes(order: usize, panels: usize, modes: usize) -> usize {
    let unknowns = 3 * order * panels;
    2 * size_of::<f64>() * unknowns * unknowns * (modes + 1)
}
