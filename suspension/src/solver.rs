//! The solver: answers any number of questions about the same shapes.

use std::sync::Arc;
use std::time::Instant;

use stokes_body::dirichlet::Formulation;
use stokes_body::progress::{Progress, Silent};
use stokes_body::resolution::Resolution;
use stokes_body::stresslet::stresslet;

use super::answer::{Answer, BodyAnswer, Finer, Statistics, Timings};
use super::arrangement::{REACH, facing_neighbours, gaps_within, is_narrow};
use super::assembly::Assembly;
use super::class::{Class, Kind, Role};
use super::error::SuspensionError;
use super::memory;
use super::motion::{Component, Mixed, Motion};
use super::options::{Accuracy, Options};
use super::refine::{Converged, Round, Rounds, Work};
use super::resolution::{first, uniform};
use super::solution::{Solution, Start};
use super::solve_error::SolveError;
use super::sums::Operators;
use super::suspension::{Body, Suspension};
use super::tolerances::Tolerances;

/// The smallest tolerance that doubles can serve.
const SMALLEST_TOLERANCE: f64 = 1e-14;
/// The largest tolerance to choose resolutions for.
const COARSEST: f64 = 1e-2;

/// Answers questions about bodies, and keeps what serves the next one.
///
/// What belongs to a shape at a resolution (matrices, factors, tables) and the operators of fast
/// sums are made once, as long as memory does for it. A question about bodies in the same places
/// with other loads needs new right-hand sides only. An earlier answer, where bodies were in other
/// places, starts the iteration for the next.
///
/// Two spheres of radius 1 sink one above the other, 3 apart, faster than one alone:
///
/// ```
/// use std::f64::consts::PI;
/// use bodies_of_revolution::{GeneratingCurve, Spheroid};
/// use stokes_suspension::{Body, Options, Solver, Suspension};
///
/// let sphere = Spheroid::sphere(1.0)?.shape();
/// let ball = |z: f64| Body::free(&sphere).at([0.0, 0.0, z]).pushed([0.0, 0.0, -6.0 * PI]);
/// let mut suspension = Suspension::new([ball(0.0), ball(3.0)]);
/// let mut solver = Solver::new(Options::tolerance(1e-8));
/// let answer = solver.solve(&suspension)?;
/// assert!(answer.error_estimate <= 1e-8);
/// let [lower, upper] = [0, 1].map(|i| answer.bodies[i].motion.velocity.z);
/// assert!((lower - upper).abs() < 1e-8 && lower < -1.4);
///
/// suspension.advance(answer.motions(), 0.5);
/// let later = solver.solve_from(&suspension, &answer)?;
/// assert!((later.bodies[0].motion.velocity.z - lower).abs() < 1e-7);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Solver {
    options: Options,
    operators: Operators,
    /// What was made for shapes, the last used last.
    classes: Vec<Arc<Class>>,
    /// The linear system of the last question.
    assembly: Option<Assembly>,
}

impl Solver {
    /// A solver that nothing was asked of yet.
    pub fn new(options: Options) -> Self {
        Self {
            options,
            operators: Operators::default(),
            classes: Vec::new(),
            assembly: None,
        }
    }

    /// How it solves.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// Answers a question.
    ///
    /// # Errors
    /// [`SolveError::Missed`], with the best answer inside, if the estimated error misses the
    /// tolerance; otherwise why there is no answer.
    pub fn solve(&mut self, suspension: &Suspension) -> Result<Answer, SolveError> {
        self.solve_with(suspension, None, &Silent)
    }

    /// The same, beginning with an earlier answer: its resolutions are the first, and its
    /// densities, moved and turned with their bodies, start the iteration. Bodies are told apart by
    /// their place among the bodies; those of another shape than then begin anew.
    ///
    /// # Errors
    /// As [`solve`](Self::solve).
    pub fn solve_from(
        &mut self,
        suspension: &Suspension,
        earlier: &Answer,
    ) -> Result<Answer, SolveError> {
        self.solve_with(suspension, Some(earlier), &Silent)
    }

    /// The same, from an earlier answer if there is one; tells `progress` where it is and asks it
    /// whether to go on.
    ///
    /// # Errors
    /// As [`solve`](Self::solve); [`SuspensionError::Interrupted`] if the caller cancels.
    pub fn solve_with(
        &mut self,
        suspension: &Suspension,
        earlier: Option<&Answer>,
        progress: &dyn Progress,
    ) -> Result<Answer, SolveError> {
        wanted(self.best(suspension, earlier.map(|answer| &answer.start), progress)?)
    }

