//! One source and one register of targets.

use f64_lanes::{Isa, Lanes};

use super::chain::Chain;

/// Most numbers any source or target has.
pub(crate) const MOST: usize = 13;

/// What one source does to one register of targets.
pub(crate) trait Pair: Copy + Send + Sync + 'static {
    /// Numbers per source.
    const STRENGTHS: usize;
    /// Numbers per target.
    const OUTPUTS: usize;
    /// First and last order $n$ of the chain that the residual needs.
    const ORDERS: [usize; 2];
    /// Factors that the strengths are multiplied by before [`add`](Self::add) sees them.
    const FACTORS: [f64; MOST];
    /// Whether sums are compiled for each precision of roots. This is done where the roots are a
    /// good part of the work.
    const EACH_PRECISION: bool = Self::OUTPUTS <= 3 && Self::STRENGTHS <= 9;

    /// Adds to `out` what a source of this `strength` does at distances `x` (target minus source).
    fn add<S: Isa, const SINGULAR: bool>(
        x: &[Lanes<S>; 3],
        chain: &Chain<S, SINGULAR>,
        strength: &[f64],
        out: &mut [Lanes<S>; MOST],
    );
}

/// The numbers of a kernel, for the code that is not compiled for each kernel: see [`Pair`].
#[derive(Clone, Copy)]
pub(crate) struct Numbers {
    pub strengths: usize,
    pub outputs: usize,
    pub orders: [usize; 2],
    pub factors: [f64; MOST],
}

impl Numbers {
    pub const fn of<P: Pair>() -> Self {
        Self {
            strengths: P::STRENGTHS,
            outputs: P::OUTPUTS,
            orders: P::ORDERS,
            factors: P::FACTORS,
        }
    }
}
