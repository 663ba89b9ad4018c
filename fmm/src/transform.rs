//! Grids of eight boxes to plane waves and back.
//!
//! The waves of a box of side 1 are real: with $t_0 = \cos$ and $t_1 = \sin$, the coefficients of a
//! density $\sum q\\,\delta(y)$ are
//!
//! $$ Q^{abc}(k) = \sum q\\, t_a(k_x y_x)\\, t_b(k_y y_y)\\, t_c(k_z y_z), \qquad
//!    k = \kappa (j_x, j_y, j_z),\ j \ge 0,\ \lvert k\rvert < K, $$
//!
//! so only an eighth of a ball is kept, eight *classes* for each wave. A grid is folded about its
//! middle into its even and odd parts, each of which meets the cosines or the sines alone. Lanes
//! are eight boxes: every axis is then contracted the same way, no row needs padding, and rows stop
//! where the ball does.

use f64_lanes::{Isa, Lanes};

use crate::gemm::{Into, Rows, gemm};

/// Boxes that are transformed together.
pub(crate) const BATCH: usize = 8;

/// Classes of each wave: cosine or sine in each axis.
pub(crate) const CLASSES: usize = 8;

/// The waves in one eighth of a ball.
///
/// They stand in rows of constant $(j_z, j_y)$ with $j_x = 0, 1, \ldots$ until the ball ends.
#[derive(Clone, Debug)]
pub(crate) struct Ball {
    /// Waves of each axis.
    pub waves: usize,
    /// For each $j_z$: the rows $j_y = 0, 1, \ldots$
    pub planes: Vec<Vec<Row>>,
    /// All waves.
    pub len: usize,
}

/// Waves of constant $(j_z, j_y)$.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    /// Number of its first wave.
    pub first: usize,
    /// Its waves.
    pub len: usize,
}

impl Ball {
    /// Waves with $j_x^2 + j_y^2 + j_z^2 <$ `radius`$^2$.
    pub fn new(radius: f64) -> Self {
        let square = radius * radius;
        let inside = |rest: f64| (0..).take_while(|&j: &u32| f64::from(j * j) < rest).count();
        let mut len = 0;
        let planes = (0..inside(square) as u32)
            .map(|z| {
                let rest = square - f64::from(z * z);
                (0..inside(rest) as u32)
                    .map(|y| {
                        let row = Row {
                            first: len,
                            len: inside(rest - f64::from(y * y)),
                        };
                        len += row.len;
                        row
                    })
                    .collect()
            })
            .collect();
        Self {
            waves: inside(square),
            planes,
            len,
        }
    }

    /// The indices $(j_x, j_y, j_z)$ of each wave.
    pub fn indices(&self) -> impl Iterator<Item = [usize; 3]> {
        self.planes.iter().enumerate().flat_map(|(z, plane)| {
            plane
                .iter()
                .enumerate()
                .flat_map(move |(y, row)| (0..row.len).map(move |x| [x, y, z]))
        })
    }
}

/// One axis: from the folded grid to its waves, and back.
#[derive(Clone, Debug)]
pub(crate) struct AxisWaves {
    /// Points of the grid: even.
    pub points: usize,
    pub waves: usize,
    /// `waves` x `points / 2`, for the points of the upper half: cosines, sines.
    pub to: [Vec<f64>; 2],
    /// Their transposes.
    from: [Vec<f64>; 2],
}

impl AxisWaves {
    pub fn new(points: usize, waves: usize, to: [Vec<f64>; 2]) -> Self {
        let half = points / 2;
        let transpose = |matrix: &Vec<f64>| {
            (0..half * waves)
                .map(|at| matrix[at % waves * half + at / waves])
                .collect()
        };
        let from = [transpose(&to[0]), transpose(&to[1])];
        Self {
            points,
            waves,
            to,
            from,
        }
    }
}

/// The transform of one scalar field of eight boxes.
#[derive(Clone, Debug)]
pub(crate) struct Transform {
    pub ball: Ball,
    pub axis: AxisWaves,
}

/// Memory of a transform.
pub(crate) struct Scratch {
    /// One column of two times eight lanes, folded: even, odd.
    folded: [Vec<f64>; 2],
    /// `[z][2][8]` of two neighbouring columns.
    columns: Vec<f64>,
    /// `[class of z][j_z][y][8]` at one x.
    slab: Vec<f64>,
    /// `[j_z][class of y][j_y][x][class of z][8]`.
    sheets: Vec<f64>,
}

impl Transform {
    /// Doubles of one field's waves: `[class of x][class of y][wave][class of z][8]`.
    pub fn waves_len(&self) -> usize {
        CLASSES * self.ball.len * BATCH
    }

