//! The smooth part of the sums: from charges to grids, up the tree, across by plane waves, down
//! again, and to the targets.

use std::ops::Range;

use f64_lanes::{Isa, WithIsa, dispatch};
use rayon::prelude::*;

use crate::far::Fields;
use crate::gridding::{self, Cube};
use crate::operators::Operators;
use crate::transform::BATCH;
use crate::translate::Slab;
use crate::tree::{GriddedBox, SortedPoints, Tree};

/// Charges of the sources, in the order of the tree: first the charge for each density, then for
/// each density the dipole along x, y and z.
pub(crate) type Charges = Vec<Vec<f64>>;

/// How the boxes of the tree work together.
#[derive(Clone, Debug)]
pub(crate) struct FarField {
    /// How the boxes of each level hand on their waves.
    levels: Vec<Vec<Slab>>,
    /// Level and box of each leaf.
    homes: Vec<[u32; 2]>,
}

/// Grids of all boxes, one level after the other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grids {
    levels: Vec<Vec<f64>>,
    /// Potentials' waves of the sources of one slab.
    waves: Vec<f64>,
    /// Potential by potential, the waves of this slab and the two before, taken over x and y.
    swept: Vec<[Vec<f64>; 3]>,
    /// One potential's waves of the targets that are served with a slab, taken over z too.
    gathered: Vec<f64>,
}

impl FarField {
    pub fn new(tree: &Tree) -> Self {
        let levels = tree.levels.iter().map(|level| {
            let with = |full: fn(&GriddedBox) -> bool| -> Vec<(u32, [i64; 3])> {
                let numbered = (0..).zip(&level.boxes).filter(|(_, gridded)| full(gridded));
                numbered
                    .map(|(number, gridded)| (number, gridded.place))
                    .collect()
            };
            Slab::cut(
                &with(|b| !b.sources.is_empty()),
                &with(|b| !b.targets.is_empty()),
            )
        });
        let mut homes = vec![[0; 2]; tree.leaves.len()];
        for (depth, level) in tree.levels.iter().enumerate() {
            for (number, gridded) in level.boxes.iter().enumerate() {
                for leaf in gridded.leaves.clone() {
                    homes[leaf as usize] = [depth as u32, number as u32];
                }
            }
        }
        Self {
            levels: levels.collect(),
            homes,
        }
    }

    /// Lays the charges on the grids, and leaves potentials there.
    pub fn fill(
        &self,
        operators: &Operators,
        fields: Fields,
        tree: &Tree,
        charges: &Charges,
        grids: &mut Grids,
    ) {
        let shape = operators.shape;
        let len = shape.len(fields.most());
        grids.levels.resize_with(tree.levels.len(), Vec::new);
        for (level, grids) in tree.levels.iter().zip(&mut grids.levels) {
            grids.resize(level.boxes.len() * len, 0.0);
        }
        for depth in (0..tree.levels.len()).rev() {
            self.up(operators, fields, tree, charges, grids, depth);
        }
        for depth in 0..tree.levels.len() {
            self.across(operators, fields, tree, grids, depth);
            if depth > 0 {
                self.down(operators, fields, tree, grids, depth);
            }
        }
    }

    /// Charges of the leaves and of the children's grids on the grids of one level.
    fn up(
        &self,
        operators: &Operators,
        fields: Fields,
        tree: &Tree,
        charges: &Charges,
        grids: &mut Grids,
        depth: usize,
    ) {
        let len = operators.shape.len(fields.most());
        let level = &tree.levels[depth];
        let (coarse, fine) = grids.levels.split_at_mut(depth + 1);
        let children = fine.first().map_or(&[][..], |fine| &fine[..]);
        let finer = tree.levels.get(depth + 1);
        coarse[depth]
            .par_chunks_exact_mut(len)
            .enumerate()
            .for_each_init(
                || operators.transfer.scratch(),
                |scratch, (number, grid)| {
                    let gridded = &level.boxes[number];
                    if gridded.sources.is_empty() {
                        return;
                    }
                    grid.fill(0.0);
                    for leaf in
                        &tree.leaves[gridded.leaves.start as usize..gridded.leaves.end as usize]
                    {
                        let range = leaf.sources.start as usize..leaf.sources.end as usize;
                        if !range.is_empty() {
                            let cube = Cube {
                                center: gridded.center,
                                side: level.side,
                            };
                            spread(operators, fields, cube, &tree.sources, charges, range, grid);
                        }
                    }
                    let Some(finer) = finer else { return };
                    for child in gridded
                        .children
                        .clone()
                        .filter(|&c| !finer.boxes[c as usize].sources.is_empty())
                    {
                        let octant = finer.boxes[child as usize].octant;
                        let from = &children[child as usize * len..][..len];
                        dispatch(Handing {
                            up: true,
                            fields: fields.densities,
                            octant,
                            from,
                            to: grid,
                            operators,
                            scratch,
                        });
                    }
                },
            );
    }

