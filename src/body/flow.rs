//! Velocity and pressure away from the body.
//!
//! The density is resampled finely enough for each target, then summed directly: with the trapezoidal rule in the
//! azimuth and Gauss–Legendre panels along the curve both converge exponentially in the number of points per distance.
//! A target that the finest resampling does not resolve is refused.

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::{Point3, Vector3};
use num_complex::Complex64;
use panel_quadrature::QuadratureError;
use rayon::prelude::*;
use rustfft::{Fft, FftPlanner};

use super::discretization::{Discretization, Node};
use super::layers::Layers;
use super::near::bernstein;
use super::surface::{SurfaceModes, azimuths};
use crate::kernel::{FlowAt, FlowGradientAt, SurfacePoint, SurfacePoints};

/// The flow of a density on a body, for viscosity 1, in the body's frame.
#[derive(Clone, Debug)]
pub struct Flow<'a> {
    discretization: &'a Discretization,
    layers: Layers,
    /// The largest coefficient of a mode.
    largest: f64,
    /// Logarithm of each mode's largest coefficient relative to the largest of all.
    mode_decay: Vec<f64>,
}

/// Why a flow cannot be evaluated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FlowError {
    /// A target is too near to the surface.
    #[error(
        "the point ({}, {}, {}) is too near to the surface for a tolerance of {tolerance:e}: expected a distance of about {least:.2e} or more",
        point.x, point.y, point.z
    )]
    TooNear {
        /// Its place among the targets.
        index: usize,
        /// The point, in the body's frame.
        point: Point3<f64>,
        /// The tolerance it was asked with.
        tolerance: f64,
        /// About the least distance that would do there.
        least: f64,
    },
    /// A target has a coordinate that is not finite.
    #[error("target {index} has a coordinate that is not finite")]
    NotFinite {
        /// Its place among the targets.
        index: usize,
    },
    /// A quadrature rule is missing.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
}

/// Resamplings: number `l` cuts every panel into `2^l` and takes `2^l` times as many azimuths.
const LEVELS: u32 = 4;

/// Natural logarithm of what the rules' errors exceed the bare powers by: the kernels are large near the surface.
const MARGIN: f64 = 7.0;

/// What is left of the ellipse's parameter (its logarithm) on a panel that bends towards the target.
const BENT: f64 = 0.9;

/// Natural logarithm of how far below the density's last coefficients the quadrature's error is worth pushing.
const BELOW_LEFT_OUT: f64 = 21.0;

impl<'a> Flow<'a> {
    /// The flow of densities on the nodes of `discretization`.
    pub fn new(discretization: &'a Discretization, layers: Layers) -> Self {
        let amplitudes: Vec<f64> = (0..layers.modes()).map(|n| layers.amplitude(n)).collect();
        let largest = amplitudes.iter().fold(f64::MIN_POSITIVE, |a, &b| a.max(b));
        Self {
            discretization,
            layers,
            largest,
            mode_decay: amplitudes.iter().map(|&a| log_ratio(a, largest)).collect(),
        }
    }

    /// Velocity and pressure at every target, with an error of the quadrature below `tolerance` relative to the density, or
    /// well below what the density's own expansion leaves out, if that is all there is to be had.
    ///
    /// # Errors
    /// [`FlowError::TooNear`] for a target that the finest resampling does not resolve.
    pub fn at(&self, targets: &[Point3<f64>], tolerance: f64) -> Result<Vec<FlowAt>, FlowError> {
        self.evaluate(targets, tolerance, SurfacePoints::flow)
    }

