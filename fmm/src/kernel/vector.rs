//! Vectors whose components are registers.

use f64_lanes::{Isa, Lanes};

/// Constant times lanes.
#[inline(always)]
pub(crate) fn scaled<S: Isa>(factor: f64, x: Lanes<S>) -> Lanes<S> {
    Lanes::splat(x.0, factor) * x
}

/// $a \cdot b$.
#[inline(always)]
pub(crate) fn dot<S: Isa>(a: &[Lanes<S>; 3], b: &[Lanes<S>; 3]) -> Lanes<S> {
    a[2].mul_add(b[2], a[1].mul_add(b[1], a[0] * b[0]))
}

/// Three numbers from place `first`, each in all lanes.
#[inline(always)]
pub(crate) fn broadcast<S: Isa>(simd: S, numbers: &[f64], first: usize) -> [Lanes<S>; 3] {
    [
        Lanes::splat(simd, numbers[first]),
        Lanes::splat(simd, numbers[first + 1]),
        Lanes::splat(simd, numbers[first + 2]),
    ]
}
