//! Arithmetic on one SIMD register of doubles, written like arithmetic on doubles.
//!
//! The instruction set is chosen at run time, so the same binary uses AVX-512 where the machine has
//! it. [`pulp::Arch`] chooses it for code that needs arithmetic and square roots only, [`dispatch`]
//! for code that also needs the approximate reciprocal square root of the [`Isa`]. Buffers handed
//! to vectorised code are padded to [`PADDING`] entries, the widest register.
//!
//! Two rules keep the code fast: everything that takes a [`Lanes`] is `#[inline(always)]`, and none
//! of it is a closure, since a closure that is not inlined is compiled without the instruction set.

mod isa;
mod padding;
mod register;

pub use isa::{Isa, Precision, WithIsa, WithRoots, dispatch, dispatch_roots};
pub use padding::{PADDING, padded};
pub use register::Lanes;

#[cfg(test)]
mod tests;
