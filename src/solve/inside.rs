//! Which body a point is in.

use std::sync::Arc;

use nalgebra::Point3;

use crate::body::flow::meridian;
use crate::body::frame::Frame;
use crate::curve::{CurveError, GeneratingCurve, Outline};

/// Bodies in their places, to ask many points about.
pub(super) struct Insides<'a> {
    outlines: Vec<Outline<'a, dyn GeneratingCurve>>,
    bodies: Vec<Place>,
}

struct Place {
    frame: Frame,
    outline: usize,
    /// Of a ball around the centre with the body in it.
    radius: f64,
}

impl<'a> Insides<'a> {
    /// The bodies with these curves and frames; those that share a curve share its outline.
    ///
    /// # Errors
    /// The first body with a curve that is not one, and why.
    pub fn new(
        bodies: impl Iterator<Item = (&'a Arc<dyn GeneratingCurve>, Frame)>,
    ) -> Result<Self, (usize, CurveError)> {
        let mut curves: Vec<(&Arc<dyn GeneratingCurve>, f64)> = Vec::new();
        let mut insides = Self {
            outlines: Vec::new(),
            bodies: Vec::new(),
        };
        for (index, (curve, frame)) in bodies.enumerate() {
            let known = curves
                .iter()
                .position(|(known, _)| Arc::ptr_eq(known, curve));
            let outline = match known {
                Some(outline) => outline,
                None => {
                    let outline = Outline::new(&**curve).map_err(|error| (index, error))?;
                    let far = outline.corners().iter().map(|x| x.r.hypot(x.z));
                    // A chord's arc lies beyond its ends by no more than the polygon's slack.
                    let radius = 1.001 * far.fold(0.0, f64::max);
                    curves.push((curve, radius));
                    insides.outlines.push(outline);
                    curves.len() - 1
                }
            };
            insides.bodies.push(Place {
                frame,
                outline,
                radius: frame.scale() * curves[outline].1,
            });
        }
        Ok(insides)
    }

    /// The first body that a point is inside of.
    pub fn body_at(&self, point: Point3<f64>) -> Option<usize> {
        let contains = |place: &Place| {
            let Place {
                frame,
                outline,
                radius,
            } = place;
            (point - frame.center()).norm() <= *radius
                && self.outlines[*outline].contains(meridian(&frame.point_to_body(point)))
        };
        self.bodies.iter().position(contains)
    }
}
