//! Factors of the modal matrices: they belong to the shape, and serve every body of that shape and
//! every right-hand side.

use std::time::Instant;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{MatMut, MatRef, Par};
use panel_quadrature::QuadratureError;
use rayon::prelude::*;

use super::discretization::Discretization;
use super::matrix::ModalMatrices;
use super::storage::Storage;
use super::surface::SurfaceModes;
use crate::progress::Progress;

/// LU factors of every mode's matrix.
#[derive(Debug)]
pub struct ModalFactors {
    /// Mode after mode, both factors in the matrix's place, column by column.
    packed: Storage,
    /// Mode after mode, the permutation of the rows.
    permutations: Vec<Permutation>,
    unknowns: usize,
    /// Square roots of the quadrature weights, node after node.
    root_weights: Vec<f64>,
}

/// Wall-clock time of the stages.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seconds {
    /// Assembling the matrices.
    pub assemble: f64,
    /// Factoring them.
    pub factor: f64,
}

/// A permutation and its inverse.
#[derive(Clone, Debug)]
pub struct Permutation {
    forward: Vec<usize>,
    backward: Vec<usize>,
}

/// Factors an `n` by `n` matrix, given column by column, in its place.
pub fn factor_in_place(columns: &mut [f64], n: usize) -> Permutation {
    let (mut forward, mut backward) = (vec![0; n], vec![0; n]);
    let scratch = factor::lu_in_place_scratch::<usize, f64>(n, n, Par::Seq, Default::default());
    factor::lu_in_place(
        MatMut::from_column_major_slice_mut(columns, n, n),
        &mut forward,
        &mut backward,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
        Default::default(),
    );
    Permutation { forward, backward }
}

/// Solves with the transpose of the matrix that was factored.
pub fn solve_transpose(packed: &[f64], permutation: &Permutation, columns: MatMut<'_, f64>) {
    let n = permutation.forward.len();
    let packed = MatRef::from_column_major_slice(packed, n, n);
    let scratch =
        solve::solve_transpose_in_place_scratch::<usize, f64>(n, columns.ncols(), Par::Seq);
    solve::solve_transpose_in_place(
        packed,
        packed,
        PermRef::new_checked(&permutation.forward, &permutation.backward, n),
        columns,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
    );
}

/// Solves with the matrix that was factored.
fn solve_plain(packed: &[f64], permutation: &Permutation, columns: MatMut<'_, f64>) {
    let n = permutation.forward.len();
    let packed = MatRef::from_column_major_slice(packed, n, n);
    let scratch = solve::solve_in_place_scratch::<usize, f64>(n, columns.ncols(), Par::Seq);
    solve::solve_in_place(
        packed,
        packed,
        PermRef::new_checked(&permutation.forward, &permutation.backward, n),
        columns,
        Par::Seq,
        MemStack::new(&mut MemBuffer::new(scratch)),
    );
}

impl ModalFactors {
    /// Assembles and factors matrices; `assemble` is given what to call after each target node.
    ///
    /// # Errors
    /// Those of `assemble`.
    pub fn assembled(
        discretization: &Discretization,
        progress: &dyn Progress,
        assemble: impl FnOnce(&(dyn Fn() + Sync)) -> Result<ModalMatrices, QuadratureError>,
    ) -> Result<(Self, Seconds), QuadratureError> {
        let done = || progress.advance(1);
        let start = Instant::now();
        progress.begin("assembling", discretization.nodes().len());
        let matrices = assemble(&done)?;
        let assemble = start.elapsed().as_secs_f64();
        let start = Instant::now();
        progress.begin("factoring", matrices.modes());
        let factors = Self::new(matrices, discretization, &done);
        let factor = start.elapsed().as_secs_f64();
        Ok((factors, Seconds { assemble, factor }))
    }

    /// Factors the matrices, one mode per task; `done` is called after each.
    pub fn new(
        matrices: ModalMatrices,
        discretization: &Discretization,
        done: &(dyn Fn() + Sync),
    ) -> Self {
        let unknowns = matrices.unknowns();
        let mut packed = matrices.into_transposed_columns();
        let permutations = packed
            .as_mut_slice()
            .par_chunks_mut(unknowns * unknowns)
            .map(|columns| {
                let permutation = factor_in_place(columns, unknowns);
                done();
                permutation
            })
            .collect();
        let nodes = discretization.nodes().iter();
        let root_weights = nodes.map(|node| node.weight.sqrt()).collect();
        Self {
            packed,
            permutations,
            unknowns,
            root_weights,
        }
    }

    /// Modes, counting the zeroth.
    pub fn count(&self) -> usize {
        self.permutations.len()
    }

    /// Unknowns of all modes: those of each mode's matrix for two families, one for mode 0.
    pub fn unknowns(&self) -> usize {
        self.unknowns * (2 * self.count() - 1)
    }

    /// The density whose potential has the boundary values `data`; modes of `data` beyond the
    /// factors' are left out.
    pub fn solve(&self, data: &SurfaceModes) -> SurfaceModes {
        let nodes = data.nodes();
        let mut density = SurfaceModes::zero(self.count() - 1, nodes);
        let packed = self
            .packed
            .as_slice()
            .par_chunks(self.unknowns * self.unknowns);
        let factors = packed.zip(&self.permutations);
        let shared = factors
            .zip(density.par_families_mut())
            .enumerate()
            .take(data.modes());
        shared.for_each(|(n, ((packed, permutation), columns))| {
            columns.copy_from_slice(data.families(n));
            if columns.iter().all(|&x| x == 0.0) {
                return;
            }
            self.scale(columns, |x, root| x * root);
            // The factors are the transposed matrix's.
            let columns_of_both = MatMut::from_column_major_slice_mut(columns, self.unknowns, 2);
            solve_transpose(packed, permutation, columns_of_both);
            self.scale(columns, |x, root| x / root);
        });
        density
    }

    /// Solves in place for columns of mode `n` that are scaled by the roots of the weights, any
    /// number of them.
    pub fn solve_scaled(&self, n: usize, columns: MatMut<'_, f64>) {
        let size = self.unknowns * self.unknowns;
        // The factors are the transposed matrix's.
        let packed = &self.packed.as_slice()[n * size..][..size];
        solve_transpose(packed, &self.permutations[n], columns);
    }

    /// Solves in place with the transposes of the matrices, for columns of mode `n` that are scaled
    /// by the roots of the weights: what a linear functional of the density is as one of the
    /// boundary values.
    pub fn solve_transposed_scaled(&self, n: usize, columns: MatMut<'_, f64>) {
        let size = self.unknowns * self.unknowns;
        // The factors are the transposed matrix's.
        let packed = &self.packed.as_slice()[n * size..][..size];
        solve_plain(packed, &self.permutations[n], columns);
    }

    fn scale(&self, columns: &mut [f64], by: impl Fn(f64, f64) -> f64) {
        for component in columns.chunks_mut(self.root_weights.len()) {
            for (x, &root) in component.iter_mut().zip(&self.root_weights) {
                *x = by(*x, root);
            }
        }
    }
}
