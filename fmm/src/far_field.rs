//! The smooth part of the sums: charges to grids, up the tree, across by plane waves, down again, to the targets.

use std::ops::Range;

use f64_lanes::{Isa, WithIsa, dispatch};
use rayon::prelude::*;

use crate::far::{FIELDS, Far};
use crate::gemm::Into;
use crate::gridding::{self, Cube};
use crate::operators::Operators;
use crate::transfer::GridShape;
use crate::transform::{BATCH, Transform};
use crate::translate::Sweeps;
use crate::tree::{GriddedBox, SortedPoints, Tree};

/// Charges of the sources, in the order of the tree: for each density its charge and, behind all charges, for
/// each density its dipole along x, y and z.
pub(crate) type Charges = Vec<Vec<f64>>;

/// How the boxes of each level are gathered for their transforms.
#[derive(Clone, Debug)]
pub(crate) struct FarField {
    levels: Vec<LevelPlan>,
    /// Level and box of each leaf.
    homes: Vec<[u32; 2]>,
}

#[derive(Clone, Debug)]
struct LevelPlan {
    /// Boxes with sources.
    sources: Vec<u32>,
    /// Boxes with targets.
    targets: Vec<u32>,
    sweeps: Sweeps,
}

/// Grids of all boxes, one level after the other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grids {
    levels: Vec<Vec<f64>>,
    /// Potentials' waves of the sources of one level.
    waves: Vec<f64>,
    /// One of these fields, translated.
    translated: Vec<f64>,
}

impl FarField {
    pub fn new(tree: &Tree) -> Self {
        let levels = tree.levels.iter().map(|level| {
            let with = |full: fn(&GriddedBox) -> bool| -> Vec<u32> {
                (0..level.boxes.len() as u32)
                    .filter(|&b| full(&level.boxes[b as usize]))
                    .collect()
            };
            let sources = with(|b| !b.sources.is_empty());
            let targets = with(|b| !b.targets.is_empty());
            let places = |boxes: &[u32]| -> Vec<[i64; 3]> {
                boxes
                    .iter()
                    .map(|&b| level.boxes[b as usize].place)
                    .collect()
            };
            let sweeps = Sweeps::new(&places(&sources), &places(&targets));
            LevelPlan {
                sources,
                targets,
                sweeps,
            }
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
    pub fn fill<K: Far>(
        &self,
        operators: &Operators,
        tree: &Tree,
        charges: &Charges,
        grids: &mut Grids,
    ) {
        let shape = operators.shape;
        let len = shape.len(FIELDS.min(K::DENSITIES.max(K::POTENTIALS)));
        grids.levels.resize_with(tree.levels.len(), Vec::new);
        for (level, grids) in tree.levels.iter().zip(&mut grids.levels) {
            grids.resize(level.boxes.len() * len, 0.0);
        }
        for depth in (0..tree.levels.len()).rev() {
            self.up::<K>(operators, tree, charges, grids, depth, len);
        }
        for depth in 0..tree.levels.len() {
            self.across::<K>(operators, tree, grids, depth, len);
            if depth > 0 {
                self.down::<K>(operators, tree, grids, depth, len);
            }
        }
    }

    /// Charges of the leaves and of the children's grids on the grids of one level.
    fn up<K: Far>(
        &self,
        operators: &Operators,
        tree: &Tree,
        charges: &Charges,
        grids: &mut Grids,
        depth: usize,
        len: usize,
    ) {
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
                            spread::<K>(operators, cube, &tree.sources, charges, range, grid);
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
                            fields: K::DENSITIES,
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
    fn across<K: Far>(
        &self,
        operators: &Operators,
        tree: &Tree,
        grids: &mut Grids,
        depth: usize,
        len: usize,
    ) {
        let (level, plan) = (&tree.levels[depth], &self.levels[depth]);
        let (transform, symbol) = if depth == 0 {
            (&operators.root.transform, &operators.root.symbol)
        } else {
            (&operators.level.transform, &operators.level.symbol)
        };
        if plan.sources.is_empty() || plan.targets.is_empty() {
            return;
        }
        let Grids {
            levels,
            waves,
            translated,
        } = grids;
        let fields = &mut levels[depth];
        let batch_len = K::POTENTIALS * transform.waves_len();
        waves.resize(plan.sources.len().div_ceil(BATCH) * batch_len, 0.0);
        let shape = operators.shape;
        waves
            .par_chunks_exact_mut(batch_len)
            .zip(plan.sources.par_chunks(BATCH))
            .for_each_init(
                || {
                    (
                        transform.scratch(),
                        vec![0.0; K::DENSITIES * transform.waves_len()],
                    )
                },
                |(scratch, densities), (waves, batch)| {
                    dispatch(Forward {
                        transform,
                        shape,
                        fields,
                        len,
                        batch,
                        densities,
                        scratch,
                    });
                    dispatch(Multiply {
                        symbol,
                        side: level.side,
                        densities,
                        potentials: waves,
                    });
                },
            );
        let mut boxes: Vec<&mut [f64]> = fields
            .chunks_exact_mut(len)
            .zip(&level.boxes)
            .filter(|(_, gridded)| !gridded.targets.is_empty())
            .map(|(grid, _)| grid)
            .collect();
        let batches = plan.targets.len().div_ceil(BATCH);
        for potential in 0..K::POTENTIALS {
            let field = |batch: usize| -> &[f64] {
                &waves[batch * batch_len + potential * transform.waves_len()..]
                    [..transform.waves_len()]
            };
            if depth > 0 {
                operators.turns.translate(&plan.sweeps, field, translated);
            }
            let translated = &*translated;
            boxes.par_chunks_mut(BATCH).enumerate().for_each_init(
                || (transform.scratch(), vec![0.0; transform.waves_len()]),
                |(scratch, waves), (batch, boxes)| {
                    if depth > 0 {
                        operators.turns.batch(translated, batches, batch, waves);
                    } else {
                        waves.copy_from_slice(field(0));
                    }
                    let at = potential * shape.field();
                    let mut grids: Vec<&mut [f64]> = boxes
                        .iter_mut()
                        .map(|grid| &mut grid[at..at + shape.field()])
                        .collect();
                    dispatch(Backward {
                        transform,
                        waves,
                        grids: &mut grids,
                        stride: shape.stride(),
                        scratch,
                    });
                },
            );
        }
    }

    /// Adds the potentials of the parents to those of one level.
    fn down<K: Far>(
        &self,
        operators: &Operators,
        tree: &Tree,
        grids: &mut Grids,
        depth: usize,
        len: usize,
    ) {
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
                        fields: K::POTENTIALS,
                        octant: gridded.octant,
                        from: &parents[gridded.parent as usize * len..][..len],
                        to: grid,
                        operators,
                        scratch,
                    });
                },
            );
    }

