//! What `benches/` reach the kernels by; no part of the library's interface.

use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use super::{
    CombinedField, FlowAt, Modes, SourceRings, SurfacePoint, SurfacePoints, TargetRing, Workspace,
};

/// How the modes of a pair are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// By the recurrence of toroidal functions.
    Recurrence,
    /// By an FFT, for pairs that are well separated.
    Fourier,
}

/// The combined field between one ring and many at the same distance.
#[derive(Debug)]
pub struct ModalPairs {
    modes: Modes,
    target: TargetRing,
    sources: SourceRings,
    workspace: Workspace,
}

impl ModalPairs {
    /// Rings of radius about 1, `distance` from the target.
    pub fn new(n_max: usize, count: usize, distance: f64, method: Method) -> Self {
        let mut sources = SourceRings::default();
        for k in 0..count {
            let (sin, cos) = (k as f64 / count as f64).sin_cos();
            let [a, b] = [distance * sin, distance * cos];
            sources.push(1.0 - a, [a, b], [cos, sin]);
        }
        let far = match method {
            Method::Recurrence => f64::INFINITY,
            Method::Fourier => 0.0,
        };
        Self {
            modes: Modes::with_far(n_max, far),
            target: TargetRing {
                r: 1.0,
                normal: [1.0, 0.0],
            },
            sources,
            workspace: Workspace::default(),
        }
    }

    /// Evaluates all modes of all pairs.
    pub fn evaluate(&mut self) -> &[f64] {
        let kernel = CombinedField { eta: 1.0 };
        self.modes
            .evaluate(&kernel, self.target, &self.sources, &mut self.workspace);
        &self.workspace.block
    }
}

/// A direct sum over points of a surface.
#[derive(Debug)]
pub struct DirectSum(SurfacePoints);

impl DirectSum {
    /// So many points on a line.
    pub fn new(count: usize) -> Self {
        let mut points = SurfacePoints::with_capacity(count);
        for k in 0..count {
            let x = Vector3::new(k as f64, 1.0, -1.0);
            points.push(SurfacePoint {
                position: x,
                normal: Vector3::z(),
                double: Vector3::x(),
                single: Vector3::x(),
            });
        }
        points.pad();
        Self(points)
    }

    /// The flow at targets.
    pub fn flow(&self, targets: &[Point3<f64>]) -> Vec<FlowAt> {
        targets
            .par_iter()
            .map(|&x| self.0.sum::<false>(0..self.0.len(), x).into())
            .collect()
    }
}
