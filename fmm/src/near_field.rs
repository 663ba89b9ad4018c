//! The near field: residual sums between the points of neighbouring leaves.
//!
//! The residual ends at its reach, but a leaf sees the whole leaves around it, and no more than
//! $4\pi/81 = 16\%$ of the pairs with these are within reach. So points are sorted into tiles of
//! eight neighbours. A tile of targets first selects the tiles of sources, then the single sources,
//! that are within reach of its bounding box. Only those are summed.

#![expect(
    clippy::needless_range_loop,
    reason = "index loops over small fixed arrays are what stays in registers"
)]

use std::marker::PhantomData;
use std::ops::Range;

use f64_lanes::{Isa, Lanes, PADDING, Precision, WithIsa, WithRoots, dispatch, dispatch_roots};
use rayon::prelude::*;

use crate::kernel::{Chain, MOST, Numbers, Pair, UNITS, dot};
use crate::tree::{SortedPoints, Tree};

/// Points per tile: one register of the widest instruction set.
const TILE: usize = PADDING;
/// Number of sources whose polynomials are evaluated together. Lists are filled up to a multiple of
/// it.
const TOGETHER: usize = 4;
/// Number of sources whose chains are made before any of them is used. The sums then have the
/// registers for themselves.
const BLOCK: usize = 16;
/// Place in a tile that no point holds.
const VACANT: u32 = u32::MAX;

/// What the near field needs to know of the points, once for all strengths.
pub(crate) struct NearField {
    sources: Tiles,
    targets: Option<Tiles>,
    /// Leaf of each tile of targets.
    leaf: Vec<u32>,
    /// What each leaf sees.
    near: Vec<Vec<NearTiles>>,
    /// The lengths of residuals that occur.
    reaches: Vec<f64>,
    /// The mollified chain in the units of the kernels: coefficients in $s = 2 (r/L)^2 - 1$,
    /// highest power first.
    chain: [Vec<f64>; 4],
    precision: Precision,
}

/// Tiles of sources within a reach.
struct NearTiles {
    tiles: Range<usize>,
    /// Index of the reach.
    reach: usize,
}

/// Points, eight by eight.
#[derive(Default)]
struct Tiles {
    /// Which point of the tree holds each place.
    points: Vec<u32>,
    /// Coordinates, place by place; infinite where vacant.
    positions: [Vec<f64>; 3],
    /// Bounding boxes of the tiles, and eight more boxes at infinity, so that eight boxes can be
    /// read starting from any tile.
    low: [Vec<f64>; 3],
    high: [Vec<f64>; 3],
}

impl Tiles {
    /// Tiles of each range in turn, and the number of tiles before each range.
    fn new(points: &SortedPoints, ranges: &[Range<u32>]) -> (Self, Vec<usize>) {
        let groups: Vec<Vec<u32>> = ranges
            .par_iter()
            .map(|range| {
                let mut group: Vec<u32> = range.clone().collect();
                bisect(&mut group, &points.positions);
                group
            })
            .collect();
        let mut tiles = Self::default();
        let mut starts = vec![0];
        for group in &groups {
            group.chunks(TILE).for_each(|tile| tiles.push(tile, points));
            starts.push(tiles.count());
        }
        for bounds in tiles.low.iter_mut().chain(&mut tiles.high) {
            bounds.extend([f64::INFINITY; TILE]);
        }
        (tiles, starts)
    }

    fn count(&self) -> usize {
        self.points.len() / TILE
    }

    fn push(&mut self, tile: &[u32], points: &SortedPoints) {
        let vacant = TILE - tile.len();
        self.points.extend_from_slice(tile);
        self.points.extend([VACANT; TILE].iter().take(vacant));
        for axis in 0..3 {
            let of = tile.iter().map(|&i| points.positions[axis][i as usize]);
            self.low[axis].push(of.clone().fold(f64::INFINITY, f64::min));
            self.high[axis].push(of.clone().fold(f64::NEG_INFINITY, f64::max));
            self.positions[axis].extend(of);
            self.positions[axis].extend([f64::INFINITY; TILE].iter().take(vacant));
        }
    }
}

