//! How a body lies in space.

use super::CaseError;
use super::node::Node;
use super::section::Section;

/// How a body lies in space, in the words of the case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BodyOrientation {
    /// The direction of the symmetry axis, of length one. The body is turned from z to it by the
    /// smallest rotation.
    Axis([f64; 3]),
    /// A rotation as a quaternion of length one: the scalar, then x, y and z.
    Quaternion([f64; 4]),
}

impl Default for BodyOrientation {
    fn default() -> Self {
        Self::Axis([0.0, 0.0, 1.0])
    }
}

impl BodyOrientation {
    /// The direction of the symmetry axis, of length one.
    pub fn axis(&self) -> [f64; 3] {
        match *self {
            Self::Axis(axis) => axis,
            Self::Quaternion([w, x, y, z]) => [
                2.0 * (x * z + w * y),
                2.0 * (y * z - w * x),
                w * w - x * x - y * y + z * z,
            ],
        }
    }
}

/// Reads `axis` or `orientation` of a body.
pub(super) fn read_orientation(section: &Section<'_>) -> Result<BodyOrientation, CaseError> {
    match (section.optional("axis"), section.optional("orientation")) {
        (None, None) => Ok(BodyOrientation::default()),
        (Some(axis), None) => Ok(BodyOrientation::Axis(axis.direction()?)),
        (None, Some(orientation)) => Ok(BodyOrientation::Quaternion(orientation.quaternion()?)),
        (Some(axis), Some(orientation)) => Err(Node::later(&axis, &orientation).error(format!(
            "both {} and {} are given: expected one of them",
            axis.key, orientation.key
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_axis_is_z_turned_by_the_quaternion() {
        let half = 0.5_f64.sqrt();
        let cases = [
            ([1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
            ([half, half, 0.0, 0.0], [0.0, -1.0, 0.0]),
            ([half, 0.0, half, 0.0], [1.0, 0.0, 0.0]),
            ([0.5, 0.5, 0.5, 0.5], [1.0, 0.0, 0.0]),
        ];
        for (quaternion, axis) in cases {
            let found = BodyOrientation::Quaternion(quaternion).axis();
            for (found, exact) in found.iter().zip(axis) {
                assert!((found - exact).abs() < 1e-15, "{quaternion:?}: {found}");
            }
        }
    }
}
