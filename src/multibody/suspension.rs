//! Exterior problems on many bodies, answered with an estimate of the error.
//!
//! Every body has a motion that is given (it is *held*) or a force and torque on it (it is *free*), and perhaps a slip, as for
//! [one body](crate::body::problem); all are in one undisturbed flow. Held and free bodies may be mixed. On body $i$
//!
//! $$ \bigl(\tfrac12 + D_i + \eta_i S_i\bigr)\\, \sigma_i + \sum_{j \ne i} u_j = U_i + \Omega_i \times x + u_{s,i} - u_\infty \quad \text{(held)}, $$
//! $$ \bigl(\tfrac12 + D_i + P_i\bigr)\\, \sigma_i + S_i[\varrho_i] + \sum_{j \ne i} u_j = u_{s,i} - u_\infty \quad \text{(free)}, $$
//!
//! where $u_j$ is the flow of body $j$'s layers: $(D_j + \eta_j S_j)\sigma_j$, or $D_j\sigma_j + S_j\varrho_j$ with the density $\varrho_j$ of its force
//! and torque (see [`mobility`](crate::body::mobility)).
//!
//! Two spheres of radius 1 sink one above the other, 3 apart, faster than one alone:
//!
//! ```
//! use axistokes::*;
//! use nalgebra::{Point3, Vector3};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let sphere: std::sync::Arc<dyn GeneratingCurve> = std::sync::Arc::new(Spheroid::sphere(1.0)?);
//! let weight = Wrench { force: -6.0 * std::f64::consts::PI * Vector3::z(), torque: Vector3::zeros() };
//! let ball = |z: f64| Body {
//!     motion: Motion::Free(weight),
//!     ..Body::new(sphere.clone(), Frame::new(Point3::new(0.0, 0.0, z), Vector3::z_axis()))
//! };
//! let answer = Suspension::new(vec![ball(0.0), ball(3.0)]).to_tolerance(1e-8, &Silent)?;
//! assert!(answer.error_estimate <= 1e-8);
//! let [lower, upper] = [0, 1].map(|i| answer.bodies[i].motion.velocity.z);
//! assert!((lower - upper).abs() < 1e-8 && lower < -1.4);
//! # Ok(())
//! # }
//! ```

use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Instant;

use nalgebra::{Matrix3, Point3};

use super::SuspensionError;
use super::check::{Miss, misses};
use super::class::{Classes, Kind, Role};
use super::contact::{Gap, Placed, gaps};
use super::flow::{BodyLayers, SuspensionFlow};
use super::resolution::{first, refined};
use super::solution::{Care, Iteration, Solution, solve};
use super::sums::Operators;
use crate::body::dirichlet::Formulation;
use crate::body::frame::Frame;
use crate::body::linear_flow::LinearFlow;
pub use crate::body::problem::Motion;
use crate::body::problem::{Resolution, Slip, evaluation_tolerance};
use crate::body::rigid::{RigidMotion, Wrench};
use crate::body::stresslet::stresslet;
use crate::curve::GeneratingCurve;
use crate::kernel::FlowAt;
use crate::krylov::{Method, Stop};
use crate::progress::Progress;

/// A body: its shape, where it is, and what is known of its motion.
#[derive(Clone)]
pub struct Body<'a> {
    /// The shape's generating curve. Bodies that share it share all that depends on the shape alone.
    pub curve: Arc<dyn GeneratingCurve>,
    /// Where the body is, and how large.
    pub frame: Frame,
    /// Its motion about its centre, or force and torque about its centre that are exerted on it from outside; in the laboratory.
    pub motion: Motion,
    /// The velocity of the surface relative to the rigid motion, in the body's own frame (where lengths are the shape's).
    pub slip: Option<Slip<'a>>,
}

