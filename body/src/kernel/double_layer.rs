//! The double layer's velocity: the stresslet with the source's normal.

use std::f64::consts::PI;

use pulp::Simd;

use super::invariant::{Kernel, Parity};
use super::moments::Moments;
use super::pair::{Pair, Separation};
use f64_lanes::Lanes;

/// The double-layer kernel
/// $D_{ij} = \frac{3}{4\pi} \bar x_i \bar x_j\\, \bar x\cdot\nu' / |\bar x|^5$; nine entries, row
/// by row, in units of 1/length². The exterior limit of its potential is $+\frac12$ of the density
/// plus the principal value.
#[derive(Clone, Copy, Debug, Default)]
pub struct DoubleLayer;

/// Modes of $\bar x_i \bar x_j (\beta - \alpha c) / |\bar x|^5$.
#[inline(always)]
pub(super) fn cubic_modes<S: Simd>(
    pair: &Pair<S>,
    m: &Moments<S>,
    beta: Lanes<S>,
    alpha: Lanes<S>,
) -> [Lanes<S>; 9] {
    let Pair { r, rp, a, b, .. } = *pair;
    let moments = m.cubic(pair);
    let even = |k: usize| beta * moments.g[k] - alpha * moments.g[k + 1];
    let odd = |k: usize| beta * moments.h[k] - alpha * moments.h[k + 1];
    let (g0, g1, g2) = (even(0), even(1), even(2));
    let (h0, h1) = (odd(0), odd(1));
    let product = r * rp;
    let a2 = a * a;
    [
        a2 * (g0 - g1) - product * g2,
        r * (a * h0 + rp * h1),
        b * (a * g0 + rp * g1),
        rp * (a * h0 - r * h1),
        product * (2.0 * g1 - g2),
        rp * b * h0,
        b * (a * g0 - r * g1),
        r * b * h0,
        b * b * g0,
    ]
}

/// `strength` times $\bar x_i \bar x_j$.
#[inline(always)]
pub(super) fn dyad<S: Simd>(strength: Lanes<S>, s: &Separation<S>) -> [Lanes<S>; 9] {
    let mut entries = [strength; 9];
    for (k, entry) in entries.iter_mut().enumerate() {
        *entry = strength * s.x[k / 3] * s.xp[k % 3];
    }
    entries
}

impl Kernel<9> for DoubleLayer {
    const PARITY: [Parity; 9] = Parity::OF_VELOCITY;

    #[inline(always)]
    fn mode<S: Simd>(&self, pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; 9] {
        let factor = 3.0 / (4.0 * PI);
        let beta = pair.nu_r * pair.a + pair.nu_z * pair.b;
        cubic_modes(pair, m, factor * beta, factor * pair.nu_r * pair.r)
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, s: &Separation<S>) -> [Lanes<S>; 9] {
        let inv2 = s.inv * s.inv;
        let strength = (3.0 / (4.0 * PI)) * s.x_nu * s.inv * inv2 * inv2;
        dyad(strength, s)
    }
}
