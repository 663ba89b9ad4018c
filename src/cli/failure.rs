//! Why the program ends badly, and its exit status.

use axistokes::output::plot::PlotError;
use axistokes::solve::SolveError;
use axistokes::study::StudyError;
use std::process::ExitCode;

/// The status of a program that was interrupted, as shells have it.
pub const INTERRUPTED_STATUS: u8 = 130;

/// Why a command failed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The input is at fault: status 2.
    #[error("{0}")]
    Input(String),
    /// The answer is worse than asked: status 3.
    #[error("{0}")]
    Missed(String),
    /// Ctrl-C: status 130.
    #[error("interrupted: nothing was written")]
    Interrupted,
    /// Something else went wrong: status 1.
    #[error("{0}")]
    Other(String),
}

impl Failure {
    /// The exit status of the program.
    pub fn status(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Input(_) => 2,
            Self::Missed(_) => 3,
            Self::Interrupted => INTERRUPTED_STATUS,
            Self::Other(_) => 1,
        })
    }
}

impl From<SolveError> for Failure {
    fn from(error: SolveError) -> Self {
        let line = error.to_string();
        match error {
            SolveError::Case(_) => Self::Input(line),
            SolveError::Interrupted => Self::Interrupted,
            _ => Self::Other(line),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        Self::Other(error.to_string())
    }
}

impl From<PlotError> for Failure {
    fn from(error: PlotError) -> Self {
        Self::Other(error.to_string())
    }
}
