//! Fast sums: a plan for the points, then any number of applications.

use std::sync::{Arc, Mutex, PoisonError};

use rayon::prelude::*;

use crate::direct;
use crate::error::FmmError;
use crate::far::Far;
use crate::far_field::{Charges, FarField, Grids};
use crate::kernel::MOST;
use crate::near_field::NearField;
use crate::operators::Operators;
use crate::tree::{SortedPoints, Tree};

/// Fast sums of one kernel over one set of points.
pub(crate) struct Fast<K> {
    operators: Arc<Operators>,
    tree: Tree,
    near: NearField,
    far: FarField,
    /// Grids of earlier applications, to be used again: large memory costs more to clear than to fill.
    grids: Mutex<Vec<Grids>>,
    kernel: std::marker::PhantomData<K>,
}

impl<K: Far> Fast<K> {
    pub fn new(operators: Arc<Operators>, sources: &[[f64; 3]], targets: Option<&[[f64; 3]]>) -> Self {
        let tree = Tree::new(sources, targets, &operators.costs::<K>());
        let near = NearField::new(&tree);
        let far = FarField::new(&tree);
        Self { operators, tree, near, far, grids: Mutex::default(), kernel: std::marker::PhantomData }
    }

    /// Sums of sources of these strengths, `K::OUTPUTS` numbers for each target, in the user's order.
    pub fn apply(&self, strength: impl Fn(usize) -> [f64; MOST] + Sync) -> Vec<f64> {
        let sources = &self.tree.sources;
        let strengths: Vec<Vec<f64>> = columns(sources, K::STRENGTHS, |index| strength(index));
        let charges = self.charges(&strengths);
        let mut grids = self.lend();
        self.far.fill::<K>(&self.operators, &self.tree, &charges, &mut grids);
        drop(charges);
        let targets = self.tree.targets.as_ref().unwrap_or(sources);
        let near = self.near.sum::<K>(&self.tree, &self.operators, &strengths);
        let out = self.gather(targets, &near, &grids);
        self.grids.lock().unwrap_or_else(PoisonError::into_inner).push(grids);
        out
    }

    fn lend(&self) -> Grids {
        self.grids.lock().unwrap_or_else(PoisonError::into_inner).pop().unwrap_or_default()
    }
}