    /// The best answer, whether or not it misses the tolerance.
    pub(crate) fn best(
        &mut self,
        asked: &Suspension,
        start: Option<&Start>,
        progress: &dyn Progress,
    ) -> Result<Answer, SuspensionError> {
        let begin = Instant::now();
        self.check_options()?;
        asked.check()?;
        progress.begin_round(1, None);
        progress.begin("gaps", 0);
        let gaps = gaps_within(&asked.bodies, REACH)?;
        let mut suspension = for_viscosity_one(asked);
        // Where resolutions are given, so are the frames that they belong to.
        if let Accuracy::Tolerance(_) = self.options.accuracy {
            suspension.bodies = facing_neighbours(&suspension.bodies, &gaps);
        }
        let kinds = self.first_kinds(&suspension, &gaps, start)?;
        let options = self.options.clone();
        let operators = self.operators.clone();
        let classes = self.classes.clone();
        let rounds = Rounds {
            narrow: is_narrow(&suspension.bodies, &gaps),
            suspension: &suspension,
            tolerance: options.accuracy.tolerance(),
            wanted: options.accuracy.wanted(),
            options: &options,
            operators: &operators,
            classes: &classes,
            viscosity: asked.viscosity,
            progress,
        };
        let tolerances = Tolerances::new(rounds.tolerance, options.residual);
        let serves = |assembly: &Assembly| assembly.serves(&suspension.bodies, &kinds, &tolerances);
        // One that does not serve is freed before the next one is made.
        let assembly = self.assembly.take().filter(serves);
        let Converged {
            best,
            work,
            assembly,
        } = rounds.converge(kinds, assembly, start)?;
        self.remember(&assembly.all_classes());
        self.assembly = Some(assembly);
        let mut answer = answer(&rounds, best, work)?;
        let t = &mut answer.statistics.timings;
        let named = t.assemble + t.factor + t.near + t.iterate + t.evaluate + t.estimate;
        t.other = (begin.elapsed().as_secs_f64() - named).max(0.0);
        Ok(answer)
    }

    fn check_options(&self) -> Result<(), SuspensionError> {
        let tolerance = self.options.accuracy.tolerance();
        if !(SMALLEST_TOLERANCE..1.0).contains(&tolerance) {
            return Err(SuspensionError::Tolerance(tolerance));
        }
        if self.options.formulation == Formulation::InteriorDoubleLayer {
            return Err(SuspensionError::Interior);
        }
        Ok(())
    }

    /// The kinds of the bodies to begin with.
    fn first_kinds(
        &self,
        suspension: &Suspension,
        gaps: &[bodies_of_revolution::Gap],
        start: Option<&Start>,
    ) -> Result<Vec<Kind>, SuspensionError> {
        let bodies = &suspension.bodies;
        let kinds = |resolutions: &[Arc<Resolution>]| self.kinds(bodies, resolutions);
        match &self.options.accuracy {
            Accuracy::Resolutions { of_bodies, .. } if of_bodies.len() != bodies.len() => {
                Err(SuspensionError::Resolutions {
                    resolutions: of_bodies.len(),
                    bodies: bodies.len(),
                })
            }
            Accuracy::Resolutions { of_bodies, .. } => self.by_hand(kinds(of_bodies)),
            &Accuracy::Uniform {
                panels,
                order,
                modes,
                ..
            } => self.by_hand(kinds(&uniform(bodies, [panels, order, modes])?)),
            &Accuracy::Tolerance(tolerance) => {
                // Where memory does not do for the tolerance, the best that it does for: the
                // estimate will tell.
                let mut looser = tolerance;
                loop {
                    let mut kinds = kinds(&first(suspension, gaps, looser)?);
                    if let Some(start) = start {
                        begin_with(&mut kinds, start);
                    }
                    let what = "the coarsest resolutions that make sense";
                    match memory::check(&kinds, &self.options, what) {
                        Ok(()) => return Ok(kinds),
                        Err(error) if looser > COARSEST => return Err(error),
                        Err(_) => looser *= 10.0,
                    }
                }
            }
        }
    }

    fn by_hand(&self, kinds: Vec<Kind>) -> Result<Vec<Kind>, SuspensionError> {
        memory::check(&kinds, &self.options, "panels, order and modes by hand")?;
        Ok(kinds)
    }

    fn kinds(&self, bodies: &[Body], resolutions: &[Arc<Resolution>]) -> Vec<Kind> {
        let kinds = bodies.iter().zip(resolutions);
        let kind = |(body, resolution): (&Body, &Arc<Resolution>)| Kind {
            shape: body.shape.clone(),
            resolution: resolution.clone(),
            role: if body.motion.is_held() {
                Role::Held(self.options.formulation)
            } else {
                Role::Free
            },
        };
        kinds.map(kind).collect()
    }

    /// Keeps classes for the next question: those of this one, and of earlier ones as far as memory
    /// does for them.
    fn remember(&mut self, used: &[Arc<Class>]) {
        let is_used = |class: &Arc<Class>| used.iter().any(|other| Arc::ptr_eq(class, other));
        self.classes.retain(|class| !is_used(class));
        self.classes.extend(used.iter().cloned());
        let entries = |class: &Arc<Class>| class.kind.entries();
        let most = memory::budget(&self.options) as f64 / 4.0 / 8.0;
        let mut kept: f64 = self.classes.iter().map(entries).sum();
        while kept > most && self.classes.len() > used.len() {
            kept -= entries(&self.classes.remove(0));
        }
    }
}