/// Sorts points so that each eight in turn are neighbours, by halving along the longest side of the
/// bounding box.
fn bisect(group: &mut [u32], positions: &[Vec<f64>; 3]) {
    if group.len() <= TILE {
        return;
    }
    let coordinate = |axis: usize, i: u32| positions[axis][i as usize];
    let extent = |axis: usize| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for &i in group.iter() {
            let x = coordinate(axis, i);
            (low, high) = (low.min(x), high.max(x));
        }
        high - low
    };
    let extents = [extent(0), extent(1), extent(2)];
    let axis = (0..3).fold(0, |a, b| if extents[b] > extents[a] { b } else { a });
    let half = (group.len() / 2).next_multiple_of(TILE);
    group.select_nth_unstable_by(half, |&i, &j| {
        coordinate(axis, i).total_cmp(&coordinate(axis, j))
    });
    let (low, high) = group.split_at_mut(half);
    bisect(low, positions);
    bisect(high, positions);
}

impl NearField {
    /// `mollified[n - 1]` are the coefficients in $s = 2t - 1$, highest first, of $b_n(t)$,
    /// $\beta_n = L^{1-2n} b_n((r/L)^2)$. Ranges of sources in the tree's near lists must be unions
    /// of leaves.
    pub fn new(tree: &Tree, mollified: &[Vec<f64>; 4], precision: Precision) -> Self {
        let mut by_place: Vec<&Range<u32>> = tree.leaves.iter().map(|leaf| &leaf.sources).collect();
        by_place.retain(|range| !range.is_empty());
        by_place.sort_unstable_by_key(|range| range.start);
        let ranges: Vec<Range<u32>> = by_place.into_iter().cloned().collect();
        let (sources, starts) = Tiles::new(&tree.sources, &ranges);
        let first = |point: u32| starts[ranges.partition_point(|range| range.start < point)];

        let targets: Vec<_> = tree
            .leaves
            .iter()
            .map(|leaf| leaf.targets.clone())
            .collect();
        let (targets, leaf_of) = match &tree.targets {
            Some(points) => {
                let (tiles, starts) = Tiles::new(points, &targets);
                let leaves = tree.leaves.len();
                (Some(tiles), owners(&starts, 0..leaves))
            }
            None => {
                let mut occupied: Vec<usize> = (0..tree.leaves.len()).collect();
                occupied.retain(|&i| !tree.leaves[i].sources.is_empty());
                occupied.sort_unstable_by_key(|&i| tree.leaves[i].sources.start);
                (None, owners(&starts, occupied.into_iter()))
            }
        };

        let mut reaches: Vec<f64> = tree
            .leaves
            .iter()
            .flat_map(|leaf| leaf.near.iter().map(|near| near.reach))
            .collect();
        reaches.sort_unstable_by(f64::total_cmp);
        reaches.dedup();
        let near = tree.leaves.iter().map(|leaf| {
            let near = leaf.near.iter().filter(|near| !near.sources.is_empty());
            let mut near: Vec<_> = near
                .map(|near| NearTiles {
                    tiles: first(near.sources.start)..first(near.sources.end),
                    reach: reaches.partition_point(|&reach| reach < near.reach),
                })
                .collect();
            // One list of sources serves all tiles of one reach.
            near.sort_by_key(|near| (near.reach, near.tiles.start));
            near
        });
        Self {
            near: near.collect(),
            sources,
            targets,
            leaf: leaf_of,
            reaches,
            chain: [0, 1, 2, 3].map(|n| mollified[n].iter().map(|c| c / UNITS[n]).collect()),
            precision,
        }
    }

    #[inline(always)]
    fn targets(&self) -> &Tiles {
        self.targets.as_ref().unwrap_or(&self.sources)
    }

    /// Adds the near field of `strengths` to `outputs`. Both are in the tree's order, one array per
    /// number.
    pub fn add(
        &self,
        numbers: &Numbers,
        add_tile: AddTile,
        strengths: &[Vec<f64>],
        outputs: &mut [Vec<f64>],
    ) {
        let seen = Seen {
            records: self.records(numbers, strengths),
            polynomials: self.polynomials(numbers.orders),
        };
        let tiles = self.targets().count();
        let mut sums = vec![0.0; tiles * numbers.outputs * TILE];
        sums.par_chunks_mut(numbers.outputs * TILE)
            .enumerate()
            .for_each_init(List::default, |list, (tile, sums)| {
                let field = self;
                dispatch(Listing { field, tile, list });
                add_tile(self, &seen, tile, list, sums);
            });
        let points = &self.targets().points;
        outputs.par_iter_mut().enumerate().for_each(|(k, output)| {
            for (points, sums) in points
                .chunks_exact(TILE)
                .zip(sums.chunks_exact(numbers.outputs * TILE))
            {
                for (&point, sum) in points.iter().zip(&sums[k * TILE..]) {
                    if point != VACANT {
                        output[point as usize] += sum;
                    }
                }
            }
        });
    }

