//! Vector fields on the surface and their azimuthal modes.
//!
//! A field is a sum over modes and the two families of [`matrix`](super::matrix); its components
//! are cylindrical.

use std::f64::consts::PI;

use bodies_of_revolution::Meridian;
use nalgebra::{Point3, UnitQuaternion, Vector3};
use num_complex::Complex64;
use panel_quadrature::QuadratureError;
use rayon::slice::ParallelSliceMut;

use super::discretization::{Discretization, Node};
use super::fft;

/// Modes of a real vector field at the nodes of a generating curve.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceModes {
    modes: usize,
    nodes: usize,
    /// Component `j` at node `k` of family `f` of mode `n` is at `((2 n + f) 3 + j) nodes + k`.
    values: Vec<f64>,
}

/// A field sampled on the surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// Its modes.
    pub modes: SurfaceModes,
    /// Its largest magnitude at the samples; infinite if it is not finite at one of them.
    pub largest: f64,
}

/// Samples around each ring that determine modes up to `n_max`, with room for a few beyond: a
/// length the FFT is quick at.
pub fn azimuths(n_max: usize) -> usize {
    let least = 2 * n_max + 8;
    (least..)
        .find(|&n| {
            let odd = n >> n.trailing_zeros();
            n.is_multiple_of(2) && (odd == 1 || odd == 3 || odd == 5)
        })
        .unwrap_or(least)
}

impl SurfaceModes {
    /// The field that vanishes.
    pub fn zero(n_max: usize, nodes: usize) -> Self {
        Self {
            modes: n_max + 1,
            nodes,
            values: vec![0.0; (n_max + 1) * 6 * nodes],
        }
    }

    /// The modes up to `n_max` of the field `f`, a vector in the body's frame at a point of its
    /// surface.
    pub fn sample(
        discretization: &Discretization,
        n_max: usize,
        mut f: impl FnMut(Vector3<f64>) -> Vector3<f64>,
    ) -> Sampled {
        Self::sample_with_normal(discretization, n_max, |x, _| f(x))
    }

    /// The same of a field that depends on the outward unit normal too, its second argument.
    pub fn sample_with_normal(
        discretization: &Discretization,
        n_max: usize,
        mut f: impl FnMut(Vector3<f64>, Vector3<f64>) -> Vector3<f64>,
    ) -> Sampled {
        let nodes = discretization.nodes();
        let mut largest = 0.0f64;
        let value = |k: usize, [cos, sin]: [f64; 2]| {
            let Node { r, z, normal, .. } = nodes[k];
            let at = |r: f64, z: f64| Vector3::new(r * cos, r * sin, z);
            let value = f(at(r, z), at(normal[0], normal[1]));
            // `max` would pass over a NaN.
            let magnitude = value.norm();
            largest = if magnitude.is_nan() {
                f64::INFINITY
            } else {
                largest.max(magnitude)
            };
            value
        };
        let modes = Self::of_samples(nodes.len(), n_max, [azimuths(n_max), 0], value);
        Sampled { modes, largest }
    }

    /// The modes up to `n_max` of a field on rings of `count` points, the first of them `halves`
    /// half steps from azimuth zero: the Cartesian `value` at a node and a point's cosine and sine,
    /// asked for ring after ring.
    pub fn of_samples(
        nodes: usize,
        n_max: usize,
        [count, halves]: [usize; 2],
        mut value: impl FnMut(usize, [f64; 2]) -> Vector3<f64>,
    ) -> Self {
        let fft = fft::forward(count);
        let mut modes = Self::zero(n_max, nodes);
        let mut rings = [(); 3].map(|()| vec![Complex64::default(); count]);
        let offset = PI * halves as f64 / count as f64;
        for k in 0..nodes {
            let [radial, azimuthal, axial] = &mut rings;
            for (l, ((radial, azimuthal), axial)) in
                radial.iter_mut().zip(azimuthal).zip(axial).enumerate()
            {
                let (sin, cos) = (2.0 * PI * l as f64 / count as f64 + offset).sin_cos();
                let value = value(k, [cos, sin]);
                *radial = (value.x * cos + value.y * sin).into();
                *azimuthal = (value.y * cos - value.x * sin).into();
                *axial = value.z.into();
            }
            for (j, ring) in rings.iter_mut().enumerate() {
                fft.process(ring);
                for (n, c) in ring.iter().enumerate().take(n_max + 1) {
                    let scale = if n == 0 { 1.0 } else { 2.0 } / count as f64;
                    let c = c * Complex64::cis(-(n as f64) * offset);
                    let (cos, sin) = (scale * c.re, -scale * c.im);
                    if j == 1 {
                        modes.component_mut(n, 0, j)[k] = sin;
                        modes.component_mut(n, 1, j)[k] = -cos;
                    } else {
                        modes.component_mut(n, 0, j)[k] = cos;
                        modes.component_mut(n, 1, j)[k] = sin;
                    }
                }
            }
        }
        modes
    }

