//! The answer to a question about bodies.

use std::fmt;

use bodies_of_revolution::{RigidMotion, Wrench};
use inexact_krylov::Stop;
use nalgebra::Matrix3;
use stokes_body::kernel::FlowAt;
use stokes_body::resolution::Resolution;

use super::error::SuspensionError;
use super::flow::Flow;
use super::iteration::Iteration;
use super::solution::Start;
use super::surface::Surface;

/// One body's part of the answer, in the laboratory and about the body's centre.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BodyAnswer {
    /// The rigid motion: the one given, or the one found.
    pub motion: RigidMotion,
    /// Force and torque that the body exerts on the fluid.
    pub wrench: Wrench,
    /// The stresslet, for the viscosity $\mu$ of the question: the symmetric traceless part of
    /// $\int x f - \mu (u n + n u)\\, d\Gamma$ with the traction $f$ by the fluid on the body, the
    /// velocity $u$ of its surface and the normal $n$ into the fluid (Batchelor 1970). A rigid
    /// sphere of radius $a$ held in the rate of strain $E$ has $\frac{20}{3}\pi\mu a^3 E$.
    pub stresslet: Matrix3<f64>,
    /// By how much the velocity is off on its surface, at most; not known of a body alone, whose
    /// whole solution is compared with a finer one.
    pub boundary_error: Option<f64>,
    /// The resolution it was computed with.
    pub resolution: Resolution,
}

/// The answer on finer surfaces, to compare with.
#[derive(Clone, Debug)]
pub(crate) struct Finer {
    pub bodies: Vec<BodyAnswer>,
    pub probes: Vec<FlowAt>,
    pub flow: Flow,
}

/// The answer to a [`Suspension`](super::suspension::Suspension); it owns what it found.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Answer {
    /// Every body.
    pub bodies: Vec<BodyAnswer>,
    /// Velocity and pressure at the probes, undisturbed flow included.
    pub probes: Vec<FlowAt>,
    /// The flow, to be evaluated anywhere.
    pub flow: Flow,
    /// On finer surfaces, if that was needed to tell the error.
    pub(crate) finer: Option<Finer>,
    /// Estimated error: of velocities at the probes, and of the motions of many bodies, relative to
    /// [`largest_speed`](Self::largest_speed); of forces, and torques over sizes, relative to the
    /// largest of them; of the motion of a body alone relative to itself.
    ///
    /// Forces and motions may vanish by symmetry: below a hundredth of $6\pi$ times size and
    /// largest speed (for viscosity 1), and below a hundredth of the largest speed, they count
    /// relative to that.
    ///
    /// A body alone is solved for twice, on finer panels with more modes, too: the estimate is
    /// twice the difference, and what rounding leaves. For many bodies it is twice the largest
    /// velocity by which the boundary condition is missed on finer surfaces; where gaps are narrow
    /// small velocities go with large tractions, and then the equations are solved on those
    /// surfaces, too, and it is no less than three times the difference.
    pub error_estimate: f64,
    /// What the estimate was to be below, unless panels and modes were chosen by hand.
    pub tolerance: Option<f64>,
    /// The largest speed on the surfaces, of what is imposed and of the motions that were found.
    pub largest_speed: f64,
    /// How it was solved.
    pub statistics: Statistics,
    pub(crate) start: Start,
}

/// How an answer was found.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Statistics {
    /// How the last iteration went; a body alone has none.
    pub iteration: Iteration,
    /// Iterations of all solutions.
    pub iterations: usize,
    /// Products of all solutions.
    pub products: usize,
    /// Unknowns of all bodies and modes.
    pub unknowns: usize,
    /// Points of all surfaces.
    pub points: usize,
    /// Points so near another body that its sum over points is not accurate there.
    pub near_points: usize,
    /// Bytes of memory that were kept to put those points right.
    pub near_bytes: usize,
    /// How many different matrices were factored for the last solution: one for each shape,
    /// resolution, and kind of motion (held or free).
    pub classes: usize,
    /// Solutions, each finer than the one before.
    pub rounds: usize,
    /// How long things took, in all rounds together.
    pub timings: Timings,
}

/// Wall-clock seconds of all rounds; all but `sum` add up to the whole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Timings {
    /// Assembling the matrices of single bodies, and all else that belongs to shapes.
    pub assemble: f64,
    /// Factoring them.
    pub factor: f64,
    /// Finding points near other bodies, and what is needed for them.
    pub near: f64,
    /// Making right-hand sides, and iterating or substituting.
    pub iterate: f64,
    /// Of that, summing over points.
    pub sum: f64,
    /// Evaluating the flow at the probes.
    pub evaluate: f64,
    /// Estimating the error of every round.
    pub estimate: f64,
    /// The rest: gaps, the choice of resolutions, what is freed.
    pub other: f64,
}

impl Answer {
    /// The motions of all bodies.
    pub fn motions(&self) -> impl Iterator<Item = RigidMotion> + '_ {
        self.bodies.iter().map(|body| body.motion)
    }

    /// The surface of a body as points, with velocity, traction and pressure there; in the
    /// laboratory.
    ///
    /// # Errors
    /// If there is no such body, or a quadrature rule is missing.
    pub fn surface(&self, body: usize) -> Result<Surface, SuspensionError> {
        self.flow.surface(body)
    }

    /// Whether the equations were solved directly, without iteration.
    pub fn is_direct(&self) -> bool {
        self.bodies.len() == 1
    }

    /// Why the iteration ended.
    pub fn stop(&self) -> Stop {
        self.statistics.iteration.stop
    }
}

impl fmt::Display for Answer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bodies = self.bodies.len();
        write!(
            f,
            "{bodies} bodies, estimated error {:.1e}",
            self.error_estimate
        )
    }
}
