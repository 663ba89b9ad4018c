//! Fast sums of one kernel: a plan for the points, then any number of applications.

use std::marker::PhantomData;
use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;

use crate::direct::{Problem, records};
use crate::far::{Far, Fields};
use crate::far_field::{Charges, FarField, Grids};
use crate::kernel::MOST;
use crate::near_field::NearField;
use crate::operators::Operators;
use crate::tree::{SortedPoints, Tree};

/// Strengths of a source by its number in the user's order, in the layout of the kernel.
pub(crate) type Strength<'a> = &'a (dyn Fn(usize) -> [f64; MOST] + Sync);

/// Sums over points that are planned for.
pub(crate) trait Planned: Send + Sync {
    /// The kernel's numbers, one column each, over the targets in the user's order.
    fn apply(&self, strength: Strength<'_>) -> Vec<Vec<f64>>;
}

/// Points in the plan's lengths: the largest distance along an axis is between 1 and 2.
pub(crate) struct Scaled {
    pub sources: Vec<[f64; 3]>,
    pub targets: Option<Vec<[f64; 3]>>,
}

impl Scaled {
    /// Whether all points are in one place.
    fn together(&self) -> bool {
        let mut all = self.sources.iter().chain(self.targets.iter().flatten());
        let first = all.next();
        all.all(|point| Some(point) == first)
    }
}

/// Points in one place: none has an effect on any.
struct Together {
    targets: usize,
    outputs: usize,
}

impl Planned for Together {
    fn apply(&self, _: Strength<'_>) -> Vec<Vec<f64>> {
        vec![vec![0.0; self.targets]; self.outputs]
    }
}

/// The cheaper of the fast and the direct sum over these points.
pub(crate) fn plan<K: Far>(points: Scaled, operators: Arc<Operators>) -> Box<dyn Planned> {
    if points.together() {
        let targets = points.targets.as_ref().unwrap_or(&points.sources).len();
        return Box::new(Together {
            targets,
            outputs: K::OUTPUTS,
        });
    }
    let costs = operators.costs;
    let targets = points.targets.as_ref().unwrap_or(&points.sources);
    let direct = points.sources.len() as f64 * targets.len() as f64 * costs.direct;
    // A tree of one box never beats the direct sum.
    if direct < costs.tree.grid {
        return Box::new(Directly::<K> {
            points,
            operators,
            kernel: PhantomData,
        });
    }
    let tree = Tree::new(&points.sources, points.targets.as_deref(), &costs.tree);
    if direct < tree.cost(&costs.tree) {
        return Box::new(Directly::<K> {
            points,
            operators,
            kernel: PhantomData,
        });
    }
    Box::new(Plan::<K>::new(operators, tree))
}

/// Sums so small that the direct sum takes less time.
struct Directly<K> {
    points: Scaled,
    operators: Arc<Operators>,
    kernel: PhantomData<fn() -> K>,
}

impl<K: Far> Planned for Directly<K> {
    fn apply(&self, strength: Strength<'_>) -> Vec<Vec<f64>> {
        let Scaled { sources, targets } = &self.points;
        let targets = targets.as_ref().unwrap_or(sources);
        let problem = Problem {
            records: records(sources, 1.0, K::STRENGTHS, strength),
            targets: targets.clone(),
            precision: self.operators.parameters.precision,
        };
        let columns = problem.sum::<K>();
        let column = |output| {
            (0..targets.len())
                .map(|target| columns.at(target, output))
                .collect()
        };
        (0..K::OUTPUTS).map(column).collect()
    }
}

/// Fast sums of the kernel `K` over one set of points.
pub(crate) struct Plan<K> {
    operators: Arc<Operators>,
    tree: Tree,
    near: NearField,
    far: FarField,
    /// Grids of earlier applications, used again: getting fresh memory costs more than clearing
    /// grids.
    grids: Mutex<Vec<Grids>>,
    kernel: PhantomData<fn() -> K>,
}

impl<K: Far> Plan<K> {
    pub fn new(operators: Arc<Operators>, tree: Tree) -> Self {
        let near = NearField::new(&tree, &operators.mollified, operators.parameters.precision);
        let far = FarField::new(&tree);
        Self {
            operators,
            tree,
            near,
            far,
            grids: Mutex::default(),
            kernel: PhantomData,
        }
    }

    fn targets(&self) -> &SortedPoints {
        self.tree.targets.as_ref().unwrap_or(&self.tree.sources)
    }

    /// Charges and dipoles of all sources.
    fn charges(&self, strengths: &[Vec<f64>]) -> Charges {
        const BLOCK: usize = 4096;
        let count = self.tree.sources.order.len();
        let columns = if K::DIPOLES { 4 } else { 1 } * K::DENSITIES;
        let mut charges = vec![vec![0.0; count]; columns];
        let mut blocks: Vec<Vec<&mut [f64]>> = Vec::new();
        blocks.resize_with(count.div_ceil(BLOCK), Vec::new);
        for column in &mut charges {
            let parts = column.chunks_mut(BLOCK);
            blocks
                .iter_mut()
                .zip(parts)
                .for_each(|(block, part)| block.push(part));
        }
        blocks
            .par_iter_mut()
            .enumerate()
            .for_each(|(number, block)| {
                let mut strength = [0.0; MOST];
                for i in 0..block[0].len() {
                    for (value, column) in strength.iter_mut().zip(strengths) {
                        *value = column[number * BLOCK + i];
                    }
                    let (charge, dipole) = K::charges(&strength);
                    for density in 0..K::DENSITIES {
                        block[density][i] = charge[density];
                        for axis in 0..if K::DIPOLES { 3 } else { 0 } {
                            block[K::DENSITIES + 3 * density + axis][i] = dipole[density][axis];
                        }
                    }
                }
            });
        charges
    }
}

impl<K: Far> Planned for Plan<K> {
    fn apply(&self, strength: Strength<'_>) -> Vec<Vec<f64>> {
        let order = &self.tree.sources.order;
        let mut strengths = vec![vec![0.0; order.len()]; K::STRENGTHS];
        for (place, &number) in order.iter().enumerate() {
            let strength = strength(number as usize);
            for (column, value) in strengths.iter_mut().zip(strength) {
                column[place] = value;
            }
        }
        let charges = self.charges(&strengths);
        let mut grids = self
            .grids
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .pop()
            .unwrap_or_default();
        self.far.fill(
            &self.operators,
            Fields::of::<K>(),
            &self.tree,
            &charges,
            &mut grids,
        );
        drop(charges);
        let order = &self.targets().order;
        let mut outputs = vec![vec![0.0; order.len()]; K::OUTPUTS];
        self.far.read(
            &self.operators,
            Fields::of::<K>(),
            &self.tree,
            &grids,
            &mut outputs,
        );
        self.grids
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(grids);
        self.near.add::<K>(&strengths, &mut outputs);
        drop(strengths);
        let unsorted = outputs.par_iter().map(|sorted| {
            let mut column = vec![0.0; order.len()];
            for (&number, value) in order.iter().zip(sorted) {
                column[number as usize] = *value;
            }
            column
        });
        unsorted.collect()
    }
}
