//! Ways to ask that several test binaries share.

use std::sync::Arc;

use axistokes::suspension::SolveError;
use axistokes::{
    Accuracy, Answer, Options, Resolution, Silent, Solver, Suspension, SuspensionError,
};

/// The answer, also if it misses its tolerance: the tests look at the estimate themselves.
pub fn try_with(suspension: &Suspension, options: &Options) -> Result<Answer, SuspensionError> {
    let answer = Solver::new(options.clone()).solve_with(suspension, None, &Silent);
    answer.or_else(SolveError::answer)
}

/// The answer to a tolerance.
#[allow(dead_code, reason = "not every test binary asks so")]
pub fn answer(suspension: &Suspension, tolerance: f64) -> Answer {
    try_with(suspension, &Options::tolerance(tolerance)).expect("an answer")
}

/// Options for given resolutions, one for each body.
#[allow(dead_code, reason = "not every test binary gives resolutions")]
pub fn given(resolutions: &[Arc<Resolution>], tolerance: f64) -> Options {
    Options::new(Accuracy::Resolutions {
        of_bodies: resolutions.to_vec(),
        tolerance,
    })
}