    /// The same field without the modes above `n_max`.
    pub fn truncated(mut self, n_max: usize) -> Self {
        self.modes = self.modes.min(n_max + 1);
        self.values.truncate(self.modes * 6 * self.nodes);
        self
    }

    /// The field times a number; none of its modes but the zeroth if that is zero.
    pub fn scaled(&self, factor: f64) -> Self {
        if factor == 0.0 {
            return Self::zero(0, self.nodes);
        }
        Self {
            values: self.values.iter().map(|x| factor * x).collect(),
            ..*self
        }
    }

    /// The inner product $\int a \cdot b\, d\Gamma$ with another field on the nodes of
    /// `discretization`.
    pub fn inner_product(&self, discretization: &Discretization, other: &Self) -> f64 {
        let mut sum = 0.0;
        for (n, k) in (0..self.modes.min(other.modes)).flat_map(|n| (0..6).map(move |k| (n, k))) {
            let (family, j) = (k / 3, k % 3);
            // The integral of the square of the sine or cosine that this component comes with.
            let around = match (n, (family == 1) == (j == 1)) {
                (0, true) => 2.0 * PI,
                (0, false) => continue,
                _ => PI,
            };
            let [a, b] = [self, other].map(|field| field.component(n, family, j));
            let products = discretization.nodes().iter().zip(a.iter().zip(b));
            sum += around
                * products
                    .map(|(node, (a, b))| node.weight * a * b)
                    .sum::<f64>();
        }
        sum
    }

    /// All components, each number times the square root of its node's quadrature weight.
    pub fn scaled_by_roots(&self, discretization: &Discretization) -> Vec<f64> {
        let mut values = self.values.clone();
        scale_by_roots(&mut values, discretization, |x, root| x * root);
        values
    }

    /// The field whose components times those roots are given.
    pub fn from_scaled(discretization: &Discretization, scaled: &[f64]) -> Self {
        let nodes = discretization.nodes().len();
        let mut values = scaled.to_vec();
        scale_by_roots(&mut values, discretization, |x, root| x / root);
        Self {
            modes: values.len() / (6 * nodes),
            nodes,
            values,
        }
    }

    /// The field at the nodes of another discretization of the same curve, by interpolation along
    /// it; without the modes above `n_max`.
    pub fn resampled(
        &self,
        from: &Discretization,
        to: &Discretization,
        n_max: usize,
    ) -> Result<Self, QuadratureError> {
        let mut resampled = Self::zero(n_max, to.nodes().len());
        let order = from.order();
        let panels = from.panels().as_slice();
        let mut row = vec![0.0; order];
        for (k, node) in to.nodes().iter().enumerate() {
            let after = panels.partition_point(|panel| panel.end < node.s);
            let index = after.min(panels.len() - 1);
            let panel = &panels[index];
            let t = (node.s - panel.start) / (0.5 * panel.length()) - 1.0;
            from.basis().interpolation_row(t, &mut row)?;
            for place in 0..6 * self.modes.min(n_max + 1) {
                let values = &self.values[place * self.nodes + index * order..][..order];
                resampled.values[place * resampled.nodes + k] =
                    row.iter().zip(values).map(|(l, x)| l * x).sum();
            }
        }
        Ok(resampled)
    }

    /// The field in a frame whose axes are turned by `rotation`, on the nodes of a sphere; its
    /// vectors turn along.
    ///
    /// With $q$ the rotation it is $q^{-1} f(q x)$, interpolated along the curve: exact to what
    /// nodes and modes resolve.
    ///
    /// # Errors
    /// If the nodes of a panel cannot be interpolated.
    pub fn on_turned_sphere(
        &self,
        discretization: &Discretization,
        rotation: &UnitQuaternion<f64>,
    ) -> Result<Self, QuadratureError> {
        let mut failed = None;
        let turned = |x: Vector3<f64>| {
            let value = self.at_point(discretization, (rotation * x).into());
            rotation.inverse()
                * value.unwrap_or_else(|error| {
                    failed = Some(error);
                    Vector3::zeros()
                })
        };
        let turned = Self::sample(discretization, self.modes - 1, turned).modes;
        failed.map_or(Ok(turned), Err)
    }

