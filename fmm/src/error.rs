//! What can be wrong with what was asked.

use thiserror::Error;

/// Why a sum was refused.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum FmmError {
    /// A number is NaN or infinite.
    #[error("{what} {index} is {value}, expected finite numbers")]
    NotFinite {
        /// Of what: "source position", "Stokeslet strength", ...
        what: &'static str,
        /// Which point, counted from 0.
        index: usize,
        /// The first number of it that is not finite.
        value: f64,
    },
    /// One array has more or fewer entries than there are points.
    #[error("{found} {what}, expected {expected}, one for each point")]
    Length {
        /// Of what: "Stokeslet strengths", ...
        what: &'static str,
        /// Entries found.
        found: usize,
        /// Points there are.
        expected: usize,
    },
    /// A tolerance that cannot be kept.
    #[error("tolerance {0:e}, expected a number from 1e-12 to 1e-1")]
    Tolerance(f64),
    /// Strengths of a kind the plan was not made for.
    #[error("{0} were given, but the plan was not made for them")]
    Unplanned(&'static str),
    /// More points than can be counted.
    #[error("{0} points, expected at most 4294967294 sources and as many targets")]
    TooMany(usize),
    /// Coordinates too far apart for their differences to be squared.
    #[error("coordinates reach {0:e}, expected at most 1e100 in magnitude")]
    TooFar(f64),
}
