//! Modes of well-separated pairs: the trapezoidal rule in the azimuth, all modes by FFT.
//!
//! The kernels are analytic in $t$ up to $\lvert\mathrm{Im}\\, t\rvert = \mathrm{acosh}\\,\chi$:
//! mode $n$ is of the size of $e^{-n\\,\mathrm{acosh}\\,\chi}$, and with $N$ samples it is off by
//! $e^{-(N - n)\\,\mathrm{acosh}\\,\chi}$. Modes below rounding are left zero, so the cost does not
//! grow with the number of modes. Four real sequences share a complex transform: two even ones and
//! two odd ones, told apart afterwards by symmetry. Each is first divided by its size, a power of
//! two: entries have different units, and the rounding of a large one would bury a small one.

use std::f64::consts::PI;
use std::fmt;
use std::sync::Arc;

use num_complex::Complex64;
use pulp::Simd;
use rustfft::Fft;

use super::invariant::{Kernel, Parity};
use super::pair::Pair;
use crate::fft;
use f64_lanes::{Lanes, padded};

/// Samples and transforms for one number of modes.
pub(crate) struct Fourier {
    /// The last mode above rounding, or `n_max`.
    last: usize,
    /// Samples around the whole circle.
    count: usize,
    /// $1 - \cos t$ and $\sin t$ at the samples in $[0, \pi]$, padded.
    c: Vec<f64>,
    sin: Vec<f64>,
    fft: Arc<dyn Fft<f64>>,
}

impl fmt::Debug for Fourier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Fourier")
            .field("last", &self.last)
            .field("count", &self.count)
            .finish()
    }
}

/// Buffers of one pair.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    /// Entry after entry, the samples in $[0, \pi]$, padded.
    samples: Vec<f64>,
    sequence: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

/// Where doubles end: $-\ln 10^{-17}$.
const DIGITS: f64 = 39.0;

impl Fourier {
    /// Samples for modes up to `n_max` of pairs with $\chi - 1 \ge$ `h`.
    pub fn new(n_max: usize, h: f64) -> Self {
        let decay = 2.0 * (0.5 * h).sqrt().asinh();
        let reach = (DIGITS / decay).ceil() as usize;
        let last = reach.min(n_max);
        let least = last + reach + 4;
        let count = (least..)
            .find(|&n| n % 4 == 0 && is_smooth(n))
            .unwrap_or(least);
        let half = padded(count / 2 + 1);
        let t = |k: usize| 2.0 * PI * k as f64 / count as f64;
        Self {
            last,
            count,
            c: (0..half)
                .map(|k| 2.0 * (0.5 * t(k)).sin().powi(2))
                .collect(),
            sin: (0..half).map(|k| t(k).sin()).collect(),
            fft: fft::forward(count),
        }
    }

    /// Samples every entry of the kernel for the pair in the first lane.
    #[inline(always)]
    pub fn sample<const K: usize, S: Simd>(
        &self,
        simd: S,
        kernel: &impl Kernel<K>,
        pair: &Pair<S>,
        workspace: &mut Workspace,
    ) {
        let half = self.c.len();
        workspace.samples.resize((K + 1) * half, 0.0);
        for register in 0..half / S::F64_LANES {
            let c = Lanes::load(simd, &self.c, register);
            let sin = Lanes::load(simd, &self.sin, register);
            let entries = kernel.sample(&pair.separation(c, sin));
            for (k, entry) in entries.iter().enumerate() {
                entry.store(&mut workspace.samples[k * half..(k + 1) * half], register);
            }
        }
    }

    /// The last mode that [`transform`](Self::transform) fills; all beyond are below rounding.
    pub fn last(&self) -> usize {
        self.last
    }

    /// Transforms the samples; mode `n` of entry `k` goes to `out[(n * K + k) * stride]`.
    pub fn transform<const K: usize>(
        &self,
        parity: [Parity; K],
        workspace: &mut Workspace,
        out: &mut [f64],
        stride: usize,
    ) {
        let Workspace {
            samples,
            sequence,
            scratch,
        } = workspace;
        let (count, half) = (self.count, self.c.len());
        sequence.resize(count, Complex64::default());
        scratch.resize(self.fft.get_inplace_scratch_len(), Complex64::default());
        let of = |wanted: Parity| (0..K).filter(move |&k| parity[k] == wanted);
        let (mut even, mut odd) = (of(Parity::Even), of(Parity::Odd));
        let scale = PI / count as f64;
        // The samples of an entry, or of one that vanishes.
        samples.resize((K + 1) * half, 0.0);
        let row = |entry: Option<usize>| &samples[entry.unwrap_or(K) * half..][..count / 2 + 1];
        loop {
            let [f1, f2] = [even.next(), even.next()];
            let [g1, g2] = [odd.next(), odd.next()];
            if f1.is_none() && g1.is_none() {
                return;
            }
            let (even1, even2, odd1, odd2) = (row(f1), row(f2), row(g1), row(g2));
            let sizes = [even1, even2, odd1, odd2].map(size);
            let inverse = |size: f64| if size > 0.0 { 1.0 / size } else { 0.0 };
            let [of_f1, of_f2, of_g1, of_g2] = sizes.map(inverse);
            for i in 0..=count / 2 {
                let f = Complex64::new(of_f1 * even1[i], of_f2 * even2[i]);
                let g = Complex64::new(of_g1 * odd1[i], of_g2 * odd2[i]);
                sequence[if i == 0 { 0 } else { count - i }] = f - g;
                sequence[i] = f + g;
            }
            self.fft.process_with_scratch(sequence, scratch);
            // Z(n) = (F1 + G2) + i (F2 - G1), with F even and G odd in n.
            for n in 0..=self.last {
                let plus = sequence[n];
                let minus = sequence[if n == 0 { 0 } else { count - n }];
                let (sum, difference) = (plus + minus, plus - minus);
                for (entry, value, size) in [
                    (f1, sum.re, sizes[0]),
                    (f2, sum.im, sizes[1]),
                    (g2, difference.re, sizes[3]),
                    (g1, -difference.im, sizes[2]),
                ] {
                    if let Some(k) = entry {
                        out[(n * K + k) * stride] = scale * size * value;
                    }
                }
            }
        }
    }
}

/// The power of two at or below the largest magnitude; 0 if there is none.
fn size(samples: &[f64]) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let largest = samples.iter().fold(0.0f64, |most, x| most.max(x.abs()));
    let power = f64::from_bits(largest.to_bits() & EXPONENT);
    if power.is_normal() { power } else { 0.0 }
}

/// No prime factors but 2, 3 and 5: a length the FFT is quick at.
fn is_smooth(mut n: usize) -> bool {
    for p in [2, 3, 5] {
        while n.is_multiple_of(p) {
            n /= p;
        }
    }
    n == 1
}
