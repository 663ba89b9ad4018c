//! Exterior problems on one body, answered with an estimate of the error.
//!
//! On the surface the velocity is $U + \Omega \times x + u_s$, in a fluid that would flow with $u_\infty$ were the body not there. The rigid
//! motion is given or, for a free body, found from force and torque; the slip $u_s$ is any function. A squirmer, say, swims with
//! two thirds of its first mode:
//!
//! ```
//! use axistokes::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let slip = squirmer(&[1.5, 3.0]);
//! let problem = Problem {
//!     motion: Motion::Free(Wrench::zero()),
//!     slip: Some(&slip),
//!     ..Problem::new(std::sync::Arc::new(Spheroid::sphere(1.0)?))
//! };
//! let answer = problem.to_tolerance(1e-10, &Silent)?;
//! assert!((answer.motion.velocity.z - 1.0).abs() < 1e-10);
//! # Ok(())
//! # }
//! ```

use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Instant;

use nalgebra::{Matrix3, Point3, Vector3};
use panel_quadrature::QuadratureError;

use super::body_flow::BodyFlow;
use super::dirichlet::{DirichletSolver, Formulation};
use super::discretization::Discretization;
use super::factors::Seconds;
use super::flow::FlowError;
use super::layers::Layers;
use super::linear_flow::{self, LinearFlow};
use super::mobility::MobilitySolver;
use super::refinement::{
    EXTRA_ORDER, ORDER, Round, error_estimate, first_panels, refine, unresolved_panels,
};
use super::surface::SurfaceModes;
use crate::kernel::FlowAt;
use crate::progress::Progress;
use bodies_of_revolution::{CurveError, GeneratingCurve, Panels};
use bodies_of_revolution::{RigidMotion, Wrench};

/// What is known of a body's rigid motion, in its own frame and about its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The motion itself.
    Given(RigidMotion),
    /// The force and torque exerted on the body from outside, which it hands on to the fluid.
    Free(Wrench),
}

/// A velocity of the surface, as a function of the point on it, in the body's frame.
pub type Slip<'a> = &'a (dyn Fn(Vector3<f64>) -> Vector3<f64> + Sync);

/// A question about one body, in its own frame and for viscosity 1.
#[derive(Clone)]
pub struct Problem<'a> {
    /// The generating curve.
    pub curve: Arc<dyn GeneratingCurve>,
    /// How the body moves, or what moves it.
    pub motion: Motion,
    /// The velocity of the surface relative to the rigid motion, if there is any: what a swimmer does, or any boundary values.
    pub slip: Option<Slip<'a>>,
    /// The undisturbed flow.
    pub background: LinearFlow,
    /// Points outside the body where the flow is wanted.
    pub targets: &'a [Point3<f64>],
    /// The equation for a given motion; an exterior one. A free body always has that of [`mobility`](super::mobility).
    pub formulation: Formulation,
}

/// A resolution: how finely curve and azimuth are discretised.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolution {
    /// Panels on the generating curve.
    pub panels: Panels,
    /// Gauss–Legendre nodes on each panel.
    pub order: usize,
    /// Azimuthal modes kept: the density's Fourier series ends with this one.
    pub modes: usize,
}

/// The answer to a [`Problem`].
#[derive(Clone, Debug)]
pub struct Answer {
    /// The rigid motion about the origin: the one given, or the one found.
    pub motion: RigidMotion,
    /// Force and torque about the origin that the body exerts on the fluid.
    pub wrench: Wrench,
    /// Velocity and pressure at the targets, background included.
    pub flow: Vec<FlowAt>,
    /// Everything that the flow is made of.
    pub body_flow: BodyFlow,
    /// The same of the solution that checks it.
    check: BodyFlow,
    /// Estimated error: of the velocities at the targets relative to [`largest_speed`](Self::largest_speed), and of what was found of
    /// force and torque or of the rigid motion relative to the larger of the two (a force times the body's size, half its largest
    /// extent, counting as torque, an angular velocity times that as velocity).
    ///
    /// Forces and rigid velocities may vanish by symmetry: below a hundredth of $6\pi$ times size and largest speed, and below a
    /// hundredth of the largest speed, they count relative to that.
    pub error_estimate: f64,
    /// Estimated absolute errors of what the other estimate does not cover.
    pub further_errors: FurtherErrors,
    /// The resolution it was computed with.
    pub resolution: Resolution,
    /// Unknowns of all modes.
    pub unknowns: usize,
    /// The largest speed on the surface, of what is imposed (rigid motion and slip together, or the background) and of a free body's
    /// motion.
    pub largest_speed: f64,
    /// How long things took.
    pub timings: Timings,
}

