//! The adaptive tree: boxes that carry grids, level by level, and the leaf cells that hang off them.

use std::ops::Range;

/// Points in the tree's order: every box and every leaf holds a contiguous range of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct SortedPoints {
    /// `order[i]` is the number, in the user's order, of the point that stands at `i` in the tree's.
    pub order: Vec<u32>,
    /// Coordinates, in the tree's order.
    pub positions: [Vec<f64>; 3],
}

/// Boxes with grids, and leaves, over sources and targets.
///
/// Level $\ell$ has boxes of side $L_\ell = L_0 / 2^\ell$. A box carries a grid ("is gridded") if the root or if
/// its parent is and refining pays. The difference kernel of level $\ell$ acts between all gridded colleagues
/// (boxes of one level that share a corner, and the box itself). Those children of a gridded box of level $\ell$
/// that are not gridded themselves are leaves, of side $L_{\ell+1}$. Two points in leaves of sides $L$ and $L'$
/// interact directly by the residual of length $\max(L, L')$.
#[derive(Clone, Debug)]
pub(crate) struct Tree {
    pub sources: SortedPoints,
    /// `None` if the targets are the sources.
    pub targets: Option<SortedPoints>,
    /// Finest last; `levels[0]` is the root alone.
    pub levels: Vec<Level>,
    pub leaves: Vec<Leaf>,
}

#[derive(Clone, Debug)]
pub(crate) struct Level {
    /// Side of its boxes.
    pub side: f64,
    pub boxes: Vec<GriddedBox>,
}

#[derive(Clone, Debug)]
pub(crate) struct GriddedBox {
    pub center: [f64; 3],
    /// Place among the boxes of the level, in box sides from the corner of the root.
    pub place: [i64; 3],
    /// Index of the parent in the level above (0 for the root).
    pub parent: u32,
    /// Which child of its parent: bit `axis` is set on the upper side of that axis.
    pub octant: u8,
    /// All points inside, those of gridded children too.
    pub sources: Range<u32>,
    pub targets: Range<u32>,
    /// Its children without grids, as indices of `Tree::leaves`.
    pub leaves: Range<u32>,
}

#[derive(Clone, Debug)]
pub(crate) struct Leaf {
    /// Side of the cell, the reach of the residual between its own points.
    pub side: f64,
    pub sources: Range<u32>,
    pub targets: Range<u32>,
    /// What its targets see directly, the leaf itself included.
    pub near: Vec<Near>,
}

/// Sources within the reach of a residual.
#[derive(Clone, Debug)]
pub(crate) struct Near {
    pub sources: Range<u32>,
    /// Length of the residual.
    pub reach: f64,
}
