//! What can go wrong, with the value that was wrong and what would be right.

/// An error of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum QuadratureError {
    /// The number of nodes asked for is zero or larger than supported.
    #[error("order {order} is out of range: expected 1 to {max}")]
    Order {
        /// The order asked for.
        order: usize,
        /// The largest order supported.
        max: usize,
    },
    /// A slice does not have the length the panel needs.
    #[error("{what} has length {found}, expected {expected}")]
    Length {
        /// Which argument.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A node index does not exist on the panel.
    #[error("node {index} does not exist on a panel of {order} nodes: expected 0 to {}", order - 1)]
    Node {
        /// The index asked for.
        index: usize,
        /// Number of nodes of the panel.
        order: usize,
    },
    /// An argument is NaN or infinite.
    #[error("{what} is {value}, expected a finite number")]
    NotFinite {
        /// Which argument.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// There is no table for this order.
    #[error("no {family} rule of order {order}: tabulated are {available:?}")]
    NotTabulated {
        /// Name of the family of rules.
        family: &'static str,
        /// The order asked for.
        order: usize,
        /// The orders there are tables for.
        available: &'static [usize],
    },
    /// The generator did not reach the accuracy it was asked for.
    #[error("{what}: the largest moment error is {residual:.1e}, expected at most {tolerance:.1e}")]
    NotConverged {
        /// Which rule.
        what: String,
        /// The moment error at the end.
        residual: f64,
        /// The moment error that was asked for.
        tolerance: f64,
    },
    /// A table of rules cannot be read.
    #[error("table {table}, line {line}: {problem}")]
    Table {
        /// Name of the table.
        table: &'static str,
        /// Line number, starting at 1.
        line: usize,
        /// What is wrong there.
        problem: String,
    },
}

/// Shorthand for a result with a [`QuadratureError`].
pub type Result<T> = std::result::Result<T, QuadratureError>;

/// Refuses a slice of the wrong length.
pub(crate) fn check_length(what: &'static str, found: usize, expected: usize) -> Result<()> {
    if found == expected {
        Ok(())
    } else {
        Err(QuadratureError::Length {
            what,
            found,
            expected,
        })
    }
}

/// Refuses NaN and infinities.
pub(crate) fn check_finite(what: &'static str, value: f64) -> Result<()> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(QuadratureError::NotFinite { what, value })
    }
}