/// Estimated absolute errors, for viscosity 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FurtherErrors {
    /// Of the pressures at the targets.
    pub pressure: f64,
    /// Of the stresslet, in the Frobenius norm.
    pub stresslet: f64,
}

/// Wall-clock seconds: the stages of the reported solution, and everything else together.
#[derive(Clone, Copy, Debug, Default)]
pub struct Timings {
    /// Assembling the matrices.
    pub assemble: f64,
    /// Factoring them.
    pub factor: f64,
    /// Solving for the density.
    pub solve: f64,
    /// Evaluating the flow at the targets.
    pub evaluate: f64,
    /// Choosing the resolution and estimating the error.
    pub estimate: f64,
}

/// Why a problem has no answer.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// The curve cannot be divided into panels as asked.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The flow cannot be evaluated at a target.
    #[error(transparent)]
    Flow(#[from] FlowError),
    /// There is no quadrature of the order asked for.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
    /// The body and its velocity would take more memory than the solver takes by itself.
    #[error(
        "a tolerance of {tolerance:e} would start with {panels} panels and {modes} modes, {gigabytes:.0} GB of matrices: expected a larger tolerance, or panels and modes by hand"
    )]
    Large {
        /// The tolerance asked for.
        tolerance: f64,
        /// Panels to start with.
        panels: usize,
        /// Modes of the velocity.
        modes: usize,
        /// Memory of the matrices.
        gigabytes: f64,
    },
    /// Whoever waited has lost interest.
    #[error("interrupted")]
    Interrupted,
    /// The velocity imposed is not finite somewhere on the surface.
    #[error("the velocity imposed on the surface is not finite everywhere")]
    Velocity,
}

/// Largest number of modes the solver chooses.
const MOST_MODES: usize = 400;
/// Most entries of all matrices that the solver chooses by itself: 8 GB.
const MOST_ENTRIES: f64 = 1e9;
/// Forces and rigid velocities below this part of what the largest speed would make them count as if they were that large.
const SMALL: f64 = 1e-2;
/// Tolerance of the flow's quadrature where the best is wanted.
const EVALUATION: f64 = 1e-15;

/// Tolerance of the flow's quadrature for an answer to a tolerance, or the best there is.
pub fn evaluation_tolerance(tolerance: Option<f64>) -> f64 {
    (1e-3 * tolerance.unwrap_or(0.0)).max(EVALUATION)
}

/// Entries of all the matrices that are in memory at once for a resolution: those of the solution it is checked with.
pub fn matrix_entries(panels: usize, order: usize, modes: usize) -> f64 {
    entries_of_check(panels, order, checking_modes(modes) + 1)
}

/// The same for a number of matrices of the check.
fn entries_of_check(panels: usize, order: usize, matrices: usize) -> f64 {
    let unknowns = (3 * panels * (order + EXTRA_ORDER)) as f64;
    unknowns * unknowns * matrices as f64
}

/// Modes of the solution that checks one of so many.
pub fn checking_modes(modes: usize) -> usize {
    modes + 8.max(modes / 4)
}

/// What a solution and the one that checks it do with different care, so that the error made there shows in the difference.
#[derive(Clone, Copy)]
struct Care {
    /// Tolerance of the flow's quadrature.
    evaluation: f64,
    /// Modes that the samples of the slip determine, over those kept: what the others alias is left in.
    oversampling: f64,
}

/// One solution, with what it takes to compare it with another.
///
/// The factors are not kept: two solutions are alive at a time, and the factors are most of what they would hold.
struct Solution {
    body_flow: BodyFlow,
    wrench: Wrench,
    flow: Vec<FlowAt>,
    largest_speed: f64,
    unknowns: usize,
    seconds: Seconds,
    solve: f64,
    evaluate: f64,
}

impl<'a> Problem<'a> {
    /// A body held still in a fluid at rest: nothing happens until fields are changed, `Problem { motion, ..Problem::new(curve) }`.
    pub fn new(curve: Arc<dyn GeneratingCurve>) -> Self {
        Self {
            curve,
            motion: Motion::Given(RigidMotion::rest()),
            slip: None,
            background: LinearFlow::rest(),
            targets: &[],
            formulation: Formulation::CombinedField,
        }
    }

