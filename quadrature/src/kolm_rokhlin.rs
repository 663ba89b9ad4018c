//! Rules for a logarithmic singularity at a node of a panel, on that panel and on its neighbours.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::error::{QuadratureError, Result};
use crate::gauss_legendre::GaussLegendre;
use crate::generate;
use crate::table;

/// The orders of panels there are rules for.
pub const ORDERS: &[usize] = &[10, 16];

/// On which side of the panel of integration the target's panel lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Side {
    /// The target is at `x_i - 2`.
    Left,
    /// The target is at `x_i + 2`.
    Right,
}

/// Which family of rules a table holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Family {
    /// The target is on the panel.
    Own,
    /// The target is on the adjacent panel.
    Neighbour,
}

/// A generalised Gaussian rule on `[-1, 1]` for `phi(x) + psi(x) log|x - y|` with the singular
/// point `y` at a node `x_i` of the `p`-point Gauss-Legendre panel `[-1, 1]`, or of an equally long
/// panel beside it.
///
/// With `2p` nodes it is exact for polynomials `phi` and `psi` of degree up to `2p - 1` (Kolm &
/// Rokhlin 2001 use 20 nodes on the own panel and 24 on neighbours for `p = 10`; 20 do for both).
/// All weights are positive and all nodes inside. Rules of mirrored targets mirror each other
/// exactly.
///
/// ```
/// use panel_quadrature::{GaussLegendre, KolmRokhlin};
///
/// let target = GaussLegendre::new(10)?.nodes()[3];
/// let rule = KolmRokhlin::own(10, 3)?;
/// let integral: f64 = rule.iter().map(|n| n.weight * n.offset.abs().ln()).sum();
/// let exact = (1.0 - target) * (1.0 - target).ln() + (1.0 + target) * (1.0 + target).ln() - 2.0;
/// assert!((integral - exact).abs() < 1e-14);
/// # Ok::<(), panel_quadrature::QuadratureError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct KolmRokhlin {
    /// Nodes in `(-1, 1)`, ascending.
    pub nodes: &'static [f64],
    /// Nodes minus the singular point, to full relative precision. Subtraction from `nodes` would
    /// lose digits.
    pub offsets: &'static [f64],
    /// Weights, positive, summing to 2.
    pub weights: &'static [f64],
}

/// One node of a rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Where it lies, in `(-1, 1)`.
    pub node: f64,
    /// The same less the singular point.
    pub offset: f64,
    /// Its weight.
    pub weight: f64,
}

impl KolmRokhlin {
    /// The rule for the singular point at node `target` of the same panel, of `order` nodes.
    ///
    /// # Errors
    /// For an order that is not one of [`ORDERS`], or a target that does not exist.
    pub fn own(order: usize, target: usize) -> Result<Self> {
        lookup(order, target, |rules| &rules.own)
    }

    /// The rule for the singular point at node `target` of the adjacent panel on the given side.
    ///
    /// # Errors
    /// For an order that is not one of [`ORDERS`], or a target that does not exist.
    pub fn neighbour(order: usize, target: usize, side: Side) -> Result<Self> {
        lookup(order, target, |rules| match side {
            Side::Left => &rules.left,
            Side::Right => &rules.right,
        })
    }

    /// Number of nodes, `2 order`.
    pub fn order(&self) -> usize {
        self.nodes.len()
    }

    /// The nodes one by one.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Node> + 'static {
        let rule = *self;
        (0..rule.order()).map(move |j| Node {
            node: rule.nodes[j],
            offset: rule.offsets[j],
            weight: rule.weights[j],
        })
    }
}

/// A rule in memory.
struct Stored {
    nodes: Vec<f64>,
    offsets: Vec<f64>,
    weights: Vec<f64>,
}

impl Stored {
    fn mirrored(&self) -> Self {
        let negated = |values: &[f64]| values.iter().rev().map(|v| -v).collect();
        Self {
            nodes: negated(&self.nodes),
            offsets: negated(&self.offsets),
            weights: self.weights.iter().rev().copied().collect(),
        }
    }
}

/// All rules of one order, by target.
struct Rules {
    own: Vec<Stored>,
    left: Vec<Stored>,
    right: Vec<Stored>,
}

