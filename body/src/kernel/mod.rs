//! Stokes kernels, in free space and mode by mode around the axis.
//!
//! With $\bar x = x - x'$, $d = \lvert\bar x\rvert$ and viscosity 1 the kernels are (Pozrikidis
//! 1992, sections 2.2 and 2.3; the signs are those of a source at $x'$ acting on the fluid)
//!
//! - single layer (Stokeslet):
//!   $S_{ij} = \frac{1}{8\pi} \left( \frac{\delta_{ij}}{d} + \frac{\bar x_i \bar x_j}{d^3} \right)$
//! - double layer (stresslet with normal $\nu'$):
//!   $D_{ij} = \frac{3}{4\pi} \frac{\bar x_i \bar x_j\\, \bar x\cdot\nu'}{d^5}$
//! - traction of the single layer:
//!   $T_{ij} = -\frac{3}{4\pi} \frac{\bar x_i \bar x_j\\, \bar x\cdot\nu}{d^5}$
//! - pressure of the single layer: $P^S_j = \frac{1}{4\pi} \frac{\bar x_j}{d^3}$
//! - pressure of the double layer:
//!   $P^D_j = \frac{1}{2\pi}
//!   \left( -\frac{\nu'_j}{d^3} + \frac{3 \bar x_j\\, \bar x\cdot\nu'}{d^5} \right)$
//!
//! # Modes
//!
//! In cylindrical components, row $i$ in the target's frame and column $j$ in the source's, a
//! kernel depends on the azimuths through $t = \theta - \theta'$ alone. It is even in $t$ when it
//! has no azimuthal index or two, and odd when it has one. Mode $n$ is the real number
//!
//! $$ K_{ij}(n) = \int_{-\pi}^{\pi} K_{ij}(t) \cos nt\\, dt \ \text{(even)}, \qquad
//!    \int_{-\pi}^{\pi} K_{ij}(t) \sin nt\\, dt \ \text{(odd)} . $$
//!
//! Near the singularity the modes come from toroidal functions, without cancellation (`moments`);
//! for well-separated pairs from one FFT per four entries (`fourier`).

#[doc(hidden)]
pub mod bench;
mod close;
mod combined;
mod direct;
mod double_layer;
mod fourier;
mod invariant;
mod modes;
mod moments;
mod pair;
mod potential;
mod pressure;
mod rings;
mod single_layer;
mod stokeslet;
#[cfg(test)]
mod tests;
mod traction;

pub(crate) use close::{DENSITIES, Potential, VelocityPressure, VelocityPressureGradient};
pub(crate) use combined::CombinedField;
pub use direct::SurfacePoint;
pub use direct::{FlowAt, FlowGradientAt};
pub(crate) use direct::{SurfacePoints, layer_velocity};
pub(crate) use double_layer::DoubleLayer;
pub(crate) use invariant::{Kernel, Parity};
pub(crate) use modes::{Modes, SourceRings, TargetRing, Workspace};
pub(crate) use pair::Pair;
pub(crate) use potential::{Columns, RingDensities, RingFields};
pub(crate) use pressure::{DoubleLayerPressure, SingleLayerPressure};
pub use rings::{Ring, RingKernel};
pub(crate) use single_layer::SingleLayer;
pub use stokeslet::Stokeslet;
pub(crate) use traction::SingleLayerTraction;
