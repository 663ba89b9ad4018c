//! The error of a case file: where, and what was expected.

use std::fmt::{self, Display, Formatter};

/// What is wrong with a case: one line, `FILE:LINE: message`.
///
/// Control characters of the input are escaped and long names cut, so that the message stays on one
/// line whatever the file held.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct CaseError {
    file: String,
    line: Option<usize>,
    message: String,
}

impl CaseError {
    /// An error at `line` of `file` (lines count from 1; `None` when it concerns the whole file).
    pub fn new(file: impl Display, line: Option<usize>, message: impl Display) -> Self {
        Self {
            file: one_line(&file.to_string()),
            line,
            message: one_line(&message.to_string()),
        }
    }

    /// The line of the file, counted from 1, if the error belongs to one.
    pub fn line(&self) -> Option<usize> {
        self.line
    }

    /// What was wrong and what was expected, without the place.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl Display for CaseError {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.file, self.message),
            None => write!(f, "{}: {}", self.file, self.message),
        }
    }
}

fn one_line(text: &str) -> String {
    const LONGEST: usize = 500;
    let mut line = String::new();
    for (i, c) in text.chars().enumerate() {
        if i == LONGEST {
            line.push_str("...");
            break;
        }
        if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}' | '\u{202e}') {
            line.extend(c.escape_default());
        } else {
            line.push(c);
        }
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stays_on_one_line() {
        let error = CaseError::new("a\nb.toml", Some(3), "x\r\ny");
        assert_eq!(error.to_string(), "a\\nb.toml:3: x\\r\\ny");
    }
}
