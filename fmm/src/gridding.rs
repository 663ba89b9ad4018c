//! From points to the grid of their box, and back.
//!
//! A grid is a buffer of `D` densities one after the other. Each has $g \times g$ rows `[x][y]` of
//! `padded(g)` numbers along $z$. Buffers that start at a multiple of 64 bytes are the fastest.

use std::ops::Range;

use f64_lanes::{Isa, Lanes, PADDING, WithIsa, dispatch, padded};

use crate::window::Window;

/// The widest window: two registers of AVX-512.
pub(crate) const WIDEST: usize = 2 * PADDING;

/// A box, for what happens inside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cube {
    pub center: [f64; 3],
    pub side: f64,
}

/// Adds to the grid of `cube` the sum
/// $\sum_i [c_{di} + \sum_k d_{dki}\,\partial_{x_k}]\,\varphi(x - y_i)$ for each density $d$, with
/// charges $c$ and, if `DIPOLES`, dipole strengths $d_{dk}$ (per unit length of the user, as is
/// `cube`).
///
/// All arrays are over the points, which are inside `cube`.
pub(crate) fn spread<const D: usize, const DIPOLES: bool>(
    window: &Window,
    cube: Cube,
    points: [&[f64]; 3],
    charges: [&[f64]; D],
    dipoles: [[&[f64]; 3]; D],
    grid: &mut [f64],
) {
    dispatch(Spread::<D, DIPOLES> {
        placing: Placing::new(window, cube),
        points,
        charges,
        dipoles,
        grid,
    });
}

/// Interpolates the `D` grids at points inside `cube`: $\sum_x \varphi(y_i - x)\,G_d(x)$ and, if
/// `GRADIENTS`, its derivatives with respect to $y_i$.
///
/// Results go to `values` point by point: `D` values and then, if `GRADIENTS`, the `D` gradients,
/// three numbers each.
pub(crate) fn interpolate<const D: usize, const GRADIENTS: bool>(
    window: &Window,
    cube: Cube,
    points: [&[f64]; 3],
    grid: &[f64],
    values: &mut [f64],
) {
    dispatch(Interpolate::<D, GRADIENTS> {
        placing: Placing::new(window, cube),
        points,
        grid,
        values,
    });
}

/// Where points stand on a grid.
#[derive(Clone, Copy)]
struct Placing<'a> {
    /// Coefficients of the window, registers of `stride` for each power.
    coefficients: &'a [f64],
    stride: usize,
    width: usize,
    grid_points: usize,
    /// Of one row along z, padding included.
    row_len: usize,
    center: [f64; 3],
    /// Grid spacings per unit length.
    scale: f64,
}

impl<'a> Placing<'a> {
    fn new(window: &'a Window, cube: Cube) -> Self {
        let values = window.values();
        assert!(values.stride <= WIDEST);
        Self {
            coefficients: &values.coefficients,
            stride: values.stride,
            width: window.width(),
            grid_points: window.points(),
            row_len: padded(window.points()),
            center: cube.center,
            scale: 1.0 / (window.spacing() * cube.side),
        }
    }

    /// First grid point in the window of a coordinate, and the argument of the window's
    /// polynomials.
    #[inline(always)]
    fn start(&self, axis: usize, coordinate: f64) -> (usize, f64) {
        let last = self.grid_points - self.width;
        let from = (coordinate - self.center[axis]) * self.scale + 0.5 * (last as f64 - 1.0);
        // Rounding may put a point on the faces just outside.
        let start = from.ceil().clamp(0.0, last as f64);
        (start as usize, 2.0 * (start - from) - 1.0)
    }

    /// Numbers in the grid of one density.
    #[inline(always)]
    fn density_len(&self) -> usize {
        self.grid_points * self.grid_points * self.row_len
    }

    /// The rows of a stencil at its grid point number `x` along that axis.
    #[inline(always)]
    fn rows(&self, stencil: &Stencil, x: usize) -> Range<usize> {
        let start = ((stencil.start[0] + x) * self.grid_points + stencil.start[1]) * self.row_len;
        start..start + self.width * self.row_len
    }

