//! Solutions, each finer than the one before, until the estimated error is small enough.

use std::sync::Arc;
use std::time::Instant;

use inexact_krylov::Stop;
use panel_quadrature::QuadratureError;
use stokes_body::dirichlet::Formulation;
use stokes_body::kernel::FlowAt;
use stokes_body::progress::Progress;
use stokes_body::refinement::unresolved_panels;

use super::assembly::{Assembly, Setup};
use super::check::{Keep, Miss, finer_kinds};
use super::class::{Class, Kind, Role};
use super::error::SuspensionError;
use super::estimate::{from_comparison, from_misses, largest_speed};
use super::flow::{BodyFlow, Flow, Parts};
use super::iteration::Iteration;
use super::memory::{self, needed_memory};
use super::options::Options;
use super::resolution::{bisected, refined};
use super::solution::{Seconds, Solution, Start};
use super::sums::Operators;
use super::suspension::Suspension;
use super::tolerances::Tolerances;

/// Solutions, each finer than the one before, and how many in a row may gain less than a factor of
/// two.
const ROUNDS: usize = 10;
const ROUNDS_ALONE: usize = 24;
const PATIENCE: usize = 2;
/// What finer resolutions aim at, in tolerances: next time the estimate is to be below it, and not
/// about it.
const AIM: f64 = 0.4;
/// Estimates that miss the tolerance by less may do so for other reasons than the resolution.
const NEARLY: f64 = 10.0;
/// Misses up to so many times what the iteration left may be the iteration's.
const BLAMED: f64 = 2.0;
/// What part of the error that is wanted the iteration may leave, and what it aims at if it left
/// more.
const MOST_LEFT: f64 = 0.5;
const AIM_LEFT: f64 = 0.25;
/// How much better the equations on finer surfaces are solved than those whose error they tell.
const FINER: f64 = 0.1;
/// How often more may be asked of them.
const TIGHTENED: usize = 3;
/// An iteration that stagnates or is cut short at so many times its residual is still worth an
/// answer: the estimate tells how much.
const STALLED: f64 = 100.0;

/// What checks keep of shapes may take one part in so many of the memory there is: a single
/// question has no use for it.
const KEPT_IN: usize = 8;

/// What all rounds of one question share.
pub(crate) struct Rounds<'a> {
    /// The question, for viscosity 1, spheres without slip turned to their neighbours.
    pub suspension: &'a Suspension,
    /// Whether a gap between bodies is narrow.
    pub narrow: bool,
    pub tolerance: f64,
    /// What the estimate is to be below, if anything.
    pub wanted: Option<f64>,
    pub options: &'a Options,
    pub operators: &'a Operators,
    /// Classes that exist already.
    pub classes: &'a [Arc<Class>],
    pub viscosity: f64,
    pub progress: &'a dyn Progress,
}

/// A solution with what is known of its error.
#[derive(Clone, Debug)]
pub(crate) struct Round {
    pub solution: Solution,
    /// Velocity and pressure at the probes, if that was needed to estimate the error.
    pub probes: Option<Vec<FlowAt>>,
    /// The solution on finer surfaces and its flow at the probes, if that was needed.
    pub finer: Option<(Solution, Vec<FlowAt>)>,
    pub misses: Option<Vec<Miss>>,
    pub error_estimate: f64,
    pub speed: f64,
    /// What it took to estimate the error.
    pub seconds: f64,
}

/// What all rounds together took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    pub iterations: usize,
    pub products: usize,
    pub rounds: usize,
    /// Wall clock of the solutions, and of estimating their errors.
    pub solving: Seconds,
    pub estimating: f64,
}

impl Work {
    /// With those of one more round.
    fn and(self, round: &Round) -> Self {
        let finer = round.finer.as_ref().map(|(solution, _)| solution);
        let solutions = [Some(&round.solution), finer].into_iter().flatten();
        let more = Self {
            rounds: self.rounds + 1,
            solving: self.solving + round.solution.seconds,
            estimating: self.estimating + round.seconds,
            ..self
        };
        solutions.fold(more, |work, solution| Self {
            iterations: work.iterations + solution.iteration.iterations,
            products: work.products + solution.iteration.products,
            ..work
        })
    }
}

/// Where it ended.
pub(crate) struct Converged {
    pub best: Round,
    pub work: Work,
    /// Of the last solution.
    pub assembly: Assembly,
}

