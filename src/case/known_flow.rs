//! `[test]`: a flow that is known, by which the solver is checked.

use super::node::Node;
use super::section::Section;
use super::{CaseError, Located};

/// A force at a point in the fluid of the case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stokeslet {
    /// Where it acts; inside a body, which is for the solver to check.
    pub at: [f64; 3],
    /// The force it exerts on the fluid.
    pub force: [f64; 3],
}

/// The flow of Stokeslets inside the bodies; its values on the surfaces replace whatever the bodies
/// impose.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct KnownFlow {
    /// The Stokeslets, at least one.
    pub stokeslets: Vec<Located<Stokeslet>>,
}

/// Reads `[test]`.
pub(super) fn read_known_flow(node: Node<'_>) -> Result<KnownFlow, CaseError> {
    let what = "a list of { at = [x, y, z], force = [x, y, z] }";
    let section = Section::new(node, &["stokeslets"])?;
    let list = section.required("stokeslets", what)?;
    let items = list.array(what)?;
    if items.is_empty() {
        return Err(list.expected("at least one Stokeslet"));
    }
    let stokeslets = items.into_iter().map(read_stokeslet);
    Ok(KnownFlow {
        stokeslets: stokeslets.collect::<Result<_, _>>()?,
    })
}

fn read_stokeslet(node: Node<'_>) -> Result<Located<Stokeslet>, CaseError> {
    let section = Section::new(node, &["at", "force"])?;
    let at = section.required("at", "a point")?.vector()?;
    let force = section.required("force", "a force")?.vector()?;
    Ok(section.node.located(Stokeslet { at, force }))
}
