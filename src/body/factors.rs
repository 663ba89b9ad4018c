//! Factors of the modal matrices: they belong to the shape, and serve every body of that shape and every right-hand side.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{MatMut, MatRef, Par};
use rayon::prelude::*;

use super::discretization::Discretization;
use super::matrix::ModalMatrices;
use super::surface::SurfaceModes;

/// LU factors of every mode's matrix.
#[derive(Clone, Debug)]
pub struct ModalFactors {
    modes: Vec<Lu>,
    /// Square roots of the quadrature weights, node after node.
    root_weights: Vec<f64>,
}

/// Both factors of one matrix, in its place column by column, and the permutation of its rows.
#[derive(Clone, Debug)]
struct Lu {
    packed: Vec<f64>,
    forward: Vec<usize>,
    backward: Vec<usize>,
}

impl Lu {
    /// Factors an `n` by `n` matrix given column by column.
    fn new(mut packed: Vec<f64>, n: usize) -> Self {
        let (mut forward, mut backward) = (vec![0; n], vec![0; n]);
        let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default());
        factor::lu_in_place(
            MatMut::from_column_major_slice_mut(&mut packed, n, n),
            &mut forward,
            &mut backward,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
            Default::default(),
        );
        Self {
            packed,
            forward,
            backward,
        }
    }

    /// Solves with the transpose of the matrix that was factored.
    fn solve_transpose(&self, columns: MatMut<'_, f64>) {
        let n = self.forward.len();
        let packed = MatRef::from_column_major_slice(&self.packed, n, n);
        let scratch =
            solve::solve_transpose_in_place_scratch::<usize, f64>(n, columns.ncols(), Par::Seq);
        solve::solve_transpose_in_place(
            packed,
            packed,
            PermRef::new_checked(&self.forward, &self.backward, n),
            columns,
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
    }
}

impl ModalFactors {
    /// Factors the matrices, one mode per task; `done` is called after each.
    pub(crate) fn new(
        matrices: ModalMatrices,
        discretization: &Discretization,
        done: &(dyn Fn() + Sync),
    ) -> Self {
        let unknowns = matrices.unknowns();
        let modes = matrices
            .into_transposed_columns()
            .into_par_iter()
            .map(|columns| {
                let lu = Lu::new(columns, unknowns);
                done();
                lu
            })
            .collect();
        let root_weights = discretization
            .nodes()
            .iter()
            .map(|node| node.weight.sqrt())
            .collect();
        Self {
            modes,
            root_weights,
        }
    }

    /// Modes, counting the zeroth.
    pub fn count(&self) -> usize {
        self.modes.len()
    }

    /// The density whose potential has the boundary values `data`; modes of `data` beyond the factors' are left out.
    pub fn solve(&self, data: &SurfaceModes) -> SurfaceModes {
        let nodes = data.nodes();
        let mut density = SurfaceModes::zero(self.count() - 1, nodes);
        let shared = self
            .modes
            .par_iter()
            .zip(density.par_families_mut())
            .enumerate();
        shared.take(data.modes()).for_each(|(n, (lu, columns))| {
            columns.copy_from_slice(data.families(n));
            if columns.iter().all(|&x| x == 0.0) {
                return;
            }
            self.scale(columns, |x, root| x * root);
            // The factors are the transposed matrix's.
            lu.solve_transpose(MatMut::from_column_major_slice_mut(columns, 3 * nodes, 2));
            self.scale(columns, |x, root| x / root);
        });
        density
    }

    fn scale(&self, columns: &mut [f64], by: impl Fn(f64, f64) -> f64) {
        for component in columns.chunks_mut(self.root_weights.len()) {
            for (x, &root) in component.iter_mut().zip(&self.root_weights) {
                *x = by(*x, root);
            }
        }
    }
}