    pub fn scratch(&self) -> Scratch {
        let (points, waves) = (self.axis.points, self.axis.waves);
        Scratch {
            folded: [vec![0.0; points * BATCH], vec![0.0; points * BATCH]],
            columns: vec![0.0; points * 2 * BATCH],
            slab: vec![0.0; 2 * waves * points * BATCH],
            sheets: vec![0.0; waves * 2 * waves * points * 2 * BATCH],
        }
    }

    /// Doubles between the sheets of $(j_z, b)$, with $b$ the class of y.
    fn sheet(&self) -> usize {
        self.axis.waves * self.axis.points * 2 * BATCH
    }

    /// Waves of the grids: rows of z are `stride` doubles long.
    #[inline(always)]
    pub fn forward<S: Isa>(
        &self,
        simd: S,
        grids: [&[f64]; BATCH],
        stride: usize,
        waves: &mut [f64],
        scratch: &mut Scratch,
    ) {
        let points = self.axis.points;
        for x in 0..points {
            for y in (0..points).step_by(2) {
                for (lane, grid) in grids.iter().enumerate() {
                    for side in 0..2 {
                        let row = &grid[(x * points + y + side) * stride..][..points];
                        for (z, value) in row.iter().enumerate() {
                            scratch.columns[(2 * z + side) * BATCH + lane] = *value;
                        }
                    }
                }
                fold(simd, &scratch.columns, &mut scratch.folded);
                for class in 0..2 {
                    let at = (class * self.axis.waves * points + y) * BATCH;
                    self.to_waves(
                        simd,
                        class,
                        self.axis.waves,
                        &scratch.folded,
                        &mut scratch.slab[at..],
                        points * BATCH,
                    );
                }
            }
            self.sheets_from_slab(simd, x, scratch);
        }
        for (z, plane) in self.ball.planes.iter().enumerate() {
            for (y, row) in plane.iter().enumerate() {
                for class_y in 0..2 {
                    let at = (2 * z + class_y) * self.sheet() + y * points * 2 * BATCH;
                    fold(
                        simd,
                        &scratch.sheets[at..][..points * 2 * BATCH],
                        &mut scratch.folded,
                    );
                    for class_x in 0..2 {
                        let at = (2 * class_x + class_y) * self.ball.len + row.first;
                        self.to_waves(
                            simd,
                            class_x,
                            row.len,
                            &scratch.folded,
                            &mut waves[at * 2 * BATCH..],
                            2 * BATCH,
                        );
                    }
                }
            }
        }
    }

    /// Contracts y at one x.
    #[inline(always)]
    fn sheets_from_slab<S: Isa>(&self, simd: S, x: usize, scratch: &mut Scratch) {
        let points = self.axis.points;
        for (z, plane) in self.ball.planes.iter().enumerate() {
            for class_z in 0..2 {
                let at = (class_z * self.axis.waves + z) * points * BATCH;
                let column = &scratch.slab[at..][..points * BATCH];
                for y in 0..points {
                    for register in 0..BATCH / Lanes::<S>::COUNT {
                        let from = &column[y * BATCH..][..BATCH];
                        let to = &mut scratch.columns[(2 * y + class_z) * BATCH..][..BATCH];
                        Lanes::load(simd, from, register).store(to, register);
                    }
                }
            }
            fold(simd, &scratch.columns, &mut scratch.folded);
            for class_y in 0..2 {
                let at = (2 * z + class_y) * self.sheet() + x * 2 * BATCH;
                self.to_waves(
                    simd,
                    class_y,
                    plane.len(),
                    &scratch.folded,
                    &mut scratch.sheets[at..],
                    points * 2 * BATCH,
                );
            }
        }
    }

    /// The first `waves` cosines or sines of a folded pair of columns.
    #[inline(always)]
    fn to_waves<S: Isa>(
        &self,
        simd: S,
        class: usize,
        waves: usize,
        folded: &[Vec<f64>; 2],
        out: &mut [f64],
        stride: usize,
    ) {
        let half = self.axis.points / 2;
        let matrix = Rows {
            data: &self.axis.to[class],
            stride: half,
        };
        let column = Rows {
            data: &folded[class],
            stride: 2 * BATCH,
        };
        gemm(
            simd,
            [waves, 2 * BATCH, half],
            matrix,
            column,
            out,
            stride,
            Into::Replace,
        );
    }

