//! Time of each stage against unknowns, with panels and modes in proportion.

use std::time::Instant;

use nalgebra::Point3;

use super::error::StudyError;
use super::plan::{MEMORY, MODES_PER_PANEL};
use super::power_law::PowerLaw;
use super::setup::Setup;
use super::size::{bytes, points};
use super::spheroid::spheroid;
use stokes_body::dirichlet::{DirichletSolver, Formulation};
use stokes_body::progress::{Progress, Silent};
use stokes_body::surface::SurfaceModes;

/// The stages: names in the order of [`Timing::seconds`].
pub const STAGES: [&str; 4] = ["assemble", "factor", "solve", "evaluate"];

/// The targets' spheroid is this much larger than in the error study, so that no resolution refines
/// its density for the evaluation: the time is then that of the sum alone.
const TARGETS_SCALED: f64 = 4.0;

/// Short stages are repeated so long, in seconds, at most [`RUNS`] times.
const LONG: f64 = 1.0;
const RUNS: usize = 7;

/// The stages' times at one resolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Panels.
    pub panels: usize,
    /// Highest mode.
    pub modes: usize,
    /// $N$.
    pub points: usize,
    /// How often it was assembled and factored.
    pub runs: usize,
    /// Median seconds of each of [`STAGES`].
    pub seconds: [f64; 4],
}

/// The stages' times at increasing resolutions.
#[derive(Clone, Debug, PartialEq)]
pub struct TimingTable {
    /// Nodes per panel.
    pub order: usize,
    /// One for each resolution.
    pub rows: Vec<Timing>,
    /// Panels left out for want of memory.
    pub left_out: Vec<usize>,
}

impl TimingTable {
    /// Measures all times of one order.
    ///
    /// # Errors
    /// If the order has no quadrature.
    pub fn measure(
        setup: &Setup,
        order: usize,
        panels: &[usize],
        progress: &dyn Progress,
    ) -> Result<Self, StudyError> {
        let fits = |&&p: &&usize| bytes(order, p, MODES_PER_PANEL * p) <= MEMORY;
        let (kept, left_out): (Vec<&usize>, Vec<&usize>) = panels.iter().partition(fits);
        progress.begin("timing", kept.iter().map(|&p| p * p * p).sum());
        if let Some(&&first) = kept.first() {
            // The first run of all also starts the threads.
            Timing::measure(setup, order, first)?;
        }
        let mut rows = Vec::with_capacity(kept.len());
        for &panels in kept {
            rows.push(Timing::measure(setup, order, panels)?);
            progress.advance(panels * panels * panels);
        }
        Ok(Self {
            order,
            rows,
            left_out: left_out.into_iter().copied().collect(),
        })
    }

    /// The rows that exponents are fitted to: the larger half, where overheads count least, and at
    /// least four.
    pub fn fitted(&self) -> &[Timing] {
        let from = self
            .rows
            .len()
            .saturating_sub(self.rows.len().div_ceil(2).max(4));
        &self.rows[from..]
    }

    /// $T \propto N^\alpha$ for each stage.
    pub fn laws(&self) -> [Option<PowerLaw>; 4] {
        std::array::from_fn(|stage| {
            let rows = self.fitted().iter();
            let points: Vec<_> = rows.map(|t| (t.points as f64, t.seconds[stage])).collect();
            PowerLaw::fit(&points)
        })
    }
}

impl Timing {
    fn measure(setup: &Setup, order: usize, panels: usize) -> Result<Self, StudyError> {
        let modes = MODES_PER_PANEL * panels;
        let build = || -> Result<DirichletSolver, StudyError> {
            let nodes = spheroid(panels, order)?;
            let formulation = Formulation::CombinedField;
            Ok(DirichletSolver::new(nodes, formulation, modes, &Silent)?)
        };
        let start = Instant::now();
        let mut solver = build()?;
        let mut stages = vec![solver.seconds()];
        while stages.len() < RUNS && start.elapsed().as_secs_f64() < LONG {
            // One at a time, for the sake of memory.
            drop(solver);
            solver = build()?;
            stages.push(solver.seconds());
        }
        let flow = |x| setup.velocity_on_body(x);
        let data = SurfaceModes::sample(solver.discretization(), modes, flow).modes;
        let (density, solve) = repeated(|| solver.solve(&data));
        let targets = setup.targets_of_body();
        let targets: Vec<Point3<f64>> = targets.iter().map(|x| x * TARGETS_SCALED).collect();
        let (values, evaluate) = repeated(|| solver.flow(&density).at(&targets, 1e-14));
        values?;
        Ok(Self {
            panels,
            modes,
            points: points(order, panels, modes),
            runs: stages.len(),
            seconds: [
                median(stages.iter().map(|s| s.assemble).collect()),
                median(stages.iter().map(|s| s.factor).collect()),
                solve,
                evaluate,
            ],
        })
    }
}

/// The result of `f` and the median of the seconds it takes.
fn repeated<T>(f: impl Fn() -> T) -> (T, f64) {
    let start = Instant::now();
    let mut result = f();
    let mut seconds = vec![start.elapsed().as_secs_f64()];
    while seconds.len() < RUNS && start.elapsed().as_secs_f64() < LONG {
        let start = Instant::now();
        result = f();
        seconds.push(start.elapsed().as_secs_f64());
    }
    (result, median(seconds))
}

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    let count = seconds.len();
    0.5 * (seconds[(count - 1) / 2] + seconds[count / 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
    }

    #[test]
    fn exponents_are_those_of_the_larger_half() {
        let row = |points: usize| Timing {
            panels: 0,
            modes: 0,
            points,
            runs: 1,
            seconds: [1.0, 1.5, 2.0, 1.0].map(|a| (points as f64).powf(a)),
        };
        let mut table = TimingTable {
            order: 16,
            rows: [1, 2, 10, 100, 1000, 10000, 20000].map(row).to_vec(),
            left_out: Vec::new(),
        };
        table.rows[0].seconds = [1e9; 4];
        assert_eq!(table.fitted().len(), 4);
        let exponents = table.laws().map(|law| law.unwrap().exponent);
        for (found, exact) in exponents.into_iter().zip([1.0, 1.5, 2.0, 1.0]) {
            assert!((found - exact).abs() < 1e-12);
        }
    }
}