    /// The stencils of a block of the points.
    #[inline(always)]
    fn place<S: Isa, const SLOPES: bool>(
        &self,
        simd: S,
        stencils: &mut [Stencil; BLOCK],
        points: [&[f64]; 3],
        block: Range<usize>,
    ) {
        for (stencil, i) in stencils.iter_mut().zip(block) {
            let point = [points[0][i], points[1][i], points[2][i]];
            stencil.place::<S, SLOPES>(simd, self, point);
        }
    }
}

/// The window of one point on the three axes.
#[repr(align(64))]
struct Stencil {
    /// First grid point of each axis; along z that of the first register.
    start: [usize; 3],
    /// Registers along z, in units of the padding.
    registers: usize,
    x: Axis<WIDEST>,
    y: Axis<WIDEST>,
    z: Axis<{ WIDEST + 2 * PADDING }>,
}

/// Values of the window on grid points, and their derivatives by the coordinate of the point.
#[repr(align(64))]
struct Axis<const N: usize> {
    value: [f64; N],
    slope: [f64; N],
}

impl Stencil {
    const fn new() -> Self {
        Self {
            start: [0; 3],
            registers: 0,
            x: Axis {
                value: [0.0; WIDEST],
                slope: [0.0; WIDEST],
            },
            y: Axis {
                value: [0.0; WIDEST],
                slope: [0.0; WIDEST],
            },
            z: Axis {
                value: [0.0; WIDEST + 2 * PADDING],
                slope: [0.0; WIDEST + 2 * PADDING],
            },
        }
    }

    /// The stencil of a point, with slopes if `SLOPES`.
    #[inline(always)]
    fn place<S: Isa, const SLOPES: bool>(
        &mut self,
        simd: S,
        placing: &Placing<'_>,
        point: [f64; 3],
    ) {
        let (x, sx) = placing.start(0, point[0]);
        let (y, sy) = placing.start(1, point[1]);
        let (z, sz) = placing.start(2, point[2]);
        let s = [sx, sy, sz].map(|s| Lanes::splat(simd, s));
        let mut along_z = Axis {
            value: [0.0; WIDEST],
            slope: [0.0; WIDEST],
        };
        let slope_scale = Lanes::splat(simd, -2.0 * placing.scale);
        for register in 0..placing.stride / Lanes::<S>::COUNT {
            let mut value = [Lanes::splat(simd, 0.0); 3];
            let mut slope = value;
            for power in placing.coefficients.chunks_exact(placing.stride) {
                let coefficient = Lanes::load(simd, power, register);
                for axis in 0..3 {
                    if SLOPES {
                        slope[axis] = slope[axis].mul_add(s[axis], value[axis]);
                    }
                    value[axis] = value[axis].mul_add(s[axis], coefficient);
                }
            }
            value[0].store(&mut self.x.value, register);
            value[1].store(&mut self.y.value, register);
            value[2].store(&mut along_z.value, register);
            if SLOPES {
                (slope[0] * slope_scale).store(&mut self.x.slope, register);
                (slope[1] * slope_scale).store(&mut self.y.slope, register);
                (slope[2] * slope_scale).store(&mut along_z.slope, register);
            }
        }
        let shift = z % PADDING;
        self.start = [x, y, z - shift];
        self.registers = (shift + placing.width).div_ceil(PADDING);
        self.z.value = shifted(&along_z.value, shift);
        if SLOPES {
            self.z.slope = shifted(&along_z.slope, shift);
        }
    }
}

/// `values` from number `shift` on, zeros elsewhere.
#[inline(always)]
fn shifted(values: &[f64; WIDEST], shift: usize) -> [f64; WIDEST + 2 * PADDING] {
    let mut shifted = [0.0; WIDEST + 2 * PADDING];
    shifted[shift % PADDING..][..WIDEST].copy_from_slice(values);
    shifted
}

/// `N` times the padding's worth of registers.
#[derive(Clone, Copy)]
struct Row<S: Isa, const N: usize>([[Lanes<S>; PADDING]; N]);

impl<S: Isa, const N: usize> Row<S, N> {
    /// Registers to the padding: only so many of each array are used.
    const PARTS: usize = PADDING / Lanes::<S>::COUNT;

    #[inline(always)]
    fn zero(simd: S) -> Self {
        Self([[Lanes::splat(simd, 0.0); PADDING]; N])
    }

