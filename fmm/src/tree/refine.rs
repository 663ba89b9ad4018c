//! Which boxes carry grids.

use std::ops::Range;

use rayon::prelude::*;

use super::boxes::{GriddedBox, Leaf, Level};
use super::costs::Costs;
use super::root::Root;
use super::sorting::{DEPTH, Keys, octant};

/// No such box.
const NONE: u32 = u32::MAX;
/// Colleagues a box can have, itself included.
const COLLEAGUES: usize = 27;
/// The slot of a cell among its own colleagues.
const SELF: usize = COLLEAGUES / 2;
/// Times the decision of every cell of a level is looked at again, given its colleagues'.
const SWEEPS: usize = 4;

/// What a cell is in the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// Below a leaf: not in the tree.
    Absent,
    /// With its index in `Tree::leaves`.
    Leaf(u32),
    /// With its index among the boxes of its level.
    Gridded(u32),
}

/// A cube of some level with points in it.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub parent: u32,
    pub octant: u8,
    pub place: [i64; 3],
    pub sources: Range<u32>,
    pub targets: Range<u32>,
    /// The cells of its level around it, with itself in the middle. At
    /// $d_x + 1 + 3 (d_y + 1) + 9 (d_z + 1)$ is the cell whose place is $d$ further, or [`NONE`].
    pub colleagues: [u32; COLLEAGUES],
    /// In the level below; empty if a grid cannot pay.
    pub children: Range<u32>,
    /// Bit `octant` is set if there is such a child.
    octants: u8,
    pub role: Role,
    /// Part of the pairs of points in colleagues that a grid takes from the direct sum.
    saved: f64,
    /// Time saved by the best set of grids in this cell and below, its own grid included, if its
    /// colleagues decide as it does.
    worth: f64,
}

/// Every cell that might carry a grid, and its children.
pub(super) struct Cells {
    pub levels: Vec<Vec<Cell>>,
}

impl Cells {
    /// Cells of the points, with their roles.
    ///
    /// The grid of a box saves direct pairs with gridded colleagues only, and may pay only after
    /// several levels. So the worth of a box is first computed from the finest cells up, as if its
    /// colleagues decided as it does. Then, from the root down, boxes that are worth a grid get
    /// one, and each cell decides again with the decisions of its colleagues known.
    pub fn new(keys: &Keys, finest: usize, costs: &Costs) -> Cells {
        let mut cells = Cells {
            levels: vec![vec![Cell::root(keys)]],
        };
        while cells.levels.len() <= finest.min(DEPTH - 1) && cells.grow(keys, costs) {}
        cells.appraise(costs);
        cells.decide(costs);
        cells
    }

    /// Grids on every box of the first `depth` levels.
    #[cfg(test)]
    pub fn uniform(keys: &Keys, depth: usize) -> Cells {
        let free = Costs {
            pair: f64::INFINITY,
            grid: 1.0,
            point: 0.0,
        };
        let mut cells = Cells {
            levels: vec![vec![Cell::root(keys)]],
        };
        while cells.levels.len() <= depth && cells.grow(keys, &free) {}
        for cell in cells.levels.iter_mut().flatten() {
            cell.worth = 1.0;
        }
        for cell in &mut cells.levels[depth] {
            cell.worth = 0.0;
        }
        for cells in &mut cells.levels[1..depth] {
            for cell in cells {
                (cell.saved, cell.worth) = (1.0, 1.0);
            }
        }
        cells.decide(&free);
        cells
    }

    /// Splits those of the finest cells that might carry a grid; whether there were any.
    fn grow(&mut self, keys: &Keys, costs: &Costs) -> bool {
        let level = self.levels.len() - 1;
        let families: Vec<Vec<Cell>> = self.levels[level]
            .par_iter()
            .enumerate()
            .map(|(i, parent)| {
                // No grid saves more than all pairs.
                let links = || self.links(level, i, |_| true);
                if level == 0 || (parent.spread(keys) && links() * costs.pair > costs.grid) {
                    parent.split(i as u32, level, keys)
                } else {
                    Vec::new()
                }
            })
            .collect();
        let mut first = 0;
        for (parent, family) in self.levels[level].iter_mut().zip(&families) {
            parent.octants = family
                .iter()
                .fold(0, |octants, child| octants | 1 << child.octant);
            parent.children = first..first + family.len() as u32;
            first = parent.children.end;
        }
        let mut children: Vec<Cell> = families.into_iter().flatten().collect();
        let parents = &self.levels[level];
        children.par_iter_mut().for_each(|child| {
            let around = &parents[child.parent as usize].colleagues;
            for slot in 0..COLLEAGUES {
                let (parent_slot, octant) = beyond(child.octant, slot);
                if let Some(parent) = parents.get(around[parent_slot] as usize) {
                    child.colleagues[slot] = parent.child(octant);
                }
            }
        });
        let grown = !children.is_empty();
        if grown {
            self.levels.push(children);
        }
        grown
    }

