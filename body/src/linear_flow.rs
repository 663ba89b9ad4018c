//! Undisturbed flows.

use bodies_of_revolution::Frame;
use nalgebra::{Matrix3, Vector3};

use super::discretization::Discretization;
use super::surface::{Sampled, SurfaceModes};

/// A flow $u(x) = U + G x$ that a body disturbs; its pressure is zero.
///
/// It solves the Stokes equations if it has no divergence, $\operatorname{tr} G = 0$, which is for
/// the caller to see to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearFlow {
    /// Velocity $U$ at the origin.
    pub velocity: Vector3<f64>,
    /// Velocity gradient $G_{ij} = \partial u_i / \partial x_j$, in units of 1/time.
    pub gradient: Matrix3<f64>,
}

/// The azimuthal modes of a linear flow end with this one.
pub const LAST_MODE: usize = 2;

impl LinearFlow {
    /// A fluid at rest.
    pub fn rest() -> Self {
        Self::uniform(Vector3::zeros())
    }

    /// The same velocity everywhere.
    pub fn uniform(velocity: Vector3<f64>) -> Self {
        Self {
            velocity,
            gradient: Matrix3::zeros(),
        }
    }

    /// Simple shear $u = \dot\gamma\\, e\\, (g \cdot x)$ with rate $\dot\gamma$, for orthogonal
    /// unit vectors $e$ along the flow and $g$ along its gradient.
    pub fn shear(rate: f64, flow: Vector3<f64>, gradient: Vector3<f64>) -> Self {
        Self {
            velocity: Vector3::zeros(),
            gradient: rate * flow * gradient.transpose(),
        }
    }

    /// The velocity at `x`.
    pub fn at(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.velocity + self.gradient * x
    }

    /// The flow as an observer in a body's frame sees it: velocities turned, lengths in units of
    /// the body's scale.
    pub fn in_frame(&self, frame: &Frame) -> Self {
        Self {
            velocity: frame.vector_to_body(self.at(frame.center().coords)),
            gradient: frame.scale() * frame.tensor_to_body(&self.gradient),
        }
    }

    /// The rate of strain $\frac12 (G + G^\mathsf{T})$.
    pub fn strain_rate(&self) -> Matrix3<f64> {
        0.5 * (self.gradient + self.gradient.transpose())
    }

    /// The angular velocity of the fluid, half its vorticity.
    pub fn angular_velocity(&self) -> Vector3<f64> {
        let g = &self.gradient;
        0.5 * Vector3::new(
            g[(2, 1)] - g[(1, 2)],
            g[(0, 2)] - g[(2, 0)],
            g[(1, 0)] - g[(0, 1)],
        )
    }

    /// The stress $G + G^\mathsf{T}$, for viscosity 1.
    pub fn stress(&self) -> Matrix3<f64> {
        2.0 * self.strain_rate()
    }

    /// The traction on the surface, for viscosity 1: modes 0 to 2, exactly.
    pub fn traction(&self, discretization: &Discretization) -> SurfaceModes {
        let stress = self.stress();
        SurfaceModes::sample_with_normal(discretization, LAST_MODE, |_, normal| stress * normal)
            .modes
    }

    /// The velocity on the surface: modes 0 to 2, exactly.
    pub fn on(&self, discretization: &Discretization) -> Sampled {
        SurfaceModes::sample(discretization, LAST_MODE, |x| self.at(x))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Point3, Unit};

    use super::*;

    #[test]
    fn a_frame_sees_the_same_flow() {
        let axis = Unit::new_normalize(Vector3::new(1.0, 1.0, 1.0));
        let frame = Frame::along(Point3::new(1.0, 2.0, 3.0), axis).scaled(2.0);
        let x = Vector3::new(0.3, -0.4, 0.5);
        let shear = LinearFlow::shear(2.0, Vector3::x(), Vector3::z());
        let in_body = shear.in_frame(&frame);
        let velocity = frame.vector_to_lab(in_body.at(frame.point_to_body(x.into()).coords));
        assert!((velocity - shear.at(x)).norm() < 1e-14);
        let strain = frame.tensor_to_lab(&in_body.strain_rate()) / frame.scale();
        assert!((strain - shear.strain_rate()).norm() < 1e-14);
    }

    #[test]
    fn a_shear_is_a_strain_and_a_rotation() {
        let (flow, gradient) = (Vector3::x(), Vector3::z());
        let shear = LinearFlow::shear(2.0, flow, gradient);
        let x = Vector3::new(0.3, -0.2, 0.7);
        assert_eq!(shear.at(x), Vector3::new(1.4, 0.0, 0.0));
        let parts = shear.strain_rate() * x + shear.angular_velocity().cross(&x);
        assert!((shear.at(x) - parts).norm() < 1e-15);
        assert_eq!(shear.angular_velocity(), Vector3::y());
    }
}
