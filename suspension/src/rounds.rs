//! Solutions, each finer than the one before, until the estimated error is small enough.

use std::f64::consts::PI;
use std::time::Instant;

use super::SuspensionError;
use super::assembly::{Assembly, Questions};
use super::check::Miss;
use super::class::{Classes, Kind};
use super::memory::{gibibytes, needed_memory};
use super::resolution::{first, refined};
use super::solution::{Care, Iteration, Solution};
use super::spheres::facing_neighbours;
use super::sums::Operators;
use super::suspension::{Motion, Suspension};
use bodies_of_revolution::Gap;
use inexact_krylov::Stop;
use stokes_body::progress::Progress;

/// Residuals and products are better than the tolerance by these factors.
const RESIDUAL: f64 = 0.1;
const PRODUCT: f64 = 0.04;
/// How far the estimate stays above what the boundary velocity is off by.
const SAFETY: f64 = 2.0;
/// What is left to rounding.
const ROUNDING: f64 = 1e-14;
/// Forces below this part of what the largest speed would make them count as if they were that large.
const SMALL: f64 = 1e-2;
/// Solutions, each finer than the one before, and how many in a row may gain less than a factor of two.
const ROUNDS: usize = 10;
const PATIENCE: usize = 2;
/// What finer resolutions aim at, in tolerances: next time the estimate is to be below it, and not about it.
const AIM: f64 = 0.4;
/// Estimates that miss the tolerance by less may do so for other reasons than the resolution.
const NEARLY: f64 = 10.0;
/// Misses up to so many times what the iteration left may be its.
const BLAMED: f64 = 2.0;
/// Gaps below so many sizes of the smaller body are narrow.
const NARROW: f64 = 0.2;
/// How much better the equations on finer surfaces are solved than those whose error they tell.
const FINER: f64 = 0.1;
/// How often more may be asked of them.
const TIGHTENED: usize = 3;
/// How far the estimate stays above the difference of two solutions: the finer one has an error too.
pub(crate) const COMPARED: f64 = 3.0;
/// Gaps of so many sizes of a body matter to its resolution.
pub(crate) const REACH: f64 = 1.0;
/// The largest tolerance to choose resolutions for.
const COARSEST: f64 = 1e-2;
/// An iteration that stagnates or is cut short at so many times its residual is still worth an answer: the estimate tells how much.
const STALLED: f64 = 100.0;
/// Least relative residual and product.
pub(crate) const LEAST: f64 = 1e-13;

/// Where to begin.
pub(crate) struct Start {
    kinds: Vec<Kind>,
    /// Whether a gap between bodies is narrow.
    narrow: bool,
    operators: Operators,
    /// Made already, for these kinds.
    assembly: Option<Assembly>,
}

/// Where it ended.
pub(crate) struct Converged {
    pub best: Round,
    pub work: Work,
    narrow: bool,
    operators: Operators,
    /// Of the last solution, if that is the best.
    assembly: Option<Assembly>,
}

impl Converged {
    /// To go on with the next question about the same bodies.
    pub fn into_start(self) -> Start {
        let solution = &self.best.solution;
        let kinds = (0..solution.layers.len()).map(|body| solution.classes.of(body).kind.clone());
        Start {
            kinds: kinds.collect(),
            narrow: self.narrow,
            operators: self.operators,
            assembly: self.assembly,
        }
    }
}

/// A solution with what is known of its error.
#[derive(Clone, Debug)]
pub(crate) struct Round {
    pub solution: Solution,
    /// On finer surfaces, if that was needed to tell the error.
    pub finer: Option<Solution>,
    pub misses: Vec<Miss>,
    pub error_estimate: f64,
    pub speed: f64,
    /// What it took to estimate the error.
    pub seconds: f64,
}

/// Iterations and products made.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    pub iterations: usize,
    pub products: usize,
}

impl Work {
    /// With those of one more round.
    pub fn and(self, round: &Round) -> Self {
        let solutions = [Some(&round.solution), round.finer.as_ref()];
        (solutions.into_iter().flatten()).fold(self, |work, solution| Self {
            iterations: work.iterations + solution.iteration.iterations,
            products: work.products + solution.iteration.products,
        })
    }
}

fn care(tolerance: f64, residual: Option<f64>, memory: usize) -> Care {
    let residual = residual.unwrap_or(RESIDUAL * tolerance);
    Care {
        tolerance,
        residual: residual.max(LEAST),
        product: (PRODUCT * tolerance).min(0.4 * residual).max(LEAST),
        memory,
    }
}