    /// Adds the potentials and, behind them, the derivatives of as many of them as there are outputs left, to
    /// `outputs`: columns over the targets in the tree's order.
    pub fn read<K: Far>(
        &self,
        operators: &Operators,
        tree: &Tree,
        grids: &Grids,
        outputs: &mut [Vec<f64>],
    ) {
        let points = tree.target_points();
        let mut parts = self.parts(tree, outputs);
        let len = operators.shape.len(K::DENSITIES.max(K::POTENTIALS));
        let numbers = K::POTENTIALS * if K::GRADIENTS { 4 } else { 1 };
        parts
            .par_iter_mut()
            .for_each_init(Vec::new, |values, (leaf, columns)| {
                let [depth, number] = self.homes[*leaf as usize].map(|at| at as usize);
                let level = &tree.levels[depth];
                let targets = tree.leaves[*leaf as usize].targets.clone();
                let range = targets.start as usize..targets.end as usize;
                let grid =
                    &grids.levels[depth][number * len..][..K::POTENTIALS * operators.shape.field()];
                values.clear();
                values.resize(range.len() * numbers, 0.0);
                let cube = Cube {
                    center: level.boxes[number].center,
                    side: level.side,
                };
                let positions = points.positions.each_ref().map(|x| &x[range.clone()]);
                interpolate::<K>(operators, cube, positions, grid, values);
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
fn spread<K: Far>(
    operators: &Operators,
    cube: Cube,
    points: &SortedPoints,
    charges: &Charges,
    range: Range<usize>,
    grid: &mut [f64],
) {
    let window = &operators.window;
    let grid = &mut grid[..K::DENSITIES * operators.shape.field()];
    let positions = points.positions.each_ref().map(|x| &x[range.clone()]);
    let charge = |density: usize| &charges[density][range.clone()];
    let dipole = |density: usize| {
        [0, 1, 2].map(|axis| &charges[K::DENSITIES + 3 * density + axis][range.clone()])
    };
    let none: [&[f64]; 3] = [&[]; 3];
    match (K::DENSITIES, K::DIPOLES) {
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
fn interpolate<K: Far>(
    operators: &Operators,
    cube: Cube,
    positions: [&[f64]; 3],
    grid: &[f64],
    values: &mut [f64],
) {
    let window = &operators.window;
    match (K::POTENTIALS, K::GRADIENTS) {
        (1, false) => gridding::interpolate::<1, false>(window, cube, positions, grid, values),
        (1, true) => gridding::interpolate::<1, true>(window, cube, positions, grid, values),
        (3, false) => gridding::interpolate::<3, false>(window, cube, positions, grid, values),
        (4, false) => gridding::interpolate::<4, false>(window, cube, positions, grid, values),
        (4, true) => gridding::interpolate::<4, true>(window, cube, positions, grid, values),
        other => unreachable!("no kernel has {other:?}"),
    }
}

/// The waves of a batch of boxes.
struct Forward<'a> {
    transform: &'a Transform,
    shape: GridShape,
    fields: &'a [f64],
    len: usize,
    batch: &'a [u32],
    densities: &'a mut [f64],
    scratch: &'a mut crate::transform::Scratch,
}

impl WithIsa for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        for (density, waves) in self
            .densities
            .chunks_exact_mut(self.transform.waves_len())
            .enumerate()
        {
            let mut grids = [&self.fields[..0]; BATCH];
            for lane in 0..BATCH {
                // A batch that is not full repeats its last box: nobody reads those lanes.
                let number = self.batch[lane.min(self.batch.len() - 1)] as usize;
                let at = number * self.len + density * self.shape.field();
                grids[lane] = &self.fields[at..][..self.shape.field()];
            }
            self.transform
                .forward(simd, grids, self.shape.stride(), waves, self.scratch);
        }
    }
}

/// Densities to potentials.
struct Multiply<'a> {
    symbol: &'a crate::symbol::Symbol,
    side: f64,
    densities: &'a [f64],
    potentials: &'a mut [f64],
}

impl WithIsa for Multiply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        self.symbol
            .apply(simd, self.side, self.densities, self.potentials);
    }
}

/// Waves of a batch to one field of its boxes.
struct Backward<'a, 'b> {
    transform: &'a Transform,
    waves: &'a [f64],
    grids: &'a mut [&'b mut [f64]],
    stride: usize,
    scratch: &'a mut crate::transform::Scratch,
}

impl WithIsa for Backward<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        let Self {
            transform,
            waves,
            grids,
            stride,
            scratch,
        } = self;
        transform.backward(simd, waves, grids, stride, Into::Replace, scratch);
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
