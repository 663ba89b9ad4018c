//! Toroidal functions: Legendre functions of the second kind and half-integer degree,
//! $Q_{n-1/2}(\chi)$.
//!
//! They are carried together with their differences $D_n = Q_{n-1/2} - Q_{n+1/2}$, because near the
//! singularity $\chi = 1$ the modal kernels are made of differences: subtracting the functions
//! themselves would cost the digits that the kernels need. With $h = \chi - 1$ the recurrence in
//! the degree (DLMF 14.10.3) becomes
//!
//! $$ (n + \tfrac12) D_n = (n - \tfrac12) D_{n-1} - 2 n h Q_{n-1/2}, \qquad
//!    Q_{n+1/2} = Q_{n-1/2} - D_n . $$
//!
//! Upwards it is stable while $n\\,\mathrm{acosh}\\,\chi \lesssim 1$; downwards every term is
//! positive, so nothing cancels at all, and it is started far enough out for its own solution to
//! have died (Miller's algorithm). The starting values are complete elliptic integrals (Bulirsch's
//! form) of the complementary modulus $k_c = \sqrt{h/(h+2)}$, which is known to full precision
//! however close the points are:
//!
//! $$ Q_{-1/2} = \sqrt{\tfrac{2}{h+2}}\\, K, \qquad D_0 = \sqrt{2(h+2)}\\,(E - k_c^2 K). $$

use pulp::{Simd, WithSimd};

use f64_lanes::Lanes;

/// $\chi - 1$ that goes with upward recurrence for degrees up to `n_max`:
/// $n\\,\mathrm{acosh}\\,\chi < 1$.
fn upward_limit(n_max: usize) -> f64 {
    let xi = 1.0 / n_max.max(1) as f64;
    2.0 * (0.5 * xi).sinh().powi(2)
}

/// $Q_{-1/2}$ and $D_0 = Q_{-1/2} - Q_{1/2}$ at $\chi = 1 + h$.
pub(crate) fn start(h: f64) -> (f64, f64) {
    let complementary = (h / (h + 2.0)).sqrt();
    // The arguments are positive and finite for every pair of distinct points, so neither call can
    // fail.
    let k = ellip::cel1(complementary).unwrap_or(f64::NAN);
    let b = ellip::cel2(complementary, 1.0, 0.0).unwrap_or(f64::NAN);
    let root = (h + 2.0).sqrt();
    (
        std::f64::consts::SQRT_2 / root * k,
        2.0 * std::f64::consts::SQRT_2 / root * b,
    )
}

/// Coefficients of the recurrence, which depend on the degree alone.
#[derive(Debug)]
struct Coefficients {
    /// $(n + 1/2) / (n - 1/2)$ and $2 n / (n - 1/2)$.
    down: Vec<[f64; 2]>,
    /// $(n - 1/2) / (n + 1/2)$ and $2 n / (n + 1/2)$.
    up: Vec<[f64; 2]>,
}

/// The functions and differences of one register of pairs, for degrees $n - 1/2$,
/// $n = 0 \dots n_\text{max}$.
#[derive(Debug)]
pub(crate) struct Ladder {
    n_max: usize,
    upward_limit: f64,
    coefficients: Coefficients,
}

/// Downward recurrence starts where the unwanted solution will have shrunk by $e^{-2 \cdot 18}$
/// when it arrives.
const DECAY: f64 = 18.0;

/// Steps between two rescalings of the downward recurrence; at `DECAY` each, no overflow in
/// between.
const RESCALE: usize = 16;

impl Ladder {
    /// A ladder for $n \le n_\text{max}$.
    pub fn new(n_max: usize) -> Self {
        // The slowest decay that is still done downwards needs the longest start.
        let longest = n_max + (DECAY * n_max.max(1) as f64).ceil() as usize + 2;
        let pair = |num: f64, n: usize, den: f64| [num / den, 2.0 * n as f64 / den];
        let coefficients = Coefficients {
            down: (0..=longest)
                .map(|n| pair(n as f64 + 0.5, n, n as f64 - 0.5))
                .collect(),
            up: (0..=n_max)
                .map(|n| pair(n as f64 - 0.5, n, n as f64 + 0.5))
                .collect(),
        };
        Self {
            n_max,
            upward_limit: upward_limit(n_max),
            coefficients,
        }
    }