    /// Pairs of a source and a target in a cell and its colleagues; half of the pairs with each
    /// colleague are counted.
    fn links(&self, level: usize, i: usize, counts: impl Fn(&Cell) -> bool) -> f64 {
        let cells = &self.levels[level];
        let cell = &cells[i];
        let (sources, targets) = (cell.sources.len() as f64, cell.targets.len() as f64);
        let mut links = 0.0;
        for &colleague in &cell.colleagues {
            if let Some(other) = cells.get(colleague as usize).filter(|other| counts(other)) {
                links += 0.5
                    * (sources * other.targets.len() as f64 + targets * other.sources.len() as f64);
            }
        }
        links
    }

    /// What grids are worth, from the finest cells up.
    fn appraise(&mut self, costs: &Costs) {
        for level in (0..self.levels.len() - 1).rev() {
            for i in 0..self.levels[level].len() {
                let cell = &self.levels[level][i];
                if cell.children.is_empty() {
                    continue;
                }
                let links = self.links(level, i, |other| !other.children.is_empty());
                let children = cell.children.start as usize..cell.children.end as usize;
                let below: f64 = children
                    .clone()
                    .map(|child| self.links(level + 1, child, |_| true))
                    .sum();
                let saved = if links > 0.0 {
                    saved(below / links)
                } else {
                    0.0
                };
                let inherited = self.inherited(level, i);
                let cell = &mut self.levels[level][i];
                cell.saved = saved;
                cell.worth = saved * links * costs.pair - costs.grid + inherited;
            }
        }
    }

    /// What the grids of the children are worth.
    fn inherited(&self, level: usize, i: usize) -> f64 {
        let children = &self.levels[level][i].children;
        if children.is_empty() {
            return 0.0;
        }
        let children = &self.levels[level + 1][children.start as usize..children.end as usize];
        children.iter().map(|child| child.worth.max(0.0)).sum()
    }

    /// Roles, from the root down.
    fn decide(&mut self, costs: &Costs) {
        let mut leaves = 0;
        self.levels[0][0].role = Role::Gridded(0);
        for level in 1..self.levels.len() {
            let (above, here) = self.levels.split_at_mut(level);
            for cell in &mut here[0] {
                cell.role = match above[level - 1][cell.parent as usize].role {
                    Role::Gridded(_) if cell.worth > 0.0 => Role::Gridded(0),
                    Role::Gridded(_) => Role::Leaf(0),
                    _ => Role::Absent,
                };
            }
            self.reconsider(level, costs);
            let mut boxes = 0;
            for cell in &mut self.levels[level] {
                let (index, next) = match &mut cell.role {
                    Role::Gridded(index) => (index, &mut boxes),
                    Role::Leaf(index) => (index, &mut leaves),
                    Role::Absent => continue,
                };
                *index = *next;
                *next += 1;
            }
            if boxes == 0 {
                self.levels.truncate(level + 1);
                break;
            }
        }
    }

    /// Lets each cell of a level change its role if that saves time as its colleagues stand.
    fn reconsider(&mut self, level: usize, costs: &Costs) {
        for _ in 0..SWEEPS {
            let mut changed = false;
            for i in 0..self.levels[level].len() {
                let cell = &self.levels[level][i];
                if cell.role == Role::Absent || cell.children.is_empty() {
                    continue;
                }
                let own = cell.sources.len() as f64 * cell.targets.len() as f64;
                let shared = self.links(level, i, |other| matches!(other.role, Role::Gridded(_)))
                    - if cell.role == Role::Leaf(0) { 0.0 } else { own };
                let gain = cell.saved * (own + 2.0 * shared) * costs.pair - costs.grid
                    + self.inherited(level, i);
                let role = if gain > 0.0 {
                    Role::Gridded(0)
                } else {
                    Role::Leaf(0)
                };
                changed |= role != cell.role;
                self.levels[level][i].role = role;
            }
            if !changed {
                break;
            }
        }
    }

    /// The boxes with grids, level by level, and the leaves, their lists of sources still empty.
    pub fn boxes_and_leaves(&self, root: &Root) -> (Vec<Level>, Vec<Leaf>) {
        let mut levels = Vec::new();
        let mut leaves = Vec::new();
        for (depth, cells) in self.levels.iter().enumerate() {
            let side = root.side(depth);
            let leaf = |cell: &Cell| Leaf {
                sources: cell.sources.clone(),
                targets: cell.targets.clone(),
                near: Vec::new(),
            };
            leaves.extend(
                cells
                    .iter()
                    .filter(|cell| matches!(cell.role, Role::Leaf(_)))
                    .map(leaf),
            );
            let boxes: Vec<GriddedBox> = cells
                .iter()
                .filter(|cell| matches!(cell.role, Role::Gridded(_)))
                .map(|cell| self.gridded(root, depth, cell))
                .collect();
            if !boxes.is_empty() {
                levels.push(Level { side, boxes });
            }
        }
        (levels, leaves)
    }