/// An answer, or that it missed its tolerance.
fn wanted(answer: Answer) -> Result<Answer, SolveError> {
    let Some(tolerance) = answer.tolerance else {
        return Ok(answer);
    };
    if answer.error_estimate <= tolerance {
        return Ok(answer);
    }
    // An estimate that is not a number comes here, too.
    Err(SolveError::Missed {
        answer: Box::new(answer),
        tolerance,
    })
}

/// Bodies that had been solved for begin with the resolutions they had then.
fn begin_with(kinds: &mut [Kind], start: &Start) {
    for (body, kind) in kinds.iter_mut().enumerate() {
        if let Some(earlier) = start.of(body, &kind.shape, kind.role) {
            kind.resolution = earlier.resolution.clone();
        }
    }
}

/// The same question for viscosity 1: forces and torques over the viscosity.
fn for_viscosity_one(asked: &Suspension) -> Suspension {
    let by = 1.0 / asked.viscosity;
    let mut scaled = asked.clone();
    scaled.viscosity = 1.0;
    for body in &mut scaled.bodies {
        match &mut body.motion {
            Motion::Given(_) => {}
            Motion::Free(wrench) => {
                wrench.force *= by;
                wrench.torque *= by;
            }
            Motion::Mixed(Mixed { components, .. }) => {
                for component in components {
                    if let Component::Free(load) = component {
                        *load *= by;
                    }
                }
            }
        }
    }
    scaled
}

/// The answer of the best round, in the units of the question.
fn answer(rounds: &Rounds<'_>, best: Round, work: Work) -> Result<Answer, SuspensionError> {
    let Round {
        solution,
        probes,
        finer,
        misses,
        error_estimate,
        speed,
        seconds: _,
    } = best;
    let boundary_error = |body: usize| misses.as_ref().map(|misses| misses[body].largest);
    let evaluation = Tolerances::new(rounds.tolerance, None).evaluation;
    let flow = rounds.flow(&solution, speed, evaluation);
    let start = Instant::now();
    let probes = match probes {
        Some(probes) => probes,
        None => rounds.probes_of(&flow, evaluation)?,
    };
    let evaluate = start.elapsed().as_secs_f64();
    let finer = finer.map(|(solution, probes)| Finer {
        bodies: bodies_of(rounds, &solution, &boundary_error),
        flow: rounds.flow(&solution, speed, evaluation),
        probes,
    });
    let seconds = work.solving;
    Ok(Answer {
        bodies: bodies_of(rounds, &solution, &boundary_error),
        probes,
        flow,
        finer,
        error_estimate,
        tolerance: rounds.wanted,
        largest_speed: speed,
        statistics: Statistics {
            iterations: work.iterations,
            products: work.products,
            rounds: work.rounds,
            unknowns: solution.unknowns,
            points: solution.points,
            near_points: solution.near_points,
            near_bytes: solution.near_bytes,
            classes: solution.classes.all().len(),
            timings: Timings {
                assemble: seconds.assemble,
                factor: seconds.factor,
                near: seconds.near,
                iterate: seconds.iterate,
                sum: seconds.sum,
                evaluate,
                estimate: work.estimating,
                other: 0.0,
            },
            iteration: solution.iteration.clone(),
        },
        start: Start::new(&rounds.suspension.bodies, &solution),
    })
}

fn bodies_of(
    rounds: &Rounds<'_>,
    solution: &Solution,
    boundary_error: &dyn Fn(usize) -> Option<f64>,
) -> Vec<BodyAnswer> {
    let viscosity = rounds.viscosity;
    let bodies = rounds
        .suspension
        .bodies
        .iter()
        .enumerate()
        .map(|(i, body)| {
            let class = solution.classes.of(i);
            let frame = &body.frame;
            let of_shape = stresslet(&class.tables.discretization, &solution.layers[i]);
            let mut wrench = match body.motion {
                Motion::Free(wrench) => wrench,
                Motion::Given(_) | Motion::Mixed(_) => frame.wrench_to_lab(solution.wrenches[i]),
            };
            wrench.force *= viscosity;
            wrench.torque *= viscosity;
            BodyAnswer {
                motion: match body.motion {
                    Motion::Given(motion) => motion,
                    Motion::Free(_) | Motion::Mixed(_) => frame.motion_to_lab(solution.motions[i]),
                },
                wrench,
                stresslet: viscosity * frame.scale().powi(2) * frame.tensor_to_lab(&of_shape),
                boundary_error: boundary_error(i),
                resolution: (*class.kind.resolution).clone(),
            }
        });
    bodies.collect()
}
