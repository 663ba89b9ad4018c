//! Exterior problems on many bodies, answered with an estimate of the error.
//!
//! Every body has a motion that is given (it is *held*) or a force and torque on it (it is *free*), and perhaps a slip, as for
//! [one body](stokes_body::problem); all are in one undisturbed flow. Held and free bodies may be mixed. On body $i$
//!
//! $$ \bigl(\tfrac12 + D_i + \eta_i S_i\bigr)\\, \sigma_i + \sum_{j \ne i} u_j = U_i + \Omega_i \times x + u_{s,i} - u_\infty \quad \text{(held)}, $$
//! $$ \bigl(\tfrac12 + D_i + P_i\bigr)\\, \sigma_i + S_i[\varrho_i] + \sum_{j \ne i} u_j = u_{s,i} - u_\infty \quad \text{(free)}, $$
//!
//! where $u_j$ is the flow of body $j$'s layers: $(D_j + \eta_j S_j)\sigma_j$, or $D_j\sigma_j + S_j\varrho_j$ with the density $\varrho_j$ of its force
//! and torque (see [`mobility`](stokes_body::mobility)).
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
//!     ..Body::new(sphere.clone(), Frame::along(Point3::new(0.0, 0.0, z), Vector3::z_axis()))
//! };
//! let answer = Suspension::new(vec![ball(0.0), ball(3.0)]).to_tolerance(1e-8, &Silent)?;
//! assert!(answer.error_estimate <= 1e-8);
//! let [lower, upper] = [0, 1].map(|i| answer.bodies[i].motion.velocity.z);
//! assert!((lower - upper).abs() < 1e-8 && lower < -1.4);
//! # Ok(())
//! # }
//! ```

use std::sync::Arc;
use std::time::Instant;

use nalgebra::{Matrix3, Point3};

use super::SuspensionError;
use super::assembly::Questions;
use super::check::Miss;
use super::class::{Classes, Kind, Role};
use super::flow::{BodyLayers, SuspensionFlow};
use super::rounds::{Converged, REACH, Round, Work};
use super::solution::{Iteration, Solution};
use super::sums::Operators;
use bodies_of_revolution::Frame;
use bodies_of_revolution::GeneratingCurve;
use bodies_of_revolution::{Gap, Placed, gaps};
use bodies_of_revolution::{RigidMotion, Wrench};
use inexact_krylov::Method;
use stokes_body::dirichlet::Formulation;
use stokes_body::kernel::FlowAt;
use stokes_body::linear_flow::LinearFlow;
pub use stokes_body::problem::Motion;
use stokes_body::problem::{Resolution, Slip, evaluation_tolerance};
use stokes_body::progress::Progress;
use stokes_body::stresslet::stresslet;

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

    /// The distance of its farthest point from its centre, or nearly.
    pub(crate) fn size(&self) -> f64 {
        extent(&*self.curve) * self.frame.scale()
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
            method: Method::Gmres { restart: 200 },
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
    /// The resolution it was computed with, in its [frame in the flow](BodyLayers::frame): where resolutions are chosen, spheres without slip
    /// look at their nearest neighbour.
    pub resolution: Resolution,
}

