//! Rigid motions of the surface, and the force and torque of a density.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::discretization::Discretization;
use super::surface::SurfaceModes;

/// A rigid motion about the origin: $u(x) = U + \Omega \times x$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    /// Velocity $U$ of the origin.
    pub velocity: Vector3<f64>,
    /// Angular velocity $\Omega$, in radians per unit time.
    pub angular_velocity: Vector3<f64>,
}

/// Force and torque about the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force.
    pub force: Vector3<f64>,
    /// Torque about the origin.
    pub torque: Vector3<f64>,
}

impl RigidMotion {
    /// No motion.
    pub fn rest() -> Self {
        Self {
            velocity: Vector3::zeros(),
            angular_velocity: Vector3::zeros(),
        }
    }

    /// The velocity at `x`.
    pub fn at(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.velocity + self.angular_velocity.cross(&x)
    }

    /// The motion's velocity on the surface: modes 0 and 1, exactly.
    pub fn on(&self, discretization: &Discretization) -> SurfaceModes {
        let nodes = discretization.nodes();
        let mut modes = SurfaceModes::zero(1, nodes.len());
        let (u, o) = (self.velocity, self.angular_velocity);
        for (k, node) in nodes.iter().enumerate() {
            let (r, z) = (node.r, node.z);
            // Mode 0: along and about the axis.
            modes.component_mut(0, 0, 2)[k] = u.z;
            modes.component_mut(0, 1, 1)[k] = -o.z * r;
            // Mode 1: u_r = (u_x + o_y z) cos + (u_y - o_x z) sin, and so on.
            let (first, second) = (u.x + o.y * z, u.y - o.x * z);
            modes.component_mut(1, 0, 0)[k] = first;
            modes.component_mut(1, 0, 1)[k] = -first;
            modes.component_mut(1, 0, 2)[k] = -o.y * r;
            modes.component_mut(1, 1, 0)[k] = second;
            modes.component_mut(1, 1, 1)[k] = -second;
            modes.component_mut(1, 1, 2)[k] = o.x * r;
        }
        modes
    }
}

impl std::ops::Neg for RigidMotion {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            velocity: -self.velocity,
            angular_velocity: -self.angular_velocity,
        }
    }
}

impl std::ops::Sub for RigidMotion {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            velocity: self.velocity - other.velocity,
            angular_velocity: self.angular_velocity - other.angular_velocity,
        }
    }
}

impl std::ops::Sub for Wrench {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self {
            force: self.force - other.force,
            torque: self.torque - other.torque,
        }
    }
}

impl Wrench {
    /// No force, no torque.
    pub fn zero() -> Self {
        Self {
            force: Vector3::zeros(),
            torque: Vector3::zeros(),
        }
    }

    /// The integrals of a density and of $x \times$ the density over the surface.
    pub fn of(discretization: &Discretization, density: &SurfaceModes) -> Self {
        let mut force = Vector3::zeros();
        let mut torque = Vector3::zeros();
        let at = |n: usize, family: usize, j: usize, k: usize| {
            if n < density.modes() {
                density.component(n, family, j)[k]
            } else {
                0.0
            }
        };
        for (k, node) in discretization.nodes().iter().enumerate() {
            let (r, z, weight) = (node.r, node.z, PI * node.weight);
            force.z += 2.0 * weight * at(0, 0, 2, k);
            torque.z -= 2.0 * weight * r * at(0, 1, 1, k);
            // The integral of e_r cos + ... : f_x from the radial and azimuthal parts of mode 1.
            let x = at(1, 0, 0, k) - at(1, 0, 1, k);
            let y = at(1, 1, 0, k) - at(1, 1, 1, k);
            let (axial_cos, axial_sin) = (at(1, 0, 2, k), at(1, 1, 2, k));
            force.x += weight * x;
            force.y += weight * y;
            torque.x += weight * (r * axial_sin - z * y);
            torque.y += weight * (z * x - r * axial_cos);
        }
        Self { force, torque }
    }
}
