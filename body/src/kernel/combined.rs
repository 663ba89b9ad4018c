//! The combined field: double layer plus a multiple of the single layer.

use pulp::Simd;

use super::double_layer::DoubleLayer;
use super::invariant::{Kernel, Parity};
use super::moments::Moments;
use super::pair::{Pair, Separation};
use super::single_layer::SingleLayer;
use f64_lanes::Lanes;

/// The kernel $D_{ij} + \eta S_{ij}$ (Hebeker 1986): the second-kind equation
/// $(\frac12 + D + \eta S)\sigma = f$ of the exterior Dirichlet problem has exactly one solution
/// for every $\eta > 0$.
#[derive(Clone, Copy, Debug)]
pub struct CombinedField {
    /// Weight of the single layer, in units of 1/length.
    pub eta: f64,
}

impl Kernel<9> for CombinedField {
    const PARITY: [Parity; 9] = Parity::OF_VELOCITY;

    #[inline(always)]
    fn mode<S: Simd>(&self, pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; 9] {
        weighted_sum(
            DoubleLayer.mode(pair, m),
            SingleLayer.mode(pair, m),
            Lanes::splat(pair.r.0, self.eta),
        )
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, s: &Separation<S>) -> [Lanes<S>; 9] {
        weighted_sum(
            DoubleLayer.sample(s),
            SingleLayer.sample(s),
            Lanes::splat(s.inv.0, self.eta),
        )
    }
}

/// `double + eta * single`. A plain loop: closures handed to the standard library would not be
/// compiled for the instruction set that was chosen.
#[inline(always)]
fn weighted_sum<S: Simd>(
    double: [Lanes<S>; 9],
    single: [Lanes<S>; 9],
    eta: Lanes<S>,
) -> [Lanes<S>; 9] {
    let mut sum = double;
    for (sum, single) in sum.iter_mut().zip(&single) {
        *sum = eta.mul_add(*single, *sum);
    }
    sum
}