impl Body<'_> {
    /// A body that is held still.
    pub fn new(curve: Arc<dyn GeneratingCurve>, frame: Frame) -> Self {
        Self {
            curve,
            frame,
            motion: Motion::Given(RigidMotion::rest()),
            slip: None,
        }
    }
}

/// A question about many bodies, in the laboratory and for viscosity 1.
#[derive(Clone)]
pub struct Suspension<'a> {
    /// The bodies.
    pub bodies: Vec<Body<'a>>,
    /// The undisturbed flow.
    pub background: LinearFlow,
    /// Points outside the bodies where the flow is wanted.
    pub targets: &'a [Point3<f64>],
    /// The equation for held bodies; an exterior one.
    pub formulation: Formulation,
    /// How it is solved.
    pub options: Options,
}

/// How the equations are solved; the defaults are good.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The Krylov method.
    pub method: Method,
    /// Most iterations of each solution.
    pub max_iterations: usize,
    /// Relative residual at which an iteration ends; if not given, what the tolerance needs.
    pub residual: Option<f64>,
    /// Whether the rigid motions of held bodies are solved for together, as a second level of the preconditioner.
    pub two_level: bool,
    /// How inexact products may become as the residual falls, relative to their results; 0 keeps them exact.
    pub loosest_product: f64,
    /// Bytes that everything together may take; if not given, a part of what the machine has.
    pub memory: Option<usize>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::Gmres { restart: 60 },
            max_iterations: 200,
            residual: None,
            two_level: true,
            loosest_product: 1e-3,
            memory: None,
        }
    }
}

/// What became of one body, in the laboratory.
#[derive(Clone, Debug)]
pub struct BodyAnswer {
    /// The rigid motion about its centre: the one given, or the one found.
    pub motion: RigidMotion,
    /// Force and torque about its centre that the body exerts on the fluid.
    pub wrench: Wrench,
    /// The stresslet about its centre.
    pub stresslet: Matrix3<f64>,
    /// By how much the velocity is off on its surface, at most.
    pub boundary_error: f64,
    /// The resolution it was computed with.
    pub resolution: Resolution,
}

/// The answer to a [`Suspension`].
#[derive(Clone, Debug)]
pub struct Answer {
    /// Every body.
    pub bodies: Vec<BodyAnswer>,
    /// Velocity and pressure at the targets, background included.
    pub targets: Vec<FlowAt>,
    /// The flow, to be evaluated anywhere.
    pub flow: SuspensionFlow,
    /// Estimated error: of velocities anywhere in the fluid and of rigid velocities relative to [`largest_speed`](Self::largest_speed), and of forces and
    /// torques relative to their largest or, where that vanishes, to a hundredth of $6\pi$ times size and largest speed.
    pub error_estimate: f64,
    /// The largest speed on the surfaces, of what is imposed and of the free bodies' motions.
    pub largest_speed: f64,
    /// How the last iteration went.
    pub iteration: Iteration,
    /// Iterations of all solutions.
    pub iterations: usize,
    /// Products of all solutions.
    pub products: usize,
    /// Unknowns of all bodies and modes.
    pub unknowns: usize,
    /// Points of all surfaces.
    pub points: usize,
    /// Points that are near another body, and the bytes that are kept for them.
    pub near: (usize, usize),
    /// Shapes and resolutions that were factored for the last solution.
    pub classes: usize,
    /// How long things took.
    pub timings: Timings,
}

/// Wall-clock seconds, of the last solution but for `refine`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Timings {
    /// Assembling the matrices of single bodies, and all else that belongs to shapes.
    pub assemble: f64,
    /// Factoring them.
    pub factor: f64,
    /// Finding points near other bodies, and what is needed for them.
    pub near: f64,
    /// Iterating.
    pub iterate: f64,
    /// Of that, summing over points.
    pub sum: f64,
    /// Evaluating the flow at the targets.
    pub evaluate: f64,
    /// Estimating the error.
    pub estimate: f64,
    /// Solutions before the last one.
    pub refine: f64,
}

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
/// Gaps of so many sizes of a body matter to its resolution.
const REACH: f64 = 1.0;
/// The largest tolerance to choose resolutions for.
const COARSEST: f64 = 1e-2;
/// An iteration that stagnates or is cut short at so many times its residual is still worth an answer: the estimate tells how much.
const STALLED: f64 = 100.0;
/// The smallest tolerance that doubles can serve.
const SMALLEST_TOLERANCE: f64 = 1e-14;
/// Least relative residual and product.
const LEAST: f64 = 1e-13;

