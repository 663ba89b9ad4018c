//! The flow of both layers away from the surface: direct sums over points.
//!
//! With the trapezoidal rule in the azimuth and Gauss–Legendre panels along the curve both
//! converge exponentially in the number of points per distance; where they do not resolve a panel's
//! action, the fields of `close` take over.

use std::f64::consts::PI;
use std::ops::Range;

use nalgebra::Vector3;
use num_complex::Complex64;
use panel_quadrature::QuadratureError;

use super::densities::Densities;
use super::discretization::Discretization;
use super::fft;
use super::linear_flow::LAST_MODE;
use super::near::bend;
use super::surface::azimuths;
use crate::kernel::{DENSITIES, SurfacePoint, SurfacePoints};
use bodies_of_revolution::Meridian;

/// Natural logarithm of the factor in front of the powers in the rules' error bounds: it is large
/// because the kernels are large near the surface.
const MARGIN: f64 = 7.0;

/// The densities on points of the surface.
#[derive(Clone, Debug)]
pub(super) struct FarFlow {
    /// Panel after panel, each padded.
    pub points: SurfacePoints,
    per_panel: usize,
    pub azimuths: usize,
    order: usize,
    /// Logarithm of each mode's largest coefficient relative to the largest of all, and panel after
    /// panel the same of its Legendre coefficients along the curve.
    mode_decay: Vec<f64>,
    panel_decay: Vec<f64>,
}

/// From which separation on the points resolve a panel's action, to a tolerance.
#[derive(Debug)]
pub struct Separation {
    /// $\chi - 1$ of the rings.
    h: f64,
    panels: Vec<PanelSeparation>,
}

/// From where on a target is far enough from one panel.
#[derive(Debug)]
struct PanelSeparation {
    /// Radius and height of the panel's ends, and the least sum of a target's distances from them:
    /// what makes the Bernstein ellipse large enough.
    ends: [[f64; 2]; 2],
    sum: f64,
    /// A circle in the half plane that all nodes lie in, and their largest radius.
    center: [f64; 2],
    radius: f64,
    widest: f64,
}

impl FarFlow {
    /// Puts the densities on points.
    pub fn new(
        discretization: &Discretization,
        densities: &Densities,
    ) -> Result<Self, QuadratureError> {
        let azimuths = azimuths(densities.modes().max(16));
        let points = sample(discretization, densities, azimuths);
        Ok(Self {
            per_panel: points.len() / discretization.panels().len(),
            points,
            azimuths,
            order: discretization.order(),
            mode_decay: densities.mode_decay(),
            panel_decay: densities.panel_decay(discretization)?,
        })
    }

    /// The points of a panel.
    pub fn panel(&self, panel: usize) -> Range<usize> {
        panel * self.per_panel..(panel + 1) * self.per_panel
    }

    /// The separation for an error below `tolerance` relative to the densities.
    pub fn separation(&self, discretization: &Discretization, tolerance: f64) -> Separation {
        Separation::new(
            discretization,
            tolerance,
            [self.order, self.azimuths],
            &self.mode_decay,
            self.panel_decay.chunks(self.order),
        )
    }
}

impl Separation {
    /// The separation of points on `order` nodes of each panel and on `azimuths`, for an error
    /// below `tolerance` relative to the density.
    ///
    /// `mode_decay` and `panel_decay` are logarithms of the density's modes, and of its Legendre
    /// coefficients on each panel, relative to the largest.
    fn new<'d>(
        discretization: &Discretization,
        tolerance: f64,
        [order, azimuths]: [usize; 2],
        mode_decay: &[f64],
        panel_decay: impl Iterator<Item = &'d [f64]>,
    ) -> Self {
        let digits = MARGIN - tolerance.ln();
        // The rule aliases mode m of the density with mode count - m of the kernel.
        let xi = (mode_decay.iter().enumerate())
            .map(|(m, decay)| (decay + digits) / (azimuths - m) as f64)
            .fold(0.0, f64::max);
        // The rule is exact up to degree 2 order: degree k of the density leaves 2 order - k to the
        // kernel.
        let log_rho = |decay: &[f64]| {
            (decay.iter().enumerate())
                .map(|(k, x)| (x + digits) / (2 * order - k) as f64)
                .fold(0.0, f64::max)
        };
        let panels = panel_decay.enumerate().map(|(panel, decay)| {
            let log_rho = log_rho(decay);
            PanelSeparation::new(discretization, panel, log_rho)
        });
        Self {
            h: 2.0 * (0.5 * xi).sinh().powi(2),
            panels: panels.collect(),
        }
    }

    /// The same for any density that is resolved to the tolerance by modes up to `n_max` and the
    /// nodes of `discretization`, which may be fewer than the points: its coefficients are taken to
    /// fall steadily to the tolerance at the last one. The modes of rigid motions and linear flows
    /// may all be as large as the largest.
    pub fn of_resolved(
        discretization: &Discretization,
        n_max: usize,
        points: [usize; 2],
        tolerance: f64,
    ) -> Self {
        let steady = |count: usize, from: usize| -> Vec<f64> {
            (0..count)
                .map(|k| {
                    let beyond = k.saturating_sub(from) as f64;
                    tolerance.ln() * beyond / count.saturating_sub(from).max(1) as f64
                })
                .collect()
        };
        let along = steady(discretization.order(), 0);
        let panels = discretization.panels().len();
        Self::new(
            discretization,
            tolerance,
            points,
            &steady(n_max + 1, LAST_MODE),
            std::iter::repeat_n(&along[..], panels),
        )
    }

    /// The largest distance from a sphere of the given radius, which the body fits in, at which a
    /// target may be too close for the points.
    pub fn reach(&self, radius: f64) -> f64 {
        // On rings: d^2 < 2 h r (r + d).
        let hr = self.h * radius;
        let around = hr + (hr * hr + 2.0 * hr * radius).sqrt();
        // On panels: at least half the sum of the distances from both ends.
        let along = self.panels.iter().map(|panel| 0.5 * panel.sum);
        along.fold(around, f64::max)
    }

    /// Whether the points resolve what a panel does to a target.
    pub fn is_kept(&self, discretization: &Discretization, target: Meridian, panel: usize) -> bool {
        let bounds = &self.panels[panel];
        let at = [target.r, target.z];
        let [first, last] = bounds.ends.map(|end| distance(at, end));
        if first + last < bounds.sum {
            return false;
        }
        // Most targets are far from all nodes together.
        let gap = distance(at, bounds.center) - bounds.radius;
        if gap > 0.0 && gap * gap >= self.h * 2.0 * target.r * bounds.widest {
            return true;
        }
        discretization.nodes_of(panel).iter().all(|node| {
            let square = (target.r - node.r).powi(2) + (target.z - node.z).powi(2);
            square >= self.h * 2.0 * target.r * node.r
        })
    }
}

