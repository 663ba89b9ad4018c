//! Laplace charges.

use f64_lanes::{Isa, Lanes};

use super::chain::{Chain, EIGHTH};
use super::pair::{MOST, Pair};

/// One charge $q$ per source. The outputs are the potential, $q/4\pi r$ for the full kernel
/// (`OUTPUTS` = 1), and also its gradient (`OUTPUTS` = 4).
#[derive(Clone, Copy)]
pub(crate) struct Laplace<const OUTPUTS: usize>;

impl<const OUTPUTS: usize> Pair for Laplace<OUTPUTS> {
    const STRENGTHS: usize = 1;
    const OUTPUTS: usize = OUTPUTS;
    const ORDERS: [usize; 2] = [1, if OUTPUTS > 1 { 3 } else { 2 }];
    const FACTORS: [f64; MOST] = [2.0 * EIGHTH; MOST];

    #[inline(always)]
    fn add<S: Isa, const SINGULAR: bool>(
        x: &[Lanes<S>; 3],
        chain: &Chain<S, SINGULAR>,
        strength: &[f64],
        out: &mut [Lanes<S>; MOST],
    ) {
        let charge = Lanes::splat(x[0].0, strength[0]);
        out[0] = charge.mul_add(chain.laplacian(), out[0]);
        if OUTPUTS > 1 {
            let slope = -(charge * chain.dipole());
            for i in 0..3 {
                out[1 + i] = slope.mul_add(x[i], out[1 + i]);
            }
        }
    }
}