    /// Potentials on the grids: the transpose of [`Self::forward`].
    #[inline(always)]
    pub fn backward<S: Isa>(
        &self,
        simd: S,
        waves: &[f64],
        grids: &mut [&mut [f64]],
        stride: usize,
        scratch: &mut Scratch,
    ) {
        let points = self.axis.points;
        for (z, plane) in self.ball.planes.iter().enumerate() {
            for (y, row) in plane.iter().enumerate() {
                for class_y in 0..2 {
                    for class_x in 0..2 {
                        let at = (2 * class_x + class_y) * self.ball.len + row.first;
                        let column = Rows {
                            data: &waves[at * 2 * BATCH..],
                            stride: 2 * BATCH,
                        };
                        self.to_folded(simd, class_x, row.len, column, &mut scratch.folded);
                    }
                    let at = (2 * z + class_y) * self.sheet() + y * points * 2 * BATCH;
                    unfold(
                        simd,
                        &scratch.folded,
                        &mut scratch.sheets[at..][..points * 2 * BATCH],
                    );
                }
            }
        }
        for x in 0..points {
            self.slab_from_sheets(simd, x, scratch);
            for y in (0..points).step_by(2) {
                for class in 0..2 {
                    let at = (class * self.axis.waves * points + y) * BATCH;
                    let column = Rows {
                        data: &scratch.slab[at..],
                        stride: points * BATCH,
                    };
                    self.to_folded(simd, class, self.axis.waves, column, &mut scratch.folded);
                }
                unfold(simd, &scratch.folded, &mut scratch.columns);
                for (lane, grid) in grids.iter_mut().enumerate() {
                    for side in 0..2 {
                        let row = &mut grid[(x * points + y + side) * stride..][..points];
                        for (z, place) in row.iter_mut().enumerate() {
                            *place = scratch.columns[(2 * z + side) * BATCH + lane];
                        }
                    }
                }
            }
        }
    }

    /// Expands y at one x.
    #[inline(always)]
    fn slab_from_sheets<S: Isa>(&self, simd: S, x: usize, scratch: &mut Scratch) {
        let points = self.axis.points;
        for (z, plane) in self.ball.planes.iter().enumerate() {
            for class_y in 0..2 {
                let at = (2 * z + class_y) * self.sheet() + x * 2 * BATCH;
                let column = Rows {
                    data: &scratch.sheets[at..],
                    stride: points * 2 * BATCH,
                };
                self.to_folded(simd, class_y, plane.len(), column, &mut scratch.folded);
            }
            unfold(simd, &scratch.folded, &mut scratch.columns);
            for class_z in 0..2 {
                let at = (class_z * self.axis.waves + z) * points * BATCH;
                let column = &mut scratch.slab[at..][..points * BATCH];
                for y in 0..points {
                    for register in 0..BATCH / Lanes::<S>::COUNT {
                        let from = &scratch.columns[(2 * y + class_z) * BATCH..][..BATCH];
                        let to = &mut column[y * BATCH..][..BATCH];
                        Lanes::load(simd, from, register).store(to, register);
                    }
                }
            }
        }
    }

    /// The even or odd part of a pair of columns from its first `waves` cosines or sines.
    #[inline(always)]
    fn to_folded<S: Isa>(
        &self,
        simd: S,
        class: usize,
        waves: usize,
        column: Rows<'_>,
        folded: &mut [Vec<f64>; 2],
    ) {
        let half = self.axis.points / 2;
        let matrix = Rows {
            data: &self.axis.from[class],
            stride: self.axis.waves,
        };
        let shape = [half, 2 * BATCH, waves];
        gemm(
            simd,
            shape,
            matrix,
            column,
            &mut folded[class],
            2 * BATCH,
            Into::Replace,
        );
    }
}

/// Even and odd part, about the middle, of a pair of columns: the upper point plus and minus its
/// mirror image.
#[inline(always)]
fn fold<S: Isa>(simd: S, columns: &[f64], folded: &mut [Vec<f64>; 2]) {
    let rows = columns.chunks_exact(2 * BATCH);
    let half = rows.len() / 2;
    let (lower, upper) = columns.split_at(half * 2 * BATCH);
    let [even, odd] = folded;
    for i in 0..half {
        let up = &upper[i * 2 * BATCH..][..2 * BATCH];
        let low = &lower[(half - 1 - i) * 2 * BATCH..][..2 * BATCH];
        for register in 0..2 * BATCH / Lanes::<S>::COUNT {
            let (up, low) = (
                Lanes::load(simd, up, register),
                Lanes::load(simd, low, register),
            );
            (up + low).store(&mut even[i * 2 * BATCH..][..2 * BATCH], register);
            (up - low).store(&mut odd[i * 2 * BATCH..][..2 * BATCH], register);
        }
    }
}

