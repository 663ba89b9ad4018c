//! A body as it is given to the search for gaps.

use nalgebra::Point3;

use super::gap::ContactError;
use crate::curve::GeneratingCurve;
use crate::frame::Frame;

/// A body in the laboratory.
#[derive(Clone, Copy, Debug)]
pub struct Placed<'a> {
    /// The generating curve.
    pub curve: &'a dyn GeneratingCurve,
    /// Where it is, and how large.
    pub frame: Frame,
    /// Distance from this body up to which others are of interest, in the laboratory; for a pair
    /// the larger one of the two counts.
    pub reach: f64,
}

impl Placed<'_> {
    /// Refuses numbers out of range; errors name the body by the index `body`.
    pub(super) fn validate(&self, body: usize) -> Result<(), ContactError> {
        let bad = |quantity, expected, value| ContactError::Place {
            body,
            quantity,
            expected,
            value,
        };
        let scale = self.frame.scale();
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(bad("the scale", "a positive number", scale));
        }
        if !(self.reach >= 0.0 && self.reach.is_finite()) {
            return Err(bad("the reach", "zero or a positive length", self.reach));
        }
        for direction in [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let image = self.frame.point_to_lab(Point3::from(direction));
            if let Some(&value) = image.iter().find(|x| !x.is_finite()) {
                return Err(bad("every coordinate of the frame", "finite", value));
            }
        }
        Ok(())
    }
}