impl Suspension<'_> {
    /// The same question, and how the bodies lie: those that look alike from all sides look where they are resolved with the least.
    pub(crate) fn arranged(
        &self,
        progress: &dyn Progress,
    ) -> Result<(Self, Vec<Gap>), SuspensionError> {
        let gaps = self.gaps(REACH, progress)?;
        let arranged = Self {
            bodies: facing_neighbours(&self.bodies, &gaps),
            ..self.clone()
        };
        Ok((arranged, gaps))
    }

    /// The first resolutions for a tolerance.
    pub(crate) fn start(
        &self,
        gaps: &[Gap],
        tolerance: f64,
        questions: Questions,
    ) -> Result<Start, SuspensionError> {
        // Where memory does not do for the tolerance, the best that it does for: the estimate will tell.
        let mut looser = tolerance;
        loop {
            let kinds = self.kinds(&first(self, gaps, looser)?)?;
            match self.check_memory(
                &kinds,
                questions,
                "the coarsest resolutions that make sense",
            ) {
                Ok(()) => {
                    return Ok(Start {
                        kinds,
                        narrow: self.is_narrow(gaps),
                        operators: Operators::default(),
                        assembly: None,
                    });
                }
                Err(error) if looser > COARSEST => return Err(error),
                Err(_) => looser *= 10.0,
            }
        }
    }

    /// Finer and finer solutions until the estimated error is below the tolerance or no longer falls.
    pub(crate) fn converge(
        &self,
        start: Start,
        tolerance: f64,
        questions: Questions,
        progress: &dyn Progress,
    ) -> Result<Converged, SuspensionError> {
        let Start {
            mut kinds,
            narrow,
            operators,
            assembly,
        } = start;
        let assemble = |kinds: &[Kind], tolerance: f64, known: &Classes| {
            self.assemble(kinds, tolerance, questions, known, &operators, progress)
        };
        let mut assembly = match assembly {
            Some(assembly) => assembly,
            None => assemble(&kinds, tolerance, &Classes::default())?,
        };
        // What misses by far is refined anyway.
        let look_at = if narrow { NEARLY * tolerance } else { 0.0 };
        let mut latest = self.round(&mut assembly, None, look_at, progress)?;
        let mut work = Work::default().and(&latest);
        let mut best = latest.clone();
        let mut best_is_latest = true;
        let mut without_gain = 0;
        // An assembly that served before may be better than it need be.
        let mut care = assembly.care().tolerance;
        for _ in 1..ROUNDS {
            if best.error_estimate <= tolerance || without_gain > PATIENCE {
                break;
            }
            let worst = latest.misses.iter().map(|miss| miss.largest);
            let allowed = AIM * worst.fold(0.0, f64::max) * tolerance / latest.error_estimate;
            let left = &latest.solution.left;
            // What the iteration left is no matter of panels and modes.
            let finer = refined(&kinds, &latest.misses, |body| {
                allowed.max(BLAMED * left[body])
            });
            if needed_memory(&finer, questions, &self.options) > self.memory() {
                break;
            }
            kinds = finer;
            // What is left near the end may be of sums, too.
            let missed = latest.error_estimate / tolerance;
            if missed < NEARLY {
                care = care.min(0.5 * tolerance / missed);
            }
            let most_left = left.iter().copied().fold(0.0, f64::max);
            if BLAMED * most_left > allowed {
                care *= allowed / (BLAMED * most_left);
            }
            let known = latest.solution.classes.clone();
            // Let go of the old one first: two would take twice the memory.
            drop(assembly);
            assembly = assemble(&kinds, care, &known)?;
            let next = match self.round(&mut assembly, Some(&latest.solution), look_at, progress) {
                // What was found before is still an answer.
                Err(SuspensionError::NotConverged { .. }) => {
                    best_is_latest = false;
                    break;
                }
                next => next?,
            };
            work = work.and(&next);
            // An error that was looked at on finer surfaces is known better.
            let known_better = next.finer.is_some() && best.finer.is_none();
            let gain = known_better || next.error_estimate < 0.5 * best.error_estimate;
            without_gain = if gain { 0 } else { without_gain + 1 };
            best_is_latest = known_better
                || next.error_estimate < best.error_estimate
                    && next.finer.is_some() == best.finer.is_some();
            if best_is_latest {
                best = next.clone();
            }
            latest = next;
        }
        Ok(Converged {
            best,
            work,
            narrow,
            assembly: best_is_latest.then_some(assembly),
            operators,
        })
    }

    pub(crate) fn assemble(
        &self,
        kinds: &[Kind],
        tolerance: f64,
        questions: Questions,
        known: &Classes,
        operators: &Operators,
        progress: &dyn Progress,
    ) -> Result<Assembly, SuspensionError> {
        let needed = needed_memory(kinds, questions, &self.options);
        let rest = self.memory().saturating_sub(needed);
        let care = care(tolerance, self.options.residual, rest);
        let operators = operators.clone();
        Assembly::new(self, kinds, care, questions, known, operators, progress)
    }

    pub(crate) fn check_memory(
        &self,
        kinds: &[Kind],
        questions: Questions,
        what: &'static str,
    ) -> Result<(), SuspensionError> {
        let (needed, budget) = (
            needed_memory(kinds, questions, &self.options),
            self.memory(),
        );
        if needed <= budget {
            return Ok(());
        }
        Err(SuspensionError::Memory {
            what,
            needed: gibibytes(needed),
            budget: gibibytes(budget),
        })
    }

    /// Whether a gap between bodies is narrow.
    pub(crate) fn is_narrow(&self, gaps: &[Gap]) -> bool {
        gaps.iter().any(|gap| {
            let sizes = gap.bodies.map(|body| self.bodies[body].size());
            gap.distance < NARROW * sizes[0].min(sizes[1])
        })
    }

    /// One solution, and by how much it is off; if that seems to be no more than `look_at`, by what a solution on finer surfaces says, too.
    pub(crate) fn round(
        &self,
        assembly: &mut Assembly,
        before: Option<&Solution>,
        look_at: f64,
        progress: &dyn Progress,
    ) -> Result<Round, SuspensionError> {
        let solution = assembly.solve(self, before, progress)?;
        let Iteration {
            iterations,
            residual,
            stop,
            ..
        } = solution.iteration;
        let wanted = assembly.care().residual;
        if stop != Stop::Converged && (stop == Stop::Breakdown || residual > STALLED * wanted) {
            return Err(SuspensionError::NotConverged {
                iterations,
                residual,
                wanted,
                stop,
            });
        }
        let start = Instant::now();
        let misses = assembly.misses(self, &solution, progress)?;
        let speed = self.largest_speed(&solution);
        let mut error_estimate = self.error_estimate(&solution, &misses, speed);
        let mut finer = None;
        if error_estimate <= look_at {
            let worst = misses.iter().map(|miss| miss.largest).fold(0.0, f64::max);
            finer = self.on_finer_surfaces(assembly, &solution, worst, progress)?;
            if let Some(finer) = &finer {
                let tolerance = assembly.care().tolerance;
                let apart = self.apart(&solution, finer, speed);
                let in_flow = self.apart_in_flow(&solution, finer, speed, tolerance, progress)?;
                error_estimate = error_estimate.max(COMPARED * apart.max(in_flow));
            }
        }
        Ok(Round {
            solution,
            finer,
            misses,
            error_estimate,
            speed,
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// The solution on the surfaces of the check, if memory does for it, iterated until little is left of a velocity that was off by `worst`.
    ///
    /// Where gaps are narrow, the tractions that go with small velocities are large: by how much forces are off no velocity tells.
    fn on_finer_surfaces(
        &self,
        assembly: &mut Assembly,
        solution: &Solution,
        worst: f64,
        progress: &dyn Progress,
    ) -> Result<Option<Solution>, SuspensionError> {
        let kinds = assembly.finer_kinds();
        let needed = needed_memory(&kinds, Questions::One, &self.options);
        let budget = self.memory();
        if 2 * needed > budget {
            return Ok(None);
        }
        let mut finer = match assembly.take_finer() {
            Some(finer) => finer,
            None => {
                let tolerance = FINER * assembly.care().tolerance;
                let care = care(tolerance, None, budget - 2 * needed);
                let operators = assembly.operators().clone();
                let known = Classes::default();
                let questions = Questions::One;
                Assembly::new(self, &kinds, care, questions, &known, operators, progress)?
            }
        };
        let mut found = finer.solve(self, Some(solution), progress)?;
        for _ in 0..TIGHTENED {
            // Residuals are small in the mean: in a gap, where panels are short, they may be all that was off.
            let left = found.left.iter().copied().fold(0.0, f64::max);
            if left <= FINER * worst || found.iteration.stop != Stop::Converged {
                break;
            }
            finer.tighten(FINER * worst / left);
            found = finer.solve(self, Some(&found), progress)?;
        }
        assembly.keep_finer(finer);
        Ok(Some(found))
    }

    /// By how much the motions of two solutions differ, over the speed, and their forces, over the largest.
    fn apart(&self, one: &Solution, other: &Solution, speed: f64) -> f64 {
        let (mut motions, mut forces) = (0.0f64, 0.0f64);
        for (i, body) in self.bodies.iter().enumerate() {
            let size = one.classes.of(i).tables.discretization.size();
            let [a, b] = [one, other].map(|solution| (solution.motions[i], solution.wrenches[i]));
            let turning = (a.0.angular_velocity - b.0.angular_velocity).norm();
            let moving = (a.0.velocity - b.0.velocity).norm();
            motions = motions.max(moving).max(size * turning);
            if let Motion::Given(_) = body.motion {
                let force = (a.1.force - b.1.force).norm();
                let torque = (a.1.torque - b.1.torque).norm();
                forces = forces.max(body.frame.scale() * force.max(torque / size));
            }
        }
        if motions == 0.0 && forces == 0.0 {
            return 0.0;
        }
        let scale = self.force_scale(one, speed);
        (motions / speed).max(if forces == 0.0 { 0.0 } else { forces / scale })
    }

    /// By how much the velocities at the targets differ, over the speed.
    fn apart_in_flow(
        &self,
        one: &Solution,
        other: &Solution,
        speed: f64,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<f64, SuspensionError> {
        let at = |solution| self.at_targets(&self.flow_of(solution), tolerance, progress);
        let (one, other) = (at(one)?, at(other)?);
        let both = one.iter().zip(&other);
        let apart = both.map(|(a, b)| (a.velocity - b.velocity).norm() / speed);
        Ok(apart.fold(0.0, f64::max))
    }

    /// The largest force or torque over size on a held body, or a part of what the largest speed would make it.
    fn force_scale(&self, solution: &Solution, speed: f64) -> f64 {
        let mut scale = 0.0f64;
        for (i, body) in self.bodies.iter().enumerate() {
            if let Motion::Given(_) = body.motion {
                let size = body.frame.scale() * solution.classes.of(i).tables.discretization.size();
                let wrench = body.frame.wrench_to_lab(solution.wrenches[i]);
                let found = wrench.force.norm().max(wrench.torque.norm() / size);
                scale = scale.max(found).max(SMALL * 6.0 * PI * size * speed);
            }
        }
        scale
    }

    /// Of what is imposed, and of free bodies.
    fn largest_speed(&self, solution: &Solution) -> f64 {
        let speeds = self.bodies.iter().enumerate().map(|(i, body)| {
            let motion = &solution.motions[i];
            let size = solution.classes.of(i).tables.discretization.size();
            match body.motion {
                Motion::Given(_) => 0.0,
                Motion::Free(_) => {
                    (motion.velocity.norm()).max(size * motion.angular_velocity.norm())
                }
            }
        });
        speeds.fold(solution.largest_imposed, f64::max)
    }

    fn error_estimate(&self, solution: &Solution, misses: &[Miss], speed: f64) -> f64 {
        let worst = misses.iter().fold(0.0f64, |most, miss| {
            if miss.largest.is_nan() {
                f64::INFINITY
            } else {
                most.max(miss.largest)
            }
        });
        if worst == 0.0 {
            return 0.0;
        }
        let velocities = worst / speed;
        // A boundary velocity takes 6 pi size times itself to hold back, more or less; free bodies are known to have no such force.
        let mut force = 0.0f64;
        for (i, body) in self.bodies.iter().enumerate() {
            if let Motion::Given(_) = body.motion {
                let size = body.frame.scale() * solution.classes.of(i).tables.discretization.size();
                force = force.max(6.0 * PI * size * misses[i].largest);
            }
        }
        let forces = if force == 0.0 {
            0.0
        } else {
            force / self.force_scale(solution, speed)
        };
        SAFETY * velocities.max(forces) + ROUNDING
    }
}
