//! All modes of the fields at one ring, from densities on many.

use pulp::{Arch, Simd, WithSimd};

use super::close::{DENSITIES, Potential};
use super::fourier;
use super::modes::{Modes, SourceRings, TargetRing, Workspace};
use super::moments::MomentSeries;
use super::pair::Pair;
use crate::special::lanes::{Lanes, PADDING, padded};

/// Modes of the densities on source rings, times the rings' quadrature weights.
#[derive(Debug, Default)]
pub(crate) struct RingDensities {
    /// Density `j` of family `f` of mode `n` on ring number `k` of the workspace's `order` is at
    /// `((2 n + f) DENSITIES + j) stride + column(k)`.
    pub values: Vec<f64>,
    /// Columns per density.
    pub stride: usize,
}

impl RingDensities {
    /// Makes room; the columns between near and far rings are zero.
    pub fn resize(&mut self, rows: usize, columns: Columns) {
        self.stride = columns.near + columns.far;
        self.values.clear();
        self.values.resize(rows * self.stride, 0.0);
    }
}

/// Columns of near rings and of the others, with those that pad the last register.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns {
    near: usize,
    far: usize,
}

impl Workspace {
    /// The columns that densities need for the rings it was arranged for.
    pub fn columns(&self) -> Columns {
        Columns {
            near: padded(self.near),
            far: padded(self.order.len() - self.near),
        }
    }

    /// The column of ring number `k` of `order`: the others begin after the near ones' last register.
    pub fn column(&self, k: usize) -> usize {
        if k < self.near {
            k
        } else {
            padded(self.near) + k - self.near
        }
    }
}

impl Modes {
    /// The modes of the potential's fields at `target`: field `i` of family `f` of mode `n` is number `(2 n + f) FIELDS + i`.
    ///
    /// `workspace` must have been arranged for the same rings.
    pub fn fields<const K: usize, const FIELDS: usize>(
        &self,
        potential: &impl Potential<K, FIELDS>,
        target: TargetRing,
        sources: &SourceRings,
        densities: &RingDensities,
        workspace: &mut Workspace,
        fields: &mut Vec<f64>,
    ) {
        fields.clear();
        fields.resize(2 * self.count() * FIELDS, 0.0);
        if sources.len() > 0 {
            Arch::new().dispatch(Fields::<K, FIELDS, _> {
                modes: self,
                potential,
                target,
                sources,
                densities,
                workspace,
                fields,
            });
        }
    }
}

struct Fields<'a, const K: usize, const FIELDS: usize, P: Potential<K, FIELDS>> {
    modes: &'a Modes,
    potential: &'a P,
    target: TargetRing,
    sources: &'a SourceRings,
    densities: &'a RingDensities,
    workspace: &'a mut Workspace,
    fields: &'a mut [f64],
}

impl<const K: usize, const FIELDS: usize, P: Potential<K, FIELDS>> WithSimd
    for Fields<'_, K, FIELDS, P>
{
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self {
            modes,
            potential,
            target,
            sources,
            densities,
            workspace,
            fields,
        } = self;
        let splat = |x| Lanes::splat(simd, x);
        let (r, none) = (splat(target.r), splat(0.0));
        // Sums over the lanes are left to the end.
        let mut sums = std::mem::take(&mut workspace.sums);
        sums.clear();
        sums.resize(2 * modes.count() * FIELDS * PADDING, 0.0);
        let near = workspace.near.div_ceil(S::F64_LANES);
        for register in 0..near {
            let (pair, q0, d0) = workspace.pair(simd, register, r, [none, none]);
            let (q, d, scale) = modes.ladder(simd, &pair, q0, d0, &mut workspace.ladder);
            let mut series = MomentSeries::new(&pair, q, d, scale);
            for n in 0..modes.count() {
                let entries = potential.mode(&pair, &series.next(n));
                for family in [2 * n, 2 * n + 1] {
                    let first = family * DENSITIES;
                    let mut density = [none; DENSITIES];
                    for (j, density) in density.iter_mut().enumerate() {
                        let row = &densities.values[(first + j) * densities.stride..];
                        *density = Lanes::load(simd, &row[..densities.stride], register);
                    }
                    let found = P::fields([pair.nu_r, pair.nu_z], &entries, &density);
                    let sums = &mut sums[family * FIELDS * PADDING..][..FIELDS * PADDING];
                    for (i, found) in found.into_iter().enumerate() {
                        let sum = &mut sums[i * PADDING..][..PADDING];
                        (Lanes::load(simd, sum, 0) + found).store(sum, 0);
                    }
                }
            }
        }
        for (field, sums) in fields.iter_mut().zip(sums.chunks(PADDING)) {
            *field = sums[..S::F64_LANES].iter().sum();
        }
        workspace.sums = sums;
        // Well-separated pairs: all entries' modes by FFT, and the same contraction in scalars.
        let fourier = modes.fourier();
        let mut entries = std::mem::take(&mut workspace.block);
        entries.clear();
        entries.resize((fourier.last() + 1) * K, 0.0);
        for k in workspace.near..sources.len() {
            let (j, column) = (workspace.order[k], workspace.column(k));
            let pair = Pair::new(
                r,
                splat(sources.r[j]),
                splat(sources.a[j]),
                splat(sources.b[j]),
                splat(sources.nu_r[j]),
                splat(sources.nu_z[j]),
                none,
                none,
            );
            let scratch: &mut fourier::Workspace = &mut workspace.fourier;
            fourier.sample(simd, potential, &pair, scratch);
            fourier.transform::<K>(P::PARITY, scratch, &mut entries, 1);
            let scalar = pulp::Scalar;
            let normal = [sources.nu_r[j], sources.nu_z[j]].map(|x| Lanes(scalar, x));
            for (n, entries) in entries.chunks_exact(K).enumerate() {
                let mut mode = [Lanes(scalar, 0.0); K];
                for (to, &from) in mode.iter_mut().zip(entries) {
                    to.1 = from;
                }
                for family in [2 * n, 2 * n + 1] {
                    let mut density = [Lanes(scalar, 0.0); DENSITIES];
                    for (j, density) in density.iter_mut().enumerate() {
                        let row = (family * DENSITIES + j) * densities.stride;
                        density.1 = densities.values[row + column];
                    }
                    let found = P::fields(normal, &mode, &density);
                    for (field, found) in fields[family * FIELDS..].iter_mut().zip(found) {
                        *field += found.1;
                    }
                }
            }
        }
        workspace.block = entries;
    }
}
