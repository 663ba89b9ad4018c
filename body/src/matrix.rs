//! Modal Nyström matrices of a layer potential on a surface.
//!
//! A real field is the sum over modes $n$ of two families,
//! $(\alpha \cos n\theta, \beta \sin n\theta, \gamma \cos n\theta)$ and
//! $(\alpha \sin n\theta, -\beta \cos n\theta, \gamma \sin n\theta)$ in the cylindrical components;
//! the second is the first turned about the axis. A rotationally invariant operator maps each
//! family to itself by the same real matrix: with the kernel's modes $K_{ij}(n)$
//!
//! $$ \begin{pmatrix} K_{rr} & -K_{r\theta} & K_{rz} \\\\
//!    K_{\theta r} & K_{\theta\theta} & K_{\theta z} \\\\
//!    K_{zr} & -K_{z\theta} & K_{zz} \end{pmatrix} . $$
//!
//! Only $n \ge 0$ is needed, in real arithmetic. Rows and columns carry the square roots of the
//! quadrature weights, $\sqrt{w_i} K_{ij} \sqrt{w_j}$, so that the matrix acts on $L^2$ of the
//! surface and its condition number is the operator's.

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use panel_quadrature::QuadratureError;
use rayon::prelude::*;

use super::discretization::{Discretization, Node};
use super::layers::LayerWeights;
use super::near::{NearNodes, NearRules, Sight};
use super::storage::Storage;
use super::surface::SurfaceModes;
use crate::kernel::{
    CombinedField, DoubleLayer, Kernel, Modes, SingleLayer, SingleLayerTraction, SourceRings,
    TargetRing, Workspace,
};

/// A layer potential on the surface, for viscosity 1 and as a principal value; kernels and signs as
/// in [`kernel`](crate::kernel).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum LayerPotential {
    /// The velocity of the single layer, $S$.
    Single,
    /// The velocity of the double layer, $D$.
    Double,
    /// The traction of the single layer, $T$.
    SingleTraction,
}

/// The matrices of modes $0 \dots n_\text{max}$, transposed.
///
/// Unknown $j N + k$ is component $j$ (radial, azimuthal, axial) at node $k$ of $N$.
#[derive(Debug)]
pub struct ModalMatrices {
    modes: usize,
    unknowns: usize,
    /// Mode after mode, the matrix row by row.
    rows: Storage,
}

/// The rows of one target: component `i` of mode `n` is number `3 n + i`.
pub type TargetRows<'a> = Vec<&'a mut [f64]>;

/// The sign with which entry $3 i + j$ of a kernel enters the matrix of the first family.
pub const SIGN: [f64; 9] = [1.0, -1.0, 1.0, 1.0, 1.0, 1.0, 1.0, -1.0, 1.0];

/// Consecutive columns that stand one after the other in a block, too.
struct Run {
    place: usize,
    column: usize,
    length: usize,
}

/// A thread's buffers.
#[derive(Default)]
struct Buffers {
    near: NearNodes,
    sources: SourceRings,
    columns: Vec<usize>,
    near_panels: Vec<usize>,
    runs: Vec<Run>,
    workspace: Workspace,
    interpolated: Vec<f64>,
    weighted: Vec<f64>,
}

