//! The pressures of the single and the double layer.

use std::f64::consts::PI;

use pulp::Simd;

use super::invariant::{Kernel, Parity};
use super::moments::Moments;
use super::pair::{Pair, Separation};
use f64_lanes::Lanes;

/// The kernel $P^S_j = \bar x_j / 4\pi|\bar x|^3$; three entries, in units of 1/length².
#[derive(Clone, Copy, Debug, Default)]
pub struct SingleLayerPressure;

/// The kernel $P^D_j = (-\nu'_j/|\bar x|^3 + 3 \bar x_j\\, \bar x\cdot\nu'/|\bar x|^5)/2\pi$ for
/// viscosity 1; three entries, in units of 1/length³.
#[derive(Clone, Copy, Debug, Default)]
pub struct DoubleLayerPressure;

impl Kernel<3> for SingleLayerPressure {
    const PARITY: [Parity; 3] = Parity::OF_PRESSURE;

    #[inline(always)]
    fn mode<S: Simd>(&self, pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; 3] {
        let factor = 1.0 / (4.0 * PI);
        let e0 = factor * m.e0;
        let e1 = factor * m.e1;
        let e1_over_rho2 = e1 * pair.inv_rho2;
        [
            pair.a * e1_over_rho2 - 0.5 * pair.inv_rp * (e0 - e1),
            m.n * pair.inv_rp * e0,
            pair.b * e1_over_rho2,
        ]
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, s: &Separation<S>) -> [Lanes<S>; 3] {
        let strength = (1.0 / (4.0 * PI)) * s.inv * s.inv * s.inv;
        [strength * s.xp[0], strength * s.xp[1], strength * s.xp[2]]
    }
}

impl Kernel<3> for DoubleLayerPressure {
    const PARITY: [Parity; 3] = Parity::OF_PRESSURE;

    #[inline(always)]
    fn mode<S: Simd>(&self, pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; 3] {
        let Pair {
            r,
            a,
            b,
            nu_r,
            nu_z,
            ..
        } = *pair;
        let factor = 1.0 / (2.0 * PI);
        let moments = m.cubic(pair);
        let beta = (3.0 * factor) * (nu_r * a + nu_z * b);
        let alpha = (3.0 * factor) * nu_r * r;
        let even = |k: usize| beta * moments.g[k] - alpha * moments.g[k + 1];
        let (g0, g1) = (even(0), even(1));
        let e1 = factor * m.e1 * pair.inv_rho2;
        [
            a * g0 - r * g1 - nu_r * e1,
            r * (beta * moments.h[0] - alpha * moments.h[1]),
            b * g0 - nu_z * e1,
        ]
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, s: &Separation<S>) -> [Lanes<S>; 3] {
        let inv2 = s.inv * s.inv;
        let strength = (1.0 / (2.0 * PI)) * s.inv * inv2;
        let along = 3.0 * inv2 * s.x_nu;
        [
            strength * (along * s.xp[0] - s.nu[0]),
            strength * (along * s.xp[1] - s.nu[1]),
            strength * (along * s.xp[2] - s.nu[2]),
        ]
    }
}