impl<'a> Suspension<'a> {
    /// Bodies in a fluid at rest: nothing happens until they are given something to do.
    pub fn new(bodies: Vec<Body<'a>>) -> Self {
        Self {
            bodies,
            background: LinearFlow::rest(),
            targets: &[],
            formulation: Formulation::CombinedField,
            options: Options::default(),
        }
    }

    /// The answer with given resolutions, one for each body.
    ///
    /// # Errors
    /// See [`SuspensionError`].
    pub fn at_resolutions(
        &self,
        resolutions: &[Arc<Resolution>],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Answer, SuspensionError> {
        let begin = Instant::now();
        if resolutions.len() != self.bodies.len() {
            return Err(SuspensionError::Resolutions {
                resolutions: resolutions.len(),
                bodies: self.bodies.len(),
            });
        }
        self.check_question(tolerance)?;
        self.gaps(0.0, progress)?;
        let kinds = self.kinds(resolutions)?;
        self.check_memory(&kinds, "panels, order and modes by hand")?;
        let (known, operators) = (Classes::default(), Operators::default());
        let round = self.round(&kinds, tolerance, &known, None, &operators, progress)?;
        let work = Work::default().and(&round.solution.iteration);
        self.answer(round, tolerance, work, begin, progress)
    }

    /// The answer to a tolerance: the first resolutions found whose error estimate is below it, or the best there are; compare
    /// [`Answer::error_estimate`] with the tolerance.
    ///
    /// # Errors
    /// See [`SuspensionError`].
    pub fn to_tolerance(
        &self,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Answer, SuspensionError> {
        let begin = Instant::now();
        let start = self.start(tolerance, progress)?;
        let Converged { best, work, .. } = self.converge(start, tolerance, progress)?;
        self.answer(best, tolerance, work, begin, progress)
    }

    /// The first resolutions for a tolerance.
    pub(crate) fn start(
        &self,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Start, SuspensionError> {
        if self.bodies.is_empty() {
            return Err(SuspensionError::Empty);
        }
        self.check_question(tolerance)?;
        let gaps = self.gaps(REACH, progress)?;
        // Where memory does not do for the tolerance, the best that it does for: the estimate will tell.
        let mut looser = tolerance;
        loop {
            let kinds = self.kinds(&first(self, &gaps, looser)?)?;
            match self.check_memory(&kinds, "the coarsest resolutions that make sense") {
                Ok(()) => {
                    return Ok(Start {
                        kinds,
                        known: Classes::default(),
                        operators: Operators::default(),
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
        progress: &dyn Progress,
    ) -> Result<Converged, SuspensionError> {
        let Start {
            mut kinds,
            known,
            operators,
        } = start;
        let mut latest = self.round(&kinds, tolerance, &known, None, &operators, progress)?;
        let mut work = Work::default();
        let mut best = latest.clone();
        let mut without_gain = 0;
        for _ in 1..ROUNDS {
            if best.error_estimate <= tolerance || without_gain > PATIENCE {
                break;
            }
            let worst = latest.misses.iter().map(|miss| miss.largest);
            let allowed = AIM * worst.fold(0.0, f64::max) * tolerance / latest.error_estimate;
            let finer = refined(&kinds, &latest.misses, allowed);
            if needed_memory(&finer, &self.options) > self.memory() {
                break;
            }
            kinds = finer;
            work = work.and(&latest.solution.iteration);
            let known = &latest.solution.classes;
            // What is left near the end may be of iteration and sums, too.
            let missed = latest.error_estimate / tolerance;
            let care = if missed < NEARLY {
                0.5 * tolerance / missed
            } else {
                tolerance
            };
            let next = self.round(
                &kinds,
                care,
                known,
                Some(&latest.solution),
                &operators,
                progress,
            )?;
            let gain = next.error_estimate < 0.5 * best.error_estimate;
            without_gain = if gain { 0 } else { without_gain + 1 };
            if next.error_estimate < best.error_estimate {
                best = next.clone();
            }
            latest = next;
        }
        work = work.and(&latest.solution.iteration);
        Ok(Converged {
            best,
            operators,
            work,
        })
    }

    fn check_memory(&self, kinds: &[Kind], what: &'static str) -> Result<(), SuspensionError> {
        let (needed, budget) = (needed_memory(kinds, &self.options), self.memory());
        if needed <= budget {
            return Ok(());
        }
        Err(SuspensionError::Memory {
            what,
            needed: gibibytes(needed),
            budget: gibibytes(budget),
        })
    }

    /// How far the bodies are apart whose gap is below `reach` sizes; an error if any are not.
    fn gaps(&self, reach: f64, progress: &dyn Progress) -> Result<Vec<Gap>, SuspensionError> {
        progress.begin("gaps", 0);
        let placed: Vec<Placed<'_>> = (self.bodies.iter())
            .map(|body| {
                let extent = extent(&*body.curve);
                Placed {
                    curve: &*body.curve,
                    frame: body.frame,
                    reach: reach * extent * body.frame.scale(),
                }
            })
            .collect();
        let gaps = gaps(&placed)?;
        gaps.iter().try_for_each(|gap| gap.check(0.0))?;
        Ok(gaps)
    }

    fn check_wrenches(&self) -> Result<(), SuspensionError> {
        for (index, body) in self.bodies.iter().enumerate() {
            let Motion::Free(Wrench { force, torque }) = body.motion else {
                continue;
            };
            let mut components = force.iter().chain(torque.iter());
            if let Some(&value) = components.find(|x| !x.is_finite()) {
                return Err(SuspensionError::Wrench { body: index, value });
            }
        }
        Ok(())
    }

    /// Bytes that everything may take.
    fn memory(&self) -> usize {
        self.options.memory.unwrap_or_else(default_memory)
    }

    /// Refuses questions that make no sense.
    fn check_question(&self, tolerance: f64) -> Result<(), SuspensionError> {
        if !(SMALLEST_TOLERANCE..1.0).contains(&tolerance) {
            return Err(SuspensionError::Tolerance(tolerance));
        }
        if self.formulation == Formulation::InteriorDoubleLayer {
            return Err(SuspensionError::Interior);
        }
        self.check_wrenches()
    }

    fn kinds(&self, resolutions: &[Arc<Resolution>]) -> Result<Vec<Kind>, SuspensionError> {
        if self.bodies.is_empty() {
            return Err(SuspensionError::Empty);
        }
        let kinds = self.bodies.iter().zip(resolutions);
        Ok(kinds
            .map(|(body, resolution)| Kind {
                curve: body.curve.clone(),
                resolution: resolution.clone(),
                role: match body.motion {
                    Motion::Given(_) => Role::Held(self.formulation),
                    Motion::Free(_) => Role::Free,
                },
            })
            .collect())
    }

    fn care(&self, tolerance: f64, memory: usize) -> Care {
        let residual = self.options.residual.unwrap_or(RESIDUAL * tolerance);
        Care {
            residual: residual.max(LEAST),
            product: (PRODUCT * tolerance).min(0.4 * residual).max(LEAST),
            memory,
        }
    }

    /// One solution, and by how much it is off.
    fn round(
        &self,
        kinds: &[Kind],
        tolerance: f64,
        known: &Classes,
        before: Option<&Solution>,
        operators: &Operators,
        progress: &dyn Progress,
    ) -> Result<Round, SuspensionError> {
        let rest = self
            .memory()
            .saturating_sub(needed_memory(kinds, &self.options));
        let care = self.care(tolerance, rest);
        let (solution, imposed) = solve(self, kinds, care, known, before, operators, progress)?;
        let Iteration {
            iterations,
            residual,
            stop,
            ..
        } = solution.iteration;
        if stop != Stop::Converged
            && (stop == Stop::Breakdown || residual > STALLED * care.residual)
        {
            return Err(SuspensionError::NotConverged {
                iterations,
                residual,
                wanted: care.residual,
                stop,
            });
        }
        let start = Instant::now();
        let misses = misses(self, &solution, care.product, operators, progress)?;
        let speed = self.largest_speed(&solution, imposed);
        let error_estimate = self.error_estimate(&solution, &misses, speed);
        Ok(Round {
            solution,
            misses,
            error_estimate,
            speed,
            estimate: start.elapsed().as_secs_f64(),
        })
    }

    /// Of what is imposed, and of free bodies.
    fn largest_speed(&self, solution: &Solution, imposed: f64) -> f64 {
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
        speeds.fold(imposed, f64::max)
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
        let mut scale = 0.0f64;
        for (i, body) in self.bodies.iter().enumerate() {
            if let Motion::Given(_) = body.motion {
                let size = body.frame.scale() * solution.classes.of(i).tables.discretization.size();
                let wrench = body.frame.wrench_to_lab(solution.wrenches[i]);
                let found = wrench.force.norm().max(wrench.torque.norm() / size);
                force = force.max(6.0 * PI * size * misses[i].largest);
                scale = scale.max(found).max(SMALL * 6.0 * PI * size * speed);
            }
        }
        let forces = if force == 0.0 { 0.0 } else { force / scale };
        SAFETY * velocities.max(forces) + ROUNDING
    }

    fn answer(
        &self,
        round: Round,
        tolerance: f64,
        work: Work,
        begin: Instant,
        progress: &dyn Progress,
    ) -> Result<Answer, SuspensionError> {
        let Round {
            solution,
            misses,
            error_estimate,
            speed,
            estimate,
        } = round;
        let bodies = self.bodies.iter().enumerate().map(|(i, body)| {
            let class = solution.classes.of(i);
            let frame = &body.frame;
            let volume = frame.scale().powi(2);
            let of_shape = stresslet(&class.tables.discretization, &solution.layers[i]);
            BodyAnswer {
                motion: match body.motion {
                    Motion::Given(motion) => motion,
                    Motion::Free(_) => frame.motion_to_lab(solution.motions[i]),
                },
                wrench: match body.motion {
                    Motion::Given(_) => frame.wrench_to_lab(solution.wrenches[i]),
                    Motion::Free(wrench) => wrench,
                },
                stresslet: volume * frame.tensor_to_lab(&of_shape),
                boundary_error: misses[i].largest,
                resolution: (*class.kind.resolution).clone(),
            }
        });
        let flow = SuspensionFlow {
            bodies: (self.bodies.iter().enumerate())
                .map(|(i, body)| BodyLayers {
                    frame: body.frame,
                    discretization: solution.classes.of(i).tables.discretization.clone(),
                    layers: solution.layers[i].clone(),
                })
                .collect(),
            background: self.background,
        };
        let start = Instant::now();
        let targets = if self.targets.is_empty() {
            Vec::new()
        } else {
            flow.evaluate(
                self.targets,
                evaluation_tolerance(Some(tolerance)),
                progress,
            )?
        };
        let evaluate = start.elapsed().as_secs_f64();
        let seconds = solution.seconds;
        let own = seconds.assemble
            + seconds.factor
            + seconds.near
            + seconds.iterate
            + evaluate
            + estimate;
        Ok(Answer {
            bodies: bodies.collect(),
            targets,
            flow,
            error_estimate,
            largest_speed: speed,
            iterations: work.iterations,
            products: work.products,
            unknowns: solution.unknowns,
            points: solution.points,
            near: (solution.near_points, solution.near_bytes),
            classes: solution.classes.len(),
            iteration: solution.iteration,
            timings: Timings {
                assemble: seconds.assemble,
                factor: seconds.factor,
                near: seconds.near,
                iterate: seconds.iterate,
                sum: seconds.sum,
                evaluate,
                estimate,
                refine: begin.elapsed().as_secs_f64() - own,
            },
        })
    }
}

/// Bytes that solving takes beside the rows of near points: factors and point sums of each kind and of its finer surface, and for
/// every point what the fast sum and the vectors of the iteration take.
fn needed_memory(kinds: &[Kind], options: &Options) -> usize {
    let mut distinct: Vec<&Kind> = Vec::new();
    let mut points = 0;
    for kind in kinds {
        points += kind.points();
        if !distinct.contains(&kind) {
            distinct.push(kind);
        }
    }
    let entries: f64 = distinct.iter().map(|kind| kind.entries()).sum();
    let vectors = match options.method {
        Method::Gmres { restart } => restart.min(VECTORS) + 8,
        Method::BiCgStab => 12,
    };
    (8.0 * MATRICES * entries) as usize + points * (SUM_BYTES + 24 * vectors)
}

/// Matrices in memory, in matrices of one kind: factors, point sums, and those of the check.
const MATRICES: f64 = 5.0;
/// Bytes that a fast sum takes for each point of a finer surface, by each point of the surface itself.
const SUM_BYTES: usize = 4000;
/// Vectors that an iteration keeps as a rule.
const VECTORS: usize = 25;

fn gibibytes(bytes: usize) -> f64 {
    bytes as f64 / f64::from(1 << 30)
}

/// Seven tenths of what the machine has.
fn default_memory() -> usize {
    let mut system = sysinfo::System::new();
    system.refresh_memory();
    (system.total_memory() as f64 * 0.7) as usize
}

/// The distance of the farthest point of a curve from the origin, or nearly.
fn extent(curve: &dyn GeneratingCurve) -> f64 {
    let ends = curve.breakpoints();
    let (first, last) = (ends[0], ends[ends.len() - 1]);
    let far = (0..=64).map(|k| {
        let point = curve.point(first + (last - first) * f64::from(k) / 64.0);
        point.r.hypot(point.z)
    });
    far.fold(0.0, f64::max)
}

/// Where to begin.
pub(crate) struct Start {
    kinds: Vec<Kind>,
    /// What is factored already, and the operators of sums.
    known: Classes,
    operators: Operators,
}

/// Where it ended.
pub(crate) struct Converged {
    pub best: Round,
    operators: Operators,
    work: Work,
}

/// Iterations and products made.
#[derive(Clone, Copy, Debug, Default)]
struct Work {
    iterations: usize,
    products: usize,
}

impl Work {
    /// With those of one more iteration.
    fn and(self, iteration: &Iteration) -> Self {
        Self {
            iterations: self.iterations + iteration.iterations,
            products: self.products + iteration.products,
        }
    }
}

impl Converged {
    /// To go on with the next question about the same bodies.
    pub fn into_start(self) -> Start {
        let classes = self.best.solution.classes;
        let kinds = (0..self.best.solution.layers.len()).map(|body| classes.of(body).kind.clone());
        Start {
            kinds: kinds.collect(),
            known: classes,
            operators: self.operators,
        }
    }
}

/// A solution with what is known of its error.
#[derive(Clone, Debug)]
pub(crate) struct Round {
    pub solution: Solution,
    misses: Vec<Miss>,
    pub error_estimate: f64,
    speed: f64,
    estimate: f64,
}
