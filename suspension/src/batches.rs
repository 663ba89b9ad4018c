//! Bodies that are alike go through a matrix together.

use std::sync::Arc;

use faer::MatMut;
use rayon::prelude::*;
use stokes_body::matrix::ModalMatrices;

use super::layout::Layout;
use super::tables::{Member, Tables};

/// Bodies that have the same tables, a few at a time: their columns go through a matrix together.
#[derive(Debug)]
pub(crate) struct Batches {
    batches: Vec<Batch>,
}

#[derive(Clone, Debug)]
struct Batch {
    tables: Arc<Tables>,
    bodies: Vec<usize>,
}

/// Bodies of a batch: enough that the matrix is read from memory seldom.
const BATCH: usize = 16;

impl Batches {
    /// The batches of some bodies.
    pub fn new(members: &[Member]) -> Self {
        let mut classes: Vec<Batch> = Vec::new();
        for (body, member) in members.iter().enumerate() {
            let known = classes
                .iter_mut()
                .find(|class| Arc::ptr_eq(&class.tables, &member.tables));
            match known {
                Some(class) => class.bodies.push(body),
                None => classes.push(Batch {
                    tables: member.tables.clone(),
                    bodies: vec![body],
                }),
            }
        }
        let batches = classes.iter().flat_map(|class| {
            class.bodies.chunks(BATCH).map(|bodies| Batch {
                tables: class.tables.clone(),
                bodies: bodies.to_vec(),
            })
        });
        Self {
            batches: batches.collect(),
        }
    }

    /// Class by class.
    pub fn by_tables(&self) -> impl Iterator<Item = (&Tables, Self)> {
        let alike = |batches: &[Batch]| Self {
            batches: batches.to_vec(),
        };
        let same = |a: &Batch, b: &Batch| Arc::ptr_eq(&a.tables, &b.tables);
        let classes = self.batches.chunk_by(same);
        classes.map(move |batches| (&*batches[0].tables, alike(batches)))
    }

    /// Applies to the columns of each mode of each body, in place, a matrix of its tables:
    /// `operator` is given a body that has those tables, the mode, the columns, and room.
    pub fn apply(
        &self,
        layout: &Layout,
        fields: &mut [f64],
        operator: impl Fn(usize, usize, MatMut<'_, f64>, &mut Vec<f64>) + Sync,
    ) {
        let mut parts: Vec<Option<&mut [f64]>> =
            layout.split(fields).into_iter().map(Some).collect();
        let tasks: Vec<(&Batch, Vec<&mut [f64]>)> = self
            .batches
            .iter()
            .map(|batch| {
                let fields = batch.bodies.iter().filter_map(|&body| parts[body].take());
                (batch, fields.collect())
            })
            .collect();
        tasks.into_par_iter().for_each_init(
            || (Vec::new(), Vec::new()),
            |(columns, scratch), (batch, mut fields)| {
                let unknowns = 3 * batch.tables.discretization.nodes().len();
                for n in 0..=batch.tables.n_max {
                    columns.clear();
                    for field in &fields {
                        columns.extend_from_slice(&field[2 * n * unknowns..][..2 * unknowns]);
                    }
                    let all =
                        MatMut::from_column_major_slice_mut(columns, unknowns, 2 * fields.len());
                    operator(batch.bodies[0], n, all, scratch);
                    for (field, columns) in fields.iter_mut().zip(columns.chunks(2 * unknowns)) {
                        field[2 * n * unknowns..][..2 * unknowns].copy_from_slice(columns);
                    }
                }
            },
        );
    }
}

/// Replaces columns of mode `n` by what a matrix makes of them.
pub(crate) fn multiply(
    matrices: &ModalMatrices,
    n: usize,
    mut columns: MatMut<'_, f64>,
    scratch: &mut Vec<f64>,
) {
    let (rows, count) = (columns.nrows(), columns.ncols());
    scratch.resize(rows * count, 0.0);
    let mut product = MatMut::from_column_major_slice_mut(scratch, rows, count);
    matrices.apply_scaled(n, columns.as_ref(), product.as_mut());
    columns.copy_from(product);
}
