//! Probes: where velocity and pressure are wanted.

use super::node::Node;
use super::section::Section;
use super::{CaseError, Located};

/// Reads `[probes]`; that no probe lies in a body is for the solver to check.
pub(super) fn read_probes(node: Node<'_>) -> Result<Vec<Located<[f64; 3]>>, CaseError> {
    let what = "a list of points, [[x, y, z], ...]";
    let section = Section::new(node, &["points"])?;
    let points = section.required("points", what)?.array(what)?;
    points
        .iter()
        .map(|point| Ok(point.located(point.vector()?)))
        .collect()
}
