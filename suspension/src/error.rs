//! Why a suspension has no answer. Messages name a body as a program does, `bodies[0]`.

use bodies_of_revolution::{ContactError, CurveError};
use inexact_krylov::Stop;
use panel_quadrature::QuadratureError;
use stokes_body::flow::FlowError;
use stokes_fmm::FmmError;

use super::interactions::InteractionError;

/// Why a suspension has no answer.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SuspensionError {
    /// There are no bodies.
    #[error("no bodies: expected at least one")]
    Empty,
    /// A curve cannot be divided into panels.
    #[error("bodies[{body}]: {error}")]
    Curve {
        /// The first body of that shape.
        body: usize,
        /// Why.
        error: CurveError,
    },
    /// Bodies touch or overlap, or their places make no sense.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// The iteration did not converge.
    #[error(
        "the iteration ended after {iterations} iterations at a relative residual of {residual:.1e}: expected {wanted:.1e}; {stop}"
    )]
    NotConverged {
        /// Iterations made.
        iterations: usize,
        /// The true residual.
        residual: f64,
        /// The residual that was to be reached.
        wanted: f64,
        /// Why it ended.
        stop: Stop,
    },
    /// A tolerance that no answer can have.
    #[error("a tolerance of {0:e}: expected one from 1e-14 to less than 1")]
    Tolerance(f64),
    /// A tolerance that no flow can have.
    #[error("a tolerance of {0:e} for a flow: expected one above 0 and below 1")]
    FlowTolerance(f64),
    /// An equation for the inside of bodies.
    #[error(
        "the interior double layer is not an equation for a suspension: expected the combined field or the single layer"
    )]
    Interior,
    /// There is not one resolution for each body.
    #[error("{resolutions} resolutions for {bodies} bodies: expected one for each")]
    Resolutions {
        /// How many were given.
        resolutions: usize,
        /// How many there should be.
        bodies: usize,
    },
    /// A body that there is not.
    #[error("there is no bodies[{body}]: there are {bodies}, counted from 0")]
    NoBody {
        /// What was asked for.
        body: usize,
        /// How many there are.
        bodies: usize,
    },
    /// A viscosity that is not one.
    #[error("a viscosity of {0}: expected a positive number")]
    Viscosity(f64),
    /// The undisturbed flow is not finite.
    #[error("velocity and gradient of the undisturbed flow must be finite")]
    Background,
    /// A number of what is known of a body's motion is not finite.
    #[error("motion, force and torque of bodies[{body}] must be finite, got {value}")]
    Motion {
        /// Which body.
        body: usize,
        /// The number that is not.
        value: f64,
    },
    /// The velocity imposed on a body is not finite.
    #[error("the velocity imposed on bodies[{body}] is not finite everywhere")]
    Velocity {
        /// Which body.
        body: usize,
    },
    /// More memory would be needed than there is.
    #[error(
        "{needed:.3} GiB of memory would be needed for {what}: expected at most {budget:.3} GiB"
    )]
    Memory {
        /// For what.
        what: &'static str,
        /// How much, in GiB.
        needed: f64,
        /// How much there may be, in GiB.
        budget: f64,
    },
    /// The iteration cannot be made.
    #[error("{0}")]
    Iteration(String),
    /// Cancelled by the caller.
    #[error("interrupted")]
    Interrupted,
    /// The flow cannot be evaluated.
    #[error(transparent)]
    Flow(#[from] FlowError),
    /// The interactions cannot be computed.
    #[error(transparent)]
    Interactions(InteractionError),
    /// A quadrature rule is missing.
    #[error(transparent)]
    Quadrature(#[from] QuadratureError),
}

impl From<InteractionError> for SuspensionError {
    fn from(error: InteractionError) -> Self {
        match error {
            InteractionError::Interrupted => Self::Interrupted,
            other => Self::Interactions(other),
        }
    }
}

impl From<FmmError> for SuspensionError {
    fn from(error: FmmError) -> Self {
        Self::Interactions(error.into())
    }
}
