//! All that depends on the kernel and the tolerance alone, shared by every level of every tree.

use std::f64::consts::PI;
use std::ops::Range;

use crate::far::Far;
use crate::parameters::Parameters;
use crate::splitting::{ROOT_PERIOD, ROOT_RADIUS, Splitting};
use crate::symbol::Symbol;
use crate::transfer::{GridShape, Transfer};
use crate::transform::{AxisWaves, Ball, Transform};
use crate::translate::Turns;
use crate::tree::{GriddedBox, SortedPoints};
use crate::window::Window;

/// Operators of the far field, and the residual's polynomials.
#[derive(Clone, Debug)]
pub(crate) struct Operators {
    pub parameters: Parameters,
    pub window: Window,
    pub shape: GridShape,
    /// The whole of the free-space kernel, mollified at half the root's side.
    pub root: Across,
    /// The difference of two mollified kernels, in a box of side 1 and its colleagues.
    pub level: Across,
    pub turns: Turns,
    pub transfer: Transfer,
    /// Mollified chain, order by order from 1, as polynomials in $s = 2(r/L)^2 - 1$, highest power first.
    pub mollified: Vec<Vec<f64>>,
}

/// From charges on a grid to potentials on a grid.
#[derive(Clone, Debug)]
pub(crate) struct Across {
    pub transform: Transform,
    pub symbol: Symbol,
}

impl Operators {
    pub fn new<K: Far>(parameters: Parameters) -> Self {
        let splitting = Splitting::new(parameters.waves);
        let window = Window::new(parameters.width, parameters.points, parameters.waves);
        let terms = K::symbol();
        let cutoff = 2.0 * splitting.bandwidth();
        let across = |spacing: f64, radius: Option<f64>, biharmonic: &dyn Fn(f64) -> f64| {
            let ball = Ball::new(cutoff / spacing);
            let waves: Vec<f64> = (0..ball.waves).map(|j| spacing * j as f64).collect();
            let matrix = window.waves_matrix(&waves);
            let axis = AxisWaves::new(parameters.points, ball.waves, [matrix.even, matrix.odd]);
            let symbol = Symbol::new(&terms, &ball, spacing, radius, biharmonic);
            Across { transform: Transform { ball, axis }, symbol }
        };
        let level = across(2.0 * PI / 3.0, None, &|k| splitting.difference(k));
        let root = across(2.0 * PI / ROOT_PERIOD, Some(ROOT_RADIUS), &|k| splitting.free_space(k));
        let transfer = Transfer::new(parameters.points, window.reach(), &window.transfer());
        let mollified =
            (1..=K::ORDERS[1]).map(|order| splitting.polynomial(order, parameters.accuracy)).collect();
        Self {
            shape: GridShape { points: parameters.points },
            turns: Turns::new(&level.transform.ball),
            root,
            level,
            transfer,
            mollified,
            window,
            parameters,
        }
    }

    /// Lays the charges of some points of a box on its grid.
    pub fn spread<K: Far>(
        &self,
        gridded: &GriddedBox,
        side: f64,
        points: &SortedPoints,
        charges: &[Vec<f64>],
        range: Range<usize>,
        grid: &mut [f64],
    ) {
        let (n, stride, field) = (self.shape.points, self.shape.stride(), self.shape.field());
        for i in range {
            let (start, w, d) = self.weights(gridded, side, points, i);
            for a in 0..self.window.width() {
                for b in 0..self.window.width() {
                    for c in 0..self.window.width() {
                        let at = ((start[0] + a) * n + start[1] + b) * stride + start[2] + c;
                        for f in 0..K::DENSITIES {
                            let mut q = charges[f][i] * w[0][a] * w[1][b] * w[2][c];
                            if K::DIPOLES {
                                let dip = |axis: usize| charges[K::DENSITIES + 3 * f + axis][i] / side;
                                q -= dip(0) * d[0][a] * w[1][b] * w[2][c]
                                    + dip(1) * w[0][a] * d[1][b] * w[2][c]
                                    + dip(2) * w[0][a] * w[1][b] * d[2][c];
                            }
                            grid[f * field + at] += q;
                        }
                    }
                }
            }
        }
    }

    fn weights(&self, gridded: &GriddedBox, side: f64, points: &SortedPoints, i: usize) -> ([usize; 3], [Vec<f64>; 3], [Vec<f64>; 3]) {
        let mut start = [0; 3];
        let mut weights = [0; 3].map(|_| Vec::new());
        let mut slopes = [0; 3].map(|_| Vec::new());
        for axis in 0..3 {
            let window = &self.window;
            let x = (points.positions[axis][i] - gridded.center[axis]) / side;
            let z = x / window.spacing() + 0.5 * (window.points() - 1) as f64;
            let from = z - 0.5 * window.width() as f64;
            let first = from.ceil().clamp(0.0, (window.points() - window.width()) as f64);
            let s = 2.0 * (first - from) - 1.0;
            start[axis] = first as usize;
            let values = window.values();
            let at = |coefficients: &[f64]| (0..window.width()).map(|m| coefficients.chunks(values.stride).fold(0.0, |sum, power| sum * s + power[m])).collect();
            weights[axis] = at(&values.value);
            slopes[axis] = at(&values.derivative);
        }
        (start, weights, slopes)
    }

    /// Potentials and their derivatives at some points of a box.
    pub fn interpolate<K: Far>(
        &self,
        gridded: &GriddedBox,
        side: f64,
        points: &SortedPoints,
        range: Range<usize>,
        grid: &[f64],
        out: &mut [f64],
    ) {
        let (n, stride, field) = (self.shape.points, self.shape.stride(), self.shape.field());
        let count = range.len();
        for (place, i) in range.enumerate() {
            let (start, w, d) = self.weights(gridded, side, points, i);
            for a in 0..self.window.width() {
                for b in 0..self.window.width() {
                    for c in 0..self.window.width() {
                        let at = ((start[0] + a) * n + start[1] + b) * stride + start[2] + c;
                        for f in 0..K::POTENTIALS {
                            let v = grid[f * field + at];
                            out[f * count + place] += v * w[0][a] * w[1][b] * w[2][c];
                            if K::GRADIENTS {
                                let to = |axis: usize| (K::POTENTIALS + 3 * f + axis) * count + place;
                                out[to(0)] += v * d[0][a] * w[1][b] * w[2][c] / side;
                                out[to(1)] += v * w[0][a] * d[1][b] * w[2][c] / side;
                                out[to(2)] += v * w[0][a] * w[1][b] * d[2][c] / side;
                            }
                        }
                    }
                }
            }
        }
    }
}
