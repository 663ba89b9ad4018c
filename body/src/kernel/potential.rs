//! All modes of the fields at one ring, from densities on many.

use pulp::{Arch, Simd, WithSimd};

use super::close::{DENSITIES, Potential};
use super::fourier;
use super::modes::{Modes, SourceRings, TargetRing, Workspace};
use super::moments::MomentSeries;
use super::pair::Pair;
use f64_lanes::{Lanes, PADDING, padded};

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
    /// Makes room; columns that pad the near rings' last register are zero.
    pub fn resize(&mut self, rows: usize, columns: Columns) {
        self.stride = padded(columns.near) + padded(columns.far);
        self.values.resize(rows * self.stride, 0.0);
        for row in self.values.chunks_mut(self.stride.max(1)) {
            row[columns.near..padded(columns.near)].fill(0.0);
        }
    }
}

/// How many rings are near and how many are not.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Columns {
    pub near: usize,
    pub far: usize,
}

impl Columns {
    /// The columns for the rings that a workspace was arranged for.
    pub fn of(workspace: &Workspace) -> Self {
        Self {
            near: workspace.near,
            far: workspace.order.len() - workspace.near,
        }
    }

    /// The column of ring number `k` of the workspace's `order`: the others begin after the near
    /// ones' last register.
    pub fn place(&self, k: usize) -> usize {
        if k < self.near {
            k
        } else {
            padded(self.near) + k - self.near
        }
    }
}

/// Modes of the fields on a ring: field `i` of family `f` of mode `n` is number
/// `(2 n + f) FIELDS + i`.
#[derive(Debug, Default)]
pub(crate) struct RingFields {
    /// Each field's partial sums, one for each lane of a register.
    lanes: Vec<f64>,
}

impl RingFields {
    /// So many fields, all zero.
    pub fn reset(&mut self, count: usize) {
        self.lanes.clear();
        self.lanes.resize(count * PADDING, 0.0);
    }

    /// Adds the modes of the potential's fields at `target`.
    ///
    /// `workspace` must have been arranged by `modes` for the same rings.
    pub fn add<const K: usize, const FIELDS: usize>(
        &mut self,
        modes: &Modes,
        potential: &impl Potential<K, FIELDS>,
        target: TargetRing,
        sources: &SourceRings,
        densities: &RingDensities,
        workspace: &mut Workspace,
    ) {
        if sources.len() > 0 {
            Arch::new().dispatch(Fields::<K, FIELDS, _> {
                modes,
                potential,
                target,
                sources,
                densities,
                workspace,
                fields: self,
            });
        }
    }

    /// The fields, field after field.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.lanes
            .chunks_exact(PADDING)
            .map(|lanes| lanes.iter().sum())
    }
}

struct Fields<'a, const K: usize, const FIELDS: usize, P: Potential<K, FIELDS>> {
    modes: &'a Modes,
    potential: &'a P,
    target: TargetRing,
    sources: &'a SourceRings,
    densities: &'a RingDensities,
    workspace: &'a mut Workspace,
    fields: &'a mut RingFields,
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
        let sums = &mut fields.lanes;
        let columns = Columns::of(workspace);
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
                    for i in 0..FIELDS {
                        let sum = &mut sums[i * PADDING..][..PADDING];
                        (Lanes::load(simd, sum, 0) + found[i]).store(sum, 0);
                    }
                }
            }
        }
        // Well-separated pairs: all entries' modes by FFT, and the same contraction in scalars.
        let fourier = modes.fourier();
        let mut entries = std::mem::take(&mut workspace.block);
        entries.clear();
        entries.resize((fourier.last() + 1) * K, 0.0);
        for k in workspace.near..sources.len() {
            let (j, column) = (workspace.order[k], columns.place(k));
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
                    for (i, found) in found.iter().enumerate() {
                        sums[(family * FIELDS + i) * PADDING] += found.1;
                    }
                }
            }
        }
        workspace.block = entries;
    }
}
