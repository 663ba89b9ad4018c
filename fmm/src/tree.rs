//! The adaptive tree: boxes that carry grids, level by level, and the leaf cells that hang off
//! them.

mod boxes;
mod costs;
mod near;
mod points;
mod refine;
mod root;
mod sorting;
#[cfg(test)]
mod tests;

use rayon::prelude::*;
use refine::Cells;
use root::Root;
use sorting::Keys;

pub(crate) use boxes::{GriddedBox, Leaf, Level, Near};
pub(crate) use costs::Costs;
pub(crate) use points::SortedPoints;

/// Points that are enough to choose the side of the root by,
const SAMPLE: usize = 1 << 15;
/// of no more than one of so many.
const SAMPLE_STRIDE: usize = 4;
/// Targets whose sources within reach are counted to estimate the cost of a tree.
const COUNTED: usize = 512;

/// Boxes with grids, and leaves, over sources and targets.
///
/// Level $\ell$ has boxes of side $L_\ell = L_0 / 2^\ell$. A box carries a grid ("is gridded") if
/// it is the root, or if its parent is gridded and refining pays. The difference kernel of level
/// $\ell$ acts between all gridded colleagues (boxes of one level that share a corner, and the box
/// itself). Those children of a gridded box of level $\ell$ that are not gridded are leaves, of
/// side $L_{\ell+1}$. Two points in leaves of sides $L$ and $L'$ interact directly by the residual
/// of length $\max(L, L')$.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub sources: SortedPoints,
    /// `None` if the targets are the sources; ranges of targets are then those of the sources.
    pub targets: Option<SortedPoints>,
    /// Finest last; `levels[0]` is the root alone.
    pub levels: Vec<Level>,
    pub leaves: Vec<Leaf>,
}

impl Tree {
    /// The tree over finite points, refined where that pays according to `costs`. Without
    /// `targets`, the targets are the sources.
    ///
    /// The root may be up to twice as large as the points need, so that the sides of leaves are not
    /// limited to powers of two times the extent. A few sides are tried on a sample of the points,
    /// and the side with the cheapest tree is taken.
    pub fn new(sources: &[[f64; 3]], targets: Option<&[[f64; 3]]>, costs: &Costs) -> Tree {
        let roots = Root::candidates(sources, targets);
        let points = sources.len() + targets.map_or(0, <[_]>::len);
        let stride = points.div_ceil(SAMPLE).max(SAMPLE_STRIDE);
        let thinned_sources = sorting::thinned(sources, stride);
        let thinned_targets = targets.map(|targets| sorting::thinned(targets, stride));
        let thinned_costs = costs.thinned(stride as f64);
        let cost = |root: &Root| {
            Tree::inside(
                root,
                &thinned_sources,
                thinned_targets.as_deref(),
                &thinned_costs,
            )
            .cost(&thinned_costs)
        };
        let times: Vec<f64> = roots.par_iter().map(cost).collect();
        let best = (0..roots.len())
            .min_by(|&a, &b| times[a].total_cmp(&times[b]))
            .unwrap_or(0);
        Tree::inside(&roots[best], sources, targets, costs)
    }

    /// The tree that has the given root.
    fn inside(
        root: &Root,
        sources: &[[f64; 3]],
        targets: Option<&[[f64; 3]]>,
        costs: &Costs,
    ) -> Tree {
        let (sources, source_keys) = sorting::sorted(sources, root);
        let (targets, target_keys) = targets
            .map(|targets| sorting::sorted(targets, root))
            .unzip();
        let keys = Keys {
            sources: &source_keys,
            targets: target_keys.as_deref(),
        };
        let cells = Cells::new(&keys, root.finest, costs);
        let (levels, mut leaves) = cells.boxes_and_leaves(root);
        near::fill(&mut leaves, &cells, root, &sources, targets.as_ref());
        Tree {
            sources,
            targets,
            levels,
            leaves,
        }
    }

    /// Coordinates of the targets, be they the sources or not.
    pub fn target_points(&self) -> &SortedPoints {
        self.targets.as_ref().unwrap_or(&self.sources)
    }

    /// Pairs within the reach of their residuals, counted for some of the targets.
    pub fn pairs(&self) -> f64 {
        let positions = &self.target_points().positions;
        let targets = positions[0].len();
        let stride = targets.div_ceil(COUNTED).max(1);
        let mut counted = 0;
        let mut pairs = 0;
        for leaf in &self.leaves {
            let first = (leaf.targets.start as usize).next_multiple_of(stride);
            for i in (first..leaf.targets.end as usize).step_by(stride) {
                let target = positions.each_ref().map(|x| x[i]);
                pairs += leaf
                    .near
                    .iter()
                    .map(|near| self.within(target, near))
                    .sum::<usize>();
                counted += 1;
            }
        }
        pairs as f64 * targets as f64 / f64::max(counted as f64, 1.0)
    }

    /// How many of the sources are within reach of a point.
    fn within(&self, point: [f64; 3], near: &Near) -> usize {
        let range = near.sources.start as usize..near.sources.end as usize;
        let [x, y, z] = self.sources.positions.each_ref().map(|x| &x[range.clone()]);
        let reach = near.reach * near.reach;
        let mut within = 0;
        for i in 0..x.len() {
            let (dx, dy, dz) = (x[i] - point[0], y[i] - point[1], z[i] - point[2]);
            within += usize::from(dx * dx + dy * dy + dz * dz < reach);
        }
        within
    }

    /// Estimated time of a sum in nanoseconds on one thread.
    pub fn cost(&self, costs: &Costs) -> f64 {
        let points = self.sources.order.len() + self.target_points().order.len();
        let boxes = self
            .levels
            .iter()
            .map(|level| level.boxes.len())
            .sum::<usize>();
        self.pairs() * costs.pair + boxes as f64 * costs.grid + 0.5 * points as f64 * costs.point
    }
}
