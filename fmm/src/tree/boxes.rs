//! Boxes with grids, leaves, and what the targets of a leaf see directly.

use std::ops::Range;

#[derive(Clone, Debug)]
pub(crate) struct Level {
    /// Side of its boxes.
    pub side: f64,
    /// In Morton order of their places.
    pub boxes: Vec<GriddedBox>,
}

#[derive(Clone, Debug)]
pub(crate) struct GriddedBox {
    /// The centre. It is exact, and so are differences of centres. A point of the box lies within
    /// half a side of it, up to the point's rounding error.
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
    /// Its children with grids, as indices of the level below.
    pub children: Range<u32>,
    /// Its children without grids, as indices of `Tree::leaves`.
    pub leaves: Range<u32>,
}

#[derive(Clone, Debug)]
pub(crate) struct Leaf {
    pub sources: Range<u32>,
    pub targets: Range<u32>,
    /// What its targets see directly, the leaf itself included, in the order of the sources.
    pub near: Vec<Near>,
}

/// Sources within the reach of a residual.
#[derive(Clone, Debug)]
pub(crate) struct Near {
    pub sources: Range<u32>,
    /// Length of the residual.
    pub reach: f64,
}
