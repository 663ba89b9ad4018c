//! Reading and writing the data files of rules.
//!
//! A file is plain text. Comments start with `#`; a line `rule <number>` starts a rule, and each
//! further line is one node, `<offset> <weight>`. Numbers have eighteen significant digits, so
//! doubles survive the round trip.

use std::collections::BTreeMap;

use crate::error::{QuadratureError, Result};

/// Offsets and weights of one rule.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Columns {
    pub(crate) offsets: Vec<f64>,
    pub(crate) weights: Vec<f64>,
}

/// Reads a table; `name` is for messages.
pub(crate) fn parse(name: &'static str, text: &str) -> Result<BTreeMap<usize, Columns>> {
    let mut rules: BTreeMap<usize, Columns> = BTreeMap::new();
    let mut current = None;
    for (line, content) in text.lines().enumerate() {
        let problem = |problem: String| QuadratureError::Table {
            table: name,
            line: line + 1,
            problem,
        };
        let content = content.trim();
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        if let Some(number) = content.strip_prefix("rule ") {
            let number = number
                .parse()
                .map_err(|_| problem(format!("{number:?} is not a rule's number")))?;
            current = Some(number);
            rules.insert(number, Columns::default());
            continue;
        }
        let number = |field: Option<&str>| -> Result<f64> {
            let field = field.ok_or_else(|| problem("expected an offset and a weight".into()))?;
            match field.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(value),
                _ => Err(problem(format!("{field:?} is not a finite number"))),
            }
        };
        let mut fields = content.split_whitespace();
        let (offset, weight) = (number(fields.next())?, number(fields.next())?);
        let rule = current
            .and_then(|number| rules.get_mut(&number))
            .ok_or_else(|| problem("a node before the first rule".into()))?;
        rule.offsets.push(offset);
        rule.weights.push(weight);
    }
    Ok(rules)
}

/// Writes rules in the format [`parse`] reads, under a comment.
pub(crate) fn write<'a>(
    comment: &str,
    rules: impl IntoIterator<Item = (usize, &'a [f64], &'a [f64])>,
) -> String {
    let mut text: String = comment.lines().map(|line| format!("# {line}\n")).collect();
    for (number, offsets, weights) in rules {
        text += &format!("rule {number}\n");
        for (offset, weight) in std::iter::zip(offsets, weights) {
            text += &format!("{offset:.17e} {weight:.17e}\n");
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let (offsets, weights) = ([-0.1, 1.0 / 3.0, 4e-9], [0.7, 0.1 + 0.2, 1e-300]);
        let text = write("two\nlines", [(4, &offsets[..], &weights[..])]);
        let rules = parse("test", &text).unwrap();
        assert_eq!(rules[&4].offsets, offsets);
        assert_eq!(rules[&4].weights, weights);
    }

    #[test]
    fn damage_is_reported_with_its_line() {
        for text in [
            "0.1 0.2",
            "rule 1\n0.1",
            "rule x",
            "rule 1\n0.1 NaN",
            "rule 1\nq 1",
        ] {
            let error = parse("test", text).unwrap_err().to_string();
            assert!(error.contains("table test, line"), "{error}");
        }
    }
}
