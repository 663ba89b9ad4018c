//! Small dense products: the transforms and transfers of the grids are made of them.

use f64_lanes::{Isa, Lanes, WithIsa};
use pulp::Simd;

/// A row-major matrix inside a buffer.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'a> {
    pub data: &'a [f64],
    /// Doubles from one row to the next.
    pub stride: usize,
}

/// Whether a product replaces what is there or is added to it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Into {
    Replace,
    Add,
}

/// $C = AB$ or $C \mathrel{+}= AB$ with $A$ of `rows` x `depth` and $B$ of `depth` x `columns`;
/// `columns` is a multiple of 8, `c_stride` the doubles from one row of $C$ to the next.
#[inline(always)]
pub(crate) fn gemm<S: Isa>(
    simd: S,
    size: [usize; 3],
    a: Rows<'_>,
    b: Rows<'_>,
    c: &mut [f64],
    c_stride: usize,
    into: Into,
) {
    simd.call(Product {
        size,
        a,
        b,
        c,
        c_stride,
        into,
    });
}

/// A product, tile by tile. The code of all tiles is long, and is compiled once for each
/// instruction set.
struct Product<'a> {
    size: [usize; 3],
    a: Rows<'a>,
    b: Rows<'a>,
    c: &'a mut [f64],
    c_stride: usize,
    into: Into,
}

impl WithIsa for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        let Self {
            size: [rows, columns, depth],
            a,
            b,
            c,
            c_stride,
            into,
        } = self;
        // Tiles of 4 rows and 3 registers need 12 accumulators and as many loads as the ports
        // deliver.
        let registers = columns / Lanes::<S>::COUNT;
        let mut register = 0;
        while register < registers {
            let wide = (registers - register).min(3);
            let mut row = 0;
            while row < rows {
                let high = (rows - row).min(4);
                let at = Tile {
                    row,
                    register,
                    depth,
                };
                match (high, wide) {
                    (4, 3) => tile::<S, 4, 3>(simd, at, a, b, c, c_stride, into),
                    (4, 2) => tile::<S, 4, 2>(simd, at, a, b, c, c_stride, into),
                    (4, _) => tile::<S, 4, 1>(simd, at, a, b, c, c_stride, into),
                    (3, 3) => tile::<S, 3, 3>(simd, at, a, b, c, c_stride, into),
                    (3, 2) => tile::<S, 3, 2>(simd, at, a, b, c, c_stride, into),
                    (3, _) => tile::<S, 3, 1>(simd, at, a, b, c, c_stride, into),
                    (2, 3) => tile::<S, 2, 3>(simd, at, a, b, c, c_stride, into),
                    (2, 2) => tile::<S, 2, 2>(simd, at, a, b, c, c_stride, into),
                    (2, _) => tile::<S, 2, 1>(simd, at, a, b, c, c_stride, into),
                    (_, 3) => tile::<S, 1, 3>(simd, at, a, b, c, c_stride, into),
                    (_, 2) => tile::<S, 1, 2>(simd, at, a, b, c, c_stride, into),
                    _ => tile::<S, 1, 1>(simd, at, a, b, c, c_stride, into),
                }
                row += high;
            }
            register += wide;
        }
    }
}

/// Where a tile of the product begins, and how many terms its entries have.
#[derive(Clone, Copy)]
struct Tile {
    row: usize,
    register: usize,
    depth: usize,
}

#[inline(always)]
fn tile<S: Simd, const HIGH: usize, const WIDE: usize>(
    simd: S,
    at: Tile,
    a: Rows<'_>,
    b: Rows<'_>,
    c: &mut [f64],
    c_stride: usize,
    into: Into,
) {
    let count = Lanes::<S>::COUNT;
    let left = at.register * count;
    let mut sum = [[Lanes::splat(simd, 0.0); WIDE]; HIGH];
    let a_rows: [&[f64]; HIGH] =
        std::array::from_fn(|i| &a.data[(at.row + i) * a.stride..][..at.depth]);
    for k in 0..at.depth {
        let b_row = &b.data[k * b.stride + left..][..WIDE * count];
        for (sum, a_row) in sum.iter_mut().zip(a_rows) {
            let factor = Lanes::splat(simd, a_row[k]);
            for (j, sum) in sum.iter_mut().enumerate() {
                *sum = factor.mul_add(Lanes::load(simd, b_row, j), *sum);
            }
        }
    }
    for (i, sum) in sum.into_iter().enumerate() {
        let c_row = &mut c[(at.row + i) * c_stride + left..][..WIDE * count];
        for (j, mut value) in sum.into_iter().enumerate() {
            if into == Into::Add {
                value += Lanes::load(simd, c_row, j);
            }
            value.store(c_row, j);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use f64_lanes::dispatch;

    struct Whole<'a>([usize; 3], &'a [f64], &'a [f64], &'a mut [f64], Into);

    impl WithIsa for Whole<'_> {
        type Output = ();

        #[inline(always)]
        fn with_isa<S: Isa>(self, simd: S) {
            let [_, columns, depth] = self.0;
            let a = Rows {
                data: self.1,
                stride: depth,
            };
            let b = Rows {
                data: self.2,
                stride: columns,
            };
            gemm(simd, self.0, a, b, self.3, columns, self.4);
        }
    }

    #[test]
    fn agrees_with_the_definition() {
        for rows in 1..9 {
            for columns in [8, 16, 24, 40] {
                for depth in [1, 5, 12] {
                    let a: Vec<f64> = (0..rows * depth).map(|_| fastrand::f64() - 0.5).collect();
                    let b: Vec<f64> = (0..depth * columns)
                        .map(|_| fastrand::f64() - 0.5)
                        .collect();
                    let start: Vec<f64> = (0..rows * columns).map(|_| fastrand::f64()).collect();
                    for into in [Into::Replace, Into::Add] {
                        let mut c = start.clone();
                        dispatch(Whole([rows, columns, depth], &a, &b, &mut c, into));
                        for i in 0..rows {
                            for j in 0..columns {
                                let at = i * columns + j;
                                let before = if into == Into::Add { start[at] } else { 0.0 };
                                let exact = before
                                    + (0..depth)
                                        .map(|k| a[i * depth + k] * b[k * columns + j])
                                        .sum::<f64>();
                                assert!((c[at] - exact).abs() < 1e-14);
                            }
                        }
                    }
                }
            }
        }
    }
}
