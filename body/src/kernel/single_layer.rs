//! The single layer's velocity: the Stokeslet.

use std::f64::consts::PI;

use pulp::Simd;

use super::invariant::{Kernel, Parity};
use super::moments::Moments;
use super::pair::{Pair, Separation};
use f64_lanes::Lanes;

/// The single-layer kernel $S_{ij} = (\delta_{ij}/|\bar x| + \bar x_i \bar x_j/|\bar x|^3)/8\pi$
/// for viscosity 1; nine entries, row by row, in units of 1/length.
#[derive(Clone, Copy, Debug, Default)]
pub struct SingleLayer;

impl Kernel<9> for SingleLayer {
    const PARITY: [Parity; 9] = Parity::OF_VELOCITY;

    #[inline(always)]
    fn mode<S: Simd>(&self, pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; 9] {
        let Pair { r, rp, a, b, .. } = *pair;
        // int sin^2 t cos(nt) q^{-3/2} R / 2, and the logarithm E_0 - rho^2 E_1.
        let w = 0.5 * m.e_minus1_over_big_r + 0.5 * pair.h * (m.e1 - 2.0 * m.e0);
        let t = m.e0 - m.e1;
        let e1 = m.e1 * pair.inv_rho2;
        let swirl = (2.0 * m.n) * pair.inv_big_r * m.e0;
        let half_rho2 = 0.5 * pair.rho2;
        let mut entries = [
            m.e0_cos + a * a * pair.inv_rho2 * m.e1_cos - w,
            1.5 * m.e0_sin + (a * r - half_rho2) * swirl,
            b * (a * e1 + 0.5 * pair.inv_r * t),
            -1.5 * m.e0_sin + (a * rp + half_rho2) * swirl,
            m.e0_cos + t - w,
            b * rp * swirl,
            b * (a * e1 - 0.5 * pair.inv_rp * t),
            b * r * swirl,
            m.e0 + b * b * e1,
        ];
        for entry in &mut entries {
            *entry = *entry * (1.0 / (8.0 * PI));
        }
        entries
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, s: &Separation<S>) -> [Lanes<S>; 9] {
        let zero = Lanes::splat(s.inv.0, 0.0);
        let one = Lanes::splat(s.inv.0, 1.0);
        let frame = [s.cos, s.sin, zero, -s.sin, s.cos, zero, zero, zero, one];
        let inv2 = s.inv * s.inv;
        let inv = s.inv * (1.0 / (8.0 * PI));
        let mut entries = frame;
        for (k, entry) in entries.iter_mut().enumerate() {
            *entry = inv * (*entry + inv2 * s.x[k / 3] * s.xp[k % 3]);
        }
        entries
    }
}
