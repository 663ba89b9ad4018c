//! Points in the order of the tree.

/// Points in the tree's order: every box and every leaf holds a contiguous range of them.
#[derive(Clone, Debug, Default)]
pub(crate) struct SortedPoints {
    /// `order[i]` is the number, in the user's order, of the point that is number `i` in the tree's
    /// order.
    pub order: Vec<u32>,
    /// Coordinates, in the tree's order.
    pub positions: [Vec<f64>; 3],
}
