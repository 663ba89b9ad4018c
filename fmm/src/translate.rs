//! Translations: plane waves of boxes, handed to their colleagues.
//!
//! With waves $k = 2\pi j/3$ in units of the box, a shift by one box along an axis rotates the
//! cosine and sine of that axis by a third of a circle or not at all. So the sum over the 27
//! colleagues becomes three sums over three boxes, one along each axis.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use f64_lanes::{Isa, Lanes, WithIsa, dispatch};
use rayon::prelude::*;

use crate::transform::{BATCH, Ball, CLASSES};

/// Waves handed on together: few enough for all boxes of a level to stay in cache.
const CHUNK: usize = 16;

/// One block of a box: all classes of a chunk of waves.
const BLOCK: usize = CLASSES * CHUNK;

/// Boxes of a level that are translated together: some layers of places across the z axis.
///
/// Only the waves of three slabs are ever kept, not those of the level.
#[derive(Clone, Debug)]
pub(crate) struct Slab {
    /// Boxes with sources, as numbers of the level.
    pub sources: Vec<u32>,
    /// Boxes with targets whose sums are complete once this slab has been swept: those of its
    /// layers except the last, and of the last layer of the slab before.
    pub targets: Vec<u32>,
    /// For each receiver along x the numbers of its lower neighbour, itself and its upper neighbour
    /// among the sources. Here and below, a number one past the last means that there is no such
    /// box.
    x: Vec<Links>,
    /// For each receiver along y, the receivers along x.
    y: Vec<Links>,
    /// For each target the receivers along y: counted in this slab and, after its number for no
    /// box, in the two slabs before.
    z: Vec<Links>,
}

type Links = [u32; 3];

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

/// Boxes that are worth a slab of their own.
const WORTHWHILE: usize = 64;

impl Slab {
    /// Slabs, from the lowest to the highest, of the boxes with sources and the boxes with targets
    /// at these places.
    pub fn cut(sources: &[(u32, Place)], targets: &[(u32, Place)]) -> Vec<Self> {
        let wanted_y = around(targets.iter().map(|&(_, place)| place), 2);
        let wanted_x = around(wanted_y.iter().copied(), 1);
        let reached_x = around(sources.iter().map(|&(_, place)| place), 0);
        let after_x: Vec<Place> = reached_x.intersection(&wanted_x).copied().collect();
        let after_y: Vec<Place> = around(after_x.iter().copied(), 1)
            .intersection(&wanted_y)
            .copied()
            .collect();
        let ends = ends(sources, targets);
        let mut slabs: Vec<Self> = Vec::new();
        let mut kept: Vec<Vec<Place>> = Vec::new();
        let mut low = i64::MIN;
        for (number, &high) in ends.iter().enumerate() {
            let within = |place: &Place| (low..high).contains(&place[2]);
            let sources: Vec<_> = sources.iter().filter(|(_, place)| within(place)).collect();
            let givers: Vec<Place> = sources.iter().map(|(_, place)| *place).collect();
            let after_x: Vec<Place> = after_x.iter().filter(|p| within(p)).copied().collect();
            let after_y: Vec<Place> = after_y.iter().filter(|p| within(p)).copied().collect();
            let last = number + 1 == ends.len();
            let (from, to) = (low.saturating_sub(1), if last { high } else { high - 1 });
            let ripe = targets
                .iter()
                .filter(|(_, place)| (from..to).contains(&place[2]));
            let ripe: Vec<_> = ripe.collect();
            kept.insert(0, after_y.clone());
            kept.truncate(3);
            slabs.push(Self {
                sources: sources.iter().map(|(number, _)| *number).collect(),
                targets: ripe.iter().map(|(number, _)| *number).collect(),
                x: links(&[&givers], &after_x, 0),
                y: links(&[&after_x], &after_y, 1),
                z: links(
                    &kept.iter().map(|places| &places[..]).collect::<Vec<_>>(),
                    &ripe.iter().map(|(_, place)| *place).collect::<Vec<_>>(),
                    2,
                ),
            });
            low = high;
        }
        slabs
    }
}

/// Where slabs end: layers of z are added until there are boxes enough for a slab.
fn ends(sources: &[(u32, Place)], targets: &[(u32, Place)]) -> Vec<i64> {
    let mut layers: BTreeMap<i64, usize> = BTreeMap::new();
    for (_, place) in sources.iter().chain(targets) {
        *layers.entry(place[2]).or_default() += 1;
    }
    let mut ends = Vec::new();
    let mut boxes = 0;
    for (&layer, &count) in &layers {
        boxes += count;
        if boxes >= 2 * WORTHWHILE {
            ends.push(layer + 1);
            boxes = 0;
        }
    }
    if boxes > 0 {
        ends.push(i64::MAX);
    } else if let Some(last) = ends.last_mut() {
        *last = i64::MAX;
    }
    ends
}

