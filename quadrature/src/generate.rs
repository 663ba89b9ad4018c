//! The generator of the tabulated rules: generalised Gaussian quadrature for logarithmic
//! singularities.
//!
//! The rule has `n` nodes `u_j` and weights `w_j` and integrates `P_k` and `P_k log|u|`, `k < n`,
//! exactly over an interval: `2n` equations for `2n` unknowns. `u` is the offset from the singular
//! point, which may lie inside the interval, at its end or outside.
//!
//! The rule is found by continuation (Ma, Rokhlin & Wandzura 1996). With `log sqrt(u^2 + e^2)` in
//! place of `log|u|` and `e` of the interval's size, the Gauss-Legendre rule of `n` nodes nearly
//! solves the equations. Then `e` is lowered in steps down to zero; each step is solved by damped
//! Newton iterations from the solution of the step before. The functions are nearly dependent
//! (condition numbers beyond 1e16), so moments, Jacobian and solver work in double-double
//! arithmetic; directions that are lost to rounding even there are left unchanged. For a
//! singularity at the end or outside, `P_k` and `P_k log u` are a Chebyshev system, and the rule
//! exists, is unique and has positive weights (Karlin & Studden 1966). For a singularity inside, it
//! is not known beforehand whether the rule exists; the generator shows it by finding the rule.

mod moments;
mod newton;
mod solve;

use crate::double_double::Dd;
use crate::error::{QuadratureError, Result};
use crate::gauss_legendre::node_and_weight;
use moments::{Interval, System};

/// The largest number of nodes the generator takes on.
pub const MAX_NODES: usize = 64;

/// A rule as the generator delivers it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Generated {
    /// Nodes less the singular point, ascending, each to full relative precision.
    pub offsets: Vec<f64>,
    /// Weights, in the order of `offsets`.
    pub weights: Vec<f64>,
    /// Largest error of a moment (of `P_k` or `P_k log|u|`) before rounding to doubles.
    pub residual: f64,
}

/// The rule on `[-1, 1]` with `2 order` nodes for a singularity at node `target` of the
/// Gauss-Legendre rule of `order` nodes.
///
/// # Errors
/// For an order or target that does not exist, or if the continuation fails.
pub fn own(order: usize, target: usize) -> Result<Generated> {
    let y = target_node(order, target)?;
    let interval = Interval::new(-Dd::ONE - y, Dd::ONE - y);
    run(&interval, 2 * order, || {
        format!("own panel, order {order}, target {target}")
    })
}

/// The rule on `[-1, 1]` with `2 order` nodes for a singularity at `x + 2`, where `x` is node
/// `target` of the Gauss-Legendre rule of `order` nodes: the target lies on the panel to the right.
///
/// # Errors
/// For an order or target that does not exist, or if the continuation fails.
pub fn neighbour(order: usize, target: usize) -> Result<Generated> {
    let y = target_node(order, target)? + Dd::from(2.0);
    let interval = Interval::new(-Dd::ONE - y, Dd::ONE - y);
    run(&interval, 2 * order, || {
        format!("neighbour panel, order {order}, target {target}")
    })
}

/// The rule on `[0, 1]` with `nodes` nodes for a singularity at 0.
///
/// # Errors
/// For no nodes or more than [`MAX_NODES`], or if the continuation fails.
pub fn log_endpoint(nodes: usize) -> Result<Generated> {
    let interval = Interval::new(Dd::ZERO, Dd::ONE);
    run(&interval, nodes, || {
        format!("logarithm at the end, {nodes} nodes")
    })
}

fn target_node(order: usize, target: usize) -> Result<Dd> {
    if order == 0 || order > MAX_NODES / 2 {
        let max = MAX_NODES / 2;
        return Err(QuadratureError::Order { order, max });
    }
    if target >= order {
        return Err(QuadratureError::Node {
            index: target,
            order,
        });
    }
    Ok(node_and_weight(order, target).0)
}

fn run(interval: &Interval, nodes: usize, what: impl Fn() -> String) -> Result<Generated> {
    if nodes == 0 || nodes > MAX_NODES {
        return Err(QuadratureError::Order {
            order: nodes,
            max: MAX_NODES,
        });
    }
    let system = System::new(interval, nodes);
    let (points, residual) = newton::continuation(&system);
    if residual.is_nan() || residual > newton::TOLERANCE {
        return Err(QuadratureError::NotConverged {
            what: what(),
            residual,
            tolerance: newton::TOLERANCE,
        });
    }
    let mut pairs: Vec<(f64, f64)> = points
        .iter()
        .map(|p| (p.offset.to_f64(), p.weight.to_f64()))
        .collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (offsets, weights) = pairs.into_iter().unzip();
    Ok(Generated {
        offsets,
        weights,
        residual,
    })
}
