//! Instruction sets, told apart by how they take reciprocal square roots.

use pulp::{Arch, Scalar, Simd, WithSimd};

use crate::register::Lanes;

/// How many digits of a reciprocal square root are wanted. The value is the number of terms of a
/// series about the seed of AVX-512. Instruction sets without a seed give all digits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Relative error below 1e-4: the seed as it is.
    Seed = 0,
    /// Below 1e-8: one Newton step.
    Single = 1,
    /// Below 1e-12: one step of third order.
    Close = 2,
    /// A few units in the last place.
    Full = 3,
}

/// An instruction set with a reciprocal square root.
pub trait Isa: Simd {
    /// Whether roots have a seed. All precisions are the same without.
    const SEEDED: bool;

    /// $1/\sqrt x$ to `TERMS` terms (see [`Precision`]) where $x$ exceeds `least` $\ge 0$; 0
    /// elsewhere.
    fn rsqrt_above<const TERMS: usize>(self, x: Lanes<Self>, least: Lanes<Self>) -> Lanes<Self>;

    /// A bit for each lane, the lowest for the first: set where $a < b$.
    fn less_bits(self, a: Lanes<Self>, b: Lanes<Self>) -> usize;

    /// Does `work` in a function of its own, so that work that is wanted in several places need not
    /// be compiled in each.
    #[inline(always)]
    fn call<W: WithIsa>(self, work: W) -> W::Output {
        self.vectorize(On(work, self))
    }
}

impl<S: Isa> Lanes<S> {
    /// $1/\sqrt x$ to `TERMS` terms (see [`Precision`]) where $x$ exceeds `least` $\ge 0$; 0
    /// elsewhere.
    #[inline(always)]
    pub fn rsqrt_above<const TERMS: usize>(self, least: Self) -> Self {
        self.0.rsqrt_above::<TERMS>(self, least)
    }

    /// A bit for each lane, the lowest for the first: set where `self < bound`.
    #[inline(always)]
    pub fn less_bits(self, bound: Self) -> usize {
        self.0.less_bits(self, bound)
    }
}

/// By hardware square root and division: where there is no seed for doubles.
#[inline(always)]
fn divided<S: Simd>(x: Lanes<S>, least: Lanes<S>) -> Lanes<S> {
    least.select_less(x, 1.0 / x.sqrt(), Lanes::splat(x.0, 0.0))
}

impl Isa for Scalar {
    const SEEDED: bool = false;

    #[inline(always)]
    fn less_bits(self, a: Lanes<Self>, b: Lanes<Self>) -> usize {
        usize::from(a.1 < b.1)
    }

    #[inline(never)]
    fn call<W: WithIsa>(self, work: W) -> W::Output {
        work.with_isa(self)
    }

    #[inline(always)]
    fn rsqrt_above<const TERMS: usize>(self, x: Lanes<Self>, least: Lanes<Self>) -> Lanes<Self> {
        divided(x, least)
    }
}

#[cfg(target_arch = "x86_64")]
impl Isa for pulp::x86::V3 {
    const SEEDED: bool = false;

    #[inline(always)]
    fn less_bits(self, a: Lanes<Self>, b: Lanes<Self>) -> usize {
        let mask = self.less_than_f64s(a.1, b.1);
        self.avx._mm256_movemask_pd(pulp::cast(mask)) as usize
    }

    #[inline(always)]
    fn rsqrt_above<const TERMS: usize>(self, x: Lanes<Self>, least: Lanes<Self>) -> Lanes<Self> {
        divided(x, least)
    }
}

#[cfg(target_arch = "x86_64")]
impl Isa for pulp::x86::V4 {
    const SEEDED: bool = true;

    #[inline(always)]
    fn less_bits(self, a: Lanes<Self>, b: Lanes<Self>) -> usize {
        usize::from(self.less_than_f64s(a.1, b.1).0)
    }

    #[inline(always)]
    fn rsqrt_above<const TERMS: usize>(self, x: Lanes<Self>, least: Lanes<Self>) -> Lanes<Self> {
        // Zero seeds stay zero.
        let above = self.less_than_f64s(least.1, x.1);
        let seed = self
            .avx512f
            ._mm512_maskz_rsqrt14_pd(above.0, pulp::cast(x.1));
        let seed = Lanes(self, pulp::cast(seed));
        if TERMS == 0 {
            return seed;
        }
        // With e = 1 - x y^2 the root is y (1 - e)^(-1/2) = y (1 + e/2 + 3 e^2/8 + 5 e^3/16 + ...).
        let e = (-(x * seed)).mul_add(seed, Lanes::splat(self, 1.0));
        let mut series = Lanes::splat(self, [0.0, 0.5, 0.375, 0.3125][TERMS]);
        if TERMS > 2 {
            series = e.mul_add(series, Lanes::splat(self, 0.375));
        }
        if TERMS > 1 {
            series = e.mul_add(series, Lanes::splat(self, 0.5));
        }
        (seed * e).mul_add(series, seed)
    }
}

/// Work that wants an [`Isa`].
pub trait WithIsa {
    /// What the work returns.
    type Output;

    /// The work, compiled for each instruction set: must be `#[inline(always)]`.
    fn with_isa<S: Isa>(self, simd: S) -> Self::Output;
}

/// Does `work` on the widest instruction set of this machine.
#[inline(always)]
pub fn dispatch<W: WithIsa>(work: W) -> W::Output {
    match Arch::new() {
        #[cfg(target_arch = "x86_64")]
        Arch::V4(simd) => simd.call(work),
        #[cfg(target_arch = "x86_64")]
        Arch::V3(simd) => simd.call(work),
        _ => Scalar.call(work),
    }
}

/// Work that takes reciprocal roots of some [`Precision`].
pub trait WithRoots {
    /// What the work returns.
    type Output;

    /// Whether the work is compiled for each precision, or for the full one only.
    const EACH_PRECISION: bool;

    /// The work, with roots of `TERMS` terms: must be `#[inline(always)]`.
    fn with_roots<S: Isa, const TERMS: usize>(self, simd: S) -> Self::Output;
}

/// Does `work` with roots of at least this precision on the widest instruction set of this machine.
#[inline(always)]
pub fn dispatch_roots<W: WithRoots>(precision: Precision, work: W) -> W::Output {
    dispatch(Rooted(precision, work))
}

/// Work and the precision of its roots.
struct Rooted<W>(Precision, W);

impl<W: WithRoots> WithIsa for Rooted<W> {
    type Output = W::Output;

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) -> W::Output {
        if !(S::SEEDED && W::EACH_PRECISION) {
            return self.1.with_roots::<S, 3>(simd);
        }
        match self.0 {
            Precision::Seed => self.1.with_roots::<S, 0>(simd),
            Precision::Single => self.1.with_roots::<S, 1>(simd),
            Precision::Close => self.1.with_roots::<S, 2>(simd),
            Precision::Full => self.1.with_roots::<S, 3>(simd),
        }
    }
}

/// Work and its instruction set, as the closure of `vectorize`.
struct On<W, S>(W, S);

impl<W: WithIsa, S: Isa> WithSimd for On<W, S> {
    type Output = W::Output;

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) -> W::Output {
        self.0.with_isa(self.1)
    }
}