impl ModalMatrices {
    /// The matrices of a layer potential, for modes up to `n_max`.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn of(
        layer: LayerPotential,
        discretization: &Discretization,
        n_max: usize,
    ) -> Result<Self, QuadratureError> {
        match layer {
            LayerPotential::Single => {
                Self::assemble(discretization, &SingleLayer, 0.0, n_max, &|| ())
            }
            LayerPotential::Double => {
                Self::assemble(discretization, &DoubleLayer, 0.0, n_max, &|| ())
            }
            LayerPotential::SingleTraction => {
                Self::assemble(discretization, &SingleLayerTraction, 0.0, n_max, &|| ())
            }
        }
    }

    /// The matrices of the velocity on the surface, taken from outside, of the layers
    /// $w_D D[\sigma] + w_S S[\sigma]$ of one density: of $\tfrac12 + D + w_S S$, or of $S$ for the
    /// [single layer alone](LayerWeights::SINGLE); for modes up to `n_max`.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn from_outside(
        discretization: &Discretization,
        weights: LayerWeights,
        n_max: usize,
    ) -> Result<Self, QuadratureError> {
        let LayerWeights { double, single } = weights;
        if double == 0.0 {
            return Self::assemble(discretization, &SingleLayer, 0.0, n_max, &|| ());
        }
        let kernel = CombinedField { eta: single };
        Self::assemble(discretization, &kernel, 0.5, n_max, &|| ())
    }

    /// The matrices of `identity` plus the layer potential of `kernel` (principal value), for modes
    /// up to `n_max`; `done` is called after each target node.
    pub(crate) fn assemble(
        discretization: &Discretization,
        kernel: &impl Kernel<9>,
        identity: f64,
        n_max: usize,
        done: &(dyn Fn() + Sync),
    ) -> Result<Self, QuadratureError> {
        let nodes = discretization.nodes().len();
        let mut matrices = Self::zeros(discretization, n_max);
        let engine = Modes::new(n_max);
        let rules = NearRules::new(discretization.order(), n_max)?;
        let targets = matrices.rows_by_target();
        targets.into_par_iter().enumerate().try_for_each_init(
            Buffers::default,
            |buffers, (target, mut rows)| {
                buffers.fill_rows(discretization, kernel, &engine, &rules, target, &mut rows)?;
                for (k, row) in rows.iter_mut().enumerate() {
                    row[k % 3 * nodes + target] += identity;
                }
                done();
                Ok(())
            },
        )?;
        Ok(matrices)
    }

    /// Matrices of zeros.
    pub(crate) fn zeros(discretization: &Discretization, n_max: usize) -> Self {
        let unknowns = 3 * discretization.nodes().len();
        Self {
            modes: n_max + 1,
            unknowns,
            rows: Storage::zeros((n_max + 1) * unknowns * unknowns),
        }
    }

    /// Target by target, its three rows of every mode.
    pub(crate) fn rows_by_target(&mut self) -> Vec<TargetRows<'_>> {
        let nodes = self.unknowns / 3;
        let mut targets: Vec<TargetRows<'_>> = (0..nodes)
            .map(|_| Vec::with_capacity(3 * self.modes))
            .collect();
        for (i, row) in self
            .rows
            .as_mut_slice()
            .chunks_mut(self.unknowns)
            .enumerate()
        {
            targets[i % nodes].push(row);
        }
        targets
    }

    /// The operator applied to a density: its values at the nodes, in the modes that matrices and
    /// density share.
    pub fn apply(&self, discretization: &Discretization, density: &SurfaceModes) -> SurfaceModes {
        let nodes = discretization.nodes();
        let roots: Vec<f64> = nodes.iter().map(|node| node.weight.sqrt()).collect();
        let mut values = SurfaceModes::zero(self.modes() - 1, nodes.len());
        for n in 0..self.modes().min(density.modes()) {
            let mut scaled = density.families(n).to_vec();
            for component in scaled.chunks_mut(nodes.len()) {
                (component.iter_mut().zip(&roots)).for_each(|(x, root)| *x *= root);
            }
            matmul(
                MatMut::from_column_major_slice_mut(values.families_mut(n), self.unknowns, 2),
                Accum::Replace,
                self.transposed(n).transpose(),
                MatRef::from_column_major_slice(&scaled, self.unknowns, 2),
                1.0,
                Par::Seq,
            );
            for component in values.families_mut(n).chunks_mut(nodes.len()) {
                (component.iter_mut().zip(&roots)).for_each(|(x, root)| *x /= root);
            }
        }
        values
    }

    /// The operator of mode `n` on columns that are scaled by the roots of the weights, any number
    /// of them.
    pub fn apply_scaled(&self, n: usize, columns: MatRef<'_, f64>, out: MatMut<'_, f64>) {
        matmul(
            out,
            Accum::Replace,
            self.transposed(n).transpose(),
            columns,
            1.0,
            Par::Seq,
        );
    }

    /// Adds to mode `n` a `strength` times the orthogonal projection, in $L^2$ of the surface, onto
    /// a field of that mode: a matrix of rank one. `field` gives the field's components (radial,
    /// azimuthal, axial) at a node.
    pub fn add_projection(
        &mut self,
        discretization: &Discretization,
        n: usize,
        strength: f64,
        field: impl Fn(&Node) -> [f64; 3],
    ) {
        let nodes = discretization.nodes();
        let mut vector = vec![0.0; self.unknowns];
        for (k, node) in nodes.iter().enumerate() {
            for (j, component) in field(node).into_iter().enumerate() {
                vector[j * nodes.len() + k] = component * node.weight.sqrt();
            }
        }
        let norm_squared: f64 = vector.iter().map(|x| x * x).sum();
        let size = self.unknowns * self.unknowns;
        let rows = self.rows.as_mut_slice()[n * size..][..size].chunks_mut(self.unknowns);
        for (row, left) in rows.zip(&vector) {
            for (entry, right) in row.iter_mut().zip(&vector) {
                *entry += strength * (left * right / norm_squared);
            }
        }
    }

    /// Modes, counting the zeroth.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// Unknowns of each mode: three per node.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// The transposed matrix of mode `n`.
    pub fn transposed(&self, n: usize) -> MatRef<'_, f64> {
        let size = self.unknowns * self.unknowns;
        let columns = &self.rows.as_slice()[n * size..][..size];
        MatRef::from_column_major_slice(columns, self.unknowns, self.unknowns)
    }

    /// Mode after mode, the transposed matrix column by column.
    pub fn into_transposed_columns(self) -> Storage {
        self.rows
    }
}

