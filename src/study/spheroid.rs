//! The spheroid that is studied.

use std::sync::Arc;

use bodies_of_revolution::{Panels, Spheroid};
use stokes_body::discretization::Discretization;

use super::error::StudyError;

/// The spheroid's half axis along its axis of symmetry.
pub const POLAR: f64 = 1.0;
/// The spheroid's half axis across.
pub const EQUATORIAL: f64 = 0.5;

/// The spheroid in `panels` equal panels of `order` nodes.
pub(super) fn spheroid(panels: usize, order: usize) -> Result<Discretization, StudyError> {
    let curve = Arc::new(Spheroid::new(POLAR, EQUATORIAL)?);
    let panels = Panels::equal_arcs(&*curve, panels)?;
    Ok(Discretization::new(curve, panels, order)?)
}