    /// The same with the velocity gradient, and so the stress.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    pub fn gradient_at(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, FlowError> {
        self.evaluate(targets, tolerance, SurfacePoints::flow_gradient)
    }

    fn evaluate<T: Copy + Send>(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
        sum: impl Fn(&SurfacePoints, Point3<f64>) -> T + Sync,
    ) -> Result<Vec<T>, FlowError> {
        let mut amplitudes = legendre_amplitudes(self.discretization, &self.layers.double)?;
        let of_single = legendre_amplitudes(self.discretization, &self.layers.single)?;
        for (amplitude, other) in amplitudes.iter_mut().zip(of_single) {
            *amplitude = amplitude.max(other);
        }
        let panel_decay: Vec<f64> = amplitudes
            .into_iter()
            .map(|a| log_ratio(a, self.largest))
            .collect();
        let wanted = -tolerance.ln() + MARGIN;
        let enough = wanted.min(self.digits_of_density(&panel_decay));
        let mut by_level: Vec<Vec<usize>> = vec![Vec::new(); LEVELS as usize];
        for (index, point) in targets.iter().enumerate() {
            if !point.iter().all(|x| x.is_finite()) {
                return Err(FlowError::NotFinite { index });
            }
            let resolving =
                |digits: f64| (0..LEVELS).find(|&l| self.resolves(l, point, &panel_decay, digits));
            let level = resolving(wanted).or_else(|| resolving(enough));
            let Some(level) = level else {
                return Err(FlowError::TooNear {
                    index,
                    point: *point,
                    tolerance,
                    least: self.least_distance(tolerance),
                });
            };
            by_level[level as usize].push(index);
        }
        let mut flow = vec![None; targets.len()];
        for (level, indices) in by_level.into_iter().enumerate() {
            if indices.is_empty() {
                continue;
            }
            let points = self.resample(level as u32)?;
            let found: Vec<T> = (indices.par_iter())
                .map(|&i| sum(&points, targets[i]))
                .collect();
            for (i, at) in indices.into_iter().zip(found) {
                flow[i] = Some(at);
            }
        }
        Ok(flow.into_iter().flatten().collect())
    }

    fn azimuths(&self, level: u32) -> usize {
        azimuths(self.layers.modes().max(16)) << level
    }

    /// Digits (natural logarithm) beyond which the density's own expansion leaves nothing to resolve.
    fn digits_of_density(&self, panel_decay: &[f64]) -> f64 {
        let order = self.discretization.order();
        let ends = panel_decay
            .chunks(order)
            .map(|c| c[order - 1].max(c[order - 2]));
        BELOW_LEFT_OUT - ends.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Whether both rules of a level are good to so many digits (natural logarithm) at a target.
    fn resolves(&self, level: u32, target: &Point3<f64>, panel_decay: &[f64], digits: f64) -> bool {
        let order = self.discretization.order();
        let (r, z) = (target.x.hypot(target.y), target.z);
        let count = self.azimuths(level) as f64;
        let parts = 1usize << level;
        (0..self.discretization.panels().len()).all(|panel| {
            let around = self.discretization.nodes_of(panel).iter().all(|node| {
                let h = ((r - node.r).powi(2) + (z - node.z).powi(2)) / (2.0 * r * node.r);
                let xi = 2.0 * (0.5 * h).sqrt().asinh();
                // Mode m of the density meets mode count - m of the kernel.
                (self.mode_decay.iter().enumerate())
                    .all(|(m, decay)| decay - (count - m as f64) * xi <= -digits)
            });
            let whole = self.discretization.panel(panel);
            let length = self.discretization.arc_length(panel) / parts as f64;
            let end = |k: usize| {
                let s = whole.start + whole.length() * k as f64 / parts as f64;
                let point = self.discretization.curve().point(s);
                [point.r, point.z]
            };
            let decay = &panel_decay[panel * order..][..order];
            let along = |k: usize| {
                let log_rho = BENT * bernstein([r, z], [end(k), end(k + 1)], length).ln();
                // Degree k of the density, k / parts on a part, leaves 2 order - k to the kernel.
                (decay.iter().enumerate()).all(|(k, decay)| {
                    let left = (2 * order) as f64 - k as f64 / parts as f64;
                    decay - left * log_rho <= -digits
                })
            };
            around && (0..parts).all(along)
        })
    }

    /// About the distance from the surface at which the finest resampling starts to resolve.
    fn least_distance(&self, tolerance: f64) -> f64 {
        let digits = -tolerance.ln() + MARGIN;
        let finest = LEVELS - 1;
        let order = self.discretization.order();
        let far = (digits / (2 * order) as f64).exp();
        let panels = 0..self.discretization.panels().len();
        let longest = panels
            .map(|p| self.discretization.arc_length(p))
            .fold(0.0, f64::max);
        let along = 0.25 * (far - 1.0 / far) * longest / f64::from(1u32 << finest);
        let widest = self
            .discretization
            .nodes()
            .iter()
            .map(|n| n.r)
            .fold(0.0, f64::max);
        let around = widest * digits / self.azimuths(finest) as f64;
        along.max(around)
    }

    /// The density on the points of a level.
    fn resample(&self, level: u32) -> Result<SurfacePoints, QuadratureError> {
        let discretization = self.discretization;
        let basis = discretization.basis();
        let order = discretization.order();
        let parts = 1usize << level;
        let count = self.azimuths(level);
        let fft: Arc<dyn Fft<f64>> = FftPlanner::new().plan_fft_inverse(count);
        let mut ring = vec![Complex64::default(); count];
        let mut components = vec![[0.0; 6]; count];
        let mut row = vec![0.0; order];
        let panels = discretization.panels().len();
        let mut points = SurfacePoints::with_capacity(panels * order * parts * count);
        let rotation: Vec<(f64, f64)> = (0..count)
            .map(|l| (2.0 * PI * l as f64 / count as f64).sin_cos())
            .collect();
        for panel in 0..panels {
            let whole = *discretization.panel(panel);
            for part in 0..parts {
                for (&x, &w) in basis.nodes().iter().zip(basis.weights()) {
                    let t = (2 * part + 1) as f64 / parts as f64 - 1.0 + x / parts as f64;
                    basis.interpolation_row(t, &mut row)?;
                    let ds = 0.5 * whole.length() * w / parts as f64;
                    let node = Node::new(&**discretization.curve(), whole.at(t), ds);
                    for (k, density) in [&self.layers.double, &self.layers.single]
                        .into_iter()
                        .enumerate()
                    {
                        for j in 0..3 {
                            spectrum(density, panel * order, &row, j, &mut ring);
                            fft.process(&mut ring);
                            for (components, value) in components.iter_mut().zip(&ring) {
                                components[3 * k + j] = value.re;
                            }
                        }
                    }
                    let area = node.weight * 2.0 * PI / count as f64;
                    for (&(sin, cos), components) in rotation.iter().zip(&components) {
                        let turned = |[radial, azimuthal, axial]: [f64; 3]| {
                            Vector3::new(
                                radial * cos - azimuthal * sin,
                                radial * sin + azimuthal * cos,
                                axial,
                            )
                        };
                        let [a, b, c, d, e, f] = *components;
                        let [nu_r, nu_z] = node.normal;
                        points.push(SurfacePoint {
                            position: turned([node.r, 0.0, node.z]),
                            normal: turned([nu_r, 0.0, nu_z]),
                            double: area * turned([a, b, c]),
                            single: area * turned([d, e, f]),
                        });
                    }
                }
            }
        }
        points.pad();
        Ok(points)
    }
}

