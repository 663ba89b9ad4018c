//! How accurate the answer must be, or how finely the shapes are cut.

use stokes_body::resolution::matrix_entries;
use stokes_suspension::default_memory;

use super::CaseError;
use super::node::Node;
use super::section::Section;

/// The smallest tolerance double precision can serve.
pub const SMALLEST_TOLERANCE: f64 = 1e-14;
/// Most panels on one generating curve.
pub const MOST_PANELS: usize = 1000;
/// Most azimuthal modes.
pub const MOST_MODES: usize = 1000;

/// Bytes.
const GIB: f64 = (1u64 << 30) as f64;

/// What `[accuracy]` asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Accuracy {
    /// The solver picks panels and modes for this relative error of velocities, forces and torques.
    Tolerance(f64),
    /// Chosen by hand: nothing is promised, the error is only estimated.
    ByHand {
        /// Panels on the generating curve.
        panels: usize,
        /// Nodes on a panel: 10 or 16.
        order: usize,
        /// Azimuthal modes.
        modes: usize,
    },
}

impl Default for Accuracy {
    fn default() -> Self {
        Self::Tolerance(1e-8)
    }
}

/// What `[accuracy]` says.
#[derive(Default)]
pub(super) struct AccuracyOptions {
    /// See [`super::Case::accuracy`].
    pub(super) accuracy: Accuracy,
    /// See [`super::Case::tolerance_by_hand`].
    pub(super) tolerance_by_hand: Option<f64>,
}

/// Reads `[accuracy]`; `memory` is what `[solver]` says of it, in GiB.
pub(super) fn read_accuracy(
    node: Node<'_>,
    memory: Option<f64>,
) -> Result<AccuracyOptions, CaseError> {
    let section = Section::new(node, &["tolerance", "panels", "order", "modes"])?;
    if section.is_empty() {
        return Err(section
            .node
            .error("[accuracy] is empty: expected tolerance, or panels, order and modes"));
    }
    let tolerance = section.read("tolerance", read_tolerance)?;
    let by_hand = ["panels", "order", "modes"].iter();
    if by_hand.filter_map(|key| section.optional(key)).count() == 0 {
        return Ok(AccuracyOptions {
            accuracy: tolerance.map(Accuracy::Tolerance).unwrap_or_default(),
            tolerance_by_hand: None,
        });
    }
    Ok(AccuracyOptions {
        accuracy: read_by_hand(&section, memory)?,
        tolerance_by_hand: tolerance,
    })
}

/// A relative tolerance that doubles can serve.
pub(super) fn read_tolerance(node: &Node<'_>) -> Result<f64, CaseError> {
    let range = "a tolerance of at least 1e-14 (double precision) and less than 1";
    let value = node.number().map_err(|_| node.expected(range))?;
    if (SMALLEST_TOLERANCE..1.0).contains(&value) {
        Ok(value)
    } else {
        Err(node.expected(range))
    }
}

fn read_by_hand(section: &Section<'_>, memory: Option<f64>) -> Result<Accuracy, CaseError> {
    let all = "all three of panels, order and modes";
    let panels_node = section.required("panels", all)?;
    let order_node = section.required("order", all)?;
    let modes_node = section.required("modes", all)?;
    let panels = panels_node.integer("a number of panels", 1..=MOST_PANELS)?;
    let order = order_node
        .integer("10 or 16", 1..=16)
        .ok()
        .filter(|order| [10, 16].contains(order))
        .ok_or_else(|| order_node.expected("10 or 16"))?;
    let modes = modes_node.integer("a number of modes", 1..=MOST_MODES)?;
    // The solver counts what all bodies need. What one alone cannot have is refused here, where the
    // line can be named.
    let needed = 8.0 * matrix_entries(panels, order, modes) / GIB;
    let most = memory.unwrap_or_else(|| default_memory() as f64 / GIB);
    if needed > most {
        return Err(panels_node.error(format!(
            "panels = {panels}, order = {order}, modes = {modes} would need {needed:.1} GiB of memory: \
             expected a choice that needs at most {most:.1} GiB"
        )));
    }
    Ok(Accuracy::ByHand {
        panels,
        order,
        modes,
    })
}
