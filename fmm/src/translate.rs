//! Plane waves of boxes, handed to their colleagues.
//!
//! With waves $k = 2\pi j/3$ in units of the box, a shift by one box turns cosine and sine of an axis by a
//! third of a circle or not at all, and the sum over the 27 colleagues is three sums over three along the axes.

use std::collections::{BTreeSet, HashMap};

use f64_lanes::{Isa, Lanes, WithIsa, dispatch};
use pulp::Simd;
use rayon::prelude::*;

use crate::transform::{BATCH, Ball, CLASSES};

/// Waves handed on together: few enough for all boxes of a level to stay in cache.
const CHUNK: usize = 16;

/// One block of a box: all classes of a chunk of waves.
const BLOCK: usize = CLASSES * CHUNK;

/// Which boxes (or empty places between them) receive from which, one axis after the other.
#[derive(Clone, Debug)]
pub(crate) struct Sweeps {
    sources: usize,
    /// For each axis, for each receiver: its lower neighbour, itself, its upper neighbour among the givers.
    /// One past the last giver stands for none.
    axes: [Vec<[u32; 3]>; 3],
}

type Place = [i64; 3];

fn beside(place: Place, axis: usize, step: i64) -> Place {
    let mut place = place;
    place[axis] += step;
    place
}

/// All places next to those given along an axis, themselves included.
fn around(places: impl IntoIterator<Item = Place>, axis: usize) -> BTreeSet<Place> {
    places
        .into_iter()
        .flat_map(|place| (-1..=1).map(move |step| beside(place, axis, step)))
        .collect()
}

impl Sweeps {
    /// From the places of boxes with sources to those of boxes with targets.
    pub fn new(sources: &[Place], targets: &[Place]) -> Self {
        let wanted_y = around(targets.iter().copied(), 2);
        let wanted_x = around(wanted_y.iter().copied(), 1);
        let after_x: Vec<Place> = around(sources.iter().copied(), 0)
            .intersection(&wanted_x)
            .copied()
            .collect();
        let after_y: Vec<Place> = around(after_x.iter().copied(), 1)
            .intersection(&wanted_y)
            .copied()
            .collect();
        let axes = [
            links(sources, &after_x, 0),
            links(&after_x, &after_y, 1),
            links(&after_y, targets, 2),
        ];
        Self {
            sources: sources.len(),
            axes,
        }
    }
}

fn links(givers: &[Place], receivers: &[Place], axis: usize) -> Vec<[u32; 3]> {
    let numbers: HashMap<Place, u32> = givers
        .iter()
        .enumerate()
        .map(|(number, &place)| (place, number as u32))
        .collect();
    let number = |place| numbers.get(&place).copied().unwrap_or(givers.len() as u32);
    receivers
        .iter()
        .map(|&place| [-1, 0, 1].map(|step| number(beside(place, axis, step))))
        .collect()
}

/// Cosine and sine of the turn that each wave of a ball makes over one box, axis by axis.
#[derive(Clone, Debug)]
pub(crate) struct Turns {
    waves: usize,
    /// `[chunk][axis][cosine, sine][CHUNK]`.
    factors: Vec<f64>,
}

impl Turns {
    pub fn new(ball: &Ball) -> Self {
        let indices: Vec<[usize; 3]> = ball.indices().collect();
        let mut factors = vec![0.0; ball.len.div_ceil(CHUNK) * 6 * CHUNK];
        for (wave, j) in indices.iter().enumerate() {
            for axis in 0..3 {
                let sine = 0.75f64.sqrt();
                let (cos, sin) = [(1.0, 0.0), (-0.5, sine), (-0.5, -sine)][j[axis] % 3];
                let at = (wave / CHUNK * 6 + 2 * axis) * CHUNK + wave % CHUNK;
                factors[at] = cos;
                factors[at + CHUNK] = sin;
            }
        }
        Self {
            waves: ball.len,
            factors,
        }
    }

    /// Doubles of one field of a batch of boxes as it comes from [`Self::translate`].
    fn chunk_len(&self, batches: usize) -> usize {
        batches * BLOCK * BATCH
    }

