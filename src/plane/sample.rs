//! Evaluating the flow in a plane.

use nalgebra::Point3;
use rayon::prelude::*;

use super::{Plane, PlaneFlow};
use crate::body::flow::FlowError;
use crate::curve::{Meridian, Outline};
use crate::kernel::FlowAt;
use crate::progress::Progress;
use crate::solve::{SolveError, Solved, SolvedBody};

/// Relative accuracy of what is drawn.
const TOLERANCE: f64 = 1e-6;
/// Points that are evaluated between two reports of progress.
const CHUNK: usize = 2048;

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
        let grid = plane.grid();
        progress.begin("plane", grid.len());
        let chunks = grid.par_chunks(CHUNK).map(|points| {
            let values = flow_at(&solved.bodies[0], points);
            progress.advance(points.len());
            values
        });
        let values: Vec<Vec<Option<FlowAt>>> = chunks.collect::<Result<_, SolveError>>()?;
        Ok(Self {
            plane,
            values: values.concat(),
        })
    }
}

/// The flow at points, `None` in the body and where it is too near to be evaluated.
fn flow_at(body: &SolvedBody, points: &[Point3<f64>]) -> Result<Vec<Option<FlowAt>>, SolveError> {
    let failed = |error: &dyn std::fmt::Display| SolveError::Failed(error.to_string());
    let curve = body.flow().discretization.curve();
    let outline = Outline::new(&**curve).map_err(|error| failed(&error))?;
    let mut targets: Vec<(usize, Point3<f64>, f64)> = Vec::new();
    for (place, &point) in points.iter().enumerate() {
        let target = body.frame().point_to_body(point);
        let meridian = Meridian {
            r: target.x.hypot(target.y),
            z: target.z,
        };
        if !outline.contains(meridian) {
            targets.push((place, target, outline.distance(meridian)));
        }
    }
    let mut values = vec![None; points.len()];
    loop {
        let positions: Vec<Point3<f64>> = targets.iter().map(|&(_, target, _)| target).collect();
        match body.flow().at(&positions, TOLERANCE) {
            Ok(flow) => {
                for (&(place, ..), at) in targets.iter().zip(flow) {
                    values[place] = Some(FlowAt {
                        velocity: body.frame().vector_to_lab(at.velocity),
                        pressure: body.viscosity() * at.pressure,
                    });
                }
                return Ok(values);
            }
            Err(FlowError::TooNear { index, .. }) => {
                let nearest = targets[index].2;
                targets.retain(|&(.., distance)| distance > 1.05 * nearest);
            }
            Err(error) => return Err(failed(&error)),
        }
    }
}