    /// Position and weighted strengths of each place, place after place, and after the last one a
    /// source of strength zero.
    fn records(&self, numbers: &Numbers, strengths: &[Vec<f64>]) -> Vec<f64> {
        let stride = 3 + numbers.strengths;
        let places = self.sources.points.len();
        let mut records = vec![0.0; stride * (places + 1)];
        records
            .par_chunks_exact_mut(stride)
            .enumerate()
            .with_min_len(1024)
            .for_each(|(place, record)| {
                if place == places {
                    (0..3).for_each(|axis| {
                        record[axis] = self.sources.positions[axis].first().copied().unwrap_or(0.0)
                    });
                } else if self.sources.points[place] != VACANT {
                    let point = self.sources.points[place] as usize;
                    (0..3).for_each(|axis| record[axis] = self.sources.positions[axis][place]);
                    for k in 0..numbers.strengths {
                        record[3 + k] = strengths[k][point] * numbers.factors[k];
                    }
                }
            });
        records
    }

    /// For each reach $L$ the coefficients of $L^{1-2n} b_n$, with the orders $n$ from first to
    /// last side by side.
    fn polynomials(&self, [first, last]: [usize; 2]) -> Vec<Vec<f64>> {
        let orders = &self.chain[first - 1..last];
        let terms = orders.iter().map(Vec::len).max().unwrap_or(0);
        let interleaved = |reach: &f64| {
            let mut coefficients = Vec::with_capacity(terms * orders.len());
            for term in 0..terms {
                for (n, order) in (first..).zip(orders) {
                    let own = (term + order.len()).checked_sub(terms);
                    let power = reach.powi(1 - 2 * n as i32);
                    coefficients.push(own.map_or(0.0, |own| order[own] * power));
                }
            }
            coefficients
        };
        self.reaches.iter().map(interleaved).collect()
    }
}

/// For each tile its owner, `starts[i]..starts[i + 1]` being the tiles of the owner in place `i`.
fn owners(starts: &[usize], owners: impl Iterator<Item = usize>) -> Vec<u32> {
    let tiles = starts.windows(2).zip(owners);
    tiles
        .flat_map(|(tiles, owner)| std::iter::repeat_n(owner as u32, tiles[1] - tiles[0]))
        .collect()
}

/// The bounding box of a tile of targets.
struct Bounds {
    low: [f64; 3],
    high: [f64; 3],
}

impl Bounds {
    /// One bit for each of the eight boxes from number `first` on: set if its distance from these
    /// bounds is less than the root of `reach2`. Boxes are points where `low` is `high`.
    #[inline(always)]
    fn near<S: Isa>(
        &self,
        simd: S,
        low: &[Vec<f64>; 3],
        high: &[Vec<f64>; 3],
        first: usize,
        reach2: f64,
    ) -> usize {
        let zero = Lanes::splat(simd, 0.0);
        let mut bits = 0;
        for register in 0..TILE / Lanes::<S>::COUNT {
            let mut square = zero;
            for axis in 0..3 {
                let low = Lanes::load(simd, &low[axis][first..first + TILE], register);
                let high = Lanes::load(simd, &high[axis][first..first + TILE], register);
                let (below, above) = (self.low[axis] - high, low - self.high[axis]);
                let gap = below.larger(above).larger(zero);
                square = gap.mul_add(gap, square);
            }
            let near = square.less_bits(Lanes::splat(simd, reach2));
            bits |= near << (register * Lanes::<S>::COUNT);
        }
        bits
    }
}

/// For each byte the places of its bits that are set, lowest first.
const PLACES: [[u8; TILE]; 256] = {
    let mut places = [[0; TILE]; 256];
    let mut byte = 0;
    while byte < 256 {
        let (mut place, mut count) = (0, 0);
        while place < TILE {
            if byte >> place & 1 == 1 {
                places[byte][count] = place as u8;
                count += 1;
            }
            place += 1;
        }
        byte += 1;
    }
    places
};

/// Writes `first` plus the place of each set bit of `bits` to `list`, and returns how many there
/// are. Entries beyond these have no meaning.
#[inline(always)]
fn unpack(bits: usize, first: usize, list: &mut [u32]) -> usize {
    let (places, list) = (&PLACES[bits & 255], &mut list[..TILE]);
    for i in 0..TILE {
        list[i] = first as u32 + u32::from(places[i]);
    }
    bits.count_ones() as usize
}

/// Sources within reach of a tile of targets.
#[derive(Default)]
pub(crate) struct List {
    places: Vec<u32>,
    /// Reaches, and where in the list the sources of each end.
    ends: Vec<(usize, usize)>,
}

