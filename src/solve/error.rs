//! Why a case has no answer.

use crate::case::CaseError;

/// Why a case has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The case is at fault: its geometry, what it would take, or a part of the format that is not
    /// built.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// Cancelled by the caller.
    #[error("interrupted")]
    Interrupted,
    /// The computation itself failed.
    #[error("{0}")]
    Failed(String),
}