    /// Charges of all boxes of a level to potentials, by plane waves.
    fn across(
        &self,
        operators: &Operators,
        fields: Fields,
        tree: &Tree,
        grids: &mut Grids,
        depth: usize,
    ) {
        let len = operators.shape.len(fields.most());
        let side = tree.levels[depth].side;
        let Grids {
            levels,
            waves,
            swept,
            gathered,
        } = grids;
        let mut boxes: Vec<&mut [f64]> = levels[depth].chunks_exact_mut(len).collect();
        let shape = operators.shape;
        if depth == 0 {
            let across = &operators.root;
            across.forward(fields, shape, side, &boxes, &[0], waves);
            for (potential, root) in waves.chunks_exact(across.transform.waves_len()).enumerate() {
                let waves_of = |_, out: &mut [f64]| out.copy_from_slice(root);
                across.backward(shape, potential, &mut boxes, &[0], waves_of);
            }
            return;
        }
        let across = &operators.level;
        swept.resize_with(fields.potentials, Default::default);
        for (number, slab) in self.levels[depth].iter().enumerate() {
            across.forward(fields, shape, side, &boxes, &slab.sources, waves);
            let batches = slab.targets.len().div_ceil(BATCH);
            for (potential, swept) in swept.iter_mut().enumerate() {
                swept.rotate_right(1);
                operators
                    .turns
                    .sweep(slab, potential, fields.potentials, waves, &mut swept[0]);
                operators
                    .turns
                    .gather(slab, &swept[..3.min(number + 1)], gathered);
                let waves_of =
                    |batch, out: &mut [f64]| operators.turns.batch(gathered, batch, batches, out);
                across.backward(shape, potential, &mut boxes, &slab.targets, waves_of);
            }
        }
    }

    /// Adds the potentials of the parents to those of one level.
    fn down(
        &self,
        operators: &Operators,
        fields: Fields,
        tree: &Tree,
        grids: &mut Grids,
        depth: usize,
    ) {
        let len = operators.shape.len(fields.most());
        let (coarse, fine) = grids.levels.split_at_mut(depth);
        let parents = &coarse[depth - 1];
        let level = &tree.levels[depth];
        fine[0]
            .par_chunks_exact_mut(len)
            .zip(&level.boxes)
            .for_each_init(
                || operators.transfer.scratch(),
                |scratch, (grid, gridded)| {
                    if gridded.targets.is_empty() {
                        return;
                    }
                    dispatch(Handing {
                        up: false,
                        fields: fields.potentials,
                        octant: gridded.octant,
                        from: &parents[gridded.parent as usize * len..][..len],
                        to: grid,
                        operators,
                        scratch,
                    });
                },
            );
    }

    /// Adds to `outputs`, columns over the targets in the tree's order, first the potentials, then
    /// the derivatives of as many of them as there are outputs left.
    pub fn read(
        &self,
        operators: &Operators,
        fields: Fields,
        tree: &Tree,
        grids: &Grids,
        outputs: &mut [Vec<f64>],
    ) {
        let points = tree.target_points();
        let mut parts = self.parts(tree, outputs);
        let len = operators.shape.len(fields.most());
        let numbers = fields.potentials * if fields.gradients { 4 } else { 1 };
        parts
            .par_iter_mut()
            .for_each_init(Vec::new, |values, (leaf, columns)| {
                let [depth, number] = self.homes[*leaf as usize].map(|at| at as usize);
                let level = &tree.levels[depth];
                let targets = tree.leaves[*leaf as usize].targets.clone();
                let range = targets.start as usize..targets.end as usize;
                let grid = &grids.levels[depth][number * len..]
                    [..fields.potentials * operators.shape.field()];
                values.clear();
                values.resize(range.len() * numbers, 0.0);
                let cube = Cube {
                    center: level.boxes[number].center,
                    side: level.side,
                };
                let positions = points.positions.each_ref().map(|x| &x[range.clone()]);
                interpolate(operators, fields, cube, positions, grid, values);
                for (column, out) in columns.iter_mut().enumerate() {
                    for (out, values) in out.iter_mut().zip(values.chunks_exact(numbers)) {
                        *out += values[column];
                    }
                }
            });
    }

