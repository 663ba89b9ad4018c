//! Why there is no outcome.

use thiserror::Error;

/// Why there is no outcome.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum KrylovError<E> {
    /// A product failed, or the report asked to stop.
    #[error(transparent)]
    Operator(#[from] E),
    /// A number that is not finite, or so large that its square is not.
    #[error("entry {index} of {quantity} must be a finite number, got {value}")]
    NotFinite {
        /// Of which vector.
        quantity: &'static str,
        /// Which entry, from 0.
        index: usize,
        /// What it is.
        value: f64,
    },
    /// Start and right-hand side of different lengths.
    #[error("the start must have as many entries as the right-hand side, {expected}, got {found}")]
    Length {
        /// The length of the right-hand side.
        expected: usize,
        /// That of the start.
        found: usize,
    },
    /// A setting out of range.
    #[error("{quantity} must be {expected}, got {value}")]
    Control {
        /// Which one.
        quantity: &'static str,
        /// What was given.
        value: f64,
        /// What is accepted.
        expected: &'static str,
    },
}