    /// Fills `q[n]` $= Q_{n-1/2}(1 + h)$ and `d[n]` $= D_n$ for $n \le n_\text{max}$, up to the
    /// common factor returned, by which both have yet to be multiplied. `q0`, `d0` are the values
    /// of [`start`].
    #[inline(always)]
    pub fn fill<S: Simd>(
        &self,
        simd: S,
        h: Lanes<S>,
        q0: Lanes<S>,
        d0: Lanes<S>,
        q: &mut [S::f64s],
        d: &mut [S::f64s],
    ) -> Lanes<S> {
        let limit = Lanes::splat(simd, self.upward_limit);
        if h.max() < self.upward_limit {
            self.upward(h, q0, d0, q, d);
            return Lanes::splat(simd, 1.0);
        }
        self.downward(h, q, d);
        let scale = q0 / Lanes(simd, q[0]);
        if h.min() < self.upward_limit {
            // Lanes of both kinds: run upwards too, and keep for each lane what is right for it.
            let (mut q_up, mut d_up) = (q0, d0);
            q[0] = q0.1;
            d[0] = d0.1;
            for n in 1..=self.n_max {
                q_up = q_up - d_up;
                d_up = self.step_up(n, h, q_up, d_up);
                q[n] = h.select_less(limit, q_up, Lanes(simd, q[n]) * scale).1;
                d[n] = h.select_less(limit, d_up, Lanes(simd, d[n]) * scale).1;
            }
            return Lanes::splat(simd, 1.0);
        }
        scale
    }

    #[inline(always)]
    fn step_up<S: Simd>(&self, n: usize, h: Lanes<S>, q: Lanes<S>, d: Lanes<S>) -> Lanes<S> {
        let [ratio, slope] = self.coefficients.up[n];
        d * ratio - h * slope * q
    }

    #[inline(always)]
    fn upward<S: Simd>(
        &self,
        h: Lanes<S>,
        q0: Lanes<S>,
        d0: Lanes<S>,
        q: &mut [S::f64s],
        d: &mut [S::f64s],
    ) {
        let (mut q_n, mut d_n) = (q0, d0);
        q[0] = q_n.1;
        d[0] = d_n.1;
        for n in 1..=self.n_max {
            q_n = q_n - d_n;
            d_n = self.step_up(n, h, q_n, d_n);
            q[n] = q_n.1;
            d[n] = d_n.1;
        }
    }

    #[inline(always)]
    fn downward<S: Simd>(&self, h: Lanes<S>, q: &mut [S::f64s], d: &mut [S::f64s]) {
        let slowest = h.min().max(self.upward_limit);
        let decay = 2.0 * (0.5 * slowest).sqrt().asinh();
        let first = (self.n_max + 1 + (DECAY / decay).ceil() as usize)
            .min(self.coefficients.down.len() - 1);
        // As if the functions decayed by exp(-acosh chi) from here on.
        let mut q_n = Lanes::splat(h.0, 1.0);
        let mut d_n = (h * (h + 2.0)).sqrt() - h;
        let mut n = first;
        while n > self.n_max {
            let stop = n.saturating_sub(RESCALE).max(self.n_max);
            while n > stop {
                let [ratio, slope] = self.coefficients.down[n];
                d_n = (h * slope).mul_add(q_n, d_n * ratio);
                q_n += d_n;
                n -= 1;
            }
            d_n = d_n / q_n;
            q_n = Lanes::splat(h.0, 1.0);
        }
        // Room for growth by exp(n_max acosh chi) on the way down, made again where that exceeds
        // what doubles hold.
        let tiny = Lanes::splat(h.0, 1e-250);
        let (large, one) = (Lanes::splat(h.0, 1e250), Lanes::splat(h.0, 1.0));
        let shrink = Lanes::splat(h.0, 1e-300);
        d_n = d_n * tiny;
        q_n = tiny;
        for n in (1..=self.n_max).rev() {
            if n % RESCALE == 0 && q_n.max() > 1e250 {
                let factor = q_n.select_less(large, one, shrink);
                q_n = q_n * factor;
                d_n = d_n * factor;
                for x in q[n + 1..=self.n_max]
                    .iter_mut()
                    .chain(&mut d[n + 1..=self.n_max])
                {
                    *x = (Lanes(h.0, *x) * factor).1;
                }
            }
            q[n] = q_n.1;
            d[n] = d_n.1;
            let [ratio, slope] = self.coefficients.down[n];
            d_n = (h * slope).mul_add(q_n, d_n * ratio);
            q_n += d_n;
        }
        q[0] = q_n.1;
        d[0] = d_n.1;
    }
}