    /// The field at the point of the surface nearest to `x`, Cartesian.
    fn at_point(
        &self,
        discretization: &Discretization,
        x: Point3<f64>,
    ) -> Result<Vector3<f64>, QuadratureError> {
        let s = super::close::sight(discretization, Meridian::of(&x)).s;
        let panels = discretization.panels().as_slice();
        let after = panels.partition_point(|panel| panel.end < s);
        let index = after.min(panels.len() - 1);
        let panel = &panels[index];
        let order = discretization.order();
        let mut row = vec![0.0; order];
        let t = (s - panel.start) / (0.5 * panel.length()) - 1.0;
        (discretization.basis()).interpolation_row(t.clamp(-1.0, 1.0), &mut row)?;
        let theta = x.y.atan2(x.x);
        let mut value = Vector3::zeros();
        for (i, l) in row.iter().enumerate() {
            value += *l * Vector3::from(self.at(index * order + i, theta));
        }
        let (sin, cos) = theta.sin_cos();
        Ok(Vector3::new(
            value.x * cos - value.y * sin,
            value.x * sin + value.y * cos,
            value.z,
        ))
    }

    /// The field plus another one, on the same nodes, times a number.
    pub fn plus(mut self, factor: f64, other: &Self) -> Self {
        debug_assert_eq!(self.nodes, other.nodes);
        self.modes = self.modes.max(other.modes);
        self.values.resize(self.modes * 6 * self.nodes, 0.0);
        for (value, other) in self.values.iter_mut().zip(&other.values) {
            *value += factor * other;
        }
        self
    }

    /// Modes, counting the zeroth.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// Nodes on the generating curve.
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Component `j` (radial, azimuthal, axial) of a family (0, 1) of mode `n`, node after node.
    pub fn component(&self, n: usize, family: usize, j: usize) -> &[f64] {
        &self.values[((2 * n + family) * 3 + j) * self.nodes..][..self.nodes]
    }

    /// The same, to be written.
    pub fn component_mut(&mut self, n: usize, family: usize, j: usize) -> &mut [f64] {
        &mut self.values[((2 * n + family) * 3 + j) * self.nodes..][..self.nodes]
    }

    /// Both families of mode `n`: the right-hand sides of that mode's system, one after the other.
    pub fn families(&self, n: usize) -> &[f64] {
        &self.values[6 * n * self.nodes..][..6 * self.nodes]
    }

    /// Both families of every mode.
    pub fn par_families_mut(&mut self) -> rayon::slice::ChunksMut<'_, f64> {
        self.values.par_chunks_mut(6 * self.nodes)
    }

    pub(crate) fn families_mut(&mut self, n: usize) -> &mut [f64] {
        &mut self.values[6 * n * self.nodes..][..6 * self.nodes]
    }

    /// The field's cylindrical components (radial, azimuthal, axial) at node `k` and azimuth
    /// `theta`, in the body's frame.
    pub fn at(&self, k: usize, theta: f64) -> [f64; 3] {
        let mut value = [0.0; 3];
        let step = Complex64::cis(theta);
        let mut turn = Complex64::from(1.0);
        for n in 0..self.modes {
            let Complex64 { re: cos, im: sin } = turn;
            turn *= step;
            for (j, value) in value.iter_mut().enumerate() {
                let (first, second) = (self.component(n, 0, j)[k], self.component(n, 1, j)[k]);
                *value += if j == 1 {
                    first * sin - second * cos
                } else {
                    first * cos + second * sin
                };
            }
        }
        value
    }

    /// The largest length of the vectors at node `k`, on so many azimuths; a NaN if there is one.
    pub fn length_at(&self, k: usize, azimuths: usize) -> f64 {
        let lengths = (0..azimuths).map(|l| {
            let [r, t, z] = self.at(k, 2.0 * PI * l as f64 / azimuths as f64);
            (r * r + t * t + z * z).sqrt()
        });
        // `max` would pass over a NaN.
        lengths.fold(0.0, |most: f64, x| if x.is_nan() { x } else { most.max(x) })
    }

    /// The largest absolute value of a coefficient of mode `n`.
    pub fn amplitude(&self, n: usize) -> f64 {
        self.families(n)
            .iter()
            .fold(0.0, |most, x| most.max(x.abs()))
    }
}

fn scale_by_roots(
    values: &mut [f64],
    discretization: &Discretization,
    by: impl Fn(f64, f64) -> f64,
) {
    let nodes = discretization.nodes();
    for component in values.chunks_mut(nodes.len()) {
        for (x, node) in component.iter_mut().zip(nodes) {
            *x = by(*x, node.weight.sqrt());
        }
    }
}
