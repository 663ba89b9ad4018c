//! A surface as points: every node on equidistant azimuths, and the way from modes to values there
//! and back.
//!
//! Fields are *scaled*: their modes are multiplied by the square roots of the nodes' quadrature
//! weights, as the rows and columns of the [modal matrices](super::matrix) are, so that the
//! Euclidean norm is that of $L^2$ of the surface (but for a factor of two in the square of mode
//! 0). Component `j` (radial, azimuthal, axial) at node `k` of family `f` of mode `n` is number
//! $((2n + f)\,3 + j) N + k$.

use std::f64::consts::PI;
use std::ops::Range;

use faer::linalg::matmul::matmul;
use faer::prelude::ReborrowMut;
use faer::{Accum, MatMut, MatRef, Par};
use nalgebra::{Point3, Vector3};

use super::discretization::Discretization;
use super::layers::LayerWeights;
use crate::kernel::layer_velocity;
use f64_lanes::padded;

/// The points of a surface, in the body's frame: panel after panel, on it azimuth after azimuth, on
/// that node after node.
#[derive(Debug)]
pub struct SurfaceGrid {
    nodes: usize,
    order: usize,
    modes: usize,
    azimuths: usize,
    /// Where the next panel's points begin: a whole number of registers.
    stride: usize,
    /// Square roots of the nodes' weights.
    roots: Vec<f64>,
    /// Cosine and sine of the azimuths.
    directions: Vec<[f64; 2]>,
    /// Azimuth after azimuth, what each family of each mode is there: of radial and axial
    /// components, and of azimuthal ones.
    waves: [Vec<f64>; 2],
    position: [Vec<f64>; 3],
    normal: [Vec<f64>; 3],
}

/// One vector for each point of a [`SurfaceGrid`], component after component, panels padded with
/// zeros.
pub type PointVectors = [Vec<f64>; 3];

/// Azimuths that determine modes up to `n_max`.
pub fn azimuths(n_max: usize) -> usize {
    2 * n_max + 1
}

impl SurfaceGrid {
    /// The points at the nodes of `discretization`, for modes up to `n_max`.
    pub fn new(discretization: &Discretization, n_max: usize) -> Self {
        Self::with_azimuths(discretization, n_max, azimuths(n_max))
    }

    /// The same with more azimuths than those modes need.
    pub fn with_azimuths(discretization: &Discretization, n_max: usize, azimuths: usize) -> Self {
        let (nodes, order) = (discretization.nodes(), discretization.order());
        let angle = |l: usize| 2.0 * PI * l as f64 / azimuths as f64;
        let directions: Vec<[f64; 2]> = (0..azimuths)
            .map(|l| [angle(l).cos(), angle(l).sin()])
            .collect();
        let mut waves = [(); 2].map(|()| Vec::with_capacity(2 * (n_max + 1) * azimuths));
        for l in 0..azimuths {
            for n in 0..=n_max {
                let [cos, sin] = directions[n * l % azimuths];
                waves[0].extend([cos, sin]);
                waves[1].extend([sin, -cos]);
            }
        }
        let stride = padded(order * azimuths);
        let panels = discretization.panels().len();
        let mut position = [(); 3].map(|()| Vec::with_capacity(panels * stride));
        let mut normal = position.clone();
        for on_panel in nodes.chunks(order) {
            for &[cos, sin] in &directions {
                for node in on_panel {
                    let [nu_r, nu_z] = node.normal;
                    let (x, nu) = (
                        [node.r * cos, node.r * sin, node.z],
                        [nu_r * cos, nu_r * sin, nu_z],
                    );
                    for k in 0..3 {
                        position[k].push(x[k]);
                        normal[k].push(nu[k]);
                    }
                }
            }
            // Copies of the last point, which are given no strength: no source must be where a
            // target may be by accident.
            while position[0].len() % stride != 0 {
                for buffer in position.iter_mut().chain(&mut normal) {
                    buffer.push(buffer[buffer.len() - 1]);
                }
            }
        }
        Self {
            nodes: nodes.len(),
            order,
            modes: n_max + 1,
            azimuths,
            stride,
            roots: nodes.iter().map(|node| node.weight.sqrt()).collect(),
            directions,
            waves,
            position,
            normal,
        }
    }

    /// Numbers that make up a field: six for each node and mode.
    pub fn field_len(&self) -> usize {
        6 * self.modes * self.nodes
    }

