//! A value of the case's tree that knows its key and its line, and the readers of the simple types.
//!
//! Below a body keys begin anew, and messages begin with the body's number: `body 2: slip.kind`.

use super::source::Source;
use super::{CaseError, Located};
use std::fmt::Display;
use std::ops::{Range, RangeInclusive};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The largest magnitude a number of a case may have: products of a dozen are still representable.
const LARGEST: f64 = 1e30;
/// The smallest a quantity that must be positive may be.
const SMALLEST: f64 = 1e-30;

/// One value with the key that leads to it, such as `shapes.rod.polar`, or from its body such as
/// `slip.kind`.
#[derive(Clone)]
pub(super) struct Node<'a> {
    source: &'a Source<'a>,
    /// The number of the body that it belongs to, from 1.
    body: Option<usize>,
    pub(super) key: String,
    pub(super) line: usize,
    content: Content<'a>,
}

#[derive(Clone)]
enum Content<'a> {
    Root(&'a DeTable<'a>),
    Value(&'a Spanned<DeValue<'a>>),
}

impl<'a> Node<'a> {
    pub(super) fn root<'t>(source: &'a Source<'t>, document: &'a DeTable<'t>) -> Self
    where
        't: 'a,
    {
        Self {
            source,
            body: None,
            key: String::new(),
            line: 1,
            content: Content::Root(document),
        }
    }

    /// A value below this one, at the line of `place`.
    pub(super) fn below(
        &self,
        key: String,
        place: Range<usize>,
        value: &'a Spanned<DeValue<'a>>,
    ) -> Self {
        Self {
            source: self.source,
            body: self.body,
            key,
            line: self.source.line(place.start),
            content: Content::Value(value),
        }
    }

    /// The same as the table of a body.
    pub(super) fn of_body(self, number: usize) -> Self {
        Self {
            body: Some(number),
            key: String::new(),
            ..self
        }
    }

    /// Attaches this node's line to what was read from it.
    pub(super) fn located<T>(&self, value: T) -> Located<T> {
        let line = self.line;
        Located { line, value }
    }

    /// The one of two nodes that comes later in the file; the second if they share a line.
    pub(super) fn later<'n>(first: &'n Self, second: &'n Self) -> &'n Self {
        if first.line > second.line {
            first
        } else {
            second
        }
    }

    /// An error at this node: `key = value: expected ...`.
    pub(super) fn expected(&self, what: impl Display) -> CaseError {
        let message = match &self.content {
            Content::Value(value) => match value.get_ref() {
                DeValue::Table(_) => format!("{} is a table: expected {what}", self.key),
                _ if self.key.is_empty() => {
                    let quoted = self.source.quote(value.span());
                    format!("{quoted}: expected {what}")
                }
                _ => {
                    let quoted = self.source.quote(value.span());
                    format!("{} = {quoted}: expected {what}", self.key)
                }
            },
            Content::Root(_) => format!("expected {what}"),
        };
        self.error(message)
    }

    /// An error at this node in other words.
    pub(super) fn error(&self, message: impl Display) -> CaseError {
        self.error_at(Some(self.line), message)
    }

    /// An error at the line of a byte of the file.
    pub(super) fn error_at_byte(&self, byte: usize, message: impl Display) -> CaseError {
        self.error_at(Some(self.source.line(byte)), message)
    }

    /// An error of the whole file.
    pub(super) fn error_of_file(&self, message: impl Display) -> CaseError {
        self.error_at(None, message)
    }

    fn error_at(&self, line: Option<usize>, message: impl Display) -> CaseError {
        match self.body {
            Some(number) => (self.source).error(line, format!("body {number}: {message}")),
            None => self.source.error(line, message),
        }
    }

    pub(super) fn table(&self) -> Result<&'a DeTable<'a>, CaseError> {
        match &self.content {
            Content::Root(table) => Ok(table),
            Content::Value(value) => match value.get_ref() {
                DeValue::Table(table) => Ok(table),
                DeValue::Array(array) if array.iter().any(|v| v.get_ref().is_table()) => Err(self
                    .error(format!(
                        "{} is an array of tables: expected one table, [{}]",
                        self.key, self.key
                    ))),
                _ if self.key.is_empty() => Err(self.expected("a table, [[bodies]]")),
                _ => Err(self.expected(format!("a table, [{}]", self.key))),
            },
        }
    }

