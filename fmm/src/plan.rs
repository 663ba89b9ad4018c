//! Fast sums of one kernel: a plan for the points, then any number of applications.

use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;

use crate::direct::{Problem, records};
use crate::dispatch::Kernel;
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
pub(crate) fn plan(
    kernel: &'static Kernel,
    points: Scaled,
    operators: Arc<Operators>,
) -> Box<dyn Planned> {
    if points.together() {
        let targets = points.targets.as_ref().unwrap_or(&points.sources).len();
        return Box::new(Together {
            targets,
            outputs: kernel.numbers.outputs,
        });
    }
    let costs = operators.costs;
    let targets = points.targets.as_ref().unwrap_or(&points.sources);
    let direct = points.sources.len() as f64 * targets.len() as f64 * costs.direct;
    // A tree of one box never beats the direct sum.
    if direct < costs.tree.grid {
        return Box::new(Directly {
            kernel,
            points,
            operators,
        });
    }
    let tree = Tree::new(&points.sources, points.targets.as_deref(), &costs.tree);
    if direct < tree.cost(&costs.tree) {
        return Box::new(Directly {
            kernel,
            points,
            operators,
        });
    }
    Box::new(Plan::new(kernel, operators, tree))
}

/// Sums so small that the direct sum takes less time.
struct Directly {
    kernel: &'static Kernel,
    points: Scaled,
    operators: Arc<Operators>,
}

impl Planned for Directly {
    fn apply(&self, strength: Strength<'_>) -> Vec<Vec<f64>> {
        let Scaled { sources, targets } = &self.points;
        let targets = targets.as_ref().unwrap_or(sources);
        let problem = Problem {
            records: records(sources, 1.0, self.kernel.numbers.strengths, strength),
            targets: targets.clone(),
            precision: self.operators.parameters.precision,
        };
        let columns = problem.sum(self.kernel);
        let column = |output| {
            (0..targets.len())
                .map(|target| columns.at(target, output))
                .collect()
        };
        (0..self.kernel.numbers.outputs).map(column).collect()
    }
}

/// Fast sums of a kernel over one set of points.
pub(crate) struct Plan {
    kernel: &'static Kernel,
    operators: Arc<Operators>,
    tree: Tree,
    near: NearField,
    far: FarField,
    /// Grids of earlier applications, used again: getting fresh memory costs more than clearing
    /// grids.
    grids: Mutex<Vec<Grids>>,
}

/// Sources whose charges one task makes.
const BLOCK: usize = 4096;

impl Plan {
    pub fn new(kernel: &'static Kernel, operators: Arc<Operators>, tree: Tree) -> Self {
        let near = NearField::new(&tree, &operators.mollified, operators.parameters.precision);
        let far = FarField::new(&tree);
        Self {
            kernel,
            operators,
            tree,
            near,
            far,
            grids: Mutex::default(),
        }
    }

    fn targets(&self) -> &SortedPoints {
        self.tree.targets.as_ref().unwrap_or(&self.tree.sources)
    }

    /// Charges and dipoles of all sources.
    fn charges(&self, strengths: &[Vec<f64>]) -> Charges {
        let count = self.tree.sources.order.len();
        let fields = self.kernel.fields;
        let columns = if fields.dipoles { 4 } else { 1 } * fields.densities;
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
                (self.kernel.lay_charges)(strengths, number * BLOCK, block);
            });
        charges
    }
}

impl Planned for Plan {
    fn apply(&self, strength: Strength<'_>) -> Vec<Vec<f64>> {
        let order = &self.tree.sources.order;
        let mut strengths = vec![vec![0.0; order.len()]; self.kernel.numbers.strengths];
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
            self.kernel.fields,
            &self.tree,
            &charges,
            &mut grids,
        );
        drop(charges);
        let order = &self.targets().order;
        let mut outputs = vec![vec![0.0; order.len()]; self.kernel.numbers.outputs];
        self.far.read(
            &self.operators,
            self.kernel.fields,
            &self.tree,
            &grids,
            &mut outputs,
        );
        self.grids
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .push(grids);
        let kernel = self.kernel;
        (self.near).add(&kernel.numbers, kernel.add_tile, &strengths, &mut outputs);
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
