//! The body's frame and the laboratory's.

use nalgebra::{IsometryMatrix3, Matrix3, Point3, Rotation3, Unit, Vector3};

use super::linear_flow::LinearFlow;
use super::rigid::{RigidMotion, Wrench};

/// Where a body is: its centre, the direction of its symmetry axis and its scale, in the laboratory.
///
/// A body of scale $L$ is its shape made $L$ times as large. Its equations, written in its own frame, are those of the shape: velocities
/// and densities of double layers are the same numbers in both frames but for the rotation, angular velocities and velocity gradients are $L$ times
/// as large in the body's, forces $1/L$ and torques $1/L^2$ times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    isometry: IsometryMatrix3<f64>,
    scale: f64,
}

impl Frame {
    /// The frame with origin `center` whose `z` axis is `axis`, of scale 1.
    pub fn new(center: Point3<f64>, axis: Unit<Vector3<f64>>) -> Self {
        // An orthonormal basis without cancellation for any direction (Duff et al. 2017).
        let sign = 1f64.copysign(axis.z);
        let a = -1.0 / (sign + axis.z);
        let b = axis.x * axis.y * a;
        let first = Vector3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
        let second = Vector3::new(b, sign + axis.y * axis.y * a, -axis.y);
        let rotation = Rotation3::from_basis_unchecked(&[first, second, *axis]);
        Self {
            isometry: IsometryMatrix3::from_parts(center.into(), rotation),
            scale: 1.0,
        }
    }

    /// The same for a body `scale` times as large as its shape: a positive number.
    pub fn scaled(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// The body's centre.
    pub fn center(&self) -> Point3<f64> {
        self.isometry.translation.vector.into()
    }

    /// The direction of the symmetry axis.
    pub fn axis(&self) -> Unit<Vector3<f64>> {
        Unit::new_unchecked(self.rotation().matrix().column(2).into_owned())
    }

    /// How many times larger the body is than its shape.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    fn rotation(&self) -> &Rotation3<f64> {
        &self.isometry.rotation
    }

    /// A point of the laboratory, in the body's frame.
    pub fn point_to_body(&self, point: Point3<f64>) -> Point3<f64> {
        (self.vector_to_body(point - self.center()) / self.scale()).into()
    }

    /// A point of the body's frame, in the laboratory.
    pub fn point_to_lab(&self, point: Point3<f64>) -> Point3<f64> {
        self.center() + self.scale() * (self.rotation() * point.coords)
    }

    /// A vector of the laboratory, in the body's frame; its length stays.
    pub fn vector_to_body(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.rotation().inverse_transform_vector(&vector)
    }

    /// A vector of the body's frame, in the laboratory; its length stays.
    pub fn vector_to_lab(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.rotation() * vector
    }

    /// A flow of the laboratory, in the body's frame.
    pub fn flow_to_body(&self, flow: &LinearFlow) -> LinearFlow {
        let rotation = self.rotation().matrix();
        LinearFlow {
            velocity: self.vector_to_body(flow.at(self.center().coords)),
            gradient: self.scale() * (rotation.transpose() * flow.gradient * rotation),
        }
    }

    /// A rigid motion about the body's centre, from the laboratory to the body's frame.
    pub fn motion_to_body(&self, motion: RigidMotion) -> RigidMotion {
        RigidMotion {
            velocity: self.vector_to_body(motion.velocity),
            angular_velocity: self.scale() * self.vector_to_body(motion.angular_velocity),
        }
    }

    /// A rigid motion about the body's centre, from its frame to the laboratory.
    pub fn motion_to_lab(&self, motion: RigidMotion) -> RigidMotion {
        RigidMotion {
            velocity: self.vector_to_lab(motion.velocity),
            angular_velocity: self.vector_to_lab(motion.angular_velocity) / self.scale(),
        }
    }

    /// Force and torque about the body's centre, from the laboratory to the body's frame.
    pub fn wrench_to_body(&self, wrench: Wrench) -> Wrench {
        let scale = self.scale();
        Wrench {
            force: self.vector_to_body(wrench.force) / scale,
            torque: self.vector_to_body(wrench.torque) / (scale * scale),
        }
    }

    /// Force and torque about the body's centre, from its frame to the laboratory.
    pub fn wrench_to_lab(&self, wrench: Wrench) -> Wrench {
        let scale = self.scale();
        Wrench {
            force: scale * self.vector_to_lab(wrench.force),
            torque: scale * scale * self.vector_to_lab(wrench.torque),
        }
    }

    /// A tensor of second rank of the body's frame, in the laboratory; its size stays.
    pub fn tensor_to_lab(&self, tensor: &Matrix3<f64>) -> Matrix3<f64> {
        let rotation = self.rotation().matrix();
        rotation * tensor * rotation.transpose()
    }
}
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back_for_every_direction_even_the_opposite_one() {
        let axes = [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
            [1.0, 1.0, 1.0],
            [1e-9, 0.0, -1.0],
        ];
        for axis in axes.map(|a| Unit::new_normalize(Vector3::from(a))) {
            let frame = Frame::new(Point3::new(1.0, 2.0, 3.0), axis);
            assert!((frame.vector_to_lab(Vector3::z()) - *axis).norm() < 1e-15);
            let x = Vector3::new(0.3, -0.4, 0.5);
            assert!((frame.vector_to_body(frame.vector_to_lab(x)) - x).norm() < 1e-15);
            let shear = LinearFlow::shear(2.0, Vector3::x(), Vector3::z());
            let in_body = frame.flow_to_body(&shear);
            let velocity = frame.vector_to_lab(in_body.at(frame.point_to_body(x.into()).coords));
            assert!((velocity - shear.at(x)).norm() < 1e-14);
            let strain = frame.tensor_to_lab(&in_body.strain_rate());
            assert!((strain - shear.strain_rate()).norm() < 1e-14);
            let point = Point3::from(x);
            assert!((frame.point_to_body(frame.point_to_lab(point)) - point).norm() < 1e-14);
            let on_axis = frame.point_to_body(frame.center() + *axis * 2.0);
            assert!((on_axis.coords - Vector3::new(0.0, 0.0, 2.0)).norm() < 1e-14);
        }
    }
}