    /// The elements of an array.
    pub(super) fn array(&self, what: &str) -> Result<Vec<Node<'a>>, CaseError> {
        let items = self.items(what)?.iter().enumerate();
        Ok(items
            .map(|(i, item)| self.below(format!("{}[{i}]", self.key), item.span(), item))
            .collect())
    }

    fn items(&self, what: &str) -> Result<&'a [Spanned<DeValue<'a>>], CaseError> {
        match self.value() {
            Some(DeValue::Array(array)) => Ok(array),
            _ => Err(self.expected(what)),
        }
    }

    /// A finite number, integers included.
    pub(super) fn number(&self) -> Result<f64, CaseError> {
        let what = "a finite number";
        self.value()
            .and_then(as_number)
            .filter(|x| x.abs() <= LARGEST)
            .ok_or_else(|| self.expected(format_args!("{what} (at most 1e30 in magnitude)")))
    }

    /// A finite number greater than zero, described by `what`.
    pub(super) fn positive(&self, what: &str) -> Result<f64, CaseError> {
        self.value()
            .and_then(as_number)
            .filter(|x| (SMALLEST..=LARGEST).contains(x))
            .ok_or_else(|| {
                self.expected(format_args!(
                    "{what}, a finite number greater than zero (1e-30 to 1e30)"
                ))
            })
    }

    /// An integer within a range, described by `what`.
    pub(super) fn integer(
        &self,
        what: &str,
        range: RangeInclusive<usize>,
    ) -> Result<usize, CaseError> {
        let value = match self.value() {
            Some(DeValue::Integer(i)) => usize::from_str_radix(i.as_str(), i.radix()).ok(),
            _ => None,
        };
        value.filter(|n| range.contains(n)).ok_or_else(|| {
            self.expected(format_args!(
                "{what}, an integer from {} to {}",
                range.start(),
                range.end()
            ))
        })
    }

    /// Three finite numbers.
    pub(super) fn vector(&self) -> Result<[f64; 3], CaseError> {
        self.components("three finite numbers (at most 1e30 in magnitude), [x, y, z]")
    }

    /// Three components, each a finite number or, as `None`, the word "free".
    pub(super) fn vector_or_free(&self) -> Result<[Option<f64>; 3], CaseError> {
        let what = "three components [x, y, z], each a finite number (at most 1e30 in magnitude) \
                    or \"free\"";
        let items: &[_; 3] = (self.items(what)?.try_into()).map_err(|_| self.expected(what))?;
        let mut components = [None; 3];
        for (component, item) in components.iter_mut().zip(items) {
            *component = match item.get_ref() {
                DeValue::String(word) if word == "free" => None,
                value => {
                    let number = as_number(value).filter(|x| x.abs() <= LARGEST);
                    Some(number.ok_or_else(|| self.expected(what))?)
                }
            };
        }
        Ok(components)
    }

    /// Three finite numbers, not all zero, scaled to length one.
    pub(super) fn direction(&self) -> Result<[f64; 3], CaseError> {
        normalized(self.vector()?).ok_or_else(|| self.expected("a vector of any length but zero"))
    }

    /// A quaternion, scalar first: four finite numbers, not all zero, scaled to length one.
    pub(super) fn quaternion(&self) -> Result<[f64; 4], CaseError> {
        let what = "a quaternion: four finite numbers (at most 1e30 in magnitude), [w, x, y, z]";
        normalized(self.components(what)?)
            .ok_or_else(|| self.expected("a quaternion of any length but zero"))
    }

    /// As many finite numbers as the result has, described by `what`.
    fn components<const N: usize>(&self, what: &str) -> Result<[f64; N], CaseError> {
        let items: &[_; N] = (self.items(what)?.try_into()).map_err(|_| self.expected(what))?;
        let mut components = [0.0; N];
        for (component, item) in components.iter_mut().zip(items) {
            *component = as_number(item.get_ref())
                .filter(|x| x.abs() <= LARGEST)
                .ok_or_else(|| self.expected(what))?;
        }
        Ok(components)
    }

    /// A list of finite numbers, at least one.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, CaseError> {
        let items = self.array("a list of finite numbers")?;
        if items.is_empty() {
            return Err(self.expected("a list of at least one finite number"));
        }
        items.iter().map(Node::number).collect()
    }

    /// A text.
    pub(super) fn string(&self, what: &str) -> Result<&'a str, CaseError> {
        match self.value() {
            Some(DeValue::String(text)) if !text.is_empty() => Ok(text),
            _ => Err(self.expected(what)),
        }
    }

    /// One of a few words.
    pub(super) fn choice<T: Copy>(&self, choices: &[(&str, T)]) -> Result<T, CaseError> {
        let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
        let list = names.join(", ");
        let word = self.string(&format!("one of {list}"))?;
        if let Some((_, value)) = choices.iter().find(|(name, _)| *name == word) {
            return Ok(*value);
        }
        let meant = super::suggest::nearest(word, &names)
            .map(|name| format!("; did you mean `{name}`?"))
            .unwrap_or_default();
        Err(self.expected(format_args!("one of {list}{meant}")))
    }

    /// `true` or `false`.
    pub(super) fn boolean(&self) -> Result<bool, CaseError> {
        self.value()
            .and_then(DeValue::as_bool)
            .ok_or_else(|| self.expected("true or false"))
    }

    fn value(&self) -> Option<&'a DeValue<'a>> {
        match self.content {
            Content::Root(_) => None,
            Content::Value(value) => Some(value.get_ref()),
        }
    }
}

/// The same direction with length one; none for the zero vector.
fn normalized<const N: usize>(vector: [f64; N]) -> Option<[f64; N]> {
    let largest = vector.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    if largest < SMALLEST {
        return None;
    }
    // divided first by the largest, so that no square over- or underflows
    let scaled = vector.map(|x| x / largest);
    let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    Some(scaled.map(|x| x / length))
}

/// The number a TOML integer or float stands for; infinities and NaN pass.
fn as_number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(x) => x.as_str().parse().ok(),
        DeValue::Integer(i) if i.radix() == 10 => i.as_str().parse().ok(),
        DeValue::Integer(i) => i64::from_str_radix(i.as_str(), i.radix())
            .ok()
            .map(|i| i as f64),
        _ => None,
    }
}
