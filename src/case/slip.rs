//! Tangential slip on a body's surface.

use super::CaseError;
use super::node::Node;
use super::section::Section;
use super::shape::ShapeSpec;
use serde::{Deserialize, Serialize};

/// A tangential velocity of the surface, in the frame of the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Slip {
    /// Squirming modes of a sphere.
    Squirmer {
        /// The amplitudes `b_1, b_2, ...`, velocities.
        b: Vec<f64>,
    },
    /// From the upper pole of a spheroid to the lower.
    PoleToPole {
        /// Semi-axis of the spheroid along its axis.
        polar: f64,
        /// Semi-axis across it.
        equatorial: f64,
        /// Speed at the equator, down the axis if positive.
        speed: f64,
    },
}

#[derive(Clone, Copy)]
enum Kind {
    Squirmer,
    PoleToPole,
}

/// Reads `slip = { kind = ... }` of a body of the given shape.
pub(super) fn read_slip(node: Node<'_>, shape: &ShapeSpec) -> Result<Slip, CaseError> {
    let section = Section::open(node)?;
    let kind_node = section.kind("one of squirmer, pole-to-pole")?;
    let kind = kind_node.choice(&[
        ("squirmer", Kind::Squirmer),
        ("pole-to-pole", Kind::PoleToPole),
    ])?;
    match kind {
        Kind::Squirmer => {
            section.check(&["kind", "b"])?;
            if !matches!(shape, ShapeSpec::Sphere { .. }) {
                return Err(kind_node.expected("a sphere, the only shape with squirming modes"));
            }
            let b = section.required("b", "a list of velocities")?.numbers()?;
            Ok(Slip::Squirmer { b })
        }
        Kind::PoleToPole => {
            section.check(&["kind", "speed"])?;
            let (polar, equatorial) = match *shape {
                ShapeSpec::Sphere { radius } => (radius, radius),
                ShapeSpec::Spheroid { polar, equatorial } => (polar, equatorial),
                _ => return Err(kind_node.expected("a spheroid, the only shape with this slip")),
            };
            let speed = section.required("speed", "a velocity")?.number()?;
            Ok(Slip::PoleToPole {
                polar,
                equatorial,
                speed,
            })
        }
    }
}
