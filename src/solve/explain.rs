//! Errors with the names of bodies and their lines in the case.

use std::fmt::Display;

use super::error::SolveError;
use super::question::{Question, at_shape, name};
use crate::case::{Case, CaseError};
use bodies_of_revolution::{ContactError, Placed, gaps};
use stokes_suspension::{Stop, SuspensionError};

/// An error of the library about the bodies of a case, with their names and their lines.
pub fn explain(case: &Case, error: SuspensionError) -> SolveError {
    let line = |a: usize, b: usize| case.bodies[a.max(b)].line;
    let name = |body: usize| name(case, body);
    let at_shape = |body: usize, error: &dyn Display| at_shape(case, &case.bodies[body], error);
    let contact = |error: ContactError| match error {
        ContactError::Curve { body, source } => at_shape(body, &source),
        ContactError::Touch { first, second } => case.error(
            line(first, second),
            format!(
                "{} and {} touch: expected bodies that are apart",
                name(first),
                name(second)
            ),
        ),
        ContactError::Overlap {
            first,
            second,
            depth,
        } => case.error(
            line(first, second),
            format!(
                "{} and {} overlap by {depth:.3e}: expected bodies that are apart",
                name(first),
                name(second)
            ),
        ),
        ContactError::Inside { inner, outer } => case.error(
            line(inner, outer),
            format!(
                "{} is inside {}: expected bodies that are apart",
                name(inner),
                name(outer)
            ),
        ),
        ContactError::Near {
            first,
            second,
            distance,
            needed,
        } => case.error(
            line(first, second),
            format!(
                "{} and {} are {distance:.3e} apart: expected at least {needed:.3e}",
                name(first),
                name(second)
            ),
        ),
        ContactError::Place {
            body,
            quantity,
            expected,
            value,
        } => case.error(
            line(body, body),
            format!("{}: {quantity} is {value}: expected {expected}", name(body)),
        ),
        other => CaseError::new(case.path.display(), None, other.to_string()),
    };
    match error {
        SuspensionError::Contact(error) => contact(error).into(),
        SuspensionError::Curve { body, error } => at_shape(body, &error).into(),
        SuspensionError::Memory { .. } => {
            let message = format!("{error} (solver.memory)");
            CaseError::new(case.path.display(), None, message).into()
        }
        SuspensionError::Velocity { body } => SolveError::Failed(format!(
            "{}: the velocity imposed on {} is not finite everywhere",
            case.path.display(),
            name(body)
        )),
        SuspensionError::NotConverged {
            stop: Stop::MaxIterations,
            ..
        } => SolveError::Failed(format!(
            "{}: {error} by solver.max_iterations{}",
            case.path.display(),
            narrowest_gap(case).unwrap_or_default()
        )),
        SuspensionError::Interrupted => SolveError::Interrupted,
        other => SolveError::Failed(format!("{}: {other}", case.path.display())),
    }
}

/// Gaps below this part of the size of a body are hard on the iteration.
const NARROW: f64 = 1e-3;

/// The narrowest of the gaps that are so narrow that more iterations hardly help.
fn narrowest_gap(case: &Case) -> Option<String> {
    let question = Question::new(case).ok()?;
    let placed = question.suspension.bodies.iter().map(|body| Placed {
        curve: &*body.shape,
        frame: body.frame,
        reach: NARROW * body.shape.extent() * body.frame.scale(),
    });
    let found = gaps(&placed.collect::<Vec<_>>()).ok()?;
    let gap = (found.into_iter()).min_by(|a, b| a.distance.total_cmp(&b.distance))?;
    let [first, second] = gap.bodies.map(|body| name(case, body));
    Some(format!(
        "; the gap of {:.1e} between {first} and {second} may be too narrow for any number",
        gap.distance
    ))
}
