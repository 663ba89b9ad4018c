//! What all sources do to a chunk of targets: the part of direct sums that is compiled for each
//! kernel.

#![expect(
    clippy::needless_range_loop,
    reason = "index loops over small fixed arrays are what stays in registers"
)]

use std::marker::PhantomData;

use f64_lanes::{Isa, Lanes, Precision, WithRoots, dispatch_roots};

use crate::kernel::{Chain, MOST, Pair, dot};

/// Targets that one task takes.
pub(super) const CHUNK: usize = 192;
/// Sources that stay in the first-level cache while the targets of a chunk pass.
const BLOCK: usize = 256;

/// Adds what all sources do to one chunk of targets.
pub(crate) fn add_chunk<P: Pair>(
    precision: Precision,
    records: &[f64],
    targets: &[[f64; 3]],
    numbers: &mut [f64],
) {
    let work = ChunkSum::<P> {
        records,
        targets,
        numbers,
        pair: PhantomData,
    };
    dispatch_roots(precision, work);
}

/// All sources against one chunk of targets.
pub(super) struct ChunkSum<'a, P> {
    pub records: &'a [f64],
    pub targets: &'a [[f64; 3]],
    pub numbers: &'a mut [f64],
    pub pair: PhantomData<P>,
}

impl<P: Pair> WithRoots for ChunkSum<'_, P> {
    type Output = ();
    const EACH_PRECISION: bool = P::EACH_PRECISION;

    #[inline(always)]
    fn with_roots<S: Isa, const TERMS: usize>(self, simd: S) {
        let mut positions = [[0.0; CHUNK]; 3];
        for (i, target) in self.targets.iter().enumerate() {
            for axis in 0..3 {
                positions[axis][i] = target[axis];
            }
        }
        for block in self.records.chunks(BLOCK * (3 + P::STRENGTHS)) {
            // As many sums at a time as the registers bear.
            if const { P::OUTPUTS > 4 } {
                add_block::<S, P, TERMS, 1>(
                    simd,
                    block,
                    &positions,
                    self.targets.len(),
                    self.numbers,
                );
            } else {
                add_block::<S, P, TERMS, 2>(
                    simd,
                    block,
                    &positions,
                    self.targets.len(),
                    self.numbers,
                );
            }
        }
    }
}

/// A block of sources against all targets. Each broadcast of a source serves `REGISTERS` registers
/// of targets.
#[inline(always)]
fn add_block<S: Isa, P: Pair, const TERMS: usize, const REGISTERS: usize>(
    simd: S,
    block: &[f64],
    positions: &[[f64; CHUNK]; 3],
    count: usize,
    numbers: &mut [f64],
) {
    let zero = Lanes::splat(simd, 0.0);
    let least = Lanes::splat(simd, LEAST);
    for tile in 0..count.div_ceil(REGISTERS * Lanes::<S>::COUNT) {
        let mut targets = [[zero; 3]; REGISTERS];
        for register in 0..REGISTERS {
            for axis in 0..3 {
                let index = tile * REGISTERS + register;
                targets[register][axis] = Lanes::load(simd, &positions[axis], index);
            }
        }
        let mut sums = [[zero; MOST]; REGISTERS];
        for record in block.chunks_exact(3 + P::STRENGTHS) {
            for register in 0..REGISTERS {
                let target = &targets[register];
                let x = [
                    target[0] - record[0],
                    target[1] - record[1],
                    target[2] - record[2],
                ];
                let chain = Chain::full::<TERMS>(dot(&x, &x), least);
                P::add(&x, &chain, &record[3..], &mut sums[register]);
            }
        }
        for register in 0..REGISTERS {
            for output in 0..P::OUTPUTS {
                let index = tile * REGISTERS + register + output * (CHUNK / Lanes::<S>::COUNT);
                (Lanes::load(simd, numbers, index) + sums[register][output]).store(numbers, index);
            }
        }
    }
}

/// Square of the distance, relative to the largest coordinate, up to which two points count as one.
const LEAST: f64 = 1e-80;
