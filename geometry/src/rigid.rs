//! Rigid motions, forces and torques.

use std::ops::{Add, Neg, Sub};

use nalgebra::Vector3;

/// A rigid motion about a point: $u(x) = U + \Omega \times x$, with $x$ counted from that point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    /// Velocity $U$ of the point.
    pub velocity: Vector3<f64>,
    /// Angular velocity $\Omega$, in radians per unit time.
    pub angular_velocity: Vector3<f64>,
}

/// Force and torque about a point.
///
/// On whom is said where one is used: of an answer, it is what the body exerts on the fluid; of a
/// question, what is exerted on the body from outside. For a free body both are the same.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force.
    pub force: Vector3<f64>,
    /// Torque about the point.
    pub torque: Vector3<f64>,
}

impl RigidMotion {
    /// No motion.
    pub fn rest() -> Self {
        Self::translation(Vector3::zeros())
    }

    /// A translation with this velocity.
    pub fn translation(velocity: Vector3<f64>) -> Self {
        Self {
            velocity,
            angular_velocity: Vector3::zeros(),
        }
    }

    /// A rotation with this angular velocity.
    pub fn rotation(angular_velocity: Vector3<f64>) -> Self {
        Self {
            velocity: Vector3::zeros(),
            angular_velocity,
        }
    }

    /// The velocity at `x`, counted from the point that the motion is about.
    pub fn at(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.velocity + self.angular_velocity.cross(&x)
    }
}

impl Wrench {
    /// No force, no torque.
    pub fn zero() -> Self {
        Self::force(Vector3::zeros())
    }

    /// This force and no torque.
    pub fn force(force: Vector3<f64>) -> Self {
        Self {
            force,
            torque: Vector3::zeros(),
        }
    }

    /// This torque and no force.
    pub fn torque(torque: Vector3<f64>) -> Self {
        Self {
            force: Vector3::zeros(),
            torque,
        }
    }

    /// The rate of work $F \cdot U + T \cdot \Omega$ in a motion about the same point.
    pub fn power(&self, motion: &RigidMotion) -> f64 {
        self.force.dot(&motion.velocity) + self.torque.dot(&motion.angular_velocity)
    }
}

impl Neg for RigidMotion {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            velocity: -self.velocity,
            angular_velocity: -self.angular_velocity,
        }
    }
}

impl Add for RigidMotion {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            velocity: self.velocity + other.velocity,
            angular_velocity: self.angular_velocity + other.angular_velocity,
        }
    }
}

impl Sub for RigidMotion {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Sub for Wrench {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            force: self.force - other.force,
            torque: self.torque - other.torque,
        }
    }
}
