//! Azimuthal moments of the powers of the distance, from the toroidal functions.
//!
//! With $c = 1 - \cos t$ and $|\bar x|^2 = q = \rho^2 + R c$,
//!
//! $$ E_m(n) = \int_{-\pi}^{\pi} \frac{\cos nt}{q^{m+1/2}}\\, dt, \qquad
//!    \int_{-\pi}^{\pi} \frac{c^k \cos nt}{q^{m+1/2}}\\, dt, \qquad
//!    \int_{-\pi}^{\pi} \frac{c^k \sin t \sin nt}{q^{m+1/2}}\\, dt . $$
//!
//! Powers of $c$, unlike powers of $\cos t$, are small where the singularity is, so the kernels
//! written in them are sums of terms of the size of the result. Every moment follows from the
//! bounded numbers $e_m = \rho^{2m} E_m$; with $k_0 = 2\sqrt2/\sqrt R$, $\nu = n - 1/2$ and
//! $G_n = \nu (D_{n-1} - h Q_n)$
//!
//! $$ e_0 = k_0 Q_n, \quad e_1 = \frac{2 k_0 G_n}{h+2}, \quad
//!    e_2 = \frac{4 k_0}{3}\left[\frac{(n^2 - \tfrac14) h Q_n}{h+2} +
//!    \frac{2 (1+h) G_n}{(h+2)^2}\right] . $$

use pulp::Simd;

use super::pair::Pair;
use f64_lanes::Lanes;

/// The moments of one mode.
#[derive(Clone, Copy)]
pub(crate) struct Moments<S: Simd> {
    /// The mode.
    pub n: f64,
    /// $E_{-1}(n) / R$.
    pub e_minus1_over_big_r: Lanes<S>,
    /// $E_0$, $\rho^2 E_1$, $\rho^4 E_2$.
    pub e0: Lanes<S>,
    pub e1: Lanes<S>,
    pub e2: Lanes<S>,
    /// $(E_0(n-1) + E_0(n+1))/2$ and the same of $\rho^2 E_1$: the moments with another factor
    /// $\cos t$.
    pub e0_cos: Lanes<S>,
    pub e1_cos: Lanes<S>,
    /// $(E_0(n-1) - E_0(n+1))/2$: the moment $\int \sin t \sin nt\\, q^{-1/2}$.
    pub e0_sin: Lanes<S>,
}

/// Makes the moments of one register of pairs, mode after mode, from a ladder of toroidal
/// functions.
pub(crate) struct MomentSeries<'a, S: Simd> {
    q: &'a [S::f64s],
    d: &'a [S::f64s],
    k0: Lanes<S>,
    h: Lanes<S>,
    /// $1/(h+2)$.
    inv: Lanes<S>,
    e1: [Lanes<S>; 3],
}

impl<'a, S: Simd> MomentSeries<'a, S> {
    /// `q`, `d` (times `scale`) hold $Q_{n-1/2}$ and $D_n$ one degree beyond the last mode wanted.
    #[inline(always)]
    pub fn new(pair: &Pair<S>, q: &'a [S::f64s], d: &'a [S::f64s], scale: Lanes<S>) -> Self {
        let h = pair.h;
        let inv = 1.0 / (h + 2.0);
        let k0 = scale * (8.0 * pair.inv_big_r).sqrt();
        let mut series = Self {
            q,
            d,
            k0,
            h,
            inv,
            e1: [k0; 3],
        };
        // E_1 is even in n, so the mode before the zeroth is the first.
        series.e1 = [series.e1(1), series.e1(0), series.e1(1)];
        series
    }

    #[inline(always)]
    fn q(&self, n: usize) -> Lanes<S> {
        Lanes(self.h.0, self.q[n])
    }

    #[inline(always)]
    fn d(&self, n: usize) -> Lanes<S> {
        Lanes(self.h.0, self.d[n])
    }

    #[inline(always)]
    fn g(&self, n: usize) -> Lanes<S> {
        if n == 0 {
            0.5 * (self.d(0) + self.h * self.q(0))
        } else {
            (n as f64 - 0.5) * (self.d(n - 1) - self.h * self.q(n))
        }
    }

    #[inline(always)]
    fn e1(&self, n: usize) -> Lanes<S> {
        2.0 * self.k0 * self.g(n) * self.inv
    }

    /// The moments of mode `n`; to be called for n = 0, 1, 2, ... in turn.
    #[inline(always)]
    pub fn next(&mut self, n: usize) -> Moments<S> {
        if n > 0 {
            self.e1 = [self.e1[1], self.e1[2], self.e1(n + 1)];
        }
        let nf = n as f64;
        let (k0, h, inv) = (self.k0, self.h, self.inv);
        let q = self.q(n);
        let e0 = k0 * q;
        let e1 = self.e1[1];
        let e2 = (4.0 / 3.0 * inv) * ((nf * nf - 0.25) * h * e0 + (1.0 + h) * e1);
        let half = 0.5 * k0;
        let (e0_cos, e0_sin, e_minus1_over_big_r) = if n == 0 {
            let zero = Lanes::splat(h.0, 0.0);
            (k0 * self.q(1), zero, h * e0 + k0 * self.d(0))
        } else {
            let sin = half * (self.d(n - 1) + self.d(n));
            let cos = half * (self.q(n - 1) + self.q(n + 1));
            (cos, sin, (-0.5 / nf) * sin)
        };
        Moments {
            n: nf,
            e_minus1_over_big_r,
            e0,
            e1,
            e2,
            e0_cos,
            e1_cos: 0.5 * (self.e1[0] + self.e1[2]),
            e0_sin,
        }
    }
}

/// Moments of $c^k q^{-5/2}$ with $\cos nt$ ($k = 0 \dots 3$) and $\sin t \sin nt$
/// ($k = 0 \dots 2$): what kernels of the stresslet's strength are made of.
#[derive(Clone, Copy)]
pub(crate) struct CubicMoments<S: Simd> {
    pub g: [Lanes<S>; 4],
    pub h: [Lanes<S>; 3],
}

impl<S: Simd> Moments<S> {
    /// The moments of $q^{-5/2}$.
    #[inline(always)]
    pub fn cubic(&self, pair: &Pair<S>) -> CubicMoments<S> {
        let Self { n, e0, e1, e2, .. } = *self;
        let inv_big_r2 = pair.inv_big_r * pair.inv_big_r;
        let inv_mixed = pair.inv_big_r * pair.inv_rho2;
        let n_inv_big_r2 = n * inv_big_r2;
        CubicMoments {
            g: [
                e2 * pair.inv_rho2 * pair.inv_rho2,
                (e1 - e2) * inv_mixed,
                (e0 - 2.0 * e1 + e2) * inv_big_r2,
                (self.e_minus1_over_big_r - pair.h * (3.0 * (e0 - e1) + e2)) * inv_big_r2,
            ],
            h: [
                (2.0 / 3.0 * n) * e1 * inv_mixed,
                n_inv_big_r2 * (2.0 * e0 - (2.0 / 3.0) * e1),
                inv_big_r2 * (self.e0_sin - n * pair.h * (4.0 * e0 - (2.0 / 3.0) * e1)),
            ],
        }
    }
}
