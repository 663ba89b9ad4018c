//! Where a body is: the frame that its generating curve is given in, and the laboratory's.

use nalgebra::{Matrix3, Point3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};

use super::rigid::{RigidMotion, Wrench};

/// Where a body is: its centre, its orientation and its scale, in the laboratory.
///
/// In its own frame a body has its centre at the origin and its symmetry axis along $z$. The frame
/// takes a point $x$ of the body to $c + L\, q x q^*$ in the laboratory, with the centre $c$, the
/// unit quaternion $q$ and the scale $L$.
///
/// A body of scale $L$ is its shape made $L$ times as large. Its equations, written in its own
/// frame, are those of the shape: velocities and densities of double layers are the same numbers in
/// both frames but for the rotation; angular velocities and velocity gradients are $L$ times as
/// large in the body's frame, forces $1/L$ and torques $1/L^2$ times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    center: Point3<f64>,
    orientation: UnitQuaternion<f64>,
    /// The matrix of the orientation.
    rotation: Rotation3<f64>,
    scale: f64,
}

impl Frame {
    /// The frame with origin `center` whose axes are those of the laboratory turned by
    /// `orientation`, of scale 1.
    pub fn new(center: Point3<f64>, orientation: UnitQuaternion<f64>) -> Self {
        Self {
            center,
            orientation,
            rotation: orientation.to_rotation_matrix(),
            scale: 1.0,
        }
    }

    /// The frame with origin `center` and the axes of the laboratory, of scale 1.
    pub fn at(center: Point3<f64>) -> Self {
        Self::new(center, UnitQuaternion::identity())
    }

    /// The frame with origin `center` whose `z` axis is `axis`, turned from the laboratory by the
    /// smallest rotation that does it: about $e_z \times$ `axis`, or about $e_x$ if `axis` is
    /// $-e_z$. Of scale 1.
    pub fn along(center: Point3<f64>, axis: Unit<Vector3<f64>>) -> Self {
        Self::new(center, smallest_rotation_to(axis))
    }

    /// The same for a body `scale` times as large as its shape: a positive number.
    #[must_use]
    pub fn scaled(self, scale: f64) -> Self {
        Self { scale, ..self }
    }

    /// The frame of a body that has moved: its centre by `displacement`, and turned about its
    /// centre by the angle $\lvert\theta\rvert$ (radians) about the direction of the `rotation`
    /// vector $\theta$, both in the laboratory.
    #[must_use]
    pub fn moved(&self, displacement: Vector3<f64>, rotation: Vector3<f64>) -> Self {
        let mut turned = UnitQuaternion::from_scaled_axis(rotation) * self.orientation;
        // A product of unit quaternions is one but for rounding, which would add up over many
        // steps.
        turned.renormalize();
        Self::new(self.center + displacement, turned).scaled(self.scale)
    }

    /// The body's centre.
    pub fn center(&self) -> Point3<f64> {
        self.center
    }

    /// How the body is turned: the rotation from the laboratory's axes to the body's.
    pub fn orientation(&self) -> UnitQuaternion<f64> {
        self.orientation
    }

    /// The direction of the symmetry axis.
    pub fn axis(&self) -> Unit<Vector3<f64>> {
        Unit::new_unchecked(self.rotation.matrix().column(2).into_owned())
    }

    /// How many times larger the body is than its shape.
    pub fn scale(&self) -> f64 {
        self.scale
    }

    /// A point of the laboratory, in the body's frame.
    pub fn point_to_body(&self, point: Point3<f64>) -> Point3<f64> {
        (self.vector_to_body(point - self.center) / self.scale).into()
    }

    /// A point of the body's frame, in the laboratory.
    pub fn point_to_lab(&self, point: Point3<f64>) -> Point3<f64> {
        self.center + self.scale * (self.rotation * point.coords)
    }

    /// A vector of the laboratory, in the body's frame; its length stays.
    pub fn vector_to_body(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.rotation.inverse_transform_vector(&vector)
    }

    /// A vector of the body's frame, in the laboratory; its length stays.
    pub fn vector_to_lab(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.rotation * vector
    }

    /// A rigid motion about the body's centre, from the laboratory to the body's frame.
    pub fn motion_to_body(&self, motion: RigidMotion) -> RigidMotion {
        RigidMotion {
            velocity: self.vector_to_body(motion.velocity),
            angular_velocity: self.scale * self.vector_to_body(motion.angular_velocity),
        }
    }

    /// A rigid motion about the body's centre, from its frame to the laboratory.
    pub fn motion_to_lab(&self, motion: RigidMotion) -> RigidMotion {
        RigidMotion {
            velocity: self.vector_to_lab(motion.velocity),
            angular_velocity: self.vector_to_lab(motion.angular_velocity) / self.scale,
        }
    }

