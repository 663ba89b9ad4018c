//! All that depends on the kernel and the tolerance alone, shared by every level of every tree.

use std::f64::consts::PI;

use crate::across::Across;
use rayon::ThreadPoolBuilder;

use crate::dispatch::Kernel;
use crate::error::FmmError;
use crate::parameters::Parameters;
use crate::splitting::{ROOT_PERIOD, Splitting};
use crate::symbol::Symbol;
use crate::transfer::{GridShape, Transfer};
use crate::transform::{AxisWaves, Ball, Transform};
use crate::translate::Turns;
use crate::tree;
use crate::window::Window;

/// Operators of the far field, and the residual's polynomials.
#[derive(Clone, Debug)]
pub(crate) struct Operators {
    pub parameters: Parameters,
    pub costs: Costs,
    pub window: Window,
    pub shape: GridShape,
    /// The whole of the free-space kernel, mollified at half the root's side.
    pub root: Across,
    /// The difference of two mollified kernels, in a box of side 1 and its colleagues.
    pub level: Across,
    pub turns: Turns,
    pub transfer: Transfer,
    /// Mollified chain, order by order from 1, as polynomials in $s = 2(r/L)^2 - 1$, highest power
    /// first.
    pub mollified: [Vec<f64>; 4],
}

impl Operators {
    /// # Errors
    ///
    /// Tolerances outside of 1e-12 to 1e-1.
    pub fn new(kernel: &Kernel, tolerance: f64) -> Result<Self, FmmError> {
        if !(1e-12..=1e-1).contains(&tolerance) {
            return Err(FmmError::Tolerance(tolerance));
        }
        Ok(alone(|| {
            let parameters = Parameters::for_tolerance(tolerance, kernel.derivatives);
            Self::with_parameters(kernel, parameters)
        }))
    }

    pub fn with_parameters(kernel: &Kernel, parameters: Parameters) -> Self {
        let splitting = Splitting::new(parameters.waves);
        let window = Window::new(parameters.width, parameters.points, parameters.waves);
        let terms = (kernel.symbol)();
        let cutoff = 2.0 * splitting.bandwidth();
        let across = |spacing: f64, free_space: bool, biharmonic: &dyn Fn(f64) -> f64| {
            let ball = Ball::new(cutoff / spacing);
            let waves: Vec<f64> = (0..ball.waves).map(|j| spacing * j as f64).collect();
            let matrix = window.waves_matrix(&waves);
            let axis = AxisWaves::new(parameters.points, ball.waves, [matrix.even, matrix.odd]);
            let symbol = Symbol::new(&terms, &ball, spacing, free_space, biharmonic);
            Across {
                transform: Transform { ball, axis },
                symbol,
            }
        };
        let level = across(2.0 * PI / 3.0, false, &|k| splitting.difference(k));
        let root = across(2.0 * PI / ROOT_PERIOD, true, &|k| splitting.free_space(k));
        let transfer = Transfer::new(parameters.points, window.reach(), &window.transfer());
        let needed = kernel.numbers.orders[0]..=kernel.numbers.orders[1];
        let mollified = [1, 2, 3, 4].map(|order| {
            if needed.contains(&order) {
                splitting.polynomial(order, parameters.accuracy)
            } else {
                Vec::new()
            }
        });
        let terms = mollified.iter().map(Vec::len).max().unwrap_or(0);
        let costs = Costs::new(
            kernel,
            &parameters,
            &level.transform.ball,
            window.reach(),
            terms,
        );
        Self {
            shape: GridShape {
                points: parameters.points,
            },
            turns: Turns::new(&level.transform.ball),
            root,
            level,
            transfer,
            mollified,
            window,
            costs,
            parameters,
        }
    }
}

/// Does `work` on one thread: the last digits of factorisations that are shared between threads
/// depend on the number of threads.
fn alone<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match ThreadPoolBuilder::new().num_threads(1).build() {
        Ok(pool) => pool.install(work),
        Err(_) => work(),
    }
}

/// What the pieces of a sum take, in nanoseconds on one thread.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Costs {
    /// A pair of the direct sum.
    pub direct: f64,
    pub tree: tree::Costs,
}

impl Costs {
    /// Counted operations times their cost, measured on one core with AVX-512. Only ratios matter.
    fn new(
        kernel: &Kernel,
        parameters: &Parameters,
        ball: &Ball,
        reach: usize,
        terms: usize,
    ) -> Self {
        let numbers = (kernel.numbers.strengths + kernel.numbers.outputs) as f64;
        let orders = (kernel.numbers.orders[1] + 1 - kernel.numbers.orders[0]) as f64;
        // About every other pair that is evaluated is within reach.
        let pair = 1.9 * (0.3 + 0.08 * numbers + 0.021 * orders * terms as f64);
        let [g, r, j] = [parameters.points, reach, ball.waves].map(|n| n as f64);
        let rows = ball.planes.iter().map(Vec::len).sum::<usize>() as f64;
        let transform = g * g * g * j + 2.0 * g * g * rows + 4.0 * g * ball.len as f64;
        let transfer = r * g * g * g + r * r * g * g + r * r * r * g;
        let fields = (kernel.fields.densities + kernel.fields.potentials) as f64;
        let translation = 13.0 * (ball.len * kernel.fields.potentials) as f64;
        let grid = 1e5 + fields * (transform + transfer) / 15.0 + translation;
        let direct = 0.03 + 0.07 * numbers;
        let point = 40.0 * (parameters.width as f64 / 4.0).powi(3).max(2.0);
        Self {
            direct,
            tree: tree::Costs { pair, grid, point },
        }
    }
}
