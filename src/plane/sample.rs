//! Evaluating the flow in a plane.

use nalgebra::Point3;
use rayon::prelude::*;

use super::{Plane, PlaneFlow};
use crate::curve::{Meridian, Outline};
use crate::kernel::FlowAt;
use crate::progress::Progress;
use crate::solve::{SolveError, Solved};

/// Relative accuracy of what is drawn.
const TOLERANCE: f64 = 1e-6;
/// Points that are evaluated between two reports of progress.
const CHUNK: usize = 1024;

impl PlaneFlow {
    /// The flow of a solved case at the grid points of a plane, relative to the laboratory, to about six digits.
    ///
    /// # Errors
    /// If the flow cannot be evaluated.
    pub fn sample(
        solved: &Solved,
        plane: Plane,
        progress: &dyn Progress,
    ) -> Result<Self, SolveError> {
        let failed = |error: &dyn std::fmt::Display| SolveError::Failed(error.to_string());
        let body = &solved.bodies[0];
        let (frame, flow) = (body.frame(), body.flow());
        let curve = flow.discretization.curve();
        let outline = Outline::new(&**curve).map_err(|error| failed(&error))?;
        let grid = plane.grid();
        progress.begin("plane", grid.len());
        let outside = |point: &Point3<f64>| {
            let x = frame.point_to_body(*point);
            let (r, z) = (x.x.hypot(x.y), x.z);
            (!outline.contains(Meridian { r, z })).then_some(x)
        };
        let targets: Vec<Option<Point3<f64>>> = grid.par_iter().map(outside).collect();
        let disturbance = flow.disturbance();
        let mut values = Vec::with_capacity(grid.len());
        for targets in targets.chunks(CHUNK) {
            let fluid: Vec<Point3<f64>> = targets.iter().copied().flatten().collect();
            let found = disturbance.at(&fluid, TOLERANCE);
            let mut found = found.map_err(|error| failed(&error))?.into_iter();
            values.extend(targets.iter().map(|target| {
                let (x, at) = ((*target)?, found.next()?);
                Some(FlowAt {
                    velocity: frame.vector_to_lab(at.velocity + flow.background.at(x.coords)),
                    pressure: body.viscosity() * at.pressure,
                })
            }));
            progress.advance(targets.len());
        }
        Ok(Self { plane, values })
    }
}
