//! A value and the line it came from.

use std::ops::Deref;

/// A value read from a case file with its line, so that a later check can still point at it.
#[derive(Clone, Debug, PartialEq)]
pub struct Located<T> {
    /// Line of the file, counted from 1.
    pub line: usize,
    /// The value itself.
    pub value: T,
}

impl<T> Deref for Located<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}