    /// Force and torque about the body's centre, from the laboratory to the body's frame.
    pub fn wrench_to_body(&self, wrench: Wrench) -> Wrench {
        Wrench {
            force: self.vector_to_body(wrench.force) / self.scale,
            torque: self.vector_to_body(wrench.torque) / (self.scale * self.scale),
        }
    }

    /// Force and torque about the body's centre, from its frame to the laboratory.
    pub fn wrench_to_lab(&self, wrench: Wrench) -> Wrench {
        Wrench {
            force: self.scale * self.vector_to_lab(wrench.force),
            torque: self.scale * self.scale * self.vector_to_lab(wrench.torque),
        }
    }

    /// A tensor of second rank of the laboratory, in the body's frame; its size stays.
    pub fn tensor_to_body(&self, tensor: &Matrix3<f64>) -> Matrix3<f64> {
        let rotation = self.rotation.matrix();
        rotation.transpose() * tensor * rotation
    }

    /// A tensor of second rank of the body's frame, in the laboratory; its size stays.
    pub fn tensor_to_lab(&self, tensor: &Matrix3<f64>) -> Matrix3<f64> {
        let rotation = self.rotation.matrix();
        rotation * tensor * rotation.transpose()
    }
}

/// The smallest rotation that takes $e_z$ to `axis`.
fn smallest_rotation_to(axis: Unit<Vector3<f64>>) -> UnitQuaternion<f64> {
    if axis.z >= 0.0 {
        return UnitQuaternion::new_normalize(Quaternion::new(1.0 + axis.z, -axis.y, axis.x, 0.0));
    }
    // Divided by the distance from -z: near there 1 + z would cancel, and squares underflow.
    let across = axis.x.hypot(axis.y);
    if across == 0.0 {
        return UnitQuaternion::new_unchecked(Quaternion::new(0.0, 1.0, 0.0, 0.0));
    }
    let scalar = across / (1.0 - axis.z);
    UnitQuaternion::new_normalize(Quaternion::new(
        scalar,
        -axis.y / across,
        axis.x / across,
        0.0,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes() -> impl Iterator<Item = Unit<Vector3<f64>>> {
        [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
            [1.0, 1.0, 1.0],
            [1e-9, 0.0, -1.0],
            [0.0, 3e-160, -1.0],
        ]
        .into_iter()
        .map(|axis| Unit::new_normalize(Vector3::from(axis)))
    }

    #[test]
    fn there_and_back_for_every_direction_even_the_opposite_one() {
        for axis in axes() {
            let frame = Frame::along(Point3::new(1.0, 2.0, 3.0), axis);
            assert!((frame.vector_to_lab(Vector3::z()) - *axis).norm() < 1e-15);
            let x = Vector3::new(0.3, -0.4, 0.5);
            assert!((frame.vector_to_body(frame.vector_to_lab(x)) - x).norm() < 1e-15);
            let tensor = Matrix3::new(1.0, 2.0, 0.3, -0.4, 0.5, -1.0, 0.7, 0.2, -1.5);
            let back = frame.tensor_to_lab(&frame.tensor_to_body(&tensor));
            assert!((back - tensor).norm() < 1e-14);
            let point = Point3::from(x);
            assert!((frame.point_to_body(frame.point_to_lab(point)) - point).norm() < 1e-14);
            let on_axis = frame.point_to_body(frame.center() + *axis * 2.0);
            assert!((on_axis.coords - Vector3::new(0.0, 0.0, 2.0)).norm() < 1e-14);
        }
    }

    /// No other rotation that takes the axis there turns by less: the angle is that between the
    /// axes.
    #[test]
    fn an_axis_stands_for_the_smallest_rotation() {
        for axis in axes() {
            let orientation = Frame::along(Point3::origin(), axis).orientation();
            let between = Vector3::z().angle(&axis);
            assert!((orientation.angle() - between).abs() < 1e-7, "{axis:?}");
        }
        let tilted = Frame::along(Point3::origin(), Vector3::x_axis());
        assert!((tilted.vector_to_lab(Vector3::y()) - Vector3::y()).norm() < 1e-15);
    }

    #[test]
    fn small_rotations_add_up_without_drift() {
        let axis = Vector3::new(0.6, -0.48, 0.64);
        let start = Frame::along(Point3::origin(), Vector3::x_axis()).scaled(2.0);
        let steps = 10_000;
        let step = std::f64::consts::TAU / f64::from(steps);
        let mut frame = start;
        for _ in 0..steps {
            frame = frame.moved(Vector3::z() * step, step * axis);
        }
        let turned = frame.orientation().angle_to(&start.orientation());
        assert!(turned < 1e-11, "{turned:e}");
        assert!((frame.orientation().norm() - 1.0).abs() < 1e-15);
        assert_eq!(frame.scale(), 2.0);
    }
}
