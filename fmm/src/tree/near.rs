//! What targets see directly.

use std::ops::Range;

use rayon::prelude::*;

use super::boxes::{Leaf, Near};
use super::points::SortedPoints;
use super::refine::{Cell, Cells, Role};
use super::root::Root;

/// Smallest box around some points.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Bounds {
    const EMPTY: Bounds = Bounds {
        low: [f64::INFINITY; 3],
        high: [f64::NEG_INFINITY; 3],
    };

    fn of(points: &SortedPoints, range: &Range<u32>) -> Bounds {
        let range = range.start as usize..range.end as usize;
        let positions = points.positions.each_ref().map(|x| &x[range.clone()]);
        Bounds {
            low: positions.map(|x| x.iter().fold(f64::INFINITY, |a, &b| a.min(b))),
            high: positions.map(|x| x.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b))),
        }
    }

    fn union(self, other: Bounds) -> Bounds {
        Bounds {
            low: std::array::from_fn(|axis| self.low[axis].min(other.low[axis])),
            high: std::array::from_fn(|axis| self.high[axis].max(other.high[axis])),
        }
    }

    /// Whether points of the two may be nearer than `reach`.
    fn within(&self, other: &Bounds, reach: f64) -> bool {
        let gap = |axis: usize| {
            (self.low[axis] - other.high[axis])
                .max(other.low[axis] - self.high[axis])
                .max(0.0)
        };
        let (x, y, z) = (gap(0), gap(1), gap(2));
        x * x + y * y + z * z < reach * reach
    }
}

/// A cell of the tree: its level and its index there.
type Address = (usize, u32);

/// Bounds of the sources and of the targets of every cell in the tree, level by level.
struct CellBounds {
    sources: Vec<Vec<Bounds>>,
    targets: Option<Vec<Vec<Bounds>>>,
}

impl CellBounds {
    fn new(cells: &Cells, sources: &SortedPoints, targets: Option<&SortedPoints>) -> CellBounds {
        CellBounds {
            sources: bounds(cells, sources, |cell| &cell.sources),
            targets: targets.map(|points| bounds(cells, points, |cell| &cell.targets)),
        }
    }

    fn sources(&self, (level, index): Address) -> &Bounds {
        &self.sources[level][index as usize]
    }

    fn targets(&self, (level, index): Address) -> &Bounds {
        &self.targets.as_ref().unwrap_or(&self.sources)[level][index as usize]
    }
}

/// Bounds of cells: of leaves from their points, of gridded boxes from their children.
fn bounds(
    cells: &Cells,
    points: &SortedPoints,
    range: impl Fn(&Cell) -> &Range<u32> + Sync,
) -> Vec<Vec<Bounds>> {
    let mut levels: Vec<Vec<Bounds>> = vec![Vec::new(); cells.levels.len()];
    for (level, cells) in cells.levels.iter().enumerate().rev() {
        let below = levels.get(level + 1);
        levels[level] = cells
            .par_iter()
            .map(|cell| match cell.role {
                Role::Absent => Bounds::EMPTY,
                Role::Leaf(_) => Bounds::of(points, range(cell)),
                Role::Gridded(_) => below.map_or(Bounds::EMPTY, |below| {
                    let children = &below[cell.children.start as usize..cell.children.end as usize];
                    children
                        .iter()
                        .fold(Bounds::EMPTY, |all, &child| all.union(child))
                }),
            })
            .collect();
    }
    levels
}

/// Fills in the lists of the leaves that the cells of these points have.
///
/// A leaf sees all colleagues of its own level within a reach of its own side. Of the colleagues of
/// its ancestors it sees those that are leaves, within a reach of their sides.
pub(super) fn fill(
    leaves: &mut [Leaf],
    cells: &Cells,
    root: &Root,
    sources: &SortedPoints,
    targets: Option<&SortedPoints>,
) {
    let bounds = CellBounds::new(cells, sources, targets);
    // Larger leaves that each cell of the level above sees.
    let mut above: Vec<Vec<Address>> = vec![Vec::new()];
    let mut filled = 0;
    for level in 1..cells.levels.len() {
        let side = root.side(level);
        let here = &cells.levels[level];
        let lists: Vec<Vec<Near>> = here
            .par_iter()
            .enumerate()
            .filter(|(_, cell)| matches!(cell.role, Role::Leaf(_)))
            .map(|(i, cell)| {
                near(
                    cells,
                    &bounds,
                    (level, i as u32),
                    side,
                    &above[cell.parent as usize],
                )
            })
            .collect();
        for list in lists {
            leaves[filled].near = list;
            filled += 1;
        }
        above = here
            .par_iter()
            .enumerate()
            .map(|(i, cell)| match cell.role {
                Role::Gridded(_) => larger_leaves(
                    cells,
                    &bounds,
                    (level, i as u32),
                    side,
                    &above[cell.parent as usize],
                ),
                _ => Vec::new(),
            })
            .collect();
    }
}

/// Leaves of this level and those above that some descendant of a gridded box may see.
fn larger_leaves(
    cells: &Cells,
    bounds: &CellBounds,
    address: Address,
    side: f64,
    above: &[Address],
) -> Vec<Address> {
    let (level, index) = address;
    let here = &cells.levels[level];
    let leaf = |&&colleague: &&u32| {
        here.get(colleague as usize)
            .is_some_and(|cell| matches!(cell.role, Role::Leaf(_)))
    };
    let colleagues = here[index as usize]
        .colleagues
        .iter()
        .filter(leaf)
        .map(|&colleague| (level, colleague));
    let targets = bounds.targets(address);
    let reaches =
        |other: &Address| targets.within(bounds.sources(*other), scaled(side, level, other.0));
    above
        .iter()
        .copied()
        .chain(colleagues)
        .filter(reaches)
        .collect()
}

/// The list of a leaf, adjacent ranges of one reach merged.
fn near(
    cells: &Cells,
    bounds: &CellBounds,
    address: Address,
    side: f64,
    above: &[Address],
) -> Vec<Near> {
    let (level, index) = address;
    let here = &cells.levels[level];
    let leaf = &here[index as usize];
    if leaf.targets.is_empty() {
        return Vec::new();
    }
    let present = |&&colleague: &&u32| {
        here.get(colleague as usize)
            .is_some_and(|cell| cell.role != Role::Absent)
    };
    let colleagues = leaf
        .colleagues
        .iter()
        .filter(present)
        .map(|&colleague| (level, colleague));
    let mut seen: Vec<Near> = above
        .iter()
        .copied()
        .chain(colleagues)
        .map(|other| (other, scaled(side, level, other.0)))
        .filter(|&(other, reach)| bounds.targets(address).within(bounds.sources(other), reach))
        .map(|((level, index), reach)| Near {
            sources: cells.levels[level][index as usize].sources.clone(),
            reach,
        })
        .collect();
    seen.sort_unstable_by_key(|near| near.sources.start);
    let mut merged: Vec<Near> = Vec::with_capacity(seen.len());
    for near in seen {
        match merged.last_mut() {
            Some(last) if last.sources.end == near.sources.start && last.reach == near.reach => {
                last.sources.end = near.sources.end;
            }
            _ => merged.push(near),
        }
    }
    merged
}

/// Side of boxes of level `other`, given that of `level`.
fn scaled(side: f64, level: usize, other: usize) -> f64 {
    side * 2f64.powi(level as i32 - other as i32)
}
