//! Points along the Morton curve.

use rayon::prelude::*;

use super::points::SortedPoints;
use super::root::Root;

/// Levels that keys tell apart.
pub(super) const DEPTH: usize = 42;

/// Morton keys of sources and targets, ascending: three bits for each level, with the coarsest
/// level in the highest bits.
pub(super) struct Keys<'a> {
    pub sources: &'a [u128],
    /// `None` if the targets are the sources.
    pub targets: Option<&'a [u128]>,
}

/// Points in Morton order, equal keys in the user's order, and their keys.
pub(super) fn sorted(points: &[[f64; 3]], root: &Root) -> (SortedPoints, Vec<u128>) {
    let scale = (1u64 << DEPTH) as f64 / root.side;
    let mut keyed: Vec<(u128, u32)> = points
        .par_iter()
        .enumerate()
        .map(|(i, &point)| (key(point, root, scale), i as u32))
        .collect();
    keyed.par_sort_unstable();
    let order: Vec<u32> = keyed.par_iter().map(|one| one.1).collect();
    let gathered: Vec<[f64; 3]> = order.par_iter().map(|&i| points[i as usize]).collect();
    let positions =
        std::array::from_fn(|axis| gathered.par_iter().map(|point| point[axis]).collect());
    (
        SortedPoints { order, positions },
        keyed.par_iter().map(|one| one.0).collect(),
    )
}

/// Which child of its box of level `level` a point is in.
pub(super) fn octant(key: u128, level: usize) -> u8 {
    ((key >> (3 * (DEPTH - 1 - level))) & 7) as u8
}

/// One of `stride` points, evenly over whatever pattern the user's order has.
pub(super) fn thinned(points: &[[f64; 3]], stride: usize) -> Vec<[f64; 3]> {
    // Multiples of the golden ratio modulo 1 are spread evenly, and along every subsequence.
    let kept = |i: usize| {
        ((i as u32).wrapping_mul(0x9e37_79b9) as usize) < (u32::MAX as usize + 1) / stride
    };
    points
        .iter()
        .enumerate()
        .filter(|(i, _)| kept(*i))
        .map(|(_, &point)| point)
        .collect()
}

fn key(point: [f64; 3], root: &Root, scale: f64) -> u128 {
    let along = |axis: usize| {
        let place = ((point[axis] - root.corner[axis]) * scale) as u64;
        spread(place.min((1 << DEPTH) - 1)) << axis
    };
    along(0) | along(1) | along(2)
}

/// Moves bit i to bit 3 i, for 42 bits.
fn spread(bits: u64) -> u128 {
    let half = |mut x: u64| {
        x &= 0x1f_ffff;
        x = (x | x << 32) & 0x001f_0000_0000_ffff;
        x = (x | x << 16) & 0x001f_0000_ff00_00ff;
        x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
        x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
        x = (x | x << 2) & 0x1249_2492_4924_9249;
        u128::from(x)
    };
    half(bits) | half(bits >> 21) << 63
}