/// The columns whose folded halves are given, after each half was multiplied by its own waves: the
/// transpose of [`fold`].
#[inline(always)]
fn unfold<S: Isa>(simd: S, folded: &[Vec<f64>; 2], columns: &mut [f64]) {
    let half = columns.len() / (4 * BATCH);
    let (lower, upper) = columns.split_at_mut(half * 2 * BATCH);
    for i in 0..half {
        let up = &mut upper[i * 2 * BATCH..][..2 * BATCH];
        let low = &mut lower[(half - 1 - i) * 2 * BATCH..][..2 * BATCH];
        for register in 0..2 * BATCH / Lanes::<S>::COUNT {
            let even = Lanes::load(simd, &folded[0][i * 2 * BATCH..][..2 * BATCH], register);
            let odd = Lanes::load(simd, &folded[1][i * 2 * BATCH..][..2 * BATCH], register);
            (even + odd).store(up, register);
            (even - odd).store(low, register);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use f64_lanes::{WithIsa, dispatch};

    struct Both<'a> {
        transform: &'a Transform,
        grids: &'a [Vec<f64>],
        out: &'a mut [Vec<f64>],
        stride: usize,
    }

    impl WithIsa for Both<'_> {
        type Output = Vec<f64>;

        #[inline(always)]
        fn with_isa<S: Isa>(self, simd: S) -> Vec<f64> {
            let mut waves = vec![0.0; self.transform.waves_len()];
            let mut scratch = self.transform.scratch();
            let grids = std::array::from_fn(|lane| &self.grids[lane][..]);
            self.transform
                .forward(simd, grids, self.stride, &mut waves, &mut scratch);
            let mut out: Vec<&mut [f64]> = self.out.iter_mut().map(|grid| &mut grid[..]).collect();
            self.transform
                .backward(simd, &waves, &mut out, self.stride, &mut scratch);
            waves
        }
    }

    fn trigonometric(points: usize, waves: usize) -> AxisWaves {
        let at = |class: usize| {
            (0..waves * points / 2)
                .map(|at| {
                    let (j, i) = (at / (points / 2), at % (points / 2));
                    let phase = 0.4 * j as f64 * (i as f64 + 0.5);
                    if class == 0 { phase.cos() } else { phase.sin() }
                })
                .collect()
        };
        AxisWaves::new(points, waves, [at(0), at(1)])
    }

    #[test]
    fn waves_are_sums_of_cosines_and_sines_and_come_back_by_the_transpose() {
        let ball = Ball::new(4.2);
        let (points, stride) = (6, 8);
        let transform = Transform {
            axis: trigonometric(points, ball.waves),
            ball,
        };
        let grids: Vec<Vec<f64>> = (0..BATCH)
            .map(|_| (0..36 * stride).map(|_| fastrand::f64() - 0.5).collect())
            .collect();
        let mut out = vec![vec![0.0; 36 * stride]; BATCH];
        let waves = dispatch(Both {
            transform: &transform,
            grids: &grids,
            out: &mut out,
            stride,
        });
        let t = |class: usize, j: usize, i: usize| {
            let phase = 0.4 * j as f64 * (i as f64 - 2.5);
            if class == 0 { phase.cos() } else { phase.sin() }
        };
        let len = transform.ball.len;
        let lane = 3;
        let mut back = vec![0.0; 36 * stride];
        for (wave, [jx, jy, jz]) in transform.ball.indices().enumerate() {
            for class in 0..CLASSES {
                let [a, b, c] = [class & 1, class >> 1 & 1, class >> 2];
                let basis = |x, y, z| t(a, jx, x) * t(b, jy, y) * t(c, jz, z);
                let mut exact = 0.0;
                for (x, y, z) in points_of(points) {
                    exact += grids[lane][(x * points + y) * stride + z] * basis(x, y, z);
                }
                let found = waves[(((2 * a + b) * len + wave) * 2 + c) * BATCH + lane];
                assert!(
                    (found - exact).abs() < 1e-13,
                    "{class} {jx} {jy} {jz}: {found} {exact}"
                );
                for (x, y, z) in points_of(points) {
                    back[(x * points + y) * stride + z] += exact * basis(x, y, z);
                }
            }
        }
        for (x, y, z) in points_of(points) {
            let at = (x * points + y) * stride + z;
            assert!(
                (out[lane][at] - back[at]).abs() < 1e-11,
                "{} {}",
                out[lane][at],
                back[at]
            );
        }
        assert_eq!(
            len,
            transform
                .ball
                .indices()
                .filter(|j| j.iter().map(|j| j * j).sum::<usize>() < 18)
                .count()
        );
    }

    fn points_of(points: usize) -> impl Iterator<Item = (usize, usize, usize)> {
        (0..points * points * points)
            .map(move |at| (at / points / points, at / points % points, at % points))
    }
}
