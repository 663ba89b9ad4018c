//! All modes of a kernel between one target ring and many source rings.

use pulp::{Arch, Simd, WithSimd};

use super::fourier::Fourier;
use super::moments::{MomentSeries, Moments};
use super::pair::{Pair, Separation};
use crate::special::lanes::{Lanes, padded};
use crate::special::toroidal::{self, Ladder};

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

/// The ring on which a kernel is evaluated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TargetRing {
    pub r: f64,
    /// The unit normal `(mu_r, mu_z)`; only the traction looks at it.
    pub normal: [f64; 2],
}

/// The rings that act: buffers of equal length, one entry a ring.
#[derive(Clone, Debug, Default)]
pub(crate) struct SourceRings {
    /// Radius $r'$.
    pub r: Vec<f64>,
    /// $r - r'$ and $z - z'$ seen from the target in question.
    pub a: Vec<f64>,
    pub b: Vec<f64>,
    /// Unit normal.
    pub nu_r: Vec<f64>,
    pub nu_z: Vec<f64>,
}

impl SourceRings {
    pub fn len(&self) -> usize {
        self.r.len()
    }

    pub fn clear(&mut self) {
        for buffer in [
            &mut self.r,
            &mut self.a,
            &mut self.b,
            &mut self.nu_r,
            &mut self.nu_z,
        ] {
            buffer.clear();
        }
    }

    /// Appends a ring of radius `r`, with the target at `(a, b)` from it.
    pub fn push(&mut self, r: f64, [a, b]: [f64; 2], [nu_r, nu_z]: [f64; 2]) {
        self.r.push(r);
        self.a.push(a);
        self.b.push(b);
        self.nu_r.push(nu_r);
        self.nu_z.push(nu_z);
    }
}

/// $\chi - 1$ from which on a pair is well separated: one FFT resolves it to rounding.
///
/// Up to here the recurrence is both cheaper and as accurate; beyond, its moments start to cancel.
const FAR: f64 = 3.0;

/// Evaluates modes $0 \dots n_\text{max}$.
#[derive(Debug)]
pub(crate) struct Modes {
    n_max: usize,
    /// $\chi - 1$ from which on the FFT takes over.
    far: f64,
    ladder: Ladder,
    fourier: Fourier,
}

/// What an evaluation needs besides its arguments, kept from one to the next.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    /// The modes: entry `k` of mode `n` for the source `order[j]` is at `(n * K + k) * stride + j`.
    pub block: Vec<f64>,
    /// Columns per entry in `block`.
    pub stride: usize,
    /// Which source a column of `block` belongs to.
    pub order: Vec<usize>,
    /// The registers' inputs: r', a, b, normal, h, and the ladder's start.
    packed: [Vec<f64>; 7],
    q: Vec<f64>,
    d: Vec<f64>,
    pub(super) fourier: super::fourier::Workspace,
}

impl Modes {
    pub fn new(n_max: usize) -> Self {
        Self::with_far(n_max, FAR)
    }

    /// The same with the FFT from another separation on; it resolves pairs from [`FAR`] on.
    pub fn with_far(n_max: usize, far: f64) -> Self {
        Self {
            n_max,
            far,
            ladder: Ladder::new(n_max + 1),
            fourier: Fourier::new(n_max, FAR),
        }
    }

    /// Modes kept, counting the zeroth.
    pub fn count(&self) -> usize {
        self.n_max + 1
    }

    /// Fills `workspace.block` with all modes of `kernel` at `target` from each of `sources`.
    pub fn evaluate<const K: usize>(
        &self,
        kernel: &impl Kernel<K>,
        target: TargetRing,
        sources: &SourceRings,
        workspace: &mut Workspace,
    ) {
        if sources.len() == 0 {
            workspace.order.clear();
            workspace.stride = 0;
            return;
        }
        let near = workspace.arrange(target, sources, self.far);
        workspace.stride = padded(sources.len());
        workspace
            .block
            .resize(self.count() * K * workspace.stride, 0.0);
        Arch::new().dispatch(Evaluate {
            modes: self,
            kernel,
            target,
            sources,
            near,
            workspace,
        });
    }
}

