//! The surface as a thin shell of unit mass per area: the projection onto rigid motions, and
//! densities of given force and torque.
//!
//! In $L^2$ of the surface a shell's linear and angular momentum are the inner products of its
//! velocity with the six rigid motions. So the orthogonal projection $P\sigma$ onto them is the
//! rigid motion that has the momenta of $\sigma$. And of all densities with force $F$ and torque
//! $T$ the smallest in $L^2$ is the rigid motion with the momenta $F$ and $T$.

use std::f64::consts::PI;

use nalgebra::Vector3;

use super::discretization::Discretization;
use super::surface::SurfaceModes;
use bodies_of_revolution::{RigidMotion, Wrench};

/// Mass, centre and moments of inertia of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shell {
    area: f64,
    /// Height of the centroid, which lies on the axis.
    centroid: f64,
    /// About the axis, $\int r^2 d\Gamma$.
    inertia_along: f64,
    /// About a line through the centroid across the axis, $\int ((z - c)^2 + r^2/2)\\, d\Gamma$.
    inertia_across: f64,
}

impl Shell {
    /// The shell of a surface.
    pub fn new(discretization: &Discretization) -> Self {
        let nodes = discretization.nodes();
        let integral = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
            let values = nodes.iter().map(|node| node.weight * f(node.r, node.z));
            2.0 * PI * values.sum::<f64>()
        };
        let area = integral(&|_, _| 1.0);
        let centroid = integral(&|_, z| z) / area;
        Self {
            area,
            centroid,
            inertia_along: integral(&|r, _| r * r),
            inertia_across: integral(&|r, z| (z - centroid).powi(2) + 0.5 * r * r),
        }
    }

    /// The centroid of the surface.
    pub fn centroid(&self) -> Vector3<f64> {
        Vector3::new(0.0, 0.0, self.centroid)
    }

    /// The rigid motion in which the shell has these momenta, both motion and momenta about the
    /// origin: $F/\lvert\Gamma\rvert + (I^{-1} (T - c \times F)) \times (x - c)$ at $x$, with the
    /// centroid $c$ and the inertia $I$ about it.
    pub fn motion(&self, Wrench { force, torque }: Wrench) -> RigidMotion {
        let about_centroid = torque - self.centroid().cross(&force);
        let angular_velocity = Vector3::new(
            about_centroid.x / self.inertia_across,
            about_centroid.y / self.inertia_across,
            about_centroid.z / self.inertia_along,
        );
        RigidMotion {
            velocity: force / self.area - angular_velocity.cross(&self.centroid()),
            angular_velocity,
        }
    }

    /// The orthogonal projection of a density onto the rigid motions.
    pub fn projection(
        &self,
        discretization: &Discretization,
        density: &SurfaceModes,
    ) -> RigidMotion {
        self.motion(density.wrench(discretization))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use bodies_of_revolution::{Panels, Polar};

    #[test]
    fn a_rigid_motion_is_its_own_projection() {
        let curve = Arc::new(Polar::new(&[1.0, 0.3, 0.1]).unwrap());
        let panels = Panels::equal_arcs(&*curve, 8).unwrap();
        let discretization = Discretization::new(curve, panels, 16).unwrap();
        let shell = Shell::new(&discretization);
        assert!(shell.centroid > 0.1);
        let motion = RigidMotion {
            velocity: Vector3::new(0.3, -0.2, 0.9),
            angular_velocity: Vector3::new(0.5, 0.7, -0.4),
        };
        let found = shell.projection(
            &discretization,
            &SurfaceModes::of_motion(&discretization, &motion),
        );
        assert!((found.velocity - motion.velocity).norm() < 1e-14);
        assert!((found.angular_velocity - motion.angular_velocity).norm() < 1e-14);
    }
}