impl Rounds<'_> {
    fn is_alone(&self) -> bool {
        self.suspension.bodies.len() == 1
    }

    /// What checks keep: what depends on shapes, if memory does for it.
    fn keep(&self, kinds: &[Kind]) -> Keep {
        let needed = needed_memory(kinds, Keep::Shapes, self.options);
        if KEPT_IN * needed <= memory::budget(self.options) {
            Keep::Shapes
        } else {
            Keep::Nothing
        }
    }

    pub fn assemble(
        &self,
        kinds: &[Kind],
        tolerances: Tolerances,
        known: &[Arc<Class>],
    ) -> Result<Assembly, SuspensionError> {
        let keep = self.keep(kinds);
        let needed = needed_memory(kinds, keep, self.options);
        let setup = Setup {
            tolerances,
            options: self.options,
            known,
            operators: self.operators,
            memory: memory::budget(self.options).saturating_sub(needed),
            keep,
        };
        Assembly::new(&self.suspension.bodies, kinds, &setup, self.progress)
    }

    /// Finer and finer solutions until the estimated error is below what is wanted or no longer
    /// falls. An `assembly` for these kinds may have been made before.
    pub fn converge(
        &self,
        mut kinds: Vec<Kind>,
        assembly: Option<Assembly>,
        start: Option<&Start>,
    ) -> Result<Converged, SuspensionError> {
        let mut tolerances = Tolerances::new(self.tolerance, self.options.residual);
        let mut assembly = match assembly {
            Some(assembly) => assembly,
            None => self.assemble(&kinds, tolerances, self.classes)?,
        };
        // What misses by far is refined anyway, and not compared with finer surfaces before.
        let compared_below = match (self.is_alone(), self.narrow, self.wanted) {
            (true, ..) | (_, true, None) => f64::INFINITY,
            (_, true, Some(wanted)) => NEARLY * wanted,
            (_, false, _) => 0.0,
        };
        let mut latest = self.round(&mut assembly, start, compared_below)?;
        let mut work = Work::default().and(&latest);
        let mut best = latest.clone();
        let Some(tolerance) = self.wanted else {
            return Ok(Converged {
                best,
                work,
                assembly,
            });
        };
        let mut without_gain = 0;
        // An assembly that served before may be better than it need be.
        tolerances = *assembly.tolerances();
        let rounds = if self.is_alone() {
            ROUNDS_ALONE
        } else {
            ROUNDS
        };
        for _ in 1..rounds {
            if best.error_estimate <= tolerance || without_gain > PATIENCE {
                break;
            }
            let finer = match &latest.misses {
                None => resolve_density(&latest.solution, &kinds)?,
                Some(misses) => {
                    let allowed = allowed(&latest, misses, tolerance);
                    let left = &latest.solution.residual_speeds;
                    let target = tightened(tolerances.target, &latest, allowed, tolerance);
                    tolerances = Tolerances::new(target, self.options.residual);
                    // What the iteration left is no matter of panels and modes.
                    refined(&kinds, misses, |body| allowed.max(BLAMED * left[body]))
                }
            };
            if needed_memory(&finer, Keep::Nothing, self.options) > memory::budget(self.options) {
                break;
            }
            kinds = finer;
            (self.progress).begin_round(work.rounds + 1, Some(latest.error_estimate));
            let mut known = latest.solution.classes.all().to_vec();
            known.extend(self.classes.iter().cloned());
            // Freed first: two would take twice the memory.
            drop(assembly);
            assembly = self.assemble(&kinds, tolerances, &known)?;
            let start = Start::new(&self.suspension.bodies, &latest.solution);
            let next = match self.round(&mut assembly, Some(&start), compared_below) {
                // What was found before is still an answer.
                Err(SuspensionError::NotConverged { .. }) => break,
                next => next?,
            };
            work = work.and(&next);
            // An error that was looked at on finer surfaces is known better.
            let known_better = next.finer.is_some() && best.finer.is_none();
            let gain = known_better || next.error_estimate < 0.5 * best.error_estimate;
            without_gain = if gain { 0 } else { without_gain + 1 };
            let known_as_well = next.finer.is_some() == best.finer.is_some();
            if known_better || known_as_well && next.error_estimate < best.error_estimate {
                best = next.clone();
            }
            latest = next;
        }
        Ok(Converged {
            best,
            work,
            assembly,
        })
    }

    /// A solution, iterated on where the residual alone would make much of the error that is
    /// wanted: that is known without a check, but only when forces are. Where gaps are narrow,
    /// products would have to be better, too, and the next round sees to both.
    fn solve(
        &self,
        assembly: &mut Assembly,
        start: Option<&Start>,
    ) -> Result<Solution, SuspensionError> {
        let suspension = self.suspension;
        let mut wanted = match (self.wanted, self.options.residual) {
            (Some(wanted), None) if !self.is_alone() && !self.narrow => Some(wanted),
            _ => None,
        };
        let further = |solution: &Solution| {
            // Once: what is left after that is the check's to tell.
            let wanted = wanted.take()?;
            let speed = largest_speed(suspension, solution);
            let left = from_misses(suspension, solution, &solution.residual_speeds, speed);
            (left.is_finite() && left > MOST_LEFT * wanted).then(|| AIM_LEFT * wanted / left)
        };
        let solution = assembly.solve(suspension, start, self.options, self.progress, further)?;
        check_iteration(&solution.iteration, assembly.tolerances())?;
        Ok(solution)
    }

    /// One solution and its estimated error. Below `compared_below`, a solution on finer surfaces
    /// tells it, too.
    fn round(
        &self,
        assembly: &mut Assembly,
        start: Option<&Start>,
        compared_below: f64,
    ) -> Result<Round, SuspensionError> {
        let suspension = self.suspension;
        let solution = self.solve(assembly, start)?;
        let begin = Instant::now();
        let misses = assembly.misses(suspension, &solution, self.progress)?;
        let speed = largest_speed(suspension, &solution);
        let mut error_estimate = match &misses {
            Some(misses) => {
                let largest: Vec<f64> = misses.iter().map(|miss| miss.largest).collect();
                from_misses(suspension, &solution, &largest, speed)
            }
            None => 0.0,
        };
        let (mut finer, mut probes) = (None, None);
        if error_estimate <= compared_below {
            let worst = misses.iter().flatten().map(|miss| miss.largest);
            let worst = worst.fold(0.0, f64::max);
            if let Some(found) = self.on_finer_surfaces(assembly, &solution, worst)? {
                let tolerances = *assembly.tolerances();
                let mine = self.at_probes(&solution, speed, tolerances.evaluation)?;
                let best = Tolerances::of_comparison(tolerances.target).evaluation;
                let evaluation = if self.is_alone() {
                    best
                } else {
                    tolerances.evaluation
                };
                let theirs = self.at_probes(&found, speed, evaluation)?;
                let compared =
                    from_comparison(suspension, [&solution, &found], [&mine, &theirs], speed);
                error_estimate = error_estimate.max(compared);
                finer = Some((found, theirs));
                probes = Some(mine);
            }
        }
        Ok(Round {
            solution,
            probes,
            finer,
            misses,
            error_estimate,
            speed,
            seconds: begin.elapsed().as_secs_f64(),
        })
    }

    /// The solution on the surfaces of the check, if memory does for it, iterated until little is
    /// left of a velocity that was off by `worst`.
    ///
    /// Where gaps are narrow, the tractions that go with small velocities are large: by how much
    /// forces are off no velocity tells.
    fn on_finer_surfaces(
        &self,
        assembly: &mut Assembly,
        solution: &Solution,
        worst: f64,
    ) -> Result<Option<Solution>, SuspensionError> {
        let bodies = &self.suspension.bodies;
        let kinds = finer_kinds(bodies, assembly.classes())?;
        let needed = needed_memory(&kinds, Keep::Nothing, self.options);
        let budget = memory::budget(self.options);
        if !self.is_alone() && 2 * needed > budget {
            return Ok(None);
        }
        let mut finer = match assembly.take_finer() {
            Some(finer) => finer,
            None => {
                let target = assembly.tolerances().target;
                let target = if self.is_alone() {
                    target
                } else {
                    FINER * target
                };
                let setup = Setup {
                    tolerances: Tolerances::of_comparison(target),
                    options: self.options,
                    known: self.classes,
                    operators: self.operators,
                    memory: budget.saturating_sub(2 * needed),
                    keep: Keep::Nothing,
                };
                Assembly::new(bodies, &kinds, &setup, self.progress)?
            }
        };
        let start = Start::new(bodies, solution);
        let mut tightened = 0;
        let further = |found: &Solution| {
            // Residuals are small in the mean: in a gap, where panels are short, they may be all
            // that was off.
            let left = found.residual_speeds.iter().copied().fold(0.0, f64::max);
            tightened += 1;
            (tightened <= TIGHTENED && left > FINER * worst).then(|| FINER * worst / left)
        };
        let (suspension, options) = (self.suspension, self.options);
        let found = finer.solve(suspension, Some(&start), options, self.progress, further)?;
        assembly.keep_finer(finer);
        Ok(Some(found))
    }

    /// The flow of a solution.
    pub fn flow(&self, solution: &Solution, speed: f64, evaluation: f64) -> Flow {
        let bodies = self.suspension.bodies.iter().enumerate();
        let bodies = bodies.map(|(i, body)| {
            let on = &solution.classes.of(i).tables.discretization;
            BodyFlow {
                frame: body.frame,
                disturbance: stokes_body::flow::Flow::new(on, solution.layers[i].clone()),
                motion: solution.motions[i],
                slip: solution.slips[i].clone(),
                wrench: solution.wrenches[i],
            }
        });
        Flow::new(Parts {
            bodies: bodies.collect(),
            background: self.suspension.background,
            viscosity: self.viscosity,
            largest_speed: speed,
            tolerance: evaluation,
            operators: self.operators.clone(),
        })
    }

    fn at_probes(
        &self,
        solution: &Solution,
        speed: f64,
        evaluation: f64,
    ) -> Result<Vec<FlowAt>, SuspensionError> {
        if self.suspension.probes.is_empty() {
            return Ok(Vec::new());
        }
        let flow = self.flow(solution, speed, evaluation);
        self.probes_of(&flow, evaluation)
    }

    /// Velocity and pressure at the probes.
    pub fn probes_of(&self, flow: &Flow, evaluation: f64) -> Result<Vec<FlowAt>, SuspensionError> {
        let probes = &self.suspension.probes;
        let found = flow.evaluate::<false>(probes, evaluation, self.progress)?;
        let at = |at: stokes_body::kernel::FlowGradientAt| FlowAt {
            velocity: at.velocity,
            pressure: self.viscosity * at.pressure,
        };
        Ok(found.into_iter().map(at).collect())
    }
}