/// Finds what one tile of targets sees.
struct Listing<'a> {
    field: &'a NearField,
    tile: usize,
    list: &'a mut List,
}

impl WithIsa for Listing<'_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        self.field.list(simd, self.tile, self.list);
    }
}

/// Adds the near field of a tile of targets, of one kernel: see [`add_tile`].
pub(crate) type AddTile = fn(&NearField, &Seen, usize, &List, &mut [f64]);

/// What tiles see, for one kernel.
pub(crate) struct Seen {
    /// Positions and strengths of the sources.
    records: Vec<f64>,
    /// Coefficients of the residual of each reach.
    polynomials: Vec<Vec<f64>>,
}

/// Adds the sources of a list to the sums of a tile of targets.
pub(crate) fn add_tile<P: Pair>(
    field: &NearField,
    seen: &Seen,
    tile: usize,
    list: &List,
    sums: &mut [f64],
) {
    let work = TileSum::<P> {
        field,
        seen,
        tile,
        list,
        sums,
        pair: PhantomData,
    };
    dispatch_roots(field.precision, work);
}

/// All that one tile of targets sees.
struct TileSum<'a, P> {
    field: &'a NearField,
    seen: &'a Seen,
    tile: usize,
    list: &'a List,
    sums: &'a mut [f64],
    pair: PhantomData<P>,
}

impl<P: Pair> WithRoots for TileSum<'_, P> {
    type Output = ();
    const EACH_PRECISION: bool = P::EACH_PRECISION;

    #[inline(always)]
    fn with_roots<S: Isa, const TERMS: usize>(mut self, simd: S) {
        let mut start = 0;
        for run in 0..self.list.ends.len() {
            let (reach, end) = self.list.ends[run];
            for register in 0..TILE / Lanes::<S>::COUNT {
                self.add_listed::<S, TERMS>(simd, register, reach, start..end);
            }
            start = end;
        }
    }
}

impl NearField {
    #[inline(always)]
    fn bounds(&self, tile: usize) -> Bounds {
        let (low, high) = (&self.targets().low, &self.targets().high);
        Bounds {
            low: [low[0][tile], low[1][tile], low[2][tile]],
            high: [high[0][tile], high[1][tile], high[2][tile]],
        }
    }

    /// Lists the sources within reach of the bounding box of a tile of targets. Sources of one
    /// reach form a run, and each run is filled up with the source of strength zero.
    #[inline(always)]
    fn list<S: Isa>(&self, simd: S, tile: usize, list: &mut List) {
        let bounds = self.bounds(tile);
        let near = &self.near[self.leaf[tile] as usize];
        let most: usize = near.iter().map(|near| near.tiles.len()).sum();
        list.places
            .resize(TILE * (most + 2) + TOGETHER * self.reaches.len(), 0);
        list.ends.clear();
        let (mut count, mut close) = (0, [0; TILE]);
        for (i, group) in near.iter().enumerate() {
            let reach2 = self.reaches[group.reach] * self.reaches[group.reach];
            let Tiles {
                positions,
                low,
                high,
                ..
            } = &self.sources;
            let mut first = group.tiles.start;
            while first < group.tiles.end {
                let wanted = (1 << (group.tiles.end - first).min(TILE)) - 1;
                let bits = bounds.near(simd, low, high, first, reach2) & wanted;
                let found = unpack(bits, first, &mut close);
                for &tile in &close[..found] {
                    let first = TILE * tile as usize;
                    let bits = bounds.near(simd, positions, positions, first, reach2);
                    count += unpack(bits, first, &mut list.places[count..]);
                }
                first += TILE;
            }
            if near.get(i + 1).is_none_or(|next| next.reach != group.reach) {
                let vacant = count.next_multiple_of(TOGETHER) - count;
                list.places[count..count + vacant].fill(self.sources.points.len() as u32);
                count += vacant;
                list.ends.push((group.reach, count));
            }
        }
    }
}

