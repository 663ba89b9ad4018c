//! The question: bodies in their places, what is known of their motions, and the undisturbed flow.
//!
//! Every body has a motion that is given (it is *held*), or a force and torque on it (it is
//! *free*), or some components of each; and perhaps a slip. All are in one undisturbed flow.
//! Everything is in the laboratory.

use bodies_of_revolution::{ContactError, Frame, Gap, RigidMotion, Shape, Wrench};
use nalgebra::{Point3, Unit, UnitQuaternion, Vector3};
use stokes_body::flow::check_targets;
use stokes_body::linear_flow::LinearFlow;

use super::arrangement::gaps_of;
use super::error::SuspensionError;
use super::motion::Motion;
use super::slip::Slip;

/// A body: its shape, where it is, and what is known of its motion.
#[derive(Clone, Debug)]
pub struct Body {
    /// The shape. Bodies that share it share all that depends on the shape alone, whatever their
    /// scale.
    pub shape: Shape,
    /// Where the body is, how it is turned, and how large it is.
    pub frame: Frame,
    /// Its motion about its centre, or force and torque about its centre that are exerted on it
    /// from outside.
    pub motion: Motion,
    /// The velocity of its surface relative to the rigid motion.
    pub slip: Option<Slip>,
}

impl Body {
    /// A body that is held still.
    pub fn new(shape: Shape, frame: Frame) -> Self {
        Self {
            shape,
            frame,
            motion: Motion::Given(RigidMotion::rest()),
            slip: None,
        }
    }

    /// A body that is held still, at the origin with its axis along z.
    pub fn held(shape: &Shape) -> Self {
        Self::new(shape.clone(), Frame::at(Point3::origin()))
    }

    /// A body that no force and torque from outside acts on, at the origin with its axis along z.
    pub fn free(shape: &Shape) -> Self {
        Self {
            motion: Motion::Free(Wrench::zero()),
            ..Self::held(shape)
        }
    }

    /// The same with its centre at this point.
    #[must_use]
    pub fn at(self, center: impl Into<Point3<f64>>) -> Self {
        let frame = Frame::new(center.into(), self.frame.orientation());
        Self {
            frame: frame.scaled(self.frame.scale()),
            ..self
        }
    }

    /// The same with its axis in this direction (any length but zero), turned there by the smallest
    /// rotation from z.
    #[must_use]
    pub fn along(self, axis: impl Into<Vector3<f64>>) -> Self {
        let frame = Frame::along(self.frame.center(), Unit::new_normalize(axis.into()));
        Self {
            frame: frame.scaled(self.frame.scale()),
            ..self
        }
    }

    /// The same turned from the laboratory's axes by this rotation.
    #[must_use]
    pub fn oriented(self, orientation: UnitQuaternion<f64>) -> Self {
        let frame = Frame::new(self.frame.center(), orientation);
        Self {
            frame: frame.scaled(self.frame.scale()),
            ..self
        }
    }

    /// The same, so many times as large as its shape.
    #[must_use]
    pub fn scaled(self, scale: f64) -> Self {
        Self {
            frame: self.frame.scaled(scale),
            ..self
        }
    }

    /// The same with a motion, or what is known of it.
    #[must_use]
    pub fn with_motion(self, motion: Motion) -> Self {
        Self { motion, ..self }
    }

    /// A held body that moves with this velocity and does not turn.
    #[must_use]
    pub fn moving(self, velocity: impl Into<Vector3<f64>>) -> Self {
        self.with_motion(Motion::Given(RigidMotion::translation(velocity.into())))
    }

    /// A free body under this force from outside, and no torque.
    #[must_use]
    pub fn pushed(self, force: impl Into<Vector3<f64>>) -> Self {
        self.with_motion(Motion::Free(Wrench::force(force.into())))
    }

    /// The same with a velocity of its surface relative to the rigid motion.
    #[must_use]
    pub fn with_slip(self, slip: Slip) -> Self {
        Self {
            slip: Some(slip),
            ..self
        }
    }

