//! Bodies: a shape, where it is, and what is imposed on it.

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
    /// What is imposed on it.
    pub motion: Located<Motion>,
    /// Tangential velocity of its surface relative to the body.
    pub slip: Option<Located<Slip>>,
}

/// What is imposed on a body; vectors in the laboratory frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The rigid motion is given (zero where the case gives nothing: the body is held).
    Rigid {
        /// Velocity of the centre.
        velocity: [f64; 3],
        /// Angular velocity.
        angular_velocity: [f64; 3],
    },
    /// Force and torque are given, the motion is wanted.
    Free {
        /// Force exerted on the body from outside.
        force: [f64; 3],
        /// Torque about the centre, exerted on the body from outside.
        torque: [f64; 3],
    },
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
    items
        .into_iter()
        .map(|item| read_body(item, shapes))
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
    Ok(Body {
        line,
        center: section.read("center", Node::vector)?.unwrap_or_default(),
        orientation,
        axis: orientation.axis(),
        scale: section
            .read("scale", |node| node.positive("a scale"))?
            .unwrap_or(1.0),
        motion: read_motion(&section)?,
        slip: section.read("slip", |node| {
            Ok(node.located(read_slip(node.clone(), spec)?))
        })?,
        shape,
    })
}

fn read_motion(section: &Section<'_>) -> Result<Located<Motion>, CaseError> {
    let [velocity, angular_velocity, force, torque] =
        ["velocity", "angular_velocity", "force", "torque"].map(|key| section.optional(key));
    let rigid = velocity.as_ref().or(angular_velocity.as_ref());
    let free = force.as_ref().or(torque.as_ref());
    if let (Some(rigid), Some(free)) = (rigid, free) {
        let later = if rigid.line > free.line { rigid } else { free };
        return Err(later.error(format!(
            "both {} and {} are given: expected either velocity and angular_velocity, or force and torque",
            rigid.key, free.key
        )));
    }
    let line = rigid.or(free).map_or(section.node.line, |node| node.line);
    let is_free = free.is_some();
    let vector = |node: Option<Node<'_>>| match node {
        Some(node) => node.vector(),
        None => Ok([0.0; 3]),
    };
    let value = if is_free {
        Motion::Free {
            force: vector(force)?,
            torque: vector(torque)?,
        }
    } else {
        Motion::Rigid {
            velocity: vector(velocity)?,
            angular_velocity: vector(angular_velocity)?,
        }
    };
    Ok(Located { line, value })
}
