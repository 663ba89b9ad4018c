//! Grids of children on those of their parents, and back.

use f64_lanes::{Isa, padded};

use crate::gemm::{Into, Rows, gemm};

/// Doubles behind the last row of a grid, so that registers may be stored over its end.
pub(crate) const SPARE: usize = 16;

/// The memory of a grid of $g^3$ points: rows of z padded to whole registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct GridShape {
    pub points: usize,
}

impl GridShape {
    /// Doubles between rows of z.
    pub fn stride(self) -> usize {
        padded(self.points)
    }

    /// Doubles of one field.
    pub fn field(self) -> usize {
        self.points * self.points * self.stride()
    }

    /// Doubles of several fields of one box.
    pub fn len(self, fields: usize) -> usize {
        fields * self.field() + SPARE
    }
}

/// From the grid of a child to that of its parent, one axis after the other.
#[derive(Clone, Debug)]
pub(crate) struct Transfer {
    shape: GridShape,
    /// Points of the parent that a child reaches, from its own side of the parent's grid.
    reach: usize,
    /// Matrices for the lower and the upper child, each of `reach` x `points`, with rows padded to
    /// whole registers. The first row is the lowest point reached.
    matrix: [Vec<f64>; 2],
    /// Its transpose, `points` x `reach`, rows padded too.
    transpose: [Vec<f64>; 2],
}

/// Memory of a transfer.
pub(crate) struct TransferScratch {
    once: Vec<f64>,
    twice: Vec<f64>,
    thrice: Vec<f64>,
}

impl Transfer {
    /// `lower`: parent's points x child's points, for the lower child; rows beyond `reach` are
    /// zero.
    pub fn new(points: usize, reach: usize, lower: &[f64]) -> Self {
        let shape = GridShape { points };
        let entry = |upper: usize, row: usize, column: usize| {
            if upper == 0 {
                lower[row * points + column]
            } else {
                // Row 0 is the lowest point that the upper child reaches: the mirror image of the
                // last row.
                lower[(reach - 1 - row) * points + points - 1 - column]
            }
        };
        let (stride, width) = (shape.stride(), padded(reach));
        let mut matrix = [0, 1].map(|_| vec![0.0; reach * stride]);
        let mut transpose = [0, 1].map(|_| vec![0.0; points * width]);
        for upper in 0..2 {
            for row in 0..reach {
                for column in 0..points {
                    matrix[upper][row * stride + column] = entry(upper, row, column);
                    transpose[upper][column * width + row] = entry(upper, row, column);
                }
            }
        }
        Self {
            shape,
            reach,
            matrix,
            transpose,
        }
    }

    pub fn scratch(&self) -> TransferScratch {
        let (points, stride) = (
            self.shape.points,
            self.shape.stride().max(padded(self.reach)),
        );
        TransferScratch {
            once: vec![0.0; points * points * stride],
            twice: vec![0.0; points * points * stride],
            thrice: vec![0.0; points * points * stride],
        }
    }

    /// First point of the parent that the child reaches along each axis.
    fn corner(&self, octant: u8) -> [usize; 3] {
        [0, 1, 2].map(|axis| usize::from(octant >> axis & 1) * (self.shape.points - self.reach))
    }

    /// Adds the grid of a child to that of its parent, one field.
    #[inline(always)]
    pub fn up<S: Isa>(
        &self,
        simd: S,
        octant: u8,
        child: &[f64],
        parent: &mut [f64],
        scratch: &mut TransferScratch,
    ) {
        let (points, reach) = (self.shape.points, self.reach);
        let (stride, width) = (self.shape.stride(), padded(reach));
        let [x, y, z] = [0, 1, 2].map(|axis| usize::from(octant >> axis & 1));
        let plane = points * stride;
        let rows = |matrix| Rows {
            data: matrix,
            stride,
        };
        let child = Rows {
            data: child,
            stride: plane,
        };
        gemm(
            simd,
            [reach, plane, points],
            rows(&self.matrix[x]),
            child,
            &mut scratch.once,
            plane,
            Into::Replace,
        );
        for i in 0..reach {
            let from = Rows {
                data: &scratch.once[i * plane..],
                stride,
            };
            let to = &mut scratch.twice[i * reach * stride..];
            gemm(
                simd,
                [reach, stride, points],
                rows(&self.matrix[y]),
                from,
                to,
                stride,
                Into::Replace,
            );
        }
        let from = Rows {
            data: &scratch.twice,
            stride,
        };
        let matrix = Rows {
            data: &self.transpose[z],
            stride: width,
        };
        gemm(
            simd,
            [reach * reach, width, points],
            from,
            matrix,
            &mut scratch.thrice,
            width,
            Into::Replace,
        );
        let corner = self.corner(octant);
        for i in 0..reach {
            for j in 0..reach {
                let at = ((corner[0] + i) * points + corner[1] + j) * stride + corner[2];
                let row = &scratch.thrice[(i * reach + j) * width..][..reach];
                for (to, from) in parent[at..][..reach].iter_mut().zip(row) {
                    *to += from;
                }
            }
        }
    }

