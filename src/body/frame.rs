//! The body's frame and the laboratory's.

use nalgebra::{Point3, Rotation3, Unit, Vector3};

/// Where a body is: its centre and the direction of its symmetry axis, in the laboratory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    center: Point3<f64>,
    rotation: Rotation3<f64>,
}

impl Frame {
    /// The frame with origin `center` whose `z` axis is `axis`.
    pub fn new(center: Point3<f64>, axis: Unit<Vector3<f64>>) -> Self {
        // An orthonormal basis without cancellation for any direction (Duff et al. 2017).
        let sign = 1f64.copysign(axis.z);
        let a = -1.0 / (sign + axis.z);
        let b = axis.x * axis.y * a;
        let first = Vector3::new(1.0 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x);
        let second = Vector3::new(b, sign + axis.y * axis.y * a, -axis.y);
        let rotation = Rotation3::from_basis_unchecked(&[first, second, *axis]);
        Self { center, rotation }
    }

    /// A point of the laboratory, in the body's frame.
    pub fn point_to_body(&self, point: Point3<f64>) -> Point3<f64> {
        self.rotation
            .inverse_transform_vector(&(point - self.center))
            .into()
    }

    /// A point of the body's frame, in the laboratory.
    pub fn point_to_lab(&self, point: Point3<f64>) -> Point3<f64> {
        self.center + self.rotation * point.coords
    }

    /// A vector of the laboratory, in the body's frame.
    pub fn vector_to_body(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.rotation.inverse_transform_vector(&vector)
    }

    /// A vector of the body's frame, in the laboratory.
    pub fn vector_to_lab(&self, vector: Vector3<f64>) -> Vector3<f64> {
        self.rotation * vector
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
            let point = Point3::from(x);
            assert!((frame.point_to_body(frame.point_to_lab(point)) - point).norm() < 1e-14);
            let on_axis = frame.point_to_body(frame.center + *axis * 2.0);
            assert!((on_axis.coords - Vector3::new(0.0, 0.0, 2.0)).norm() < 1e-14);
        }
    }
}
