//! The order in which a search looks at the parts that it cuts.

use std::cmp::Ordering;

/// A part of what is searched for the least value of something.
pub(super) trait Bounded {
    /// No value in the part is less than this.
    fn lower(&self) -> f64;
}

/// A part in a heap, which gives out the one first that may hold the least value.
pub(super) struct LeastFirst<P>(pub P);

impl<P: Bounded> PartialEq for LeastFirst<P> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl<P: Bounded> Eq for LeastFirst<P> {}

impl<P: Bounded> PartialOrd for LeastFirst<P> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<P: Bounded> Ord for LeastFirst<P> {
    /// The one that may hold the least value is the greatest.
    fn cmp(&self, other: &Self) -> Ordering {
        other.0.lower().total_cmp(&self.0.lower())
    }
}