    fn gridded(&self, root: &Root, level: usize, cell: &Cell) -> GriddedBox {
        let index = |role: Role| {
            if let Role::Gridded(index) = role {
                index
            } else {
                NONE
            }
        };
        let parent = level.checked_sub(1).map_or(0, |above| {
            index(self.levels[above][cell.parent as usize].role)
        });
        let family = &self.levels.get(level + 1).map_or(&[][..], |cells| {
            &cells[cell.children.start as usize..cell.children.end as usize]
        });
        let mut children = 0..0;
        let mut leaves = 0..0;
        for child in family.iter() {
            let (range, index) = match child.role {
                Role::Gridded(index) => (&mut children, index),
                Role::Leaf(index) => (&mut leaves, index),
                Role::Absent => unreachable!("children of a gridded box are in the tree"),
            };
            if *range == (0..0) {
                range.start = index;
            }
            range.end = index + 1;
        }
        GriddedBox {
            center: root.center(level, cell.place),
            place: cell.place,
            parent,
            octant: cell.octant,
            sources: cell.sources.clone(),
            targets: cell.targets.clone(),
            children,
            leaves,
        }
    }
}

impl Cell {
    fn root(keys: &Keys) -> Cell {
        let mut colleagues = [NONE; COLLEAGUES];
        colleagues[SELF] = 0;
        Cell {
            parent: 0,
            octant: 0,
            place: [0; 3],
            sources: 0..keys.sources.len() as u32,
            targets: 0..keys.targets.unwrap_or(keys.sources).len() as u32,
            colleagues,
            children: 0..0,
            octants: 0,
            role: Role::Absent,
            saved: 0.0,
            worth: 0.0,
        }
    }

    /// Whether its points differ.
    fn spread(&self, keys: &Keys) -> bool {
        let sources = &keys.sources[self.sources.start as usize..self.sources.end as usize];
        let targets = &keys.targets.unwrap_or(keys.sources)
            [self.targets.start as usize..self.targets.end as usize];
        let mut ends = [
            sources.first(),
            sources.last(),
            targets.first(),
            targets.last(),
        ]
        .into_iter()
        .flatten();
        let first = ends.next();
        ends.any(|end| Some(end) != first)
    }

    /// Its children with points, in the order of octants.
    fn split(&self, index: u32, level: usize, keys: &Keys) -> Vec<Cell> {
        let mut children = Vec::with_capacity(8);
        let mut sources = self.sources.start;
        let mut targets = self.targets.start;
        for which in 0..8 {
            let part = |keys: &[u128], start: u32, end: u32| {
                let rest = &keys[start as usize..end as usize];
                start..start + rest.partition_point(|&key| octant(key, level) <= which) as u32
            };
            let child_sources = part(keys.sources, sources, self.sources.end);
            let child_targets = keys.targets.map_or(child_sources.clone(), |keys| {
                part(keys, targets, self.targets.end)
            });
            (sources, targets) = (child_sources.end, child_targets.end);
            if !child_sources.is_empty() || !child_targets.is_empty() {
                children.push(Cell {
                    parent: index,
                    octant: which,
                    place: std::array::from_fn(|axis| {
                        2 * self.place[axis] + i64::from(which >> axis & 1)
                    }),
                    sources: child_sources,
                    targets: child_targets,
                    colleagues: [NONE; COLLEAGUES],
                    children: 0..0,
                    octants: 0,
                    role: Role::Absent,
                    saved: 0.0,
                    worth: 0.0,
                });
            }
        }
        children
    }

    /// The child in an octant, or [`NONE`].
    fn child(&self, octant: u8) -> u32 {
        if self.octants >> octant & 1 == 0 {
            return NONE;
        }
        self.children.start + (self.octants & ((1 << octant) - 1)).count_ones()
    }
}

/// Where a colleague of a child in `octant` is: the slot of its parent among the colleagues of the
/// child's parent, and its octant there.
fn beyond(octant: u8, slot: usize) -> (usize, u8) {
    let mut parent_slot = 0;
    let mut other = 0;
    let mut rest = slot;
    for (axis, stride) in [1, 3, 9].into_iter().enumerate() {
        // In halves of the parent's side from its lower face, shifted by one parent to be positive.
        let half = usize::from(octant >> axis & 1) + rest % 3 + 1;
        parent_slot += stride * (half / 2);
        other |= ((half % 2) as u8) << axis;
        rest /= 3;
    }
    (parent_slot, other)
}

/// Part of the pairs in colleagues that halving the boxes takes from the direct sum, if it leaves
/// `remaining` of the pairs in colleagues. `remaining` is $2^{-d}$ for points that are uniform in
/// $d$ dimensions.
///
/// Before and after halving, $1, \frac23, \frac\pi9, \frac{4\pi}{81}$ of the pairs in colleagues of
/// unit side are within the reach 1 for $d = 0, \dots, 3$.
fn saved(remaining: f64) -> f64 {
    const WITHIN: [f64; 4] = [1.0, 0.6667, 0.3491, 0.1551];
    let remaining = remaining.clamp(0.125, 1.0);
    let dimension = -remaining.log2();
    let whole = (dimension as usize).min(2);
    let part = dimension - whole as f64;
    (WITHIN[whole] + part * (WITHIN[whole + 1] - WITHIN[whole])) * (1.0 - remaining)
}
