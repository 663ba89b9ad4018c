//! From a case to its answer.

use crate::case::{Case, CaseError};
use crate::output::Report;
use crate::progress::Progress;

/// Why a case has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The case is at fault: its geometry, or a part of the format that is not built.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The computation itself failed.
    #[error("{0}")]
    Failed(String),
    /// There is no solver yet.
    #[error("not built yet: the solver")]
    NotBuilt,
}

/// Solves a case once.
///
/// The report is returned even when its error estimate exceeds the tolerance: the caller compares.
///
/// # Errors
/// [`SolveError::Case`] if the case asks for the impossible or for what is not built.
pub fn solve(case: &Case, progress: &dyn Progress) -> Result<Report, SolveError> {
    case.check_supported()?;
    progress.begin("solve", 0);
    Err(SolveError::NotBuilt)
}