    #[inline(always)]
    fn load(simd: S, buffer: &[f64]) -> Self {
        let buffer = &buffer[..N * PADDING];
        let mut row = Self::zero(simd);
        for n in 0..N {
            for part in 0..Self::PARTS {
                row.0[n][part] = Lanes::load(simd, buffer, n * Self::PARTS + part);
            }
        }
        row
    }

    #[inline(always)]
    fn store(self, buffer: &mut [f64]) {
        let buffer = &mut buffer[..N * PADDING];
        for n in 0..N {
            for part in 0..Self::PARTS {
                self.0[n][part].store(buffer, n * Self::PARTS + part);
            }
        }
    }

    /// `self += factor * other`.
    #[inline(always)]
    fn add(&mut self, factor: Lanes<S>, other: &Self) {
        for n in 0..N {
            for part in 0..Self::PARTS {
                self.0[n][part] = factor.mul_add(other.0[n][part], self.0[n][part]);
            }
        }
    }

    /// The scalar product.
    #[inline(always)]
    fn dot(&self, other: &Self) -> f64 {
        let mut sum = self.0[0][0] * other.0[0][0];
        for n in 0..N {
            for part in 0..Self::PARTS {
                if n + part > 0 {
                    sum = self.0[n][part].mul_add(other.0[n][part], sum);
                }
            }
        }
        sum.sum()
    }
}

/// Number of points whose stencils are made before they are used. The densities then follow one
/// after the other, so that the part of a grid that one density uses stays in the cache.
const BLOCK: usize = 8;

struct Spread<'a, const D: usize, const DIPOLES: bool> {
    placing: Placing<'a>,
    points: [&'a [f64]; 3],
    charges: [&'a [f64]; D],
    dipoles: [[&'a [f64]; 3]; D],
    grid: &'a mut [f64],
}

impl<const D: usize, const DIPOLES: bool> WithIsa for Spread<'_, D, DIPOLES> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        let mut stencils = [const { Stencil::new() }; BLOCK];
        let count = self.points[0].len();
        for first in (0..count).step_by(BLOCK) {
            let block = first..count.min(first + BLOCK);
            self.placing
                .place::<S, DIPOLES>(simd, &mut stencils, self.points, block.clone());
            let grids = self.grid.chunks_exact_mut(self.placing.density_len());
            for (d, grid) in (0..D).zip(grids) {
                for (stencil, i) in stencils.iter().zip(block.clone()) {
                    let charge = self.charges[d][i];
                    // The window's derivative with respect to the grid point is minus that with
                    // respect to the point.
                    let dipole = if DIPOLES {
                        self.dipoles[d].map(|axis| -axis[i])
                    } else {
                        [0.0; 3]
                    };
                    let placing = &self.placing;
                    match stencil.registers {
                        1 => spread_point::<S, DIPOLES, 1>(
                            simd, placing, stencil, charge, dipole, grid,
                        ),
                        2 => spread_point::<S, DIPOLES, 2>(
                            simd, placing, stencil, charge, dipole, grid,
                        ),
                        _ => spread_point::<S, DIPOLES, 3>(
                            simd, placing, stencil, charge, dipole, grid,
                        ),
                    }
                }
            }
        }
    }
}

/// Adds one point to the grid of one density.
#[inline(always)]
fn spread_point<S: Isa, const DIPOLES: bool, const N: usize>(
    simd: S,
    placing: &Placing<'_>,
    stencil: &Stencil,
    charge: f64,
    dipole: [f64; 3],
    grid: &mut [f64],
) {
    let z = stencil.start[2];
    let value = Row::<S, N>::load(simd, &stencil.z.value);
    let slope = Row::<S, N>::load(simd, &stencil.z.slope);
    for x in 0..placing.width {
        let (wx, dx) = (stencil.x.value[x], stencil.x.slope[x]);
        // What the window along y multiplies, and what its slope does.
        let mut by_value = Row::<S, N>::zero(simd);
        let mut by_slope = Row::<S, N>::zero(simd);
        if DIPOLES {
            by_value.add(Lanes::splat(simd, charge * wx + dipole[0] * dx), &value);
            by_value.add(Lanes::splat(simd, dipole[2] * wx), &slope);
            by_slope.add(Lanes::splat(simd, dipole[1] * wx), &value);
        } else {
            by_value.add(Lanes::splat(simd, charge * wx), &value);
        }
        let rows = grid[placing.rows(stencil, x)].chunks_exact_mut(placing.row_len);
        for ((row, wy), dy) in rows.zip(&stencil.y.value).zip(&stencil.y.slope) {
            let row = &mut row[z..z + N * PADDING];
            let mut sum = Row::<S, N>::load(simd, row);
            sum.add(Lanes::splat(simd, *wy), &by_value);
            if DIPOLES {
                sum.add(Lanes::splat(simd, *dy), &by_slope);
            }
            sum.store(row);
        }
    }
}

struct Interpolate<'a, const D: usize, const GRADIENTS: bool> {
    placing: Placing<'a>,
    points: [&'a [f64]; 3],
    grid: &'a [f64],
    values: &'a mut [f64],
}

impl<const D: usize, const GRADIENTS: bool> WithIsa for Interpolate<'_, D, GRADIENTS> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        let numbers = if GRADIENTS { 4 * D } else { D };
        let mut stencils = [const { Stencil::new() }; BLOCK];
        let count = self.points[0].len();
        for (first, values) in (0..count)
            .step_by(BLOCK)
            .zip(self.values.chunks_mut(BLOCK * numbers))
        {
            let block = first..count.min(first + BLOCK);
            self.placing
                .place::<S, GRADIENTS>(simd, &mut stencils, self.points, block);
            let grids = self.grid.chunks_exact(self.placing.density_len());
            for (d, grid) in (0..D).zip(grids) {
                for (stencil, values) in stencils.iter().zip(values.chunks_exact_mut(numbers)) {
                    let placing = &self.placing;
                    let found = match stencil.registers {
                        1 => interpolate_point::<S, GRADIENTS, 1>(simd, placing, stencil, grid),
                        2 => interpolate_point::<S, GRADIENTS, 2>(simd, placing, stencil, grid),
                        _ => interpolate_point::<S, GRADIENTS, 3>(simd, placing, stencil, grid),
                    };
                    values[d] = found[0];
                    if GRADIENTS {
                        values[D + 3 * d..][..3].copy_from_slice(&found[1..]);
                    }
                }
            }
        }
    }
}

