//! What is seen of a flow in a plane: its values and the sections of the bodies, to be drawn or
//! written.

use nalgebra::Vector3;

use crate::plane::section::sections;
use crate::plane::{Plane, PlaneFlow, PlaneOptions, heads};
use bodies_of_revolution::CurveError;
use stokes_body::linear_flow::LinearFlow;
use stokes_body::progress::{Progress, Silent};
use stokes_suspension::{Answer, Flow, Suspension, SuspensionError};

/// The flow in a plane and the bodies that the plane cuts.
#[derive(Clone, Debug)]
pub struct View {
    /// Velocity and pressure at the grid points.
    pub flow: PlaneFlow,
    /// Closed curves in the coordinates of the plane, with what an odd number of them goes around
    /// inside bodies.
    pub sections: Vec<Vec<[f64; 2]>>,
    /// Arrows inside the bodies that have a slip, from tail to head.
    pub heads: Vec<[[f64; 2]; 2]>,
    /// The undisturbed flow, as the same observer sees it.
    pub background: LinearFlow,
    /// What a picture is called; nothing if empty.
    pub title: String,
}

/// Why there is nothing to see.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The flow cannot be evaluated.
    #[error(transparent)]
    Flow(#[from] SuspensionError),
    /// A body cannot be cut.
    #[error(transparent)]
    Curve(#[from] CurveError),
}

impl View {
    /// The flow of an answer in the plane where most of it is to be seen, see [`Plane::of`].
    ///
    /// # Errors
    /// If the flow cannot be evaluated or a body not be cut.
    pub fn of(asked: &Suspension, answer: &Answer) -> Result<Self, ViewError> {
        let plane = Plane::of(asked, &PlaneOptions::default());
        Self::in_plane(&answer.flow, plane, &Silent)
    }

    /// A flow in a given plane; tells `progress` where it is.
    ///
    /// # Errors
    /// If the flow cannot be evaluated, a body not be cut, or the caller cancels.
    pub fn in_plane(flow: &Flow, plane: Plane, progress: &dyn Progress) -> Result<Self, ViewError> {
        Ok(Self {
            flow: PlaneFlow::sample(flow, plane, progress)?,
            sections: sections(flow, &plane)?,
            heads: heads(flow, &plane),
            background: *flow.background(),
            title: String::new(),
        })
    }

    /// The same seen by an observer who moves with this velocity.
    #[must_use]
    pub fn relative_to(mut self, velocity: Vector3<f64>) -> Self {
        self.background.velocity -= velocity;
        Self {
            flow: self.flow.relative_to(velocity),
            ..self
        }
    }

    /// The same with a title above its pictures.
    #[must_use]
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            ..self
        }
    }
}
