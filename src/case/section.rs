//! A table of the case whose keys are known.

use super::CaseError;
use super::node::Node;
use super::suggest::{hint, nearest, not_built};
use toml::de::DeTable;

/// A table in which only known keys occur.
pub(super) struct Section<'a> {
    pub(super) node: Node<'a>,
    table: &'a DeTable<'a>,
}

impl<'a> Section<'a> {
    /// Reads `node` as a table; a key that is not in `known` is an error that names it.
    pub(super) fn new(node: Node<'a>, known: &[&str]) -> Result<Self, CaseError> {
        let section = Self::open(node)?;
        section.check(known)?;
        Ok(section)
    }

    /// Reads `node` as a table whose keys are still to be checked, or are free names.
    pub(super) fn open(node: Node<'a>) -> Result<Self, CaseError> {
        let table = node.table()?;
        Ok(Self { node, table })
    }

    /// Refuses the first key that is not in `known`.
    pub(super) fn check(&self, known: &[&str]) -> Result<(), CaseError> {
        let unknown = self
            .table
            .keys()
            .filter(|key| !known.contains(&key.get_ref().as_ref()))
            .min_by_key(|key| key.span().start);
        let Some(key) = unknown else { return Ok(()) };
        let path = self.path(key.get_ref());
        let message = match not_built(key.get_ref()) {
            Some(what) => format!("unknown key {path}: {what}"),
            None => format!("unknown key {path}{}", hint(key.get_ref(), known)),
        };
        Err(self.node.error_at_byte(key.span().start, message))
    }

    /// The value of `key`, if given.
    pub(super) fn optional(&self, key: &str) -> Option<Node<'a>> {
        let (name, value) = self.table.get_key_value(key)?;
        Some(self.node.below(self.path(key), name.span(), value))
    }

    /// The value of `key`; its absence is an error at the line of this table.
    pub(super) fn required(&self, key: &str, what: &str) -> Result<Node<'a>, CaseError> {
        self.optional(key).ok_or_else(|| {
            self.node
                .error(format!("{} is missing: expected {what}", self.path(key)))
        })
    }

    /// The value of `kind`, which decides what other keys are known. If it is missing and a key
    /// that looks like it is given, the error says so.
    pub(super) fn kind(&self, what: &str) -> Result<Node<'a>, CaseError> {
        let meant = |(name, _): &(&str, Node<'a>)| nearest(name, &["kind"]).is_some();
        match self.entries().into_iter().find(meant) {
            Some((name, node)) if self.optional("kind").is_none() => Err(node.error(format!(
                "unknown key {}, did you mean `kind`? (expected {what})",
                self.path(name)
            ))),
            _ => self.required("kind", what),
        }
    }

    /// Reads the value of `key` if it is given.
    pub(super) fn read<T>(
        &self,
        key: &str,
        read: impl FnOnce(&Node<'a>) -> Result<T, CaseError>,
    ) -> Result<Option<T>, CaseError> {
        self.optional(key).map(|node| read(&node)).transpose()
    }

    /// Every entry, in the order of the file.
    pub(super) fn entries(&self) -> Vec<(&'a str, Node<'a>)> {
        let mut entries: Vec<_> = self.table.iter().collect();
        entries.sort_by_key(|(key, _)| key.span().start);
        let node = |(key, value): (&'a toml::Spanned<_>, _)| {
            let name: &std::borrow::Cow<'a, str> = key.get_ref();
            let below = self.node.below(self.path(name), key.span(), value);
            (name.as_ref(), below)
        };
        entries.into_iter().map(node).collect()
    }

    /// Whether no key is given.
    pub(super) fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    fn path(&self, key: &str) -> String {
        // A control character would act on the terminal.
        let shown: String = key.escape_debug().take(60).collect();
        if self.node.key.is_empty() {
            shown
        } else {
            format!("{}.{shown}", self.node.key)
        }
    }
}
