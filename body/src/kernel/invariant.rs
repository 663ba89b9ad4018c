//! What a rotationally invariant kernel is.
//!
//! Between two rings it depends on the azimuths through their difference alone, so it has modes.

use pulp::Simd;

use super::moments::Moments;
use super::pair::{Pair, Separation};
use f64_lanes::Lanes;

/// Whether an entry of a kernel is even or odd in the azimuthal separation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Parity {
    Even,
    Odd,
}

impl Parity {
    /// Velocity from density: odd where exactly one index is azimuthal.
    pub const OF_VELOCITY: [Self; 9] = {
        use Parity::{Even, Odd};
        [Even, Odd, Even, Odd, Even, Odd, Even, Odd, Even]
    };

    /// Pressure from density.
    pub const OF_PRESSURE: [Self; 3] = [Self::Even, Self::Odd, Self::Even];
}

/// A rotationally invariant kernel with `K` entries.
pub(crate) trait Kernel<const K: usize>: Copy + Send + Sync {
    /// The entries' parities.
    const PARITY: [Parity; K];

    /// Mode `m.n` of every entry.
    fn mode<S: Simd>(&self, pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; K];

    /// Every entry at one azimuthal separation.
    fn sample<S: Simd>(&self, separation: &Separation<S>) -> [Lanes<S>; K];
}
