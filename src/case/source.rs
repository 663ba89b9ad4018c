//! The text of a case file, and the line of a place in it.

use super::CaseError;
use std::ops::Range;
use toml::de::DeTable;

/// Text of a case with the starts of its lines.
pub(super) struct Source<'t> {
    name: String,
    text: &'t str,
    line_starts: Vec<usize>,
}

impl<'t> Source<'t> {
    /// `name` is how errors call the file.
    pub(super) fn new(name: String, text: &'t str) -> Self {
        let ends = text.bytes().enumerate().filter(|&(_, b)| b == b'\n');
        let line_starts = std::iter::once(0).chain(ends.map(|(i, _)| i + 1)).collect();
        Self {
            name,
            text,
            line_starts,
        }
    }

    /// The document, parsed as TOML.
    pub(super) fn parse(&self) -> Result<DeTable<'t>, CaseError> {
        match DeTable::parse(self.text) {
            Ok(document) => Ok(document.into_inner()),
            Err(error) => Err(self.syntax_error(&error)),
        }
    }

    /// Line, counted from 1, of a byte offset.
    pub(super) fn line(&self, offset: usize) -> usize {
        self.line_starts.partition_point(|&start| start <= offset)
    }

    /// The text of a span, shortened to be quoted in a message.
    pub(super) fn quote(&self, span: Range<usize>) -> String {
        shorten(self.text.get(span).unwrap_or_default())
    }

    /// An error at a line.
    pub(super) fn error(&self, line: Option<usize>, message: impl std::fmt::Display) -> CaseError {
        CaseError::new(&self.name, line, message)
    }

    fn syntax_error(&self, error: &toml::de::Error) -> CaseError {
        let line = self.line(error.span().map_or(0, |span| span.start));
        let start = self.line_starts[line - 1];
        let text = self.text[start..].lines().next().unwrap_or_default();
        let quoted = shorten(text);
        let mut message = format!("not valid TOML: {}", error.message());
        if let Some((_, value)) = quoted.split_once('=')
            && is_not_finite(value)
        {
            message.push_str(", expected a finite number");
        }
        if !quoted.is_empty() {
            message.push_str(&format!(", in `{quoted}`"));
        }
        self.error(Some(line), message)
    }
}

/// At most sixty characters on one line.
fn shorten(text: &str) -> String {
    const LONGEST: usize = 60;
    // only the beginning is looked at: the text may be megabytes
    let beginning: String = text.chars().take(4 * LONGEST).collect();
    let words: Vec<&str> = beginning.split_whitespace().collect();
    let line = words.join(" ");
    if line.chars().count() <= LONGEST {
        return line;
    }
    let kept: String = line.chars().take(LONGEST).collect();
    format!("{kept}...")
}

fn is_not_finite(value: &str) -> bool {
    let word = value.trim().trim_start_matches(['+', '-']);
    ["nan", "inf", "infinity"]
        .iter()
        .any(|name| word.eq_ignore_ascii_case(name))
}