    /// One field of the boxes with sources, summed over the colleagues of the boxes with targets.
    ///
    /// `waves` gives the field of a batch of sources, `[class of x][class of y][wave][class of z][8]`; the result is
    /// `[chunk][batch of targets][class of x][class of y][CHUNK][class of z][8]`, to be read by [`Self::batch`].
    pub fn translate<'a>(
        &self,
        sweeps: &Sweeps,
        waves: impl Fn(usize) -> &'a [f64] + Sync,
        out: &mut Vec<f64>,
    ) {
        let batches = sweeps.axes[2].len().div_ceil(BATCH);
        out.resize(self.waves.div_ceil(CHUNK) * self.chunk_len(batches), 0.0);
        out.par_chunks_mut(self.chunk_len(batches))
            .enumerate()
            .for_each_init(
                || sweeps.axes.each_ref().map(|_| Vec::new()),
                |blocks, (chunk, out)| {
                    let first = chunk * CHUNK;
                    let count = CHUNK.min(self.waves - first);
                    let [even, odd, _] = blocks;
                    even.resize((sweeps.sources + 1) * BLOCK, 0.0);
                    for batch in 0..sweeps.sources.div_ceil(BATCH) {
                        let boxes = BATCH.min(sweeps.sources - batch * BATCH);
                        let blocks = &mut even[batch * BATCH * BLOCK..][..boxes * BLOCK];
                        from_lanes(waves(batch), self.waves, first, count, blocks);
                    }
                    even[sweeps.sources * BLOCK..].fill(0.0);
                    let factors = &self.factors[chunk * 6 * CHUNK..][..6 * CHUNK];
                    for axis in 0..3 {
                        let links = &sweeps.axes[axis];
                        odd.resize((links.len() + 1) * BLOCK, 0.0);
                        odd[links.len() * BLOCK..].fill(0.0);
                        let turn = &factors[2 * axis * CHUNK..][..2 * CHUNK];
                        dispatch(Sweep {
                            axis,
                            links,
                            turn,
                            from: even,
                            to: odd,
                        });
                        std::mem::swap(even, odd);
                    }
                    let boxes = &even[..sweeps.axes[2].len() * BLOCK];
                    for (boxes, out) in boxes
                        .chunks(BATCH * BLOCK)
                        .zip(out.chunks_exact_mut(BLOCK * BATCH))
                    {
                        to_lanes(boxes, out);
                    }
                },
            );
    }

    /// The field of one batch of targets, `[class of x][class of y][wave][class of z][8]`.
    pub fn batch(&self, translated: &[f64], batches: usize, batch: usize, waves: &mut [f64]) {
        let row = 2 * BATCH;
        for (chunk, blocks) in translated.chunks_exact(self.chunk_len(batches)).enumerate() {
            let first = chunk * CHUNK;
            let count = CHUNK.min(self.waves - first);
            let block = &blocks[batch * BLOCK * BATCH..][..BLOCK * BATCH];
            for class in 0..4 {
                waves[(class * self.waves + first) * row..][..count * row]
                    .copy_from_slice(&block[class * CHUNK * row..][..count * row]);
            }
        }
    }
}

/// Boxes' blocks, `[box][class of x][class of y][class of z][CHUNK]`, out of the lanes of a batch.
fn from_lanes(lanes: &[f64], waves: usize, first: usize, count: usize, blocks: &mut [f64]) {
    for class in 0..4 {
        let rows = &lanes[(class * waves + first) * 2 * BATCH..][..count * 2 * BATCH];
        for (number, block) in blocks.chunks_exact_mut(BLOCK).enumerate() {
            let (even, odd) = block[class * 2 * CHUNK..][..2 * CHUNK].split_at_mut(CHUNK);
            for (wave, row) in rows.chunks_exact(2 * BATCH).enumerate() {
                even[wave] = row[number];
                odd[wave] = row[BATCH + number];
            }
        }
    }
}

/// The reverse of [`from_lanes`] for a whole chunk.
fn to_lanes(blocks: &[f64], lanes: &mut [f64]) {
    for (number, block) in blocks.chunks_exact(BLOCK).enumerate() {
        for class in 0..4 {
            let rows = &mut lanes[class * CHUNK * 2 * BATCH..][..CHUNK * 2 * BATCH];
            let (even, odd) = block[class * 2 * CHUNK..][..2 * CHUNK].split_at(CHUNK);
            for (wave, row) in rows.chunks_exact_mut(2 * BATCH).enumerate() {
                row[number] = even[wave];
                row[BATCH + number] = odd[wave];
            }
        }
    }
}

/// The sum over three neighbours along one axis.
struct Sweep<'a> {
    axis: usize,
    links: &'a [[u32; 3]],
    /// Cosines, sines of the turns.
    turn: &'a [f64],
    from: &'a [f64],
    to: &'a mut [f64],
}

impl WithIsa for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        let apart = [4, 2, 1][self.axis] * CHUNK;
        for (links, to) in self.links.iter().zip(self.to.chunks_exact_mut(BLOCK)) {
            let [low, own, high] = links.map(|giver| &self.from[giver as usize * BLOCK..][..BLOCK]);
            for pair in 0..CLASSES / 2 {
                // The classes with a cosine along the axis.
                let class = [pair, pair + (pair & 2), 2 * pair][self.axis];
                let (cos, sin) = (class * CHUNK, class * CHUNK + apart);
                for register in 0..CHUNK / Lanes::<S>::COUNT {
                    let c0 = Lanes::load(simd, &own[cos..][..CHUNK], register);
                    let s0 = Lanes::load(simd, &own[sin..][..CHUNK], register);
                    let (c_low, c_high) = (
                        Lanes::load(simd, &low[cos..][..CHUNK], register),
                        Lanes::load(simd, &high[cos..][..CHUNK], register),
                    );
                    let (s_low, s_high) = (
                        Lanes::load(simd, &low[sin..][..CHUNK], register),
                        Lanes::load(simd, &high[sin..][..CHUNK], register),
                    );
                    let c = Lanes::load(simd, &self.turn[..CHUNK], register);
                    let s = Lanes::load(simd, &self.turn[CHUNK..], register);
                    // A giver one box up: C cos(kx - kL) + S sin(kx - kL); one box down with -L.
                    let even = c.mul_add(c_high + c_low, c0) - s * (s_high - s_low);
                    let odd = c.mul_add(s_high + s_low, s0) + s * (c_high - c_low);
                    even.store(&mut to[cos..][..CHUNK], register);
                    odd.store(&mut to[sin..][..CHUNK], register);
                }
            }
        }
    }
}
