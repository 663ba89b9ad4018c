//! The traction of the single layer on a surface element at the target.

use std::f64::consts::PI;

use pulp::Simd;

use super::double_layer::{cubic_modes, dyad};
use super::invariant::{Kernel, Parity};
use super::moments::Moments;
use super::pair::{Pair, Separation};
use f64_lanes::Lanes;

/// The kernel $T_{ij} = -\frac{3}{4\pi} \bar x_i \bar x_j\\, \bar x\cdot\nu / |\bar x|^5$ with the
/// target's normal; nine entries, row by row, in units of 1/length²: the adjoint of the double
/// layer. The exterior limit of its potential is $-\frac12$ of the density plus the principal
/// value.
#[derive(Clone, Copy, Debug, Default)]
pub struct SingleLayerTraction;

impl Kernel<9> for SingleLayerTraction {
    const PARITY: [Parity; 9] = Parity::OF_VELOCITY;

    #[inline(always)]
    fn mode<S: Simd>(&self, pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; 9] {
        let factor = -3.0 / (4.0 * PI);
        let beta = pair.mu_r * pair.a + pair.mu_z * pair.b;
        cubic_modes(pair, m, factor * beta, -factor * pair.mu_r * pair.rp)
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, s: &Separation<S>) -> [Lanes<S>; 9] {
        let inv2 = s.inv * s.inv;
        let strength = (-3.0 / (4.0 * PI)) * s.x_mu * s.inv * inv2 * inv2;
        dyad(strength, s)
    }
}
