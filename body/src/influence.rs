//! Rows of the near-field matrix: the velocity at a point close to some panels, as a linear map of
//! the density on them.
//!
//! They are the integrals of `close`, of the velocity alone: for each mode and node
//! a matrix of three by three. They are stored because an iteration applies them to many densities.

use bodies_of_revolution::Meridian;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use nalgebra::{Point3, Vector3};
use panel_quadrature::QuadratureError;

use super::close;
use super::discretization::Discretization;
use super::layers::LayerWeights;
use super::matrix::SIGN;
use super::near::{NearNodes, NearRules};
use crate::kernel::{
    CombinedField, DoubleLayer, Kernel, Modes, SingleLayer, SourceRings, TargetRing, Workspace,
};

/// Rules for close points.
#[derive(Debug)]
pub struct Influence {
    rules: NearRules,
    engine: Modes,
}

/// A thread's buffers.
#[derive(Debug, Default)]
pub struct Buffers {
    near: NearNodes,
    sources: SourceRings,
    workspace: Workspace,
    interpolation: Vec<f64>,
    interpolated: Vec<f64>,
}

impl Influence {
    /// Rules for panels of `order` nodes and modes up to `n_max`.
    pub fn new(order: usize, n_max: usize) -> Result<Self, QuadratureError> {
        Ok(Self {
            rules: NearRules::new(order, n_max)?,
            engine: Modes::new(n_max),
        })
    }

    /// The length of the rows of a point for so many panels.
    pub fn len(&self, discretization: &Discretization, panels: usize) -> usize {
        9 * self.engine.count() * panels * discretization.order()
    }

    /// The rows of a point, of $w_D D + w_S S$: entry $(i, j)$ of mode `n` for node `k` of the
    /// nodes of `panels` together is number $(9n + 3i + j) P + k$, and acts on densities
    /// [scaled](super::surface_grid) by the roots of their weights.
    pub fn fill(
        &self,
        discretization: &Discretization,
        weights: LayerWeights,
        point: Point3<f64>,
        panels: &[u32],
        buffers: &mut Buffers,
        rows: &mut [f64],
    ) -> Result<(), QuadratureError> {
        match weights {
            LayerWeights { double: 0.0, .. } => self.fill_of(
                discretization,
                &SingleLayer,
                weights.single,
                point,
                panels,
                buffers,
                rows,
            ),
            LayerWeights { single: 0.0, .. } => self.fill_of(
                discretization,
                &DoubleLayer,
                weights.double,
                point,
                panels,
                buffers,
                rows,
            ),
            LayerWeights { double, single } => {
                let kernel = CombinedField {
                    eta: single / double,
                };
                self.fill_of(
                    discretization,
                    &kernel,
                    double,
                    point,
                    panels,
                    buffers,
                    rows,
                )
            }
        }
    }

    #[expect(clippy::too_many_arguments, reason = "the generic half of `fill`")]
    fn fill_of(
        &self,
        discretization: &Discretization,
        kernel: &impl Kernel<9>,
        factor: f64,
        point: Point3<f64>,
        panels: &[u32],
        buffers: &mut Buffers,
        rows: &mut [f64],
    ) -> Result<(), QuadratureError> {
        let sight = close::sight(discretization, Meridian::of(&point));
        let seen = sight.point();
        let target = TargetRing {
            r: seen.r,
            normal: [0.0; 2],
        };
        let order = discretization.order();
        let width = panels.len() * order;
        for (place, &panel) in panels.iter().enumerate() {
            let panel = panel as usize;
            if self.rules.is_far(discretization, seen, panel) {
                buffers.near.take_own_nodes(discretization, &sight, panel);
            } else {
                self.rules.fill_panel_off_curve(
                    discretization,
                    &sight,
                    panel,
                    &mut buffers.near,
                )?;
            }
            buffers.sources.clear();
            for (node, &separation) in buffers.near.nodes.iter().zip(&buffers.near.separation) {
                buffers.sources.push(node.r, separation, node.normal);
            }
            self.engine
                .evaluate(kernel, target, &buffers.sources, &mut buffers.workspace);
            buffers.interpolate(discretization, panel, self.engine.count(), factor);
            for (entry, from) in buffers.interpolated.chunks(order).enumerate() {
                let to = &mut rows[entry * width + place * order..][..order];
                for (to, from) in to.iter_mut().zip(from) {
                    *to = SIGN[entry % 9] * from;
                }
            }
        }
        Ok(())
    }