    /// The distance of its farthest point from its centre, or nearly.
    pub(crate) fn size(&self) -> f64 {
        self.shape.extent() * self.frame.scale()
    }
}

/// A question about any number of bodies, one included. It owns what it asks.
///
/// A free sphere under a force, and a rod that is held in its way; [`Solver`](super::Solver) shows
/// how it is answered:
///
/// ```
/// use bodies_of_revolution::{GeneratingCurve, Spheroid};
/// use nalgebra::Point3;
/// use stokes_suspension::{Body, Suspension};
///
/// let ball = Spheroid::sphere(0.5)?.shape();
/// let rod = Spheroid::new(1.0, 0.5)?.shape();
/// let suspension = Suspension::new([
///     Body::free(&ball).at([0.0, 0.0, 2.0]).pushed([0.0, 0.0, -1.0]),
///     Body::held(&rod).along([1.0, 0.0, 1.0]),
/// ])
/// .with_viscosity(2.0)
/// .with_probes([Point3::new(2.0, 0.0, 0.0)]);
/// assert_eq!(suspension.bodies.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Suspension {
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The undisturbed flow.
    pub background: LinearFlow,
    /// The viscosity of the fluid.
    pub viscosity: f64,
    /// Points where velocity and pressure are wanted with the answer: its error estimate counts the
    /// velocities there.
    pub probes: Vec<Point3<f64>>,
}

impl Suspension {
    /// Bodies in a fluid of viscosity 1 that is at rest far away.
    pub fn new(bodies: impl Into<Vec<Body>>) -> Self {
        Self {
            bodies: bodies.into(),
            background: LinearFlow::rest(),
            viscosity: 1.0,
            probes: Vec::new(),
        }
    }

    /// The same in another undisturbed flow.
    #[must_use]
    pub fn in_flow(self, background: LinearFlow) -> Self {
        Self { background, ..self }
    }

    /// The same in a fluid of another viscosity.
    #[must_use]
    pub fn with_viscosity(self, viscosity: f64) -> Self {
        Self { viscosity, ..self }
    }

    /// The same with points where the flow is wanted.
    #[must_use]
    pub fn with_probes(self, probes: impl Into<Vec<Point3<f64>>>) -> Self {
        Self {
            probes: probes.into(),
            ..self
        }
    }

    /// Moves every body for a time `dt` with a motion that was found: its centre along a straight
    /// line, and turned about the direction of its angular velocity (Euler's method, of first
    /// order).
    pub fn advance(&mut self, motions: impl IntoIterator<Item = RigidMotion>, dt: f64) {
        for (body, motion) in self.bodies.iter_mut().zip(motions) {
            body.frame = (body.frame).moved(dt * motion.velocity, dt * motion.angular_velocity);
        }
    }

    /// The gaps between pairs of bodies that are at most a length `within` apart; if it is not
    /// given, at most as far apart as the larger of the two is long.
    ///
    /// # Errors
    /// If a curve has no outline.
    pub fn gaps(&self, within: Option<f64>) -> Result<Vec<Gap>, ContactError> {
        gaps_of(&self.bodies, |body| within.unwrap_or(2.0 * body.size()))
    }

    /// Refuses questions that make no sense.
    pub(crate) fn check(&self) -> Result<(), SuspensionError> {
        if self.bodies.is_empty() {
            return Err(SuspensionError::Empty);
        }
        if !(self.viscosity > 0.0 && self.viscosity.is_finite()) {
            return Err(SuspensionError::Viscosity(self.viscosity));
        }
        for (index, body) in self.bodies.iter().enumerate() {
            let numbers = body.motion.numbers();
            if let Some(&value) = numbers.iter().find(|x| !x.is_finite()) {
                return Err(SuspensionError::Motion { body: index, value });
            }
        }
        let undisturbed = self.background.velocity.iter();
        if !(undisturbed.chain(self.background.gradient.iter())).all(|x| x.is_finite()) {
            return Err(SuspensionError::Background);
        }
        Ok(check_targets(&self.probes)?)
    }
}