    /// The outputs cut into the leaves with targets.
    fn parts<'a>(
        &self,
        tree: &Tree,
        outputs: &'a mut [Vec<f64>],
    ) -> Vec<(u32, Vec<&'a mut [f64]>)> {
        let mut leaves: Vec<u32> = (0..tree.leaves.len() as u32).collect();
        leaves.retain(|&leaf| !tree.leaves[leaf as usize].targets.is_empty());
        leaves.sort_unstable_by_key(|&leaf| tree.leaves[leaf as usize].targets.start);
        let mut rest: Vec<&mut [f64]> = outputs.iter_mut().map(|column| &mut column[..]).collect();
        let cut = leaves.into_iter().map(|leaf| {
            let count = tree.leaves[leaf as usize].targets.len();
            let own = rest.iter_mut().map(|column| {
                let (own, others) = std::mem::take(column).split_at_mut(count);
                *column = others;
                own
            });
            (leaf, own.collect())
        });
        cut.collect()
    }
}

/// Lays the charges of the points in `range` on the grid of their box.
fn spread(
    operators: &Operators,
    fields: Fields,
    cube: Cube,
    points: &SortedPoints,
    charges: &Charges,
    range: Range<usize>,
    grid: &mut [f64],
) {
    let window = &operators.window;
    let grid = &mut grid[..fields.densities * operators.shape.field()];
    let positions = points.positions.each_ref().map(|x| &x[range.clone()]);
    let charge = |density: usize| &charges[density][range.clone()];
    let dipole = |density: usize| {
        [0, 1, 2].map(|axis| &charges[fields.densities + 3 * density + axis][range.clone()])
    };
    let none: [&[f64]; 3] = [&[]; 3];
    match (fields.densities, fields.dipoles) {
        (1, false) => {
            gridding::spread::<1, false>(window, cube, positions, [charge(0)], [none], grid)
        }
        (3, false) => {
            gridding::spread::<3, false>(
                window,
                cube,
                positions,
                [0, 1, 2].map(charge),
                [none; 3],
                grid,
            );
        }
        (4, true) => {
            let fields = [0, 1, 2, 3];
            gridding::spread::<4, true>(
                window,
                cube,
                positions,
                fields.map(charge),
                fields.map(dipole),
                grid,
            );
        }
        other => unreachable!("no kernel has {other:?}"),
    }
}

/// Potentials of a box's grid at points in it.
fn interpolate(
    operators: &Operators,
    fields: Fields,
    cube: Cube,
    positions: [&[f64]; 3],
    grid: &[f64],
    values: &mut [f64],
) {
    let window = &operators.window;
    match (fields.potentials, fields.gradients) {
        (1, false) => gridding::interpolate::<1, false>(window, cube, positions, grid, values),
        (1, true) => gridding::interpolate::<1, true>(window, cube, positions, grid, values),
        (3, false) => gridding::interpolate::<3, false>(window, cube, positions, grid, values),
        (4, false) => gridding::interpolate::<4, false>(window, cube, positions, grid, values),
        (4, true) => gridding::interpolate::<4, true>(window, cube, positions, grid, values),
        other => unreachable!("no kernel has {other:?}"),
    }
}

/// All fields of a box between its grid and its parent's.
struct Handing<'a> {
    up: bool,
    fields: usize,
    octant: u8,
    from: &'a [f64],
    to: &'a mut [f64],
    operators: &'a Operators,
    scratch: &'a mut crate::transfer::TransferScratch,
}

impl WithIsa for Handing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        let transfer = &self.operators.transfer;
        let field = self.operators.shape.field();
        let fields = self
            .from
            .chunks_exact(field)
            .zip(self.to.chunks_exact_mut(field));
        for (from, to) in fields.take(self.fields) {
            if self.up {
                transfer.up(simd, self.octant, from, to, self.scratch);
            } else {
                transfer.down(simd, self.octant, from, to, self.scratch);
            }
        }
    }
}

#[cfg(test)]
mod tests;