    /// The velocity at a point from its rows and a scaled density, in the body's frame.
    pub fn velocity(
        &self,
        discretization: &Discretization,
        rows: &[f64],
        panels: &[u32],
        field: &[f64],
        point: Point3<f64>,
    ) -> Vector3<f64> {
        let order = discretization.order();
        let nodes = discretization.nodes().len();
        let width = panels.len() * order;
        let r = point.x.hypot(point.y);
        let [cos, sin] = if r > 0.0 {
            [point.x / r, point.y / r]
        } else {
            [1.0, 0.0]
        };
        let mut sum = [0.0; 3];
        // Cosine and sine of n times the azimuth.
        let (mut c, mut s) = (1.0, 0.0);
        for (rows, field) in rows.chunks(9 * width).zip(field.chunks(6 * nodes)) {
            let mut value = [[0.0; 3]; 2];
            for (entry, row) in rows.chunks(width).enumerate() {
                let (i, j) = (entry / 3, entry % 3);
                for (row, &panel) in row.chunks(order).zip(panels) {
                    let first = j * nodes + panel as usize * order;
                    for (family, value) in value.iter_mut().enumerate() {
                        let density = &field[3 * family * nodes + first..][..order];
                        value[i] += dot(row, density);
                    }
                }
            }
            let [first, second] = value;
            sum[0] += c * first[0] + s * second[0];
            sum[1] += s * first[1] - c * second[1];
            sum[2] += c * first[2] + s * second[2];
            (c, s) = (c * cos - s * sin, s * cos + c * sin);
        }
        let [radial, azimuthal, axial] = sum;
        Vector3::new(
            radial * cos - azimuthal * sin,
            radial * sin + azimuthal * cos,
            axial,
        )
    }
}

/// The inner product, in four sums that a register holds.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a, rest_a) = a.as_chunks::<4>();
    let (b, rest_b) = b.as_chunks::<4>();
    for (a, b) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

impl Buffers {
    /// Maps the entries at the near nodes to the panel's own.
    fn interpolate(
        &mut self,
        discretization: &Discretization,
        panel: usize,
        modes: usize,
        factor: f64,
    ) {
        let order = discretization.order();
        let own = discretization.nodes_of(panel);
        let Workspace {
            block,
            stride,
            order: columns,
            ..
        } = &self.workspace;
        let near = &self.near;
        self.interpolation.clear();
        for &source in columns {
            let weight = factor * near.nodes[source].weight;
            let row = &near.interpolation[source * order..][..order];
            self.interpolation.extend(
                row.iter()
                    .zip(own)
                    .map(|(l, node)| l * weight / node.weight.sqrt()),
            );
        }
        self.interpolated.resize(9 * modes * order, 0.0);
        matmul(
            MatMut::from_column_major_slice_mut(&mut self.interpolated, order, 9 * modes),
            Accum::Replace,
            MatRef::from_column_major_slice(&self.interpolation, order, columns.len()),
            MatRef::from_column_major_slice_with_stride(block, *stride, 9 * modes, *stride)
                .subrows(0, columns.len()),
            1.0,
            Par::Seq,
        );
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::flow::Flow;
    use super::super::layers::Layers;
    use super::super::surface::SurfaceModes;
    use super::*;
    use bodies_of_revolution::{Panels, Spheroid};

    #[test]
    fn all_panels_together_make_the_flow() {
        let curve = Arc::new(Spheroid::new(1.0, 0.6).unwrap());
        let panels = Panels::equal_arcs(&*curve, 3).unwrap();
        let discretization = Discretization::new(curve, panels, 16).unwrap();
        let density = SurfaceModes::sample(&discretization, 5, |x| {
            Vector3::new(x.y * x.z, 1.0 + x.x * x.x, x.x * x.y * x.z - 0.3)
        })
        .modes;
        let influence = Influence::new(16, 5).unwrap();
        let field = density.scaled_by_roots(&discretization);
        let mut buffers = Buffers::default();
        let mut rows = vec![0.0; influence.len(&discretization, 3)];
        for (double, single) in [(1.0, 0.0), (0.0, 2.0), (1.0, 0.7)] {
            let weights = LayerWeights { double, single };
            let flow = Flow::new(&discretization, Layers::weighted(&density, weights));
            for point in [
                [0.0, 0.0, 1.1],
                [0.61, 0.0, 0.02],
                [-0.3, 0.5, 0.3],
                [1.0, 2.0, -0.4],
            ] {
                let point = Point3::from(point);
                influence
                    .fill(
                        &discretization,
                        weights,
                        point,
                        &[0, 1, 2],
                        &mut buffers,
                        &mut rows,
                    )
                    .unwrap();
                let found = influence.velocity(&discretization, &rows, &[0, 1, 2], &field, point);
                let exact = flow.at(&[point], 1e-15).unwrap()[0].velocity;
                assert!(
                    (found - exact).norm() < 1e-13,
                    "{:e}",
                    (found - exact).norm()
                );
            }
        }
    }
}
