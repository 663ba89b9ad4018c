//! The entry: checks what was asked, then iterates.

use super::control::{Control, Method};
use super::error::KrylovError;
use super::operator::Operator;
use super::outcome::{Outcome, Stop};
use super::session::Session;
use super::{bicgstab, gmres, vectors};

/// Solves a linear system, starting from zero or from `start`.
///
/// After each iteration `report` is called with the number of the iteration, from 1, and the
/// residual that the recurrences give, relative to the right-hand side. An error of `report` ends
/// the iteration.
///
/// The tolerance is relative to the right-hand side whatever the start, so a good start saves
/// iterations. [`Outcome::stop`] tells whether the system was solved; this is never reported as an
/// error.
///
/// # Errors
/// Errors of the operator and of the report; vectors that are not finite or differ in length;
/// settings out of range.
pub fn solve<O: Operator>(
    operator: &mut O,
    right_hand_side: &[f64],
    start: Option<&[f64]>,
    method: Method,
    control: &Control,
    report: &mut dyn FnMut(usize, f64) -> Result<(), O::Error>,
) -> Result<Outcome, KrylovError<O::Error>> {
    control.validate(method)?;
    let expected = right_hand_side.len();
    if let Some(found) = start.map(<[f64]>::len).filter(|&found| found != expected) {
        return Err(KrylovError::Length { expected, found });
    }
    vectors::check("the right-hand side", right_hand_side)?;
    vectors::check("the start", start.unwrap_or(&[]))?;
    if right_hand_side.iter().all(|&x| x == 0.0) {
        return Ok(Outcome {
            solution: vec![0.0; expected],
            iterations: 0,
            products: 0,
            residual: 0.0,
            residual_vector: vec![0.0; expected],
            stop: Stop::Converged,
            history: vec![0.0],
        });
    }
    let session = Session::new(operator, right_hand_side, *control, report);
    match method {
        Method::Gmres { restart } => gmres::iterate(session, start, restart),
        Method::BiCgStab => bicgstab::iterate(session, start),
    }
}
