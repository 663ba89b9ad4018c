//! Which body a point is in.

use std::sync::Arc;

use nalgebra::Point3;

use super::curve::{CurveError, Meridian, Outline, Shape};
use super::frame::Frame;
use super::neighbours::{Ball, Neighbours};

/// Bodies in their places, to ask about many points which body they are in.
#[derive(Clone, Debug)]
pub struct Insides {
    outlines: Vec<Outline<Shape>>,
    /// Every body's frame, and the place of its shape's outline.
    bodies: Vec<(Frame, usize)>,
    neighbours: Neighbours,
}

impl Insides {
    /// The bodies with these shapes and frames; those that share a shape share its outline.
    ///
    /// # Errors
    /// The first body whose shape has no outline, and why.
    pub fn new<'a>(
        bodies: impl IntoIterator<Item = (&'a Shape, Frame)>,
    ) -> Result<Self, (usize, CurveError)> {
        let mut shapes: Vec<(&Shape, f64)> = Vec::new();
        let mut outlines = Vec::new();
        let mut placed = Vec::new();
        let mut balls = Vec::new();
        for (body, (shape, frame)) in bodies.into_iter().enumerate() {
            let known = shapes
                .iter()
                .position(|(known, _)| Arc::ptr_eq(known, shape));
            let outline = match known {
                Some(outline) => outline,
                None => {
                    let outline = Outline::new(shape.clone()).map_err(|error| (body, error))?;
                    let far = outline.corners().iter().map(|x| x.r.hypot(x.z));
                    // An arc lies beyond the ends of its chord by no more than the polygon's slack.
                    let radius = 1.001 * far.fold(0.0, f64::max);
                    shapes.push((shape, radius));
                    outlines.push(outline);
                    shapes.len() - 1
                }
            };
            balls.push(Ball {
                center: frame.center(),
                radius: frame.scale() * shapes[outline].1,
            });
            placed.push((frame, outline));
        }
        Ok(Self {
            outlines,
            bodies: placed,
            neighbours: Neighbours::new(balls),
        })
    }

    /// The first body that a point is inside of.
    pub fn body_at(&self, point: Point3<f64>) -> Option<usize> {
        let candidates = self.neighbours.holding(point).into_iter();
        let contains = |&body: &usize| {
            let (frame, outline) = &self.bodies[body];
            let at = Meridian::of(&frame.point_to_body(point));
            self.outlines[*outline].contains(at)
        };
        candidates.into_iter().find(contains)
    }
}