/// The neighbours of each receiver along an axis, in several lists of givers. Each list is followed
/// by one number that means no box.
fn links(givers: &[&[Place]], receivers: &[Place], axis: usize) -> Vec<Links> {
    let mut numbers: HashMap<Place, u32> = HashMap::new();
    let mut first = 0;
    for givers in givers {
        numbers.extend(
            (first..)
                .zip(*givers)
                .map(|(number, &place)| (place, number)),
        );
        first += givers.len() as u32 + 1;
    }
    let none = givers.first().map_or(0, |givers| givers.len() as u32);
    let number = |place| numbers.get(&place).copied().unwrap_or(none);
    let of = |&place: &Place| [-1, 0, 1].map(|step| number(beside(place, axis, step)));
    receivers.iter().map(of).collect()
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

    /// Chunks of each field.
    fn chunks(&self) -> usize {
        self.waves.div_ceil(CHUNK)
    }

    /// Sums one of the `fields` fields of a slab's sources over x and y.
    ///
    /// `waves` has all fields of each batch, `[class of x][class of y][wave][class of z][8]`. The
    /// result is `[chunk]` `[receiver along y][class][CHUNK]`, with zeros after the receivers for
    /// boxes that do not exist.
    pub fn sweep(
        &self,
        slab: &Slab,
        field: usize,
        fields: usize,
        waves: &[f64],
        swept: &mut Vec<f64>,
    ) {
        let field_len = CLASSES * self.waves * BATCH;
        let len = (slab.y.len() + 1) * BLOCK;
        swept.resize(self.chunks() * len, 0.0);
        let blocks = || (Vec::new(), Vec::new());
        swept.par_chunks_exact_mut(len).enumerate().for_each_init(
            blocks,
            |(own, after_x), (chunk, swept)| {
                let first = chunk * CHUNK;
                let count = CHUNK.min(self.waves - first);
                own.resize((slab.sources.len() + 1) * BLOCK, 0.0);
                own[slab.sources.len() * BLOCK..].fill(0.0);
                after_x.resize((slab.x.len() + 1) * BLOCK, 0.0);
                after_x[slab.x.len() * BLOCK..].fill(0.0);
                swept[slab.y.len() * BLOCK..].fill(0.0);
                let own_blocks = own[..slab.sources.len() * BLOCK].chunks_mut(BATCH * BLOCK);
                for (batch, blocks) in own_blocks.enumerate() {
                    let lanes = &waves[(batch * fields + field) * field_len..][..field_len];
                    from_lanes(lanes, self.waves, first, count, blocks);
                }
                let turn = |axis| self.turn(chunk, axis);
                dispatch(Sweep {
                    axis: 0,
                    links: &slab.x,
                    turn: turn(0),
                    from: &[own],
                    to: after_x,
                });
                dispatch(Sweep {
                    axis: 1,
                    links: &slab.y,
                    turn: turn(1),
                    from: &[after_x],
                    to: swept,
                });
            },
        );
    }

    /// Sums one field of a slab and of the slabs before it, after their sweeps, over z. The result
    /// is the waves of its targets, `[chunk][batch of targets]`
    /// `[class of x][class of y][CHUNK][class of z][8]`, to be read by [`Self::batch`].
    pub fn gather(&self, slab: &Slab, swept: &[Vec<f64>], out: &mut Vec<f64>) {
        if slab.targets.is_empty() {
            return;
        }
        let len = slab.targets.len().div_ceil(BATCH) * BLOCK * BATCH;
        out.resize(self.chunks() * len, 0.0);
        out.par_chunks_exact_mut(len).enumerate().for_each_init(
            Vec::new,
            |blocks, (chunk, out)| {
                blocks.resize(slab.targets.len() * BLOCK, 0.0);
                let parts = swept.iter().map(|slab| {
                    let len = slab.len() / self.chunks();
                    &slab[chunk * len..(chunk + 1) * len]
                });
                let (axis, from) = (2, &parts.collect::<Vec<_>>()[..]);
                dispatch(Sweep {
                    axis,
                    links: &slab.z,
                    turn: self.turn(chunk, axis),
                    from,
                    to: blocks,
                });
                for (boxes, out) in blocks
                    .chunks(BATCH * BLOCK)
                    .zip(out.chunks_exact_mut(BLOCK * BATCH))
                {
                    to_lanes(boxes, out);
                }
            },
        );
    }

    /// Cosines and sines of a chunk's turns along an axis.
    fn turn(&self, chunk: usize, axis: usize) -> &[f64] {
        &self.factors[(chunk * 6 + 2 * axis) * CHUNK..][..2 * CHUNK]
    }

    /// One batch of targets of what was gathered, `[class of x][class of y][wave][class of z][8]`.
    pub fn batch(&self, gathered: &[f64], batch: usize, batches: usize, waves: &mut [f64]) {
        let row = 2 * BATCH;
        for (chunk, blocks) in gathered.chunks_exact(batches * BLOCK * BATCH).enumerate() {
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
    links: &'a [Links],
    /// Cosines, sines of the turns.
    turn: &'a [f64],
    /// Blocks of the givers, list after list.
    from: &'a [&'a [f64]],
    to: &'a mut [f64],
}

/// The block of a giver in the list it is in.
#[inline(always)]
fn block<'a>(from: &[&'a [f64]], giver: u32) -> &'a [f64] {
    let mut at = giver as usize * BLOCK;
    for &list in from {
        if at < list.len() {
            return &list[at..at + BLOCK];
        }
        at -= list.len();
    }
    unreachable!("links point to givers")
}