/// The grid of one density at one point, and its derivatives.
#[inline(always)]
fn interpolate_point<S: Isa, const GRADIENTS: bool, const N: usize>(
    simd: S,
    placing: &Placing<'_>,
    stencil: &Stencil,
    grid: &[f64],
) -> [f64; 4] {
    let z = stencil.start[2];
    let mut sum = Row::<S, N>::zero(simd);
    let (mut slope_x, mut slope_y) = (sum, sum);
    for x in 0..placing.width {
        let mut by_value = Row::<S, N>::zero(simd);
        let mut by_slope = Row::<S, N>::zero(simd);
        let rows = grid[placing.rows(stencil, x)].chunks_exact(placing.row_len);
        for ((row, wy), dy) in rows.zip(&stencil.y.value).zip(&stencil.y.slope) {
            let row = Row::<S, N>::load(simd, &row[z..z + N * PADDING]);
            by_value.add(Lanes::splat(simd, *wy), &row);
            if GRADIENTS {
                by_slope.add(Lanes::splat(simd, *dy), &row);
            }
        }
        let wx = Lanes::splat(simd, stencil.x.value[x]);
        sum.add(wx, &by_value);
        if GRADIENTS {
            slope_x.add(Lanes::splat(simd, stencil.x.slope[x]), &by_value);
            slope_y.add(wx, &by_slope);
        }
    }
    let value = Row::<S, N>::load(simd, &stencil.z.value);
    if GRADIENTS {
        let slope = Row::<S, N>::load(simd, &stencil.z.slope);
        let gradient = [slope_x.dot(&value), slope_y.dot(&value), sum.dot(&slope)];
        [sum.dot(&value), gradient[0], gradient[1], gradient[2]]
    } else {
        [sum.dot(&value), 0.0, 0.0, 0.0]
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use fastrand::Rng;

    use super::*;

    /// Numbers in the buffer of a grid of `densities` densities, `points` $= g$ per axis.
    fn grid_len(points: usize, densities: usize) -> usize {
        densities * points * points * padded(points)
    }

    const CUBE: Cube = Cube {
        center: [0.3, -1.1, 2.0],
        side: 0.6,
    };

    fn random(rng: &mut Rng, count: usize) -> Vec<f64> {
        (0..count).map(|_| 2.0 * rng.f64() - 1.0).collect()
    }

    /// Points in the cube, the first two at opposite corners.
    fn points(rng: &mut Rng, count: usize) -> [Vec<f64>; 3] {
        std::array::from_fn(|axis| {
            let mut unit = random(rng, count);
            (unit[0], unit[1]) = (-1.0, 1.0);
            unit.iter()
                .map(|x| CUBE.center[axis] + 0.5 * CUBE.side * x)
                .collect()
        })
    }

    fn slices<const N: usize>(vectors: &[Vec<f64>; N]) -> [&[f64]; N] {
        std::array::from_fn(|i| vectors[i].as_slice())
    }

    /// `D` charges and dipoles for each point, at random.
    struct Densities<const D: usize> {
        charges: [Vec<f64>; D],
        dipoles: [[Vec<f64>; 3]; D],
    }

    impl<const D: usize> Densities<D> {
        fn new(rng: &mut Rng, count: usize) -> Self {
            Self {
                charges: std::array::from_fn(|_| random(rng, count)),
                dipoles: std::array::from_fn(|_| std::array::from_fn(|_| random(rng, count))),
            }
        }

        fn spread<const DIPOLES: bool>(&self, window: &Window, points: &[Vec<f64>; 3]) -> Vec<f64> {
            let mut grid = vec![0.0; grid_len(window.points(), D)];
            let dipoles = std::array::from_fn(|d| slices(&self.dipoles[d]));
            spread::<D, DIPOLES>(
                window,
                CUBE,
                slices(points),
                slices(&self.charges),
                dipoles,
                &mut grid,
            );
            grid
        }
    }

    /// $\frac1{\hat\varphi}\sum_x G_d(x)\,e^{-ik\cdot x}$, real and imaginary, with $k$ and $x$ in
    /// box units.
    fn wave(window: &Window, grid: &[f64], d: usize, k: [f64; 3]) -> [f64; 2] {
        let g = window.points();
        let at = |i: usize| (i as f64 - 0.5 * (g - 1) as f64) * window.spacing();
        let norm: f64 = k.map(|k| window.fourier(k)).iter().product();
        let mut sum = [0.0; 2];
        for x in 0..g {
            for y in 0..g {
                for z in 0..g {
                    let value = grid[((d * g + x) * g + y) * padded(g) + z] / norm;
                    let phase = k[0] * at(x) + k[1] * at(y) + k[2] * at(z);
                    sum[0] += value * phase.cos();
                    sum[1] -= value * phase.sin();
                }
            }
        }
        sum
    }

    #[test]
    fn waves_are_those_of_the_points() {
        let mut rng = Rng::with_seed(1);
        for (width, grid_points, waves, bound) in
            [(6, 16, 10, 3e-4), (8, 24, 17, 1e-5), (12, 36, 24, 4e-9)]
        {
            let window = Window::new(width, grid_points, waves);
            let points = points(&mut rng, 5);
            let densities = Densities::<3>::new(&mut rng, 5);
            let grids = [
                densities.spread::<false>(&window, &points),
                densities.spread::<true>(&window, &points),
            ];
            let unit = 2.0 * PI / 3.0;
            for index in [[0, 0, 0], [1, 2, -3], [-4, 5, 1], [waves as i32 - 1, 0, -2]] {
                let k = index.map(|j| unit * j as f64);
                for d in 0..3 {
                    for (dipoles, grid) in grids.iter().enumerate() {
                        let mut expected = [0.0; 2];
                        let mut size = 0.0;
                        for i in 0..5 {
                            let phase: f64 = (0..3)
                                .map(|a| k[a] * (points[a][i] - CUBE.center[a]) / CUBE.side)
                                .sum();
                            let charge = densities.charges[d][i];
                            // (c + i k.d) e^{-i phase}
                            let slope: f64 = (0..3)
                                .map(|a| {
                                    dipoles as f64 * k[a] / CUBE.side * densities.dipoles[d][a][i]
                                })
                                .sum();
                            expected[0] += charge * phase.cos() + slope * phase.sin();
                            expected[1] += slope * phase.cos() - charge * phase.sin();
                            size += charge.abs();
                            for dipole in &densities.dipoles[d] {
                                size += unit * waves as f64 / CUBE.side * dipole[i].abs();
                            }
                        }
                        let found = wave(&window, grid, d, k);
                        let error = (found[0] - expected[0]).hypot(found[1] - expected[1]);
                        assert!(
                            error < bound * size,
                            "{width} {index:?} {d} {dipoles}: {error:e} {size}"
                        );
                    }
                }
            }
        }
    }

    fn transposed<const D: usize>(width: usize, grid_points: usize) {
        const COUNT: usize = 37;
        let mut rng = Rng::with_seed(2);
        let window = Window::new(width, grid_points, 10);
        let points = points(&mut rng, COUNT);
        let mut densities = Densities::<D>::new(&mut rng, COUNT);
        let potential = random(&mut rng, grid_len(grid_points, D));
        let mut values = vec![0.0; COUNT * D];
        let mut gradients = vec![0.0; COUNT * 4 * D];
        interpolate::<D, false>(&window, CUBE, slices(&points), &potential, &mut values);
        interpolate::<D, true>(&window, CUBE, slices(&points), &potential, &mut gradients);

        let product = |grid: &[f64]| grid.iter().zip(&potential).map(|(a, b)| a * b).sum::<f64>();
        let (mut charge_product, mut dipole_product) = (0.0, 0.0);
        for i in 0..COUNT {
            for d in 0..D {
                let (value, same) = (values[i * D + d], gradients[i * 4 * D + d]);
                assert!((value - same).abs() < 1e-12);
                charge_product += densities.charges[d][i] * value;
                for a in 0..3 {
                    dipole_product -=
                        densities.dipoles[d][a][i] * gradients[i * 4 * D + D + 3 * d + a];
                }
            }
        }
        let size = (COUNT * D) as f64;
        let error = product(&densities.spread::<false>(&window, &points)) - charge_product;
        assert!(error.abs() < 1e-13 * size, "{error:e}");
        densities
            .charges
            .iter_mut()
            .for_each(|charge| charge.fill(0.0));
        let error = product(&densities.spread::<true>(&window, &points)) - dipole_product;
        assert!(error.abs() < 1e-12 * size, "{error:e}");
    }

    #[test]
    fn interpolation_is_the_transpose_of_spreading() {
        for (width, points) in [(5, 14), (6, 16), (8, 24), (11, 32), (16, 48)] {
            transposed::<1>(width, points);
            transposed::<3>(width, points);
            transposed::<4>(width, points);
        }
    }

    #[test]
    fn gradients_are_those_of_the_values() {
        let mut rng = Rng::with_seed(3);
        let window = Window::new(8, 24, 17);
        let potential = random(&mut rng, grid_len(24, 1));
        let step = 1e-6;
        for _ in 0..20 {
            let point: [f64; 3] = std::array::from_fn(|axis| {
                CUBE.center[axis] + 0.49 * CUBE.side * (2.0 * rng.f64() - 1.0)
            });
            let value = |point: [f64; 3]| {
                let mut value = [0.0];
                let points = [&point[..1], &point[1..2], &point[2..]];
                interpolate::<1, false>(&window, CUBE, points, &potential, &mut value);
                value[0]
            };
            let mut found = [0.0; 4];
            let points = [&point[..1], &point[1..2], &point[2..]];
            interpolate::<1, true>(&window, CUBE, points, &potential, &mut found);
            for axis in 0..3 {
                let (mut above, mut below) = (point, point);
                above[axis] += step;
                below[axis] -= step;
                let difference = (value(above) - value(below)) / (2.0 * step);
                assert!(
                    (found[axis + 1] - difference).abs() < 1e-5 * found[axis + 1].abs().max(1.0)
                );
            }
        }
    }

    #[test]
    fn no_points() {
        let window = Window::new(6, 16, 10);
        let mut grid = vec![0.0; grid_len(16, 1)];
        spread::<1, false>(&window, CUBE, [&[]; 3], [&[]], [[&[]; 3]], &mut grid);
        interpolate::<1, false>(&window, CUBE, [&[]; 3], &grid, &mut []);
        assert!(grid.iter().all(|x| *x == 0.0));
    }
}