impl Workspace {
    /// Puts the near pairs first and packs what their registers need; returns how many there are.
    fn arrange(&mut self, target: TargetRing, sources: &SourceRings, far: f64) -> usize {
        let h = |j: usize| {
            let (a, b) = (sources.a[j], sources.b[j]);
            (a * a + b * b) / (2.0 * target.r * sources.r[j])
        };
        self.order.clear();
        self.order
            .extend((0..sources.len()).filter(|&j| h(j) < far));
        let near = self.order.len();
        self.order
            .extend((0..sources.len()).filter(|&j| h(j) >= far));
        for buffer in &mut self.packed {
            buffer.clear();
        }
        for column in 0..if near > 0 { padded(near) } else { 0 } {
            let j = self.order[column.min(near - 1)];
            let (q0, d0) = toroidal::start(h(j));
            let values = [
                sources.r[j],
                sources.a[j],
                sources.b[j],
                sources.nu_r[j],
                sources.nu_z[j],
                q0,
                d0,
            ];
            for (buffer, value) in self.packed.iter_mut().zip(values) {
                buffer.push(value);
            }
        }
        near
    }
}

struct Evaluate<'a, const K: usize, F: Kernel<K>> {
    modes: &'a Modes,
    kernel: &'a F,
    target: TargetRing,
    sources: &'a SourceRings,
    near: usize,
    workspace: &'a mut Workspace,
}

impl<const K: usize, F: Kernel<K>> WithSimd for Evaluate<'_, K, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            modes,
            kernel,
            target,
            sources,
            near,
            workspace,
        } = self;
        let Workspace {
            block,
            stride,
            order,
            packed,
            q,
            d,
            fourier,
        } = workspace;
        let splat = |x| Lanes::splat(simd, x);
        let (r, mu_r, mu_z) = (
            splat(target.r),
            splat(target.normal[0]),
            splat(target.normal[1]),
        );
        let lanes = S::F64_LANES;
        q.resize((modes.n_max + 2) * lanes, 0.0);
        d.resize((modes.n_max + 2) * lanes, 0.0);
        let (q, d) = (S::as_mut_simd_f64s(q).0, S::as_mut_simd_f64s(d).0);
        for register in 0..near.div_ceil(lanes) {
            let [rp, a, b, nu_r, nu_z, q0, d0] = [
                Lanes::load(simd, &packed[0], register),
                Lanes::load(simd, &packed[1], register),
                Lanes::load(simd, &packed[2], register),
                Lanes::load(simd, &packed[3], register),
                Lanes::load(simd, &packed[4], register),
                Lanes::load(simd, &packed[5], register),
                Lanes::load(simd, &packed[6], register),
            ];
            let pair = Pair::new(r, rp, a, b, nu_r, nu_z, mu_r, mu_z);
            let scale = modes.ladder.fill(simd, pair.h, q0, d0, q, d);
            let mut series = MomentSeries::new(&pair, q, d, scale);
            for n in 0..=modes.n_max {
                let entries = kernel.mode(&pair, &series.next(n));
                for (k, entry) in entries.iter().enumerate() {
                    entry.store(&mut block[(n * K + k) * *stride..][..*stride], register);
                }
            }
        }
        for entries in block
            .chunks_mut(*stride)
            .skip((modes.fourier.last() + 1) * K)
        {
            entries[near..].fill(0.0);
        }
        for (column, &j) in order.iter().enumerate().skip(near) {
            let pair = Pair::new(
                r,
                splat(sources.r[j]),
                splat(sources.a[j]),
                splat(sources.b[j]),
                splat(sources.nu_r[j]),
                splat(sources.nu_z[j]),
                mu_r,
                mu_z,
            );
            modes.fourier.sample(simd, kernel, &pair, fourier);
            modes
                .fourier
                .transform::<K>(F::PARITY, fourier, &mut block[column..], *stride);
        }
    }
}
