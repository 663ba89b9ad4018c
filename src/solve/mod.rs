//! From a case to its answer.
//!
//! | module | what |
//! |---|---|
//! | `setting` | the bodies in their places, and what of the report does not depend on how they are solved for |
//! | `single` | one body: a direct solution in its own frame |
//! | `many` | more: a [suspension](stokes_suspension) |

mod many;
mod setting;
mod single;

use nalgebra::Point3;
use rayon::prelude::*;

use crate::case::{Case, CaseError, Formulation};
use crate::output::Report;
use bodies_of_revolution::Frame;
use bodies_of_revolution::Insides;
use setting::Setting;
use stokes_body::body_flow::BodyFlow;
use stokes_body::dirichlet;
use stokes_body::discretization::Discretization;
use stokes_body::kernel::FlowAt;
use stokes_body::progress::{Progress, Silent};
use stokes_body::surface::SurfaceModes;
use stokes_suspension::flow::SuspensionFlow;

/// Why a case has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The case is at fault: its geometry, what it would take, or a part of the format that is not built.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// Whoever waited has lost interest.
    #[error("interrupted")]
    Interrupted,
    /// The computation itself failed.
    #[error("{0}")]
    Failed(String),
}

/// A case that was solved: its report, and the flow to look at more closely. Everything is in the laboratory's frame.
#[derive(Clone, Debug)]
pub struct Solved {
    /// What the case asked for.
    pub report: Report,
    /// The bodies in the order of the case.
    pub bodies: Vec<SolvedBody>,
    flow: Whole,
    viscosity: f64,
    /// Tolerance of the flow's quadrature.
    tolerance: f64,
}

/// One body of a case that was solved.
#[derive(Clone, Debug)]
pub struct SolvedBody {
    frame: Frame,
    discretization: Discretization,
    velocity: SurfaceModes,
    modes: usize,
}

/// The whole flow for viscosity 1: of one body in its own frame, of many in the laboratory.
#[derive(Clone, Debug)]
enum Whole {
    One(Box<BodyFlow>),
    Many(SuspensionFlow),
}

impl Solved {
    /// Velocity and pressure of the whole flow at any points, `None` inside a body.
    ///
    /// # Errors
    /// If a point is not finite.
    pub fn flow_at(&self, points: &[Point3<f64>]) -> Result<Vec<Option<FlowAt>>, SolveError> {
        self.evaluate(points, self.tolerance, &Silent)
    }

    /// The same to another tolerance, telling where it is.
    pub(crate) fn evaluate(
        &self,
        points: &[Point3<f64>],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<Option<FlowAt>>, SolveError> {
        let bodies = self.bodies.iter();
        let insides = Insides::new(bodies.map(|body| (body.discretization.curve(), body.frame)))
            .map_err(|(_, error)| failed(error))?;
        let is_outside = |&place: &usize| insides.body_at(points[place]).is_none();
        let places: Vec<usize> = (0..points.len())
            .into_par_iter()
            .filter(is_outside)
            .collect();
        let targets = places.iter().map(|&place| points[place]);
        let mut flow = vec![None; points.len()];
        let found: Vec<FlowAt> = match &self.flow {
            Whole::One(of_body) => {
                let frame = &self.bodies[0].frame;
                let targets: Vec<_> = targets.map(|x| frame.point_to_body(x)).collect();
                let found = of_body.evaluate(&targets, tolerance, progress);
                let in_lab = |at: FlowAt| FlowAt {
                    velocity: frame.vector_to_lab(at.velocity),
                    pressure: at.pressure / frame.scale(),
                };
                found.map_err(failed)?.into_iter().map(in_lab).collect()
            }
            Whole::Many(of_all) => {
                let targets: Vec<_> = targets.collect();
                let found = of_all.evaluate(&targets, tolerance, progress);
                found.map_err(many::failed)?
            }
        };
        if progress.is_cancelled() {
            return Err(SolveError::Interrupted);
        }
        for (place, at) in places.into_iter().zip(found) {
            flow[place] = Some(FlowAt {
                pressure: self.viscosity * at.pressure,
                ..at
            });
        }
        Ok(flow)
    }

    /// The traction of the fluid on every body's surface, a force per area: as vectors in the body's frame.
    pub(crate) fn tractions(
        &self,
        progress: &dyn Progress,
    ) -> Result<Vec<SurfaceModes>, SolveError> {
        let of_unit_viscosity = match &self.flow {
            Whole::One(of_body) => {
                let traction = of_body.traction().map_err(failed)?;
                vec![traction.scaled(1.0 / self.bodies[0].frame.scale())]
            }
            Whole::Many(of_all) => {
                let all: Vec<usize> = (0..self.bodies.len()).collect();
                let tractions = of_all.tractions(&all, self.tolerance, progress);
                tractions.map_err(many::failed)?
            }
        };
        let tractions = of_unit_viscosity.iter();
        Ok(tractions
            .map(|traction| traction.scaled(self.viscosity))
            .collect())
    }
}

impl SolvedBody {
    /// Where the body is, and how large.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Panels and nodes of its generating curve, in its own frame.
    pub fn discretization(&self) -> &Discretization {
        &self.discretization
    }

    /// The velocity of its surface, as vectors in its own frame.
    pub fn surface_velocity(&self) -> &SurfaceModes {
        &self.velocity
    }

    /// Azimuthal modes of what was solved for, the zeroth counted.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// Half its largest extent.
    pub fn size(&self) -> f64 {
        self.frame.scale() * self.discretization.size()
    }
}

/// Solves a case once.
///
/// The report is returned even when its error estimate exceeds the tolerance: the caller compares.
///
/// # Errors
/// [`SolveError::Case`] if the case asks for the impossible or for what is not built, [`SolveError::Interrupted`] if `progress` says so.
pub fn solve(case: &Case, progress: &dyn Progress) -> Result<Solved, SolveError> {
    case.check_supported()?;
    let setting = Setting::new(case)?;
    match setting.bodies.len() {
        1 => single::solve(&setting, progress),
        _ => many::solve(&setting, progress),
    }
}

fn formulation(case: &Case) -> dirichlet::Formulation {
    match case.solver.formulation {
        Formulation::SingleLayer => dirichlet::Formulation::SingleLayer,
        Formulation::Combined => dirichlet::Formulation::CombinedField,
    }
}

fn failed(error: impl std::fmt::Display) -> SolveError {
    SolveError::Failed(error.to_string())
}