    /// Adds the grid of a parent to that of its child, one field: the transpose of [`Self::up`].
    #[inline(always)]
    pub fn down<S: Isa>(
        &self,
        simd: S,
        octant: u8,
        parent: &[f64],
        child: &mut [f64],
        scratch: &mut TransferScratch,
    ) {
        let (points, reach) = (self.shape.points, self.reach);
        let (stride, width) = (self.shape.stride(), padded(reach));
        let [x, y, z] = [0, 1, 2].map(|axis| usize::from(octant >> axis & 1));
        let corner = self.corner(octant);
        for i in 0..reach {
            for j in 0..reach {
                let at = ((corner[0] + i) * points + corner[1] + j) * stride + corner[2];
                scratch.thrice[(i * reach + j) * width..][..reach]
                    .copy_from_slice(&parent[at..][..reach]);
            }
        }
        let from = Rows {
            data: &scratch.thrice,
            stride: width,
        };
        let matrix = Rows {
            data: &self.matrix[z],
            stride,
        };
        gemm(
            simd,
            [reach * reach, stride, reach],
            from,
            matrix,
            &mut scratch.twice,
            stride,
            Into::Replace,
        );
        let rows = |matrix| Rows {
            data: matrix,
            stride: width,
        };
        for i in 0..reach {
            let from = Rows {
                data: &scratch.twice[i * reach * stride..],
                stride,
            };
            let to = &mut scratch.once[i * points * stride..];
            gemm(
                simd,
                [points, stride, reach],
                rows(&self.transpose[y]),
                from,
                to,
                stride,
                Into::Replace,
            );
        }
        let plane = points * stride;
        let from = Rows {
            data: &scratch.once,
            stride: plane,
        };
        gemm(
            simd,
            [points, plane, reach],
            rows(&self.transpose[x]),
            from,
            child,
            plane,
            Into::Add,
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use f64_lanes::{WithIsa, dispatch};

    struct Both<'a>(&'a Transfer, u8, &'a [f64], &'a [f64]);

    impl WithIsa for Both<'_> {
        type Output = [Vec<f64>; 2];

        #[inline(always)]
        fn with_isa<S: Isa>(self, simd: S) -> [Vec<f64>; 2] {
            let Both(transfer, octant, child, parent) = self;
            let mut out = [vec![0.0; child.len()], vec![0.0; child.len()]];
            let mut scratch = transfer.scratch();
            transfer.up(simd, octant, child, &mut out[0], &mut scratch);
            transfer.down(simd, octant, parent, &mut out[1], &mut scratch);
            out
        }
    }

    #[test]
    fn tensor_products_of_one_axis_and_their_transpose() {
        let (points, reach) = (6, 5);
        let shape = GridShape { points };
        let lower: Vec<f64> = (0..points * points)
            .map(|at| {
                if at / points < reach {
                    fastrand::f64() - 0.5
                } else {
                    0.0
                }
            })
            .collect();
        let transfer = Transfer::new(points, reach, &lower);
        let random = || -> Vec<f64> {
            let mut grid = vec![0.0; shape.len(1)];
            for row in grid[..shape.field()].chunks_exact_mut(shape.stride()) {
                row[..points].fill_with(|| fastrand::f64() - 0.5);
            }
            grid
        };
        let axis = |upper: u8, row: usize, column: usize| match upper {
            0 => lower[row * points + column],
            _ => lower[(points - 1 - row) * points + points - 1 - column],
        };
        let at = |x: usize, y: usize, z: usize| (x * points + y) * shape.stride() + z;
        for octant in 0..8u8 {
            let (child, parent) = (random(), random());
            let [up, down] = dispatch(Both(&transfer, octant, &child, &parent));
            let (mut there, mut back) = (0.0, 0.0);
            for i in 0..shape.field() {
                there += parent[i] * up[i];
                back += child[i] * down[i];
            }
            assert!(
                (there - back).abs() < 1e-13,
                "octant {octant}: {there} {back}"
            );
            let [x, y, z] = [4, 1, 3];
            let mut exact = 0.0;
            for i in 0..points {
                for j in 0..points {
                    for k in 0..points {
                        exact += axis(octant & 1, x, i)
                            * axis(octant >> 1 & 1, y, j)
                            * axis(octant >> 2, z, k)
                            * child[at(i, j, k)];
                    }
                }
            }
            assert!((up[at(x, y, z)] - exact).abs() < 1e-13);
        }
    }
}
