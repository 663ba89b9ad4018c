//! Instruction sets, told apart by how they take reciprocal square roots.

use pulp::{Arch, Scalar, Simd, WithSimd};

use crate::Lanes;

/// How many digits of a reciprocal square root are wanted. Instruction sets without a seed give all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Relative error below 1e-4: the seed of AVX-512 as it is.
    Seed,
    /// Below 1e-8: one Newton step.
    Single,
    /// Below 1e-12: one step of third order.
    Close,
    /// A few units in the last place.
    Full,
}

/// An instruction set with a reciprocal square root.
pub trait Isa: Simd {
    /// $1/\sqrt x$ for positive lanes; unspecified (infinite or NaN) elsewhere.
    fn rsqrt(self, x: Lanes<Self>, precision: Precision) -> Lanes<Self>;
}

/// By hardware square root and division: where there is no seed for doubles.
#[inline(always)]
fn divided<S: Simd>(x: Lanes<S>) -> Lanes<S> {
    1.0 / x.sqrt()
}

impl Isa for Scalar {
    #[inline(always)]
    fn rsqrt(self, x: Lanes<Self>, _: Precision) -> Lanes<Self> {
        divided(x)
    }
}

#[cfg(target_arch = "x86_64")]
impl Isa for pulp::x86::V3 {
    #[inline(always)]
    fn rsqrt(self, x: Lanes<Self>, _: Precision) -> Lanes<Self> {
        divided(x)
    }
}

#[cfg(target_arch = "x86_64")]
impl Isa for pulp::x86::V4 {
    #[inline(always)]
    fn rsqrt(self, x: Lanes<Self>, precision: Precision) -> Lanes<Self> {
        let seed = Lanes(
            self,
            pulp::cast(self.avx512f._mm512_rsqrt14_pd(pulp::cast(x.1))),
        );
        // With e = 1 - x y^2 the root is y (1 - e)^(-1/2) = y (1 + e/2 + 3 e^2/8 + ...).
        let (half, one) = (Lanes::splat(self, 0.5), Lanes::splat(self, 1.0));
        match precision {
            Precision::Seed => seed,
            Precision::Single => {
                let e = (-(x * seed)).mul_add(seed, one);
                (seed * e).mul_add(half, seed)
            }
            Precision::Close => {
                let e = (-(x * seed)).mul_add(seed, one);
                (seed * e).mul_add(e.mul_add(Lanes::splat(self, 0.375), half), seed)
            }
            Precision::Full => {
                let e = (-(x * seed)).mul_add(seed, one);
                let series = e.mul_add(Lanes::splat(self, 0.3125), Lanes::splat(self, 0.375));
                (seed * e).mul_add(e.mul_add(series, half), seed)
            }
        }
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
        Arch::V4(simd) => Simd::vectorize(simd, On(work, simd)),
        #[cfg(target_arch = "x86_64")]
        Arch::V3(simd) => Simd::vectorize(simd, On(work, simd)),
        _ => Simd::vectorize(Scalar, On(work, Scalar)),
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
