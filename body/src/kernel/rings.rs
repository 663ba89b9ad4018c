//! Modal kernels between two rings, for use on their own.

use super::{
    DoubleLayer, DoubleLayerPressure, Kernel, Modes, SingleLayer, SingleLayerPressure,
    SingleLayerTraction, SourceRings, TargetRing, Workspace,
};

/// A circle about the axis, with the normal of the surface it belongs to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Radius, positive.
    pub r: f64,
    /// Height along the axis.
    pub z: f64,
    /// Unit normal, radial and axial component.
    pub normal: [f64; 2],
}

/// Which kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RingKernel {
    /// Velocity of the single layer: nine entries, row by row, in 1/length.
    SingleLayer,
    /// Velocity of the double layer, with the source's normal: nine entries, in 1/length².
    DoubleLayer,
    /// Traction of the single layer, with the target's normal: nine entries, in 1/length².
    SingleLayerTraction,
    /// Pressure of the single layer: three entries, in 1/length².
    SingleLayerPressure,
    /// Pressure of the double layer, with the source's normal: three entries, in 1/length³.
    DoubleLayerPressure,
}

impl RingKernel {
    /// Entries per mode.
    pub fn entries(self) -> usize {
        match self {
            Self::SingleLayer | Self::DoubleLayer | Self::SingleLayerTraction => 9,
            Self::SingleLayerPressure | Self::DoubleLayerPressure => 3,
        }
    }

    /// Modes $0 \dots n_\text{max}$ (as defined in the [module](super)'s notes) at `target` from
    /// `source`: one row of [`entries`](Self::entries) numbers a mode. Where the rings coincide
    /// they are infinite or NaN.
    ///
    /// ```
    /// use stokes_body::kernel::{Ring, RingKernel};
    ///
    /// let source = Ring { r: 1.0, z: 0.0, normal: [1.0, 0.0] };
    /// let target = Ring { r: 1.0, z: 2.0, normal: [1.0, 0.0] };
    /// // Axial pull on a ring of axial Stokeslets:
    /// // int (1/|x| + z^2/|x|^3)/(8 pi) dt > 2 pi/(4 pi) / |x|_max.
    /// let modes = RingKernel::SingleLayer.modes(&target, &source, 3);
    /// assert!(modes[0][8] > 0.5 / 8f64.sqrt() && modes[0][8] < 0.5 / 2.0);
    /// ```
    pub fn modes(self, target: &Ring, source: &Ring, n_max: usize) -> Vec<Vec<f64>> {
        match self {
            Self::SingleLayer => between(&SingleLayer, target, source, n_max),
            Self::DoubleLayer => between(&DoubleLayer, target, source, n_max),
            Self::SingleLayerTraction => between(&SingleLayerTraction, target, source, n_max),
            Self::SingleLayerPressure => between(&SingleLayerPressure, target, source, n_max),
            Self::DoubleLayerPressure => between(&DoubleLayerPressure, target, source, n_max),
        }
    }
}

fn between<const K: usize>(
    kernel: &impl Kernel<K>,
    target: &Ring,
    source: &Ring,
    n_max: usize,
) -> Vec<Vec<f64>> {
    let mut sources = SourceRings::default();
    sources.push(
        source.r,
        [target.r - source.r, target.z - source.z],
        source.normal,
    );
    let mut workspace = Workspace::default();
    let at = TargetRing {
        r: target.r,
        normal: target.normal,
    };
    Modes::new(n_max).evaluate(kernel, at, &sources, &mut workspace);
    let entry = |n: usize, k: usize| workspace.block[(n * K + k) * workspace.stride];
    (0..=n_max)
        .map(|n| (0..K).map(|k| entry(n, k)).collect())
        .collect()
}