static RULES: LazyLock<Result<BTreeMap<usize, Rules>>> = LazyLock::new(|| {
    Ok(BTreeMap::from([
        (
            10,
            read(
                10,
                ("own_10.txt", include_str!("../data/own_10.txt")),
                ("neighbour_10.txt", include_str!("../data/neighbour_10.txt")),
            )?,
        ),
        (
            16,
            read(
                16,
                ("own_16.txt", include_str!("../data/own_16.txt")),
                ("neighbour_16.txt", include_str!("../data/neighbour_16.txt")),
            )?,
        ),
    ]))
});

fn lookup(
    order: usize,
    target: usize,
    family: impl Fn(&'static Rules) -> &'static Vec<Stored>,
) -> Result<KolmRokhlin> {
    let rules = RULES.as_ref().map_err(Clone::clone)?;
    let rules = rules.get(&order).ok_or(QuadratureError::NotTabulated {
        family: "Kolm-Rokhlin",
        order,
        available: ORDERS,
    })?;
    let rule = family(rules).get(target).ok_or(QuadratureError::Node {
        index: target,
        order,
    })?;
    Ok(KolmRokhlin {
        nodes: &rule.nodes,
        offsets: &rule.offsets,
        weights: &rule.weights,
    })
}

/// Reads the two tables of an order. The own panel's has the targets of the right half only.
fn read(order: usize, own: (&'static str, &str), neighbour: (&'static str, &str)) -> Result<Rules> {
    let panel = GaussLegendre::new(order)?;
    let load = |(name, text): (&'static str, &str), targets: Vec<usize>, shift: f64| {
        let mut columns = table::parse(name, text)?;
        targets
            .into_iter()
            .map(|target| {
                let rule = columns.remove(&target).ok_or(QuadratureError::Table {
                    table: name,
                    line: text.lines().count(),
                    problem: format!("rule {target} is missing"),
                })?;
                Ok(Stored {
                    // The sum in brackets is exact or nearly so.
                    nodes: rule
                        .offsets
                        .iter()
                        .map(|offset| panel.nodes()[target] + (offset + shift))
                        .collect(),
                    offsets: rule.offsets,
                    weights: rule.weights,
                })
            })
            .collect::<Result<Vec<_>>>()
    };
    let right_half = load(own, (order / 2..order).collect(), 0.0)?;
    let left_half: Vec<Stored> = right_half.iter().rev().map(Stored::mirrored).collect();
    let right = load(neighbour, (0..order).collect(), 2.0)?;
    let left = right.iter().rev().map(Stored::mirrored).collect();
    // With an odd order the middle target has a rule of its own, which is not doubled.
    let own = left_half.into_iter().take(order / 2).chain(right_half);
    Ok(Rules {
        own: own.collect(),
        left,
        right,
    })
}

/// Makes the data file of a family and order anew, with the [generator](crate::generate). Order 16
/// takes about a minute.
///
/// # Errors
/// If the generator fails.
pub fn generate_table(family: Family, order: usize) -> Result<String> {
    let made = match family {
        Family::Own => (order / 2..order)
            .map(|target| Ok((target, generate::own(order, target)?)))
            .collect::<Result<Vec<_>>>()?,
        Family::Neighbour => (0..order)
            .map(|target| Ok((target, generate::neighbour(order, target)?)))
            .collect::<Result<Vec<_>>>()?,
    };
    let place = match family {
        Family::Own => "y = x_i; targets of the right half, the others mirror them",
        Family::Neighbour => "y = x_i + 2; for y = x_i - 2 mirror target p - 1 - i",
    };
    let comment = format!(
        "Generalised Gaussian rules on [-1, 1] for phi(x) + psi(x) log|x - y|, phi and psi of degree < {}.\n\
         x_i is a node of the Gauss-Legendre rule of order p = {order}; {place}.\n\
         The rule's number is the target i, starting at 0. Columns: node less y, weight.\n\
         Made by: cargo run --release -p panel-quadrature --example generate_tables",
        2 * order
    );
    let columns = made
        .iter()
        .map(|(target, rule)| (*target, &rule.offsets[..], &rule.weights[..]));
    Ok(table::write(&comment, columns))
}

#[cfg(test)]
mod tests;