impl<P: Pair> TileSum<'_, P> {
    /// Sums a run of the list, block by block.
    #[inline(always)]
    fn add_listed<S: Isa, const TERMS: usize>(
        &mut self,
        simd: S,
        register: usize,
        reach: usize,
        run: Range<usize>,
    ) {
        let zero = Lanes::splat(simd, 0.0);
        let registers = TILE / Lanes::<S>::COUNT;
        let target = self.field.target(simd, self.tile, register);
        let residual = Residual {
            coefficients: &self.seen.polynomials[reach],
            length: self.field.reaches[reach],
        };
        let mut chains = Chains {
            r2: [zero; BLOCK],
            b: [[zero; BLOCK]; 4],
        };
        let mut sums = [zero; MOST];
        for places in self.list.places[run].chunks(BLOCK) {
            for (i, places) in places.as_chunks().0.iter().enumerate() {
                residual.chains::<S, P, TERMS>(
                    &target,
                    &self.seen.records,
                    places,
                    TOGETHER * i,
                    &mut chains,
                );
            }
            for (i, &place) in places.iter().enumerate() {
                let record = record::<P>(&self.seen.records, place);
                let b = &chains.b;
                let chain = Chain::<S, false> {
                    r2: chains.r2[i],
                    b: [b[0][i], b[1][i], b[2][i], b[3][i]],
                };
                P::add(&distance(&target, record), &chain, &record[3..], &mut sums);
            }
        }
        for output in 0..P::OUTPUTS {
            let index = output * registers + register;
            (Lanes::load(simd, self.sums, index) + sums[output]).store(self.sums, index);
        }
    }
}

impl NearField {
    /// The targets of a register; vacant places take the position of the first.
    #[inline(always)]
    fn target<S: Isa>(&self, simd: S, tile: usize, register: usize) -> [Lanes<S>; 3] {
        let positions = &self.targets().positions;
        let mut target = [Lanes::splat(simd, 0.0); 3];
        let infinity = Lanes::splat(simd, f64::INFINITY);
        for axis in 0..3 {
            let first = Lanes::splat(simd, positions[axis][tile * TILE]);
            let index = tile * (TILE / Lanes::<S>::COUNT) + register;
            let x = Lanes::load(simd, &positions[axis], index);
            target[axis] = x.select_less(infinity, x, first);
        }
        target
    }
}

/// Chains of a block of sources and one register of targets, order by order.
struct Chains<S: Isa> {
    r2: [Lanes<S>; BLOCK],
    b: [[Lanes<S>; BLOCK]; 4],
}

/// Target minus source.
#[inline(always)]
fn distance<S: Isa>(target: &[Lanes<S>; 3], record: &[f64]) -> [Lanes<S>; 3] {
    [
        target[0] - record[0],
        target[1] - record[1],
        target[2] - record[2],
    ]
}

/// The residual of one reach.
struct Residual<'a> {
    coefficients: &'a [f64],
    length: f64,
}

impl Residual<'_> {
    /// Makes the chains of the sources in `places`, from number `first` of the block on. Horner's
    /// scheme evaluates all polynomials side by side, because each multiply-add waits for the one
    /// before.
    #[inline(always)]
    fn chains<S: Isa, P: Pair, const TERMS: usize>(
        &self,
        target: &[Lanes<S>; 3],
        records: &[f64],
        places: &[u32; TOGETHER],
        first: usize,
        chains: &mut Chains<S>,
    ) {
        let simd = target[0].0;
        let zero = Lanes::splat(simd, 0.0);
        let reach2 = Lanes::splat(simd, self.length * self.length);
        let slope = Lanes::splat(simd, 2.0 / (self.length * self.length));
        let mut r2 = [zero; TOGETHER];
        let mut s = [zero; TOGETHER];
        for i in 0..TOGETHER {
            let x = distance(target, record::<P>(records, places[i]));
            r2[i] = dot(&x, &x);
            s[i] = r2[i].mul_add(slope, Lanes::splat(simd, -1.0));
        }
        let [low, high] = P::ORDERS;
        let mut mollified = [[zero; 4]; TOGETHER];
        for term in self.coefficients.chunks_exact(1 + high - low) {
            // An inclusive range would not be unrolled, and the values not be kept in registers.
            for n in low - 1..high {
                let coefficient = Lanes::splat(simd, term[n + 1 - low]);
                for i in 0..TOGETHER {
                    mollified[i][n] = mollified[i][n].mul_add(s[i], coefficient);
                }
            }
        }
        for i in 0..TOGETHER {
            let chain = Chain::residual::<TERMS>(r2[i], reach2, &mollified[i]);
            chains.r2[first + i] = r2[i];
            for n in low - 1..high {
                chains.b[n][first + i] = chain.b[n];
            }
        }
    }
}

/// Position and strengths of the source in this place.
#[inline(always)]
fn record<P: Pair>(records: &[f64], place: u32) -> &[f64] {
    let start = place as usize * (3 + P::STRENGTHS);
    &records[start..start + 3 + P::STRENGTHS]
}

#[cfg(test)]
mod tests;