/// The complex spectrum of component `j`, interpolated with `row` on the panel whose first node is `first`; its inverse
/// transform has the component as real part.
fn spectrum(density: &SurfaceModes, first: usize, row: &[f64], j: usize, ring: &mut [Complex64]) {
    ring.fill(Complex64::default());
    let interpolate = |n: usize, family: usize| -> f64 {
        let values = &density.component(n, family, j)[first..][..row.len()];
        values.iter().zip(row).map(|(x, l)| x * l).sum()
    };
    for (n, ring) in ring.iter_mut().enumerate().take(density.modes()) {
        let (first, second) = (interpolate(n, 0), interpolate(n, 1));
        // Re((c - i s) e^{i n theta}) = c cos + s sin.
        *ring = if j == 1 {
            Complex64::new(-second, -first)
        } else {
            Complex64::new(first, -second)
        };
    }
}

/// Logarithm of an amplitude relative to the largest.
fn log_ratio(amplitude: f64, largest: f64) -> f64 {
    (amplitude / largest).max(1e-300).ln()
}

/// Panel after panel, the largest Legendre coefficients of the density along the panel, over all modes and components.
fn legendre_amplitudes(
    discretization: &Discretization,
    density: &SurfaceModes,
) -> Result<Vec<f64>, QuadratureError> {
    let order = discretization.order();
    let mut amplitudes = vec![0.0f64; discretization.nodes().len()];
    let components =
        (0..density.modes()).flat_map(|n| (0..6).map(move |k| density.component(n, k / 3, k % 3)));
    for component in components {
        for (values, amplitudes) in component.chunks(order).zip(amplitudes.chunks_mut(order)) {
            let coefficients = discretization.basis().coefficients(values)?;
            for (amplitude, coefficient) in amplitudes.iter_mut().zip(coefficients) {
                *amplitude = amplitude.max(coefficient.abs());
            }
        }
    }
    Ok(amplitudes)
}
