//! Why a solver has no answer that is good enough.

use super::answer::Answer;
use super::error::SuspensionError;

/// Why a solver has no answer that is good enough.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The estimated error of the best answer that was found misses the tolerance. The answer is
    /// inside: [`SolveError::answer`] takes it out.
    #[error(
        "the error estimate {:.3e} misses the tolerance {tolerance:e} by a factor of {:.3}",
        answer.error_estimate,
        answer.error_estimate / tolerance
    )]
    Missed {
        /// The best answer.
        answer: Box<Answer>,
        /// What its estimated error was to be below.
        tolerance: f64,
    },
    /// There is none at all.
    #[error(transparent)]
    Failed(#[from] SuspensionError),
}

impl SolveError {
    /// The answer that missed its tolerance, for those who look at its error estimate themselves.
    ///
    /// # Errors
    /// The other error, if there is no answer.
    pub fn answer(self) -> Result<Answer, SuspensionError> {
        match self {
            Self::Missed { answer, .. } => Ok(*answer),
            Self::Failed(error) => Err(error),
        }
    }
}
