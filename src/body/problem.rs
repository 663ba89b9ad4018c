//! Exterior Dirichlet problems on one body, answered with an estimate of the error.
//!
//! Every answer is computed twice: on the discretization asked for, and on one that has the same panels with more nodes on each,
//! more modes, and other quadrature for the near interactions. The difference between the two is the error of the coarser, which is
//! the one reported; where the coarser is not good enough the panels that resolve the density worst are bisected.

use std::f64::consts::PI;
use std::sync::Arc;
use std::time::Instant;

use nalgebra::{Point3, Vector3};
use panel_quadrature::QuadratureError;

use super::body_flow::BodyFlow;
use super::dirichlet::{DirichletSolver, Formulation, Seconds};
use super::discretization::Discretization;
use super::flow::FlowError;
use super::layers::Layers;
use super::linear_flow::LinearFlow;
use super::rigid::{RigidMotion, Wrench};
use super::surface::SurfaceModes;
use crate::curve::{CurveError, GeneratingCurve, Panels};
use crate::kernel::FlowAt;
use crate::progress::Progress;

/// The velocity imposed on the surface, in the body's frame.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub enum BoundaryVelocity<'a> {
    /// A rigid motion.
    Rigid(RigidMotion),
    /// Any velocity, as a function of the point on the surface.
    Field(&'a (dyn Fn(Vector3<f64>) -> Vector3<f64> + Sync)),
}

/// A question about one body, in its own frame and for viscosity 1.
#[derive(Clone)]
pub struct Problem<'a> {
    /// The generating curve.
    pub curve: Arc<dyn GeneratingCurve>,
    /// What the surface does.
    pub velocity: BoundaryVelocity<'a>,
    /// Points outside the body where the flow is wanted.
    pub targets: &'a [Point3<f64>],
    /// The equation; an exterior one.
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
    /// Force and torque about the origin that the body exerts on the fluid.
    pub wrench: Wrench,
    /// Velocity and pressure at the targets.
    pub flow: Vec<FlowAt>,
    /// The flow everywhere.
    pub body_flow: BodyFlow,
    /// Estimated error: of the velocities relative to the largest speed imposed, and of force and torque relative to the larger
    /// of the two (a force times the body's size counting as torque).
    pub error_estimate: f64,
    /// The resolution it was computed with.
    pub resolution: Resolution,
    /// Unknowns of all modes.
    pub unknowns: usize,
    /// The largest speed imposed.
    pub largest_speed: f64,
    /// How long things took.
    pub timings: Timings,
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
    /// The velocity imposed is not finite somewhere on the surface.
    #[error("the velocity imposed on the surface is not finite everywhere")]
    Velocity,
}

/// Nodes per panel where the solver chooses.
const ORDER: usize = 16;
/// Nodes per panel that the checking discretization has beyond the checked one's.
const EXTRA_ORDER: usize = 4;
/// How far the estimate stays above the difference: the checking solution has an error too.
const SAFETY: f64 = 2.0;
/// What rounding leaves even where the difference happens to vanish.
const ROUNDING: f64 = 4e-15;
/// Largest number of modes the solver chooses.
const MOST_MODES: usize = 400;
/// Most entries of all matrices that the solver chooses by itself: 8 GB.
const MOST_ENTRIES: f64 = 1e9;
/// Panels are bisected that miss this fraction of what the worst does.
const MARKED: f64 = 0.02;
/// Rounds of refinement.
const ROUNDS: usize = 24;

/// Entries of all the matrices that are in memory at once for a resolution: those of the solution it is checked with.
pub(crate) fn matrix_entries(panels: usize, order: usize, modes: usize) -> f64 {
    let unknowns = (3 * panels * (order + EXTRA_ORDER)) as f64;
    unknowns * unknowns * (checking_modes(modes) + 1) as f64
}

/// Modes of the solution that checks one of so many.
fn checking_modes(modes: usize) -> usize {
    modes + 8.max(modes / 4)
}