/// Refuses what an iteration came to if it is not worth an answer.
fn check_iteration(iteration: &Iteration, tolerances: &Tolerances) -> Result<(), SuspensionError> {
    let Iteration {
        iterations,
        residual,
        stop,
        ..
    } = *iteration;
    let wanted = tolerances.residual;
    if stop != Stop::Converged && (stop == Stop::Breakdown || residual > STALLED * wanted) {
        return Err(SuspensionError::NotConverged {
            iterations,
            residual,
            wanted,
            stop,
        });
    }
    Ok(())
}

/// By how much boundary velocities may be off next time.
fn allowed(round: &Round, misses: &[Miss], tolerance: f64) -> f64 {
    let worst = misses.iter().map(|miss| miss.largest).fold(0.0, f64::max);
    AIM * worst * tolerance / round.error_estimate
}

/// The target of sums and iteration for the next round: what is left near the end may be theirs,
/// too.
fn tightened(mut target: f64, round: &Round, allowed: f64, tolerance: f64) -> f64 {
    let missed = round.error_estimate / tolerance;
    if missed < NEARLY {
        target = target.min(0.5 * tolerance / missed);
    }
    let most_left = round
        .solution
        .residual_speeds
        .iter()
        .copied()
        .fold(0.0, f64::max);
    if BLAMED * most_left > allowed {
        target *= allowed / (BLAMED * most_left);
    }
    target
}

/// For a body alone: the panels that resolve its density worst are bisected.
fn resolve_density(solution: &Solution, kinds: &[Kind]) -> Result<Vec<Kind>, QuadratureError> {
    let kinds = kinds.iter().enumerate().map(|(body, kind)| {
        let on = &solution.classes.of(body).tables.discretization;
        let layers = &solution.layers[body];
        // A free body's single layer is a rigid motion: there is nothing to resolve.
        let density = match kind.role {
            Role::Held(Formulation::SingleLayer) => &layers.single,
            _ => &layers.double,
        };
        let marked = unresolved_panels(on, &[density])?;
        Ok(bisected(kind, &marked))
    });
    kinds.collect()
}