    /// The answer at a given resolution.
    ///
    /// # Errors
    /// If a target is not finite, the velocity imposed is not, or there is no quadrature of that order.
    pub fn at_resolution(
        &self,
        resolution: Resolution,
        progress: &dyn Progress,
    ) -> Result<Answer, ProblemError> {
        Ok(self.checked(resolution, None, progress)?.answer)
    }

    /// The answer to a tolerance: the first resolution found whose error estimate is below it, or the best there is; compare
    /// [`Answer::error_estimate`] with the tolerance.
    ///
    /// # Errors
    /// If a target is not finite, the velocity imposed is not, or the curve is not smooth enough.
    pub fn to_tolerance(
        &self,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Answer, ProblemError> {
        let begin = Instant::now();
        let first = first_panels(&*self.curve, tolerance)?;
        let modes = self.modes_for(&first, tolerance)?;
        let entries = self.entries(first.len(), modes);
        if entries > MOST_ENTRIES {
            return Err(ProblemError::Large {
                tolerance,
                panels: first.len(),
                modes,
                gigabytes: 8e-9 * entries,
            });
        }
        let affordable = |panels: usize| self.entries(panels, modes) <= MOST_ENTRIES;
        let best = refine(&*self.curve, first, tolerance, affordable, |panels| {
            let resolution = Resolution {
                panels,
                order: ORDER,
                modes,
            };
            self.checked(resolution, Some(tolerance), progress)
        })?;
        let mut answer = best.answer;
        let spent = begin.elapsed().as_secs_f64();
        answer.timings.estimate = spent - answer.timings.own();
        Ok(answer)
    }

    /// The solution at a resolution with its estimated error; without a tolerance everything at its best.
    fn checked(
        &self,
        resolution: Resolution,
        tolerance: Option<f64>,
        progress: &dyn Progress,
    ) -> Result<Round<Answer>, ProblemError> {
        let care = Care {
            evaluation: evaluation_tolerance(tolerance),
            oversampling: 1.5,
        };
        let solution = self.solve(&resolution, care, progress)?;
        let start = Instant::now();
        let finer = Resolution {
            order: resolution.order + EXTRA_ORDER,
            modes: self.modes_of_check(resolution.modes),
            panels: resolution.panels.clone(),
        };
        let care = Care {
            evaluation: EVALUATION,
            oversampling: 2.5,
        };
        let check = self.solve(&finer, care, progress)?;
        let difference = solution.difference(&check);
        let BodyFlow {
            discretization,
            layers,
            ..
        } = &solution.body_flow;
        let error_estimate = error_estimate(discretization, difference);
        let further_errors = solution.further_errors(&check);
        // A free body's single layer is a rigid motion: there is nothing to resolve.
        let density = match self.formulation {
            Formulation::SingleLayer => &layers.single,
            _ => &layers.double,
        };
        let unresolved = unresolved_panels(discretization, &[density])?;
        let errors = (error_estimate, further_errors);
        let spent = start.elapsed().as_secs_f64();
        Ok(Round {
            panels: resolution.panels.clone(),
            unresolved,
            error_estimate,
            answer: solution.answer(check.body_flow, resolution, errors, spent),
        })
    }

    fn solve(
        &self,
        resolution: &Resolution,
        care: Care,
        progress: &dyn Progress,
    ) -> Result<Solution, ProblemError> {
        if progress.is_cancelled() {
            return Err(ProblemError::Interrupted);
        }
        let discretization = self.discretization(&resolution.panels, resolution.order)?;
        let background = self.background.on(&discretization);
        let (slip, fastest) =
            self.slip_and_speed(&discretization, resolution.modes, care.oversampling);
        let imposed = fastest.max(background.largest);
        if !imposed.is_finite() {
            return Err(ProblemError::Velocity);
        }
        let data = slip.clone().plus(-1.0, &background.modes);
        let Disturbance {
            motion,
            wrench,
            layers,
            unknowns,
            seconds,
            solve,
        } = match self.motion {
            Motion::Given(motion) => {
                self.of_given_motion(motion, &discretization, data, resolution.modes, progress)
            }
            Motion::Free(wrench) => free(wrench, &discretization, data, resolution.modes, progress),
        }?;
        let largest_speed = match self.motion {
            Motion::Given(_) => imposed,
            Motion::Free(_) => imposed.max(largest_speed(&motion, &discretization)),
        };
        let start = Instant::now();
        let body_flow = BodyFlow {
            discretization,
            layers,
            background: self.background,
            motion,
            slip,
        };
        if progress.is_cancelled() {
            return Err(ProblemError::Interrupted);
        }
        let flow = body_flow.evaluate(self.targets, care.evaluation, progress)?;
        Ok(Solution {
            body_flow,
            wrench,
            flow,
            largest_speed,
            unknowns,
            seconds,
            solve,
            evaluate: start.elapsed().as_secs_f64(),
        })
    }

    /// What a body of given motion does, `data` being its slip less the background.
    fn of_given_motion(
        &self,
        motion: RigidMotion,
        discretization: &Discretization,
        data: SurfaceModes,
        modes: usize,
        progress: &dyn Progress,
    ) -> Result<Disturbance, QuadratureError> {
        let solver =
            DirichletSolver::new(discretization.clone(), self.formulation, modes, progress)?;
        let start = Instant::now();
        let density =
            solver.solve(&SurfaceModes::of_motion(discretization, &motion).plus(1.0, &data));
        Ok(Disturbance {
            motion,
            wrench: solver.wrench(&density),
            layers: Layers::weighted(&density, solver.weights()),
            unknowns: solver.unknowns(),
            seconds: solver.seconds(),
            solve: start.elapsed().as_secs_f64(),
        })
    }

    fn discretization(
        &self,
        panels: &Panels,
        order: usize,
    ) -> Result<Discretization, QuadratureError> {
        Discretization::new(self.curve.clone(), panels.clone(), order)
    }

    /// The slip, and the largest speed of given motion and slip together; infinite if the slip is not finite.
    fn slip_and_speed(
        &self,
        discretization: &Discretization,
        modes: usize,
        oversampling: f64,
    ) -> (SurfaceModes, f64) {
        let motion = match self.motion {
            Motion::Given(motion) => motion,
            Motion::Free(_) => RigidMotion::rest(),
        };
        match self.slip {
            Some(slip) => {
                let most = (oversampling * modes as f64) as usize;
                let whole = SurfaceModes::sample(discretization, most, |x| motion.at(x) + slip(x));
                let slip = whole.modes.truncated(modes.max(1));
                (
                    slip.plus(-1.0, &SurfaceModes::of_motion(discretization, &motion)),
                    whole.largest,
                )
            }
            None => (
                SurfaceModes::zero(0, discretization.nodes().len()),
                largest_speed(&motion, discretization),
            ),
        }
    }

    /// The last mode of rigid motions and the background, which are known exactly.
    fn last_exact_mode(&self) -> usize {
        if self.background.gradient == Matrix3::zeros() {
            1
        } else {
            linear_flow::LAST_MODE
        }
    }

    /// Modes of the solution that checks one of so many.
    fn modes_of_check(&self, modes: usize) -> usize {
        match self.slip {
            Some(_) => checking_modes(modes),
            None => self.last_exact_mode(),
        }
    }

    /// Matrix entries for so many panels and modes where the solver chooses.
    fn entries(&self, panels: usize, modes: usize) -> f64 {
        let single = match self.motion {
            Motion::Given(_) => 0,
            Motion::Free(_) => 2,
        };
        entries_of_check(panels, ORDER, self.modes_of_check(modes) + 1 + single)
    }

    /// The modes that the boundary velocity needs to the tolerance.
    pub fn modes_for(&self, panels: &Panels, tolerance: f64) -> Result<usize, ProblemError> {
        let least = self.last_exact_mode();
        let Some(slip) = self.slip else {
            return Ok(least);
        };
        let discretization = self.discretization(panels, ORDER)?;
        let mut modes = 32;
        loop {
            let sampled = SurfaceModes::sample(&discretization, modes, slip);
            if !sampled.largest.is_finite() {
                return Err(ProblemError::Velocity);
            }
            let small = 0.1 * tolerance * sampled.largest;
            let last = (0..=modes)
                .rev()
                .find(|&n| sampled.modes.amplitude(n) > small)
                .unwrap_or(0);
            if last < modes - modes / 8 || modes >= MOST_MODES {
                return Ok(last.max(least));
            }
            modes = (2 * modes).min(MOST_MODES);
        }
    }
}

/// What a body adds to the undisturbed flow, and how it moves.
struct Disturbance {
    motion: RigidMotion,
    wrench: Wrench,
    layers: Layers,
    unknowns: usize,
    seconds: Seconds,
    solve: f64,
}

/// What a body that hands on a force and torque does, `data` being its slip less the background.
fn free(
    wrench: Wrench,
    discretization: &Discretization,
    data: SurfaceModes,
    modes: usize,
    progress: &dyn Progress,
) -> Result<Disturbance, QuadratureError> {
    let solver = MobilitySolver::new(discretization.clone(), modes, progress)?;
    let start = Instant::now();
    let (motion, layers) = solver.solve(wrench, data);
    Ok(Disturbance {
        motion,
        wrench,
        layers,
        unknowns: solver.unknowns(),
        seconds: solver.seconds(),
        solve: start.elapsed().as_secs_f64(),
    })
}

/// The largest speed on the surface in a rigid motion; the azimuths that are looked at are near enough to the fastest.
fn largest_speed(motion: &RigidMotion, discretization: &Discretization) -> f64 {
    SurfaceModes::sample(discretization, 1, |x| motion.at(x)).largest
}

impl Solution {
    /// How far the answers of two solutions are apart, in the units of [`Answer::error_estimate`].
    fn difference(&self, other: &Self) -> f64 {
        let size = self.body_flow.discretization.size();
        let speed = other.largest_speed;
        let relative = |difference: f64, scale: f64| {
            if difference == 0.0 {
                0.0
            } else {
                difference / scale
            }
        };
        let flow = (self.flow.iter().zip(&other.flow))
            .map(|(a, b)| (a.velocity - b.velocity).norm())
            .fold(0.0, f64::max);
        let in_force = |wrench: Wrench| wrench.force.norm().max(wrench.torque.norm() / size);
        let in_velocity = |motion: RigidMotion| {
            motion
                .velocity
                .norm()
                .max(size * motion.angular_velocity.norm())
        };
        let wrench = relative(
            in_force(self.wrench - other.wrench),
            in_force(other.wrench).max(SMALL * 6.0 * PI * size * speed),
        );
        let motion = relative(
            in_velocity(self.body_flow.motion - other.body_flow.motion),
            in_velocity(other.body_flow.motion).max(SMALL * speed),
        );
        relative(flow, self.largest_speed).max(wrench).max(motion)
    }