    /// Points.
    pub fn len(&self) -> usize {
        self.nodes * self.azimuths
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Azimuths of each node.
    pub fn azimuths(&self) -> usize {
        self.azimuths
    }

    /// The places of the points in padded arrays, in their order.
    pub fn places(&self) -> impl Iterator<Item = usize> + use<> {
        let (stride, on_panel) = (self.stride, self.order * self.azimuths);
        (0..self.nodes / self.order)
            .flat_map(move |panel| panel * stride..panel * stride + on_panel)
    }

    /// The places of a panel's points, padding included.
    fn panel(&self, panel: usize) -> Range<usize> {
        panel * self.stride..(panel + 1) * self.stride
    }

    /// The point at a place.
    pub fn position(&self, place: usize) -> Point3<f64> {
        Point3::from(self.position.each_ref().map(|x| x[place]))
    }

    /// The outward unit normal at a place.
    pub fn normal(&self, place: usize) -> Vector3<f64> {
        Vector3::from(self.normal.each_ref().map(|x| x[place]))
    }

    /// Room for a vector at every point.
    pub fn vectors(&self) -> PointVectors {
        [(); 3].map(|()| vec![0.0; self.position[0].len()])
    }

    /// The field at the points, Cartesian, times the points' shares of the surface.
    pub fn to_points(&self, field: &[f64], scratch: &mut Vec<f64>, out: &mut PointVectors) {
        let (nodes, azimuths) = (self.nodes, self.azimuths);
        scratch.resize(3 * nodes * azimuths, 0.0);
        for (j, values) in scratch.chunks_mut(nodes * azimuths).enumerate() {
            matmul(
                MatMut::from_column_major_slice_mut(values, nodes, azimuths),
                Accum::Replace,
                self.component(field, j),
                MatRef::from_column_major_slice(
                    &self.waves[usize::from(j == 1)],
                    2 * self.modes,
                    azimuths,
                ),
                2.0 * PI / azimuths as f64,
                Par::Seq,
            );
        }
        let [radial, azimuthal, axial] =
            [0, 1, 2].map(|j| &scratch[j * nodes * azimuths..][..nodes * azimuths]);
        for (l, [cos, sin]) in self.directions.iter().enumerate() {
            for k in 0..nodes {
                let place = k / self.order * self.stride + l * self.order + k % self.order;
                let (r, t, z) = (
                    radial[l * nodes + k],
                    azimuthal[l * nodes + k],
                    axial[l * nodes + k],
                );
                let root = self.roots[k];
                out[0][place] = root * (r * cos - t * sin);
                out[1][place] = root * (r * sin + t * cos);
                out[2][place] = root * z;
            }
        }
    }

    /// Adds the modes of a Cartesian field that is given at the points.
    pub fn add_modes(&self, values: &PointVectors, scratch: &mut Vec<f64>, field: &mut [f64]) {
        let (nodes, azimuths) = (self.nodes, self.azimuths);
        scratch.resize(3 * nodes * azimuths, 0.0);
        for (l, [cos, sin]) in self.directions.iter().enumerate() {
            for k in 0..nodes {
                let place = k / self.order * self.stride + l * self.order + k % self.order;
                let [x, y, z] = values.each_ref().map(|v| self.roots[k] * v[place]);
                let cylindrical = [x * cos + y * sin, y * cos - x * sin, z];
                for (j, value) in cylindrical.into_iter().enumerate() {
                    scratch[(j * azimuths + l) * nodes + k] = value;
                }
            }
        }
        for (j, values) in scratch.chunks(nodes * azimuths).enumerate() {
            let values = MatRef::from_column_major_slice(values, nodes, azimuths);
            let waves = MatRef::from_column_major_slice(
                &self.waves[usize::from(j == 1)],
                2 * self.modes,
                azimuths,
            );
            let mut component = self.component_mut(field, j);
            // Mode 0 is the mean, the others twice that.
            for (columns, factor) in [(0..2, 1.0), (2..2 * self.modes, 2.0)] {
                matmul(
                    component.rb_mut().subcols_mut(columns.start, columns.len()),
                    Accum::Add,
                    values,
                    waves.subrows(columns.start, columns.len()).transpose(),
                    factor / azimuths as f64,
                    Par::Seq,
                );
            }
        }
    }

    /// The velocity at `target` (in the body's frame) of the points of a panel; `strengths` are
    /// densities times shares of the surface.
    pub fn panel_velocity(
        &self,
        panel: usize,
        weights: LayerWeights,
        strengths: &PointVectors,
        target: Point3<f64>,
    ) -> Vector3<f64> {
        let range = self.panel(panel);
        layer_velocity(
            [weights.double, weights.single],
            self.position.each_ref().map(|x| &x[range.clone()]),
            self.normal.each_ref().map(|x| &x[range.clone()]),
            strengths.each_ref().map(|x| &x[range.clone()]),
            target,
        )
    }

    fn component<'f>(&self, field: &'f [f64], j: usize) -> MatRef<'f, f64> {
        MatRef::from_column_major_slice_with_stride(
            &field[j * self.nodes..],
            self.nodes,
            2 * self.modes,
            3 * self.nodes,
        )
    }

    fn component_mut<'f>(&self, field: &'f mut [f64], j: usize) -> MatMut<'f, f64> {
        MatMut::from_column_major_slice_with_stride_mut(
            &mut field[j * self.nodes..],
            self.nodes,
            2 * self.modes,
            3 * self.nodes,
        )
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::matrix::ModalMatrices;
    use super::super::surface::SurfaceModes;
    use super::*;
    use bodies_of_revolution::{Panels, Spheroid};

    fn pear(n_max: usize) -> (Discretization, SurfaceGrid) {
        let curve = Arc::new(bodies_of_revolution::Polar::new(&[1.0, 0.2]).unwrap());
        let panels = Panels::equal_arcs(&*curve, 3).unwrap();
        let discretization = Discretization::new(curve, panels, 10).unwrap();
        let grid = SurfaceGrid::new(&discretization, n_max);
        (discretization, grid)
    }

    fn wavy(x: Vector3<f64>) -> Vector3<f64> {
        Vector3::new(x.y * x.z, 1.0 + x.x * x.x, x.x * x.y * x.z - 0.3)
    }

    #[test]
    fn modes_to_points_and_back_and_the_points_are_those_of_the_field() {
        let (discretization, grid) = pear(5);
        let modes = SurfaceModes::sample(&discretization, 5, wavy).modes;
        let field = modes.scaled_by_roots(&discretization);
        assert_eq!(field.len(), grid.field_len());
        let (mut scratch, mut out) = (Vec::new(), grid.vectors());
        grid.to_points(&field, &mut scratch, &mut out);
        let mut area = 0.0;
        for (point, place) in grid.places().enumerate() {
            let x = grid.position(place).coords;
            let k = point / (10 * 11) * 10 + point % 10;
            let share = discretization.nodes()[k].weight * 2.0 * PI / 11.0;
            area += share;
            for (out, exact) in out.iter_mut().zip(&wavy(x)) {
                assert!((out[place] - share * exact).abs() < 1e-14);
                out[place] = *exact;
            }
        }
        assert!((area - discretization.area()).abs() < 1e-12);
        let mut back = vec![0.0; field.len()];
        grid.add_modes(&out, &mut scratch, &mut back);
        for (a, b) in field.iter().zip(&back) {
            assert!((a - b).abs() < 1e-14);
        }
    }

    #[test]
    fn the_sum_over_points_is_what_the_matrices_say() {
        let curve = Arc::new(Spheroid::new(1.0, 0.6).unwrap());
        let panels = Panels::equal_arcs(&*curve, 2).unwrap();
        let discretization = Discretization::new(curve, panels, 10).unwrap();
        let grid = SurfaceGrid::new(&discretization, 4);
        let modes = SurfaceModes::sample(&discretization, 4, wavy).modes;
        let field = modes.scaled_by_roots(&discretization);
        let weights = LayerWeights {
            double: 1.0,
            single: 0.7,
        };
        let (mut scratch, mut strengths) = (Vec::new(), grid.vectors());
        grid.to_points(&field, &mut scratch, &mut strengths);
        let mut velocity = grid.vectors();
        for target in grid.places() {
            let x = grid.position(target);
            let mut sum = Vector3::zeros();
            for source in grid.places().filter(|&source| source != target) {
                let d = x - grid.position(source);
                let r = d.norm();
                let q = Vector3::from(strengths.each_ref().map(|s| s[source]));
                let stresslet = 6.0 * d * d.dot(&q) * d.dot(&grid.normal(source)) / r.powi(5);
                sum += stresslet + weights.single * (q / r + d * d.dot(&q) / r.powi(3));
            }
            for j in 0..3 {
                velocity[j][target] = sum[j] / (8.0 * PI);
            }
        }
        let mut expected = vec![0.0; field.len()];
        grid.add_modes(&velocity, &mut scratch, &mut expected);
        let matrices = ModalMatrices::of_point_sum(&discretization, weights, 4, grid.azimuths());
        let found = matrices.apply(&discretization, &modes);
        for (a, b) in expected.iter().zip(found.scaled_by_roots(&discretization)) {
            assert!((a - b).abs() < 1e-14, "{a} against {b}");
        }
    }
}