impl Buffers {
    fn fill_rows(
        &mut self,
        discretization: &Discretization,
        kernel: &impl Kernel<9>,
        engine: &Modes,
        rules: &NearRules,
        index: usize,
        rows: &mut TargetRows<'_>,
    ) -> Result<(), QuadratureError> {
        let order = discretization.order();
        let nodes = discretization.nodes();
        let (home, local) = (index / order, index % order);
        let at = &nodes[index];
        let here = Sight::on(at).point();
        let target = TargetRing {
            r: at.r,
            normal: at.normal,
        };
        self.sources.clear();
        self.columns.clear();
        self.near_panels.clear();
        for panel in 0..discretization.panels().len() {
            if panel != home && rules.is_far(discretization, here, panel) {
                self.columns.extend(panel * order..(panel + 1) * order);
            } else {
                self.near_panels.push(panel);
            }
        }
        for &column in &self.columns {
            let node = &nodes[column];
            self.sources
                .push(node.r, [at.r - node.r, at.z - node.z], node.normal);
        }
        engine.evaluate(kernel, target, &self.sources, &mut self.workspace);
        self.scatter_far(nodes, at, engine.count(), rows);
        for place in 0..self.near_panels.len() {
            let panel = self.near_panels[place];
            rules.fill(discretization, home, local, panel, &mut self.near)?;
            self.sources.clear();
            for (node, &separation) in self.near.nodes.iter().zip(&self.near.separation) {
                self.sources.push(node.r, separation, node.normal);
            }
            engine.evaluate(kernel, target, &self.sources, &mut self.workspace);
            self.interpolate_near(nodes, at, engine.count(), panel * order, order, rows);
        }
        Ok(())
    }

    fn scatter_far(&mut self, nodes: &[Node], at: &Node, modes: usize, rows: &mut TargetRows<'_>) {
        let Workspace {
            block,
            stride,
            order,
            ..
        } = &self.workspace;
        self.weighted.clear();
        self.weighted.extend(
            order
                .iter()
                .map(|&source| (nodes[self.columns[source]].weight * at.weight).sqrt()),
        );
        self.runs.clear();
        let columns = order.iter().map(|&source| self.columns[source]);
        for (place, column) in columns.enumerate() {
            match self.runs.last_mut() {
                Some(run) if run.column + run.length == column => run.length += 1,
                _ => self.runs.push(Run {
                    place,
                    column,
                    length: 1,
                }),
            }
        }
        for n in 0..modes {
            for (k, sign) in SIGN.into_iter().enumerate() {
                let entries = &block[(n * 9 + k) * stride..][..order.len()];
                let row = &mut rows[3 * n + k / 3][k % 3 * nodes.len()..][..nodes.len()];
                for run in &self.runs {
                    let entries = &entries[run.place..][..run.length];
                    let weights = &self.weighted[run.place..][..run.length];
                    let row = &mut row[run.column..][..run.length];
                    for ((to, entry), weight) in row.iter_mut().zip(entries).zip(weights) {
                        *to = sign * entry * weight;
                    }
                }
            }
        }
    }

    /// Maps the entries at the near nodes to the panel's own nodes `first..first + order`.
    fn interpolate_near(
        &mut self,
        nodes: &[Node],
        at: &Node,
        modes: usize,
        first: usize,
        order: usize,
        rows: &mut TargetRows<'_>,
    ) {
        let Workspace {
            block,
            stride,
            order: columns,
            ..
        } = &self.workspace;
        let count = columns.len();
        self.weighted.clear();
        for &source in columns {
            let weight = self.near.nodes[source].weight;
            let interpolation = &self.near.interpolation[source * order..][..order];
            self.weighted.extend(
                interpolation
                    .iter()
                    .zip(&nodes[first..])
                    .map(|(l, node)| l * weight * (at.weight / node.weight).sqrt()),
            );
        }
        self.interpolated.resize(modes * 9 * order, 0.0);
        // Column-major views: the transposes of what is meant, so that entries stay contiguous.
        matmul(
            MatMut::from_column_major_slice_mut(&mut self.interpolated, order, modes * 9),
            Accum::Replace,
            MatRef::from_column_major_slice(&self.weighted, order, count),
            MatRef::from_column_major_slice_with_stride(block, *stride, modes * 9, *stride)
                .subrows(0, count),
            1.0,
            Par::Seq,
        );
        for n in 0..modes {
            for (k, sign) in SIGN.into_iter().enumerate() {
                let from = &self.interpolated[(n * 9 + k) * order..][..order];
                let to = &mut rows[3 * n + k / 3][k % 3 * nodes.len() + first..][..order];
                for (to, from) in to.iter_mut().zip(from) {
                    *to = sign * from;
                }
            }
        }
    }
}