/// The same answer on finer surfaces.
#[derive(Clone, Debug)]
pub(crate) struct Finer {
    pub bodies: Vec<BodyAnswer>,
    pub flow: SuspensionFlow,
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
    /// On finer surfaces, if that was needed to tell the error.
    pub(crate) finer: Option<Finer>,
    /// Estimated error: of velocities at the targets and of rigid velocities relative to [`largest_speed`](Self::largest_speed), and of forces, and
    /// torques over sizes, relative to the largest of them or, where that vanishes, to a hundredth of $6\pi$ times size and largest speed.
    ///
    /// It is twice the largest velocity by which the boundary condition is missed on finer surfaces. Where gaps are narrow small velocities go with
    /// large tractions; then the equations are solved on those surfaces, too, and it is no less than three times the difference.
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

/// The smallest tolerance that doubles can serve.
const SMALLEST_TOLERANCE: f64 = 1e-14;

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
        let gaps = self.gaps(REACH, progress)?;
        let kinds = self.kinds(resolutions)?;
        self.check_memory(&kinds, Questions::One, "panels, order and modes by hand")?;
        let (known, operators) = (Classes::default(), Operators::default());
        let mut assembly = self.assemble(
            &kinds,
            tolerance,
            Questions::One,
            &known,
            &operators,
            progress,
        )?;
        let look_at = if self.is_narrow(&gaps) {
            f64::INFINITY
        } else {
            0.0
        };
        let round = self.round(&mut assembly, None, look_at, progress)?;
        drop(assembly);
        let work = Work::default().and(&round);
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
        self.check_question(tolerance)?;
        let (arranged, gaps) = self.arranged(progress)?;
        let start = arranged.start(&gaps, tolerance, Questions::One)?;
        let Converged { best, work, .. } =
            arranged.converge(start, tolerance, Questions::One, progress)?;
        arranged.answer(best, tolerance, work, begin, progress)
    }

    /// How far the bodies are apart whose gap is below `reach` sizes; an error if any are not.
    pub(crate) fn gaps(
        &self,
        reach: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<Gap>, SuspensionError> {
        progress.begin("gaps", 0);
        let placed: Vec<Placed<'_>> = (self.bodies.iter())
            .map(|body| Placed {
                curve: &*body.curve,
                frame: body.frame,
                reach: reach * body.size(),
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

    /// Refuses questions that make no sense.
    pub(crate) fn check_question(&self, tolerance: f64) -> Result<(), SuspensionError> {
        if self.bodies.is_empty() {
            return Err(SuspensionError::Empty);
        }
        if !(SMALLEST_TOLERANCE..1.0).contains(&tolerance) {
            return Err(SuspensionError::Tolerance(tolerance));
        }
        if self.formulation == Formulation::InteriorDoubleLayer {
            return Err(SuspensionError::Interior);
        }
        self.check_wrenches()
    }

    pub(crate) fn kinds(
        &self,
        resolutions: &[Arc<Resolution>],
    ) -> Result<Vec<Kind>, SuspensionError> {
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
            finer,
            error_estimate,
            speed,
            seconds: estimate,
        } = round;
        let flow = self.flow_of(&solution);
        let start = Instant::now();
        let targets = self.at_targets(&flow, tolerance, progress)?;
        let evaluate = start.elapsed().as_secs_f64();
        let finer = finer.map(|finer| Finer {
            bodies: self.bodies_of(&finer, &misses),
            flow: self.flow_of(&finer),
        });
        let bodies = self.bodies_of(&solution, &misses);
        let seconds = solution.seconds;
        let own = seconds.assemble
            + seconds.factor
            + seconds.near
            + seconds.iterate
            + evaluate
            + estimate;
        Ok(Answer {
            bodies,
            targets,
            flow,
            finer,
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

    fn bodies_of(&self, solution: &Solution, misses: &[Miss]) -> Vec<BodyAnswer> {
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
        bodies.collect()
    }

    pub(crate) fn at_targets(
        &self,
        flow: &SuspensionFlow,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<FlowAt>, SuspensionError> {
        if self.targets.is_empty() {
            return Ok(Vec::new());
        }
        let tolerance = evaluation_tolerance(Some(tolerance));
        flow.evaluate(self.targets, tolerance, progress)
    }

    pub(crate) fn flow_of(&self, solution: &Solution) -> SuspensionFlow {
        SuspensionFlow {
            bodies: (self.bodies.iter().enumerate())
                .map(|(i, body)| BodyLayers {
                    frame: body.frame,
                    discretization: solution.classes.of(i).tables.discretization.clone(),
                    layers: solution.layers[i].clone(),
                })
                .collect(),
            background: self.background,
        }
    }
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