/// One solution, with what it takes to compare it with another.
///
/// The factors are not kept: two solutions are alive at a time, and the factors are most of what they would hold.
struct Solution {
    body_flow: BodyFlow,
    unknowns: usize,
    seconds: Seconds,
    density: SurfaceModes,
    wrench: Wrench,
    flow: Vec<FlowAt>,
    largest_speed: f64,
    solve: f64,
    evaluate: f64,
}

impl Problem<'_> {
    /// The answer at a given resolution.
    ///
    /// # Errors
    /// If a target is too near to the surface, or there is no quadrature of that order.
    pub fn at_resolution(
        &self,
        resolution: Resolution,
        progress: &dyn Progress,
    ) -> Result<Answer, ProblemError> {
        let solution = self.solve(&resolution, EVALUATION, progress)?;
        let start = Instant::now();
        let check = self.check(&resolution, EVALUATION, progress)?;
        let error = solution.error(&check);
        Ok(solution.answer(resolution, error, start.elapsed().as_secs_f64()))
    }

    /// The answer to a tolerance: the first resolution found whose error estimate is below it, or the best there is; compare
    /// [`Answer::error_estimate`] with the tolerance.
    ///
    /// # Errors
    /// If a target is too near to the surface for the tolerance, or the curve is not smooth enough.
    pub fn to_tolerance(
        &self,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Answer, ProblemError> {
        let begin = Instant::now();
        let evaluation = evaluation_tolerance(Some(tolerance));
        let first = Panels::resolving(&*self.curve, ORDER, tolerance.sqrt().clamp(1e-7, 1e-2))?
            .graded_across_joints(&*self.curve);
        let mut resolution = Resolution {
            panels: first,
            order: ORDER,
            modes: 1,
        };
        resolution.modes = self.modes_for(&resolution, tolerance)?;
        let entries = self.entries(resolution.panels.len(), resolution.modes);
        if entries > MOST_ENTRIES {
            return Err(ProblemError::Large {
                tolerance,
                panels: resolution.panels.len(),
                modes: resolution.modes,
                gigabytes: 8e-9 * entries,
            });
        }
        let mut best: Option<Answer> = None;
        let mut rounds_without_gain = 0;
        for _ in 0..ROUNDS {
            let solution = self.solve(&resolution, evaluation, progress)?;
            let check = self.check(&resolution, evaluation, progress)?;
            let error = solution.error(&check);
            let marked = solution.unresolved_panels()?;
            let spent = begin.elapsed().as_secs_f64();
            let own = solution.seconds();
            let answer = solution.answer(resolution.clone(), error, spent - own);
            let gain = best
                .as_ref()
                .is_none_or(|best| error < 0.5 * best.error_estimate);
            rounds_without_gain = if gain { 0 } else { rounds_without_gain + 1 };
            if best.as_ref().is_none_or(|best| error < best.error_estimate) {
                best = Some(answer);
            }
            if error <= tolerance || rounds_without_gain > 2 {
                break;
            }
            let panels = resolution
                .panels
                .bisected(|panel| marked[panel])
                .graded_across_joints(&*self.curve);
            if self.entries(panels.len(), resolution.modes) > MOST_ENTRIES {
                break;
            }
            resolution.panels = panels;
        }
        best.ok_or(ProblemError::Velocity)
    }

    /// Matrix entries for so many panels and modes where the solver chooses.
    fn entries(&self, panels: usize, modes: usize) -> f64 {
        match self.velocity {
            // Nothing but modes 0 and 1, in the check too.
            BoundaryVelocity::Rigid(_) => {
                2.0 * (3.0 * (panels * (ORDER + EXTRA_ORDER)) as f64).powi(2)
            }
            BoundaryVelocity::Field(_) => matrix_entries(panels, ORDER, modes),
        }
    }

    fn discretization(&self, resolution: &Resolution) -> Result<Discretization, QuadratureError> {
        Discretization::new(
            self.curve.clone(),
            resolution.panels.clone(),
            resolution.order,
        )
    }

    fn solve(
        &self,
        resolution: &Resolution,
        evaluation: f64,
        progress: &dyn Progress,
    ) -> Result<Solution, ProblemError> {
        let discretization = self.discretization(resolution)?;
        let (data, largest_speed) = self.data(&discretization, resolution.modes);
        if !largest_speed.is_finite() {
            return Err(ProblemError::Velocity);
        }
        let solver =
            DirichletSolver::new(discretization, self.formulation, resolution.modes, progress)?;
        let start = Instant::now();
        let density = solver.solve(&data);
        let (motion, slip) = match self.velocity {
            BoundaryVelocity::Rigid(motion) => (motion, SurfaceModes::zero(0, data.nodes())),
            BoundaryVelocity::Field(_) => (RigidMotion::rest(), data),
        };
        let body_flow = BodyFlow {
            discretization: solver.discretization().clone(),
            layers: Layers::weighted(&density, solver.weights()),
            background: LinearFlow::rest(),
            motion,
            slip,
        };
        let wrench = body_flow.wrench();
        let solve = start.elapsed().as_secs_f64();
        let start = Instant::now();
        progress.begin("evaluating", 0);
        let flow = body_flow.at(self.targets, evaluation)?;
        let evaluate = start.elapsed().as_secs_f64();
        Ok(Solution {
            body_flow,
            unknowns: solver.unknowns(),
            seconds: solver.seconds(),
            density,
            wrench,
            flow,
            largest_speed,
            solve,
            evaluate,
        })
    }

    /// The solution that a resolution is checked against.
    fn check(
        &self,
        resolution: &Resolution,
        evaluation: f64,
        progress: &dyn Progress,
    ) -> Result<Solution, ProblemError> {
        let modes = match self.velocity {
            // A rigid motion has no more.
            BoundaryVelocity::Rigid(_) => 1,
            BoundaryVelocity::Field(_) => checking_modes(resolution.modes),
        };
        let finer = Resolution {
            order: resolution.order + EXTRA_ORDER,
            modes,
            panels: resolution.panels.clone(),
        };
        self.solve(&finer, evaluation, progress)
    }

    /// Modes of the boundary velocity, and its largest speed at the nodes.
    fn data(&self, discretization: &Discretization, modes: usize) -> (SurfaceModes, f64) {
        match self.velocity {
            BoundaryVelocity::Rigid(motion) => {
                let data = motion.on(discretization);
                let speed = |node: &super::discretization::Node| {
                    // The fastest point of a ring lies where the azimuth of the motion is extreme; eight azimuths are near enough.
                    (0..8)
                        .map(|k| {
                            let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
                            motion
                                .at(Vector3::new(node.r * cos, node.r * sin, node.z))
                                .norm()
                        })
                        .fold(0.0, f64::max)
                };
                let largest = discretization.nodes().iter().map(speed).fold(0.0, f64::max);
                (data, largest)
            }
            BoundaryVelocity::Field(field) => {
                let sampled = SurfaceModes::sample(discretization, modes, field);
                (sampled.modes, sampled.largest)
            }
        }
    }

    /// The modes that the boundary velocity needs to the tolerance.
    fn modes_for(&self, resolution: &Resolution, tolerance: f64) -> Result<usize, ProblemError> {
        let BoundaryVelocity::Field(field) = self.velocity else {
            return Ok(1);
        };
        let discretization = self.discretization(resolution)?;
        let mut modes = 32;
        loop {
            let sampled = SurfaceModes::sample(&discretization, modes, field);
            if !sampled.largest.is_finite() {
                return Err(ProblemError::Velocity);
            }
            let small = 0.1 * tolerance * sampled.largest;
            let last = (0..=modes)
                .rev()
                .find(|&n| sampled.modes.amplitude(n) > small)
                .unwrap_or(0);
            if last < modes - modes / 8 || modes >= MOST_MODES {
                return Ok(last.max(1));
            }
            modes = (2 * modes).min(MOST_MODES);
        }
    }
}

