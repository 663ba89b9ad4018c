//! What a solution takes in memory, and what there is.

use std::sync::OnceLock;

use super::check::Keep;
use super::class::Kind;
use super::error::SuspensionError;
use super::options::Options;
use inexact_krylov::Method;

/// Matrices in memory, in matrices of one kind: factors and point sums; and where all that depends
/// on shapes is kept also point sums of single layers and, with more nodes and modes, all those of
/// the check.
const MATRICES: f64 = 2.5;
const MATRICES_KEPT: f64 = 12.0;
/// Bytes that a fast sum takes for each point of a finer surface, by each point of the surface
/// itself.
const SUM_BYTES: usize = 4000;
/// Vectors that an iteration keeps as a rule: room for so many there always is.
pub(crate) const VECTORS: usize = 25;

/// Bytes that everything may take.
pub(crate) fn budget(options: &Options) -> usize {
    options.memory.unwrap_or_else(default_memory)
}

/// Refuses what does not fit into memory.
pub(crate) fn check(
    kinds: &[Kind],
    options: &Options,
    what: &'static str,
) -> Result<(), SuspensionError> {
    let (needed, budget) = (
        needed_memory(kinds, Keep::Nothing, options),
        budget(options),
    );
    if needed <= budget {
        return Ok(());
    }
    Err(SuspensionError::Memory {
        what,
        needed: gibibytes(needed),
        budget: gibibytes(budget),
    })
}

/// Bytes that solving takes beside the rows of near points: factors and point sums of each kind and
/// of its finer surface, and for every point what the fast sum and the vectors of the iteration
/// take.
pub(crate) fn needed_memory(kinds: &[Kind], keep: Keep, options: &Options) -> usize {
    let mut distinct: Vec<&Kind> = Vec::new();
    let mut points = 0;
    for kind in kinds {
        points += kind.points();
        if !distinct.contains(&kind) {
            distinct.push(kind);
        }
    }
    let entries: f64 = distinct.iter().map(|kind| kind.entries()).sum();
    let matrices = match keep {
        Keep::Nothing => MATRICES,
        Keep::Shapes | Keep::Places { .. } => MATRICES_KEPT,
    };
    // A body alone has no sums and no iteration.
    let together = usize::from(kinds.len() > 1);
    let vectors = match options.method {
        Method::Gmres { restart } => restart.min(VECTORS) + 8,
        Method::BiCgStab => 12,
    };
    (8.0 * matrices * entries) as usize + together * points * (SUM_BYTES + 24 * vectors)
}

fn gibibytes(bytes: usize) -> f64 {
    bytes as f64 / f64::from(1 << 30)
}

/// Bytes that a solver may take where its [`Options::memory`] says nothing: seven tenths of what
/// the machine has (feature `machine-memory`), or of 8 GiB.
pub fn default_memory() -> usize {
    static MEMORY: OnceLock<usize> = OnceLock::new();
    *MEMORY.get_or_init(|| (total_memory() as f64 * 0.7) as usize)
}

#[cfg(feature = "machine-memory")]
fn total_memory() -> u64 {
    let mut system = sysinfo::System::new();
    system.refresh_memory();
    system.total_memory()
}

/// Assumed, where nobody asks the machine.
#[cfg(not(feature = "machine-memory"))]
fn total_memory() -> u64 {
    8 << 30
}
