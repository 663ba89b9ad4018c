//! Bodies: a shape, where it is, and what is imposed on it.

use super::motion::{Component, Motion, read_motion};
use super::node::Node;
use super::orientation::{BodyOrientation, read_orientation};
use super::section::Section;
use super::shape::ShapeSpec;
use super::slip::{Slip, read_slip};
use super::suggest::hint;
use super::{CaseError, Located};
use std::collections::BTreeMap;

const KEYS: &[&str] = &[
    "shape",
    "center",
    "axis",
    "orientation",
    "scale",
    "velocity",
    "angular_velocity",
    "force",
    "torque",
    "slip",
];

/// One body of the case.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Body {
    /// Line of the file at which the body begins.
    pub line: usize,
    /// Name of its shape; always one of the case's shapes.
    pub shape: String,
    /// Where the origin of the shape lies; the origin if not given.
    pub center: [f64; 3],
    /// How it lies in space; its axis is z if not given.
    pub orientation: BodyOrientation,
    /// Direction of the symmetry axis, of length one. It is always that of `orientation`: for
    /// whoever needs no rotation about the axis.
    pub axis: [f64; 3],
    /// How many times larger the body is than its shape, positive; 1 if not given.
    pub scale: f64,
    /// What is imposed on it, component by component: velocity x, y, z, then angular velocity x,
    /// y, z. This is the one thing that holds for every body.
    pub components: [Component; 6],
    /// The same for bodies that are moved in all components or free in all. Of a mixed body it
    /// says only what is imposed, with zeros where it is free: see [`Self::is_mixed`].
    pub motion: Located<Motion>,
    /// Whether the case says anything of velocity, force, angular velocity or torque.
    pub(super) motion_given: bool,
    /// Tangential velocity of its surface relative to the body.
    pub slip: Option<Located<Slip>>,
}

impl Body {
    /// Whether some of its six components are imposed and some are free.
    pub fn is_mixed(&self) -> bool {
        let free = |component: &&Component| matches!(component, Component::Free(_));
        (1..6).contains(&self.components.iter().filter(free).count())
    }
}

/// Reads `[[bodies]]`.
pub(super) fn read_bodies(
    node: &Node<'_>,
    shapes: &BTreeMap<String, Located<ShapeSpec>>,
) -> Result<Vec<Body>, CaseError> {
    let items = node.array("an array of tables, [[bodies]]")?;
    if items.is_empty() {
        return Err(node.error("no bodies: expected at least one [[bodies]]"));
    }
    (1..)
        .zip(items)
        .map(|(number, item)| read_body(item.of_body(number), shapes))
        .collect()
}

fn read_body(
    node: Node<'_>,
    shapes: &BTreeMap<String, Located<ShapeSpec>>,
) -> Result<Body, CaseError> {
    let line = node.line;
    let section = Section::new(node, KEYS)?;
    let shape_node = section.required("shape", "the name of a shape")?;
    let shape = shape_node.string("the name of a shape")?.to_owned();
    let Some(spec) = shapes.get(&shape) else {
        let names: Vec<&str> = shapes.keys().map(String::as_str).collect();
        let hint = hint(&shape, &names);
        return Err(shape_node.expected(format_args!("the name of a shape of this case{hint}")));
    };
    let orientation = read_orientation(&section)?;
    let given = read_motion(&section)?;
    Ok(Body {
        line,
        center: section.read("center", Node::vector)?.unwrap_or_default(),
        orientation,
        axis: orientation.axis(),
        scale: section
            .read("scale", |node| node.positive("a scale"))?
            .unwrap_or(1.0),
        components: given.components,
        motion: given.motion,
        motion_given: given.by_case,
        slip: section.read("slip", |node| {
            Ok(node.located(read_slip(node.clone(), spec)?))
        })?,
        shape,
    })
}