    /// The errors that the solution which checks this one lets expect, with what rounding leaves.
    fn further_errors(&self, check: &Self) -> FurtherErrors {
        let discretization = &self.body_flow.discretization;
        let estimate = |difference, scale| absolute_error(discretization, difference, scale);
        let pressures = self.flow.iter().zip(&check.flow);
        let (difference, scale) =
            pressures.fold((0.0f64, 0.0f64), |(difference, scale), (a, b)| {
                let (off, size) = ((a.pressure - b.pressure).abs(), b.pressure.abs());
                (difference.max(off), scale.max(size))
            });
        let [a, b] = [self, check].map(|solution| solution.body_flow.stresslet());
        FurtherErrors {
            pressure: estimate(difference, scale),
            stresslet: estimate((a - b).norm(), b.norm()),
        }
    }

    fn answer(
        self,
        check: BodyFlow,
        resolution: Resolution,
        (error_estimate, further_errors): (f64, FurtherErrors),
        estimate: f64,
    ) -> Answer {
        let Seconds { assemble, factor } = self.seconds;
        let timings = Timings {
            assemble,
            factor,
            solve: self.solve,
            evaluate: self.evaluate,
            estimate,
        };
        Answer {
            motion: self.body_flow.motion,
            wrench: self.wrench,
            unknowns: self.unknowns,
            flow: self.flow,
            body_flow: self.body_flow,
            check,
            error_estimate,
            further_errors,
            resolution,
            largest_speed: self.largest_speed,
            timings,
        }
    }
}

/// The estimated error of a number about as large as `scale`, from how far the solution that checks it is off.
fn absolute_error(discretization: &Discretization, difference: f64, scale: f64) -> f64 {
    scale * error_estimate(discretization, difference / scale.max(f64::MIN_POSITIVE))
}

impl Answer {
    /// The estimated absolute error of [`BodyFlow::power`], for viscosity 1; with a slip it takes the tractions of the solution and of
    /// the one that checks it.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn power_error(&self) -> Result<f64, QuadratureError> {
        let (a, b) = (self.body_flow.power()?, self.check.power()?);
        let discretization = &self.body_flow.discretization;
        Ok(absolute_error(discretization, (a - b).abs(), b.abs()))
    }
}

impl Timings {
    /// The stages of the reported solution.
    fn own(&self) -> f64 {
        self.assemble + self.factor + self.solve + self.evaluate
    }
}
