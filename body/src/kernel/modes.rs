//! All modes of a kernel between one target ring and many source rings.

use pulp::{Arch, Simd, WithSimd};

use super::fourier::{self, Fourier};
use super::invariant::Kernel;
use super::moments::MomentSeries;
use super::pair::Pair;
use crate::special::toroidal::{self, Ladder};
use f64_lanes::{Lanes, padded};

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
    /// How many columns are near: the first ones.
    pub(super) near: usize,
    /// The registers' inputs: r', a, b, normal, and the ladder's start.
    packed: [Vec<f64>; 7],
    pub(super) ladder: LadderSpace,
    pub(super) fourier: fourier::Workspace,
}

/// Room for the toroidal functions of one register.
#[derive(Debug, Default)]
pub(super) struct LadderSpace {
    q: Vec<f64>,
    d: Vec<f64>,
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
        self.arrange(target, sources, workspace);
        workspace.stride = padded(sources.len());
        workspace
            .block
            .resize(self.count() * K * workspace.stride, 0.0);
        Arch::new().dispatch(Evaluate {
            modes: self,
            kernel,
            target,
            sources,
            workspace,
        });
    }

    /// Puts the near pairs first in `workspace.order` and packs what their registers need.
    pub fn arrange(&self, target: TargetRing, sources: &SourceRings, workspace: &mut Workspace) {
        workspace.near = workspace.arrange(target, sources, self.far);
    }

    /// The FFT for the pairs that are not near.
    pub(super) fn fourier(&self) -> &Fourier {
        &self.fourier
    }

    /// The toroidal functions of a register, for one degree beyond the last mode, and the factor
    /// they are yet to be multiplied by.
    #[inline(always)]
    pub(super) fn ladder<'w, S: Simd>(
        &self,
        simd: S,
        pair: &Pair<S>,
        q0: Lanes<S>,
        d0: Lanes<S>,
        space: &'w mut LadderSpace,
    ) -> (&'w [S::f64s], &'w [S::f64s], Lanes<S>) {
        let room = (self.n_max + 2) * S::F64_LANES;
        space.q.resize(room, 0.0);
        space.d.resize(room, 0.0);
        let (q, d) = (
            S::as_mut_simd_f64s(&mut space.q).0,
            S::as_mut_simd_f64s(&mut space.d).0,
        );
        let scale = self.ladder.fill(simd, pair.h, q0, d0, q, d);
        (q, d, scale)
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

    /// Register number `index` of the near pairs, and where its ladder starts.
    #[inline(always)]
    pub(super) fn pair<S: Simd>(
        &self,
        simd: S,
        index: usize,
        r: Lanes<S>,
        [mu_r, mu_z]: [Lanes<S>; 2],
    ) -> (Pair<S>, Lanes<S>, Lanes<S>) {
        let [rp, a, b, nu_r, nu_z, q0, d0] = [
            Lanes::load(simd, &self.packed[0], index),
            Lanes::load(simd, &self.packed[1], index),
            Lanes::load(simd, &self.packed[2], index),
            Lanes::load(simd, &self.packed[3], index),
            Lanes::load(simd, &self.packed[4], index),
            Lanes::load(simd, &self.packed[5], index),
            Lanes::load(simd, &self.packed[6], index),
        ];
        (Pair::new(r, rp, a, b, nu_r, nu_z, mu_r, mu_z), q0, d0)
    }
}

struct Evaluate<'a, const K: usize, F: Kernel<K>> {
    modes: &'a Modes,
    kernel: &'a F,
    target: TargetRing,
    sources: &'a SourceRings,
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
            workspace,
        } = self;
        let splat = |x| Lanes::splat(simd, x);
        let r = splat(target.r);
        let [mu_r, mu_z] = target.normal.map(splat);
        let mut block = std::mem::take(&mut workspace.block);
        let stride = workspace.stride;
        let near = workspace.near;
        for register in 0..near.div_ceil(S::F64_LANES) {
            let (pair, q0, d0) = workspace.pair(simd, register, r, [mu_r, mu_z]);
            let (q, d, scale) = modes.ladder(simd, &pair, q0, d0, &mut workspace.ladder);
            let mut series = MomentSeries::new(&pair, q, d, scale);
            for n in 0..=modes.n_max {
                let entries = kernel.mode(&pair, &series.next(n));
                for (k, entry) in entries.iter().enumerate() {
                    entry.store(&mut block[(n * K + k) * stride..][..stride], register);
                }
            }
        }
        for entries in block
            .chunks_mut(stride)
            .skip((modes.fourier.last() + 1) * K)
        {
            entries[near..].fill(0.0);
        }
        for (column, &j) in workspace.order.iter().enumerate().skip(near) {
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
            modes
                .fourier
                .sample(simd, kernel, &pair, &mut workspace.fourier);
            modes.fourier.transform::<K>(
                F::PARITY,
                &mut workspace.fourier,
                &mut block[column..],
                stride,
            );
        }
        workspace.block = block;
    }
}