/// The toroidal functions of one argument, for degrees $n - 1/2$, $n = 0 \dots n_\text{max}$.
#[derive(Clone, Debug)]
pub struct Toroidal {
    h: f64,
    q: Vec<f64>,
    d: Vec<f64>,
}

impl Toroidal {
    /// Functions of $\chi = 1 + h$; `h` (given instead of $\chi$ so that arguments near 1 keep
    /// their digits) is positive and finite, or the values are NaN. Values below the smallest
    /// double are zero.
    ///
    /// Relative error below `1e-13` for $n \le 1000$ and every $h$ (tested against 40-digit
    /// values).
    pub fn new(h: f64, n_max: usize) -> Self {
        if !(h > 0.0 && h.is_finite()) {
            let nan = vec![f64::NAN; n_max + 1];
            return Self {
                h,
                q: nan.clone(),
                d: nan,
            };
        }
        // exp(-690) is where doubles end; beyond it the functions underflow, and the ladder would
        // overflow.
        let decay = 2.0 * (0.5 * h).sqrt().asinh();
        let reach = (690.0 / decay).min(n_max as f64) as usize;
        struct Fill<'a>(&'a Ladder, f64, &'a mut [f64], &'a mut [f64]);
        impl WithSimd for Fill<'_> {
            type Output = f64;
            #[inline(always)]
            fn with_simd<S: Simd>(self, simd: S) -> f64 {
                let (q0, d0) = start(self.1);
                let splat = |x| Lanes::splat(simd, x);
                let mut q = vec![simd.splat_f64s(0.0); self.2.len()];
                let mut d = q.clone();
                let scale = self
                    .0
                    .fill(simd, splat(self.1), splat(q0), splat(d0), &mut q, &mut d);
                for n in 0..q.len() {
                    self.2[n] = (Lanes(simd, q[n]) * scale).max();
                    self.3[n] = (Lanes(simd, d[n]) * scale).max();
                }
                scale.max()
            }
        }
        let ladder = Ladder::new(reach);
        let mut q = vec![0.0; reach + 1];
        let mut d = vec![0.0; reach + 1];
        Fill(&ladder, h, &mut q, &mut d).with_simd(pulp::Scalar);
        q.resize(n_max + 1, 0.0);
        d.resize(n_max + 1, 0.0);
        Self { h, q, d }
    }

    /// $Q_{n-1/2}(\chi)$.
    pub fn q(&self, n: usize) -> f64 {
        self.q[n]
    }

    /// $D_n = Q_{n-1/2} - Q_{n+1/2}$, without cancellation.
    pub fn difference(&self, n: usize) -> f64 {
        self.d[n]
    }

    /// The derivative of order `k` $\le 3$ with respect to $\chi$: with $\nu = n - 1/2$,
    /// $(\chi^2-1) Q' = -\nu (D_{n-1} - h Q)$, $(1-\chi^2) Q'' = 2\chi Q' - \nu(\nu+1) Q$ and
    /// $(1-\chi^2) Q''' = 4\chi Q'' - (\nu(\nu+1) - 2) Q'$ (DLMF 14.10.5 and Legendre's equation).
    /// The associated functions are $Q^m_\nu = (\chi^2-1)^{m/2} \\, d^m Q_\nu / d\chi^m$ in DLMF's
    /// sign.
    ///
    /// `None` for `k > 3`.
    pub fn derivative(&self, n: usize, k: usize) -> Option<f64> {
        let (h, chi, q) = (self.h, 1.0 + self.h, self.q[n]);
        let weight = h * (h + 2.0);
        let nu = n as f64 - 0.5;
        let before = if n == 0 { -self.d[0] } else { self.d[n - 1] };
        let first = -nu * (before - h * q) / weight;
        let second = (nu * (nu + 1.0) * q - 2.0 * chi * first) / weight;
        let third = ((nu * (nu + 1.0) - 2.0) * first - 4.0 * chi * second) / weight;
        [q, first, second, third].get(k).copied()
    }
}
