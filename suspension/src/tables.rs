//! What depends on a shape, its resolution and its layers alone: made once, shared by all bodies that are alike in them.

use std::sync::{Arc, OnceLock};

use faer::MatMut;
use panel_quadrature::QuadratureError;
use rayon::prelude::*;

use super::upsampling::{self, Upsampling};
use bodies_of_revolution::Frame;
use stokes_body::discretization::Discretization;
use stokes_body::influence::Influence;
use stokes_body::layers::LayerWeights;
use stokes_body::matrix::ModalMatrices;
use stokes_body::surface_grid::SurfaceGrid;

/// Tables of one shape at one resolution, for the flow $w_D D[\sigma] + w_S S[\sigma]$ of a density, in the body's frame.
#[derive(Debug)]
pub(crate) struct Tables {
    pub discretization: Discretization,
    pub n_max: usize,
    pub weights: LayerWeights,
    pub grid: SurfaceGrid,
    pub influence: Influence,
    /// Made when they are first wanted: few problems need all.
    upsamplings: [OnceLock<Arc<Upsampling>>; upsampling::LEVELS],
    point_sum: OnceLock<ModalMatrices>,
}

impl Tables {
    /// The tables for modes up to `n_max`.
    pub fn new(
        discretization: Discretization,
        n_max: usize,
        weights: LayerWeights,
    ) -> Result<Self, QuadratureError> {
        Ok(Self {
            influence: Influence::new(discretization.order(), n_max)?,
            upsamplings: Default::default(),
            point_sum: OnceLock::new(),
            grid: SurfaceGrid::new(&discretization, n_max),
            n_max,
            weights,
            discretization,
        })
    }

    /// The body with more points; levels go from few to many.
    pub fn upsampling(&self, level: usize) -> Result<Arc<Upsampling>, QuadratureError> {
        let made = &self.upsamplings[level];
        if let Some(upsampling) = made.get() {
            return Ok(upsampling.clone());
        }
        let upsampling = Upsampling::new(&self.discretization, self.n_max, level)?;
        Ok(made.get_or_init(|| Arc::new(upsampling)).clone())
    }

    /// What the sum over the body's points does at those points.
    pub fn point_sum(&self) -> &ModalMatrices {
        self.point_sum.get_or_init(|| self.new_point_sum())
    }

    /// The same for those who need it once: it is not kept.
    pub fn new_point_sum(&self) -> ModalMatrices {
        let azimuths = self.grid.azimuths();
        ModalMatrices::of_point_sum(&self.discretization, self.weights, self.n_max, azimuths)
    }
}

/// A body: its tables, and where it is.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub tables: Arc<Tables>,
    pub frame: Frame,
}

/// Where each body's numbers are in a vector for all of them.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// The bodies' first numbers, and the end.
    starts: Vec<usize>,
}

impl Layout {
    /// Bodies with so many numbers each, one after the other.
    pub fn new(lengths: impl Iterator<Item = usize>) -> Self {
        let mut starts = vec![0];
        for length in lengths {
            starts.push(starts[starts.len() - 1] + length);
        }
        Self { starts }
    }

    /// Numbers of all bodies.
    pub fn len(&self) -> usize {
        self.starts[self.starts.len() - 1]
    }

    /// Where a body's numbers are.
    pub fn of(&self, body: usize) -> std::ops::Range<usize> {
        self.starts[body]..self.starts[body + 1]
    }

    /// Every body's part of a vector.
    pub fn split<'v, T>(&self, mut vector: &'v mut [T]) -> Vec<&'v mut [T]> {
        let mut parts = Vec::with_capacity(self.starts.len() - 1);
        for pair in self.starts.windows(2) {
            let (part, rest) = vector.split_at_mut(pair[1] - pair[0]);
            parts.push(part);
            vector = rest;
        }
        parts
    }
}

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

    /// Applies to the columns of each mode of each body, in place, a matrix of its tables: `operator` is given a body that has those tables, the mode, the
    /// columns, and room.
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