/// Tolerance of the flow's quadrature where the best is wanted.
const EVALUATION: f64 = 1e-15;

/// Tolerance of the flow's quadrature for an answer to a tolerance, or the best there is.
pub(crate) fn evaluation_tolerance(tolerance: Option<f64>) -> f64 {
    (1e-3 * tolerance.unwrap_or(0.0)).max(EVALUATION)
}

impl Solution {
    fn seconds(&self) -> f64 {
        let Seconds { assemble, factor } = self.seconds;
        assemble + factor + self.solve + self.evaluate
    }

    /// The estimated error, from the solution that checks this one.
    fn error(&self, check: &Self) -> f64 {
        SAFETY * self.difference(check) + ROUNDING * self.thinness()
    }

    /// $A^2 / 12\pi a V$ for area, size and volume: 1 for a sphere and about that for a needle, but the aspect ratio of a disc, whose two
    /// faces nearly cancel and lose as many digits.
    fn thinness(&self) -> f64 {
        let nodes = self.body_flow.discretization.nodes();
        // The volume is a third of the flux of the position, x . nu.
        let flux: f64 = nodes
            .iter()
            .map(|n| n.weight * (n.r * n.normal[0] + n.z * n.normal[1]))
            .sum();
        let (area, size) = (
            self.body_flow.discretization.area(),
            self.body_flow.discretization.size(),
        );
        (area * area / (8.0 * PI * PI * size * flux)).max(1.0)
    }