impl WithIsa for Sweep<'_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        let apart = [4, 2, 1][self.axis] * CHUNK;
        for (links, to) in self.links.iter().zip(self.to.chunks_exact_mut(BLOCK)) {
            let [low, own, high] = [0, 1, 2].map(|i| block(self.from, links[i]));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The waves of a field of a box, `[class of x][class of y][wave][class of z]`, moved by one
    /// place along an axis.
    fn moved(field: &[f64], ball: &Ball, step: Place) -> Vec<f64> {
        let mut field = field.to_vec();
        let at = |wave: usize, class: [usize; 3]| {
            ((2 * class[0] + class[1]) * ball.len + wave) * 2 + class[2]
        };
        for axis in 0..3 {
            let before = field.clone();
            for (wave, j) in ball.indices().enumerate() {
                let phase = 2.0 * std::f64::consts::PI / 3.0 * j[axis] as f64 * step[axis] as f64;
                for class in 0..CLASSES {
                    let own = [class & 1, class >> 1 & 1, class >> 2];
                    let mut other = own;
                    other[axis] = 1 - own[axis];
                    // cos(a - b) and sin(a - b) give and take across the classes.
                    let sign = if own[axis] == 0 { -1.0 } else { 1.0 };
                    field[at(wave, own)] = phase.cos() * before[at(wave, own)]
                        + sign * phase.sin() * before[at(wave, other)];
                }
            }
        }
        field
    }

    #[test]
    fn slabs_add_up_what_colleagues_send() {
        let mut random = fastrand::Rng::with_seed(11);
        let ball = Ball::new(3.5);
        let turns = Turns::new(&ball);
        let len = CLASSES * ball.len;
        for spread in [3, 9] {
            let mut places = || -> Vec<(u32, Place)> {
                let all: BTreeSet<Place> = (0..300)
                    .map(|_| [3, spread, spread].map(|n| random.i64(0..n)))
                    .collect();
                (0..).zip(all).collect()
            };
            let (sources, targets) = (places(), places());
            let fields: Vec<Vec<f64>> = sources
                .iter()
                .map(|_| (0..len).map(|_| random.f64() - 0.5).collect())
                .collect();
            let mut swept: [Vec<f64>; 3] = Default::default();
            let (mut gathered, mut waves) = (Vec::new(), vec![0.0; len * BATCH]);
            let mut served = 0;
            let slabs = Slab::cut(&sources, &targets);
            assert!(slabs.len() > 1 || spread == 3);
            for (number, slab) in slabs.iter().enumerate() {
                let mut lanes = vec![0.0; slab.sources.len().div_ceil(BATCH) * len * BATCH];
                for (place, &source) in slab.sources.iter().enumerate() {
                    for (i, value) in fields[source as usize].iter().enumerate() {
                        // One field: batches follow each other.
                        lanes[((place / BATCH) * len + i) * BATCH + place % BATCH] = *value;
                    }
                }
                swept.rotate_right(1);
                turns.sweep(slab, 0, 1, &lanes, &mut swept[0]);
                turns.gather(slab, &swept[..3.min(number + 1)], &mut gathered);
                for (place, &target) in slab.targets.iter().enumerate() {
                    let batches = slab.targets.len().div_ceil(BATCH);
                    turns.batch(&gathered, place / BATCH, batches, &mut waves);
                    let mut exact = vec![0.0; len];
                    for (source, field) in sources.iter().zip(&fields) {
                        let step =
                            [0, 1, 2].map(|axis| source.1[axis] - targets[target as usize].1[axis]);
                        if step.iter().all(|step| step.abs() <= 1) {
                            for (sum, value) in exact.iter_mut().zip(moved(field, &ball, step)) {
                                *sum += value;
                            }
                        }
                    }
                    for (i, exact) in exact.iter().enumerate() {
                        assert!((waves[i * BATCH + place % BATCH] - exact).abs() < 1e-13);
                    }
                    served += 1;
                }
            }
            assert_eq!(served, targets.len());
        }
    }
}
