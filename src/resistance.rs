//! From a case to the resistance of its shapes.

use crate::case::{Accuracy, Case};
use crate::output::{Input, ResistanceReport, ShapeReport};
use crate::solve::SolveError;
use bodies_of_revolution::Panels;
use stokes_body::error::BodyError;
use stokes_body::progress::Progress;
use stokes_body::resistance::RigidBodyMatrices;

/// Resistance and mobility of every shape of a case, each about its origin and in its own frame:
/// bodies and what is imposed on them do not matter.
///
/// The report is returned even when an error estimate exceeds the tolerance: the caller compares.
///
/// # Errors
/// [`SolveError::Case`] if a shape cannot be computed with.
pub fn resistance(case: &Case, progress: &dyn Progress) -> Result<ResistanceReport, SolveError> {
    let mut shapes = Vec::new();
    for (name, shape) in &case.shapes {
        let at_shape = |error: &dyn std::fmt::Display| {
            SolveError::Case(case.error(shape.line, format!("shapes.{name}: {error}")))
        };
        let curve = shape.value.curve().map_err(|error| at_shape(&error))?;
        let matrices = match case.accuracy {
            Accuracy::Tolerance(tolerance) => {
                RigidBodyMatrices::to_tolerance(curve, tolerance, progress)
            }
            Accuracy::ByHand { panels, order, .. } => Panels::equal_arcs(&*curve, panels)
                .map_err(BodyError::from)
                .and_then(|panels| {
                    RigidBodyMatrices::at_resolution(curve.clone(), panels, order, progress)
                }),
        };
        let matrices = matrices.map_err(|error| match error {
            BodyError::Curve(error) => at_shape(&error),
            other => SolveError::Failed(other.to_string()),
        })?;
        shapes.push(ShapeReport::new(
            name,
            &shape.value,
            &matrices,
            case.viscosity,
        ));
    }
    Ok(ResistanceReport {
        input: Input::of(case),
        shapes,
    })
}