    /// How far the answers of two solutions are apart, in the units of [`Answer::error_estimate`].
    fn difference(&self, other: &Self) -> f64 {
        let size = self.body_flow.discretization.size();
        let velocity = (self.flow.iter().zip(&other.flow))
            .map(|(a, b)| (a.velocity - b.velocity).norm())
            .fold(0.0, f64::max);
        let (a, b) = (self.wrench, other.wrench);
        let scale = b.force.norm().max(b.torque.norm() / size);
        let wrench = (a.force - b.force)
            .norm()
            .max((a.torque - b.torque).norm() / size);
        let relative = |difference: f64, scale: f64| {
            if difference == 0.0 {
                0.0
            } else {
                difference / scale
            }
        };
        relative(velocity, self.largest_speed).max(relative(wrench, scale))
    }

    /// Panels on which the density is resolved worst, by the last two of its Legendre coefficients there.
    ///
    /// The difference of two densities would not do: what one panel misses spreads over all.
    fn unresolved_panels(&self) -> Result<Vec<bool>, QuadratureError> {
        let order = self.body_flow.discretization.order();
        let mut missed = vec![0.0; self.body_flow.discretization.panels().len()];
        for n in 0..self.density.modes() {
            for k in 0..6 {
                let values = self.density.component(n, k / 3, k % 3);
                for (values, missed) in values.chunks(order).zip(&mut missed) {
                    let coefficients =
                        self.body_flow.discretization.basis().coefficients(values)?;
                    *missed += coefficients[order - 2..].iter().map(|c| c * c).sum::<f64>();
                }
            }
        }
        for (panel, missed) in missed.iter_mut().enumerate() {
            *missed *= self
                .body_flow
                .discretization
                .nodes_of(panel)
                .iter()
                .map(|n| n.weight)
                .sum::<f64>();
        }
        let most = missed.iter().copied().fold(0.0, f64::max);
        Ok(missed
            .into_iter()
            .map(|missed| missed >= MARKED * MARKED * most)
            .collect())
    }

    fn answer(self, resolution: Resolution, error_estimate: f64, estimate: f64) -> Answer {
        let Seconds { assemble, factor } = self.seconds;
        let timings = Timings {
            assemble,
            factor,
            solve: self.solve,
            evaluate: self.evaluate,
            estimate,
        };
        Answer {
            wrench: self.wrench,
            unknowns: self.unknowns,
            flow: self.flow,
            body_flow: self.body_flow,
            error_estimate,
            resolution,
            largest_speed: self.largest_speed,
            timings,
        }
    }
}