impl PanelSeparation {
    /// For an ellipse whose parameter has this logarithm, a bend counted.
    fn new(discretization: &Discretization, panel: usize, log_rho: f64) -> Self {
        let ends = discretization.ends(panel);
        let center = [0, 1].map(|k| 0.5 * (ends[0][k] + ends[1][k]));
        let nodes = discretization.nodes_of(panel);
        let from_center = nodes.iter().map(|node| distance([node.r, node.z], center));
        // The sum of the distances, in half lengths, is rho + 1/rho.
        let rho = log_rho * bend(discretization, panel);
        Self {
            ends,
            sum: discretization.arc_length(panel) * rho.cosh(),
            center,
            radius: from_center.fold(0.0, f64::max),
            widest: nodes.iter().map(|node| node.r).fold(0.0, f64::max),
        }
    }
}

/// In the half plane. A square root of squares: `hypot` takes several times as long, and here no
/// square of interest overflows.
fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt()
}

/// The densities on so many azimuths of every node.
fn sample(discretization: &Discretization, densities: &Densities, count: usize) -> SurfacePoints {
    let nodes = discretization.nodes();
    let fft = fft::inverse(count);
    let mut ring = vec![Complex64::default(); count];
    let mut components = vec![[0.0; 6]; count];
    let mut points = SurfacePoints::with_capacity(nodes.len() * count);
    let rotation: Vec<(f64, f64)> = (0..count)
        .map(|l| (2.0 * PI * l as f64 / count as f64).sin_cos())
        .collect();
    for (k, node) in nodes.iter().enumerate() {
        for j in 0..6 {
            spectrum(densities, k, j, &mut ring);
            fft.process(&mut ring);
            for (components, value) in components.iter_mut().zip(&ring) {
                components[j] = value.re;
            }
        }
        let area = node.weight * 2.0 * PI / count as f64;
        for (&(sin, cos), components) in rotation.iter().zip(&components) {
            let turned = |radial: f64, azimuthal: f64, axial: f64| {
                Vector3::new(
                    radial * cos - azimuthal * sin,
                    radial * sin + azimuthal * cos,
                    axial,
                )
            };
            let density = |which: usize| {
                let [radial, azimuthal, axial] = [0, 1, 2].map(|j| components[3 * which + j]);
                area * turned(radial, azimuthal, axial)
            };
            let [nu_r, nu_z] = node.normal;
            points.push(SurfacePoint {
                position: turned(node.r, 0.0, node.z),
                normal: turned(nu_r, 0.0, nu_z),
                double: density(0),
                single: density(1),
            });
        }
        if (k + 1) % discretization.order() == 0 {
            points.pad();
        }
    }
    points
}

/// The complex spectrum of density `j` (of both layers) at node `k`; its inverse transform has the
/// density as real part.
fn spectrum(densities: &Densities, k: usize, j: usize, ring: &mut [Complex64]) {
    ring.fill(Complex64::default());
    for (n, ring) in ring.iter_mut().enumerate().take(densities.modes()) {
        let [first, second] = [0, 1].map(|f| densities.row((2 * n + f) * DENSITIES + j)[k]);
        // Re((c - i s) e^{i n theta}) = c cos + s sin.
        *ring = if j % 3 == 1 {
            Complex64::new(-second, -first)
        } else {
            Complex64::new(first, -second)
        };
    }
}
