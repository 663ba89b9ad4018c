//! The undisturbed flow.

use super::CaseError;
use super::node::Node;
use super::section::Section;
use serde::{Deserialize, Serialize};

/// How far from orthogonal, or from free of divergence, a flow may be: relative rounding of its
/// given digits.
const SLACK: f64 = 1e-12;

/// A flow `U + G x` that the bodies disturb.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
#[non_exhaustive]
pub enum Background {
    /// The same velocity everywhere.
    Uniform {
        /// That velocity.
        velocity: [f64; 3],
    },
    /// Simple shear: velocity `rate * flow * (gradient . x)`.
    Shear {
        /// Shear rate, one over time.
        rate: f64,
        /// Direction of the flow, of length one.
        flow: [f64; 3],
        /// Direction in which the velocity grows, of length one and orthogonal to `flow`.
        gradient: [f64; 3],
    },
    /// Velocity `gradient x`.
    Linear {
        /// Rows of the velocity gradient, `gradient[i][j] = d u_i / d x_j`; its trace is zero.
        gradient: [[f64; 3]; 3],
    },
}

#[derive(Clone, Copy)]
enum Kind {
    Uniform,
    Shear,
    Linear,
}

/// Reads `[background]`.
pub(super) fn read_background(node: Node<'_>) -> Result<Background, CaseError> {
    let section = Section::open(node)?;
    let kind = section.kind("one of uniform, shear, linear")?;
    let kinds = [
        ("uniform", Kind::Uniform),
        ("shear", Kind::Shear),
        ("linear", Kind::Linear),
    ];
    match kind.choice(&kinds)? {
        Kind::Uniform => {
            section.check(&["kind", "velocity"])?;
            let velocity = section.required("velocity", "a velocity")?.vector()?;
            Ok(Background::Uniform { velocity })
        }
        Kind::Shear => read_shear(&section),
        Kind::Linear => read_linear(&section),
    }
}

fn read_shear(section: &Section<'_>) -> Result<Background, CaseError> {
    section.check(&["kind", "rate", "flow", "gradient"])?;
    let rate = section.required("rate", "a shear rate")?.number()?;
    let flow = section
        .read("flow", Node::direction)?
        .unwrap_or([1.0, 0.0, 0.0]);
    let gradient = section
        .read("gradient", Node::direction)?
        .unwrap_or([0.0, 1.0, 0.0]);
    let along: f64 = flow.iter().zip(&gradient).map(|(f, g)| f * g).sum();
    if along.abs() > SLACK {
        let node = section.optional("gradient").or(section.optional("flow"));
        let node = node.as_ref().unwrap_or(&section.node);
        return Err(node.expected("flow and gradient orthogonal to each other"));
    }
    Ok(Background::Shear {
        rate,
        flow,
        gradient,
    })
}

fn read_linear(section: &Section<'_>) -> Result<Background, CaseError> {
    section.check(&["kind", "gradient"])?;
    let what = "three rows of three numbers";
    let node = section.required("gradient", what)?;
    let rows = node.array(what)?;
    let rows: Vec<[f64; 3]> = rows.iter().map(Node::vector).collect::<Result<_, _>>()?;
    let gradient: [[f64; 3]; 3] = rows.try_into().map_err(|_| node.expected(what))?;
    let trace = gradient[0][0] + gradient[1][1] + gradient[2][2];
    let largest = gradient
        .iter()
        .flatten()
        .fold(0.0_f64, |m, x| m.max(x.abs()));
    if trace.abs() > SLACK * largest {
        let divergence = format!("rows whose diagonal sums to zero, not {trace:e}");
        return Err(node.expected(divergence));
    }
    Ok(Background::Linear { gradient })
}
