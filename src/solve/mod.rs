//! From a case to its answer: a case file is read, asked as a [`Suspension`],
//! and reported.

mod error;
mod explain;
mod question;
mod report;

use nalgebra::Vector3;

use crate::case::{Case, CaseError, PlaneFrame};
use crate::output::Report;
use crate::plane::{Plane, PlaneOptions, PlaneOrientation};
pub use error::SolveError;
pub use explain::explain;
use question::Question;
use stokes_body::progress::Progress;
use stokes_suspension::{Answer, Options, SolveError as Unsolved, Solver, Suspension};

/// A case that was solved.
#[derive(Clone, Debug)]
pub struct Solved {
    /// What the case asked for.
    pub report: Report,
    /// The answer as the library gives it, to look at more closely.
    pub answer: Answer,
    /// The plane that the case shows.
    pub plane: Plane,
    /// The velocity of the observer who sees the plane.
    pub observer: Vector3<f64>,
}

/// Solves a case once.
///
/// The report is returned even when its error estimate exceeds the tolerance: the caller compares.
///
/// # Errors
/// [`SolveError::Case`] if the case asks for the impossible or for what is not built,
/// [`SolveError::Interrupted`] if `progress` says so.
pub fn solve(case: &Case, progress: &dyn Progress) -> Result<Solved, SolveError> {
    case.check_supported()?;
    let question = Question::new(case)?;
    let mut solver = Solver::new(question.options.clone());
    let answer = solver.solve_with(&question.suspension, None, progress);
    let answer = answer.or_else(Unsolved::answer);
    let answer = answer.map_err(|error| explain::explain(case, error))?;
    let plane = Plane::of(&question.suspension, &plane_options(case));
    let observer = match case.plane.frame {
        PlaneFrame::Laboratory => Vector3::zeros(),
        PlaneFrame::Body => answer.bodies[0].motion.velocity,
    };
    Ok(Solved {
        report: report::report(case, &question, &answer, progress)
            .map_err(|error| explain::explain(case, error))?,
        answer,
        plane,
        observer,
    })
}

/// What a case asks, in the library's terms.
///
/// # Errors
/// If the case asks for the impossible.
pub fn question_of(case: &Case) -> Result<(Suspension, Options), CaseError> {
    let question = Question::new(case)?;
    Ok((question.suspension, question.options))
}

/// The plane that a case shows.
///
/// # Errors
/// If the case asks for the impossible.
pub fn plane_of(case: &Case) -> Result<Plane, CaseError> {
    let question = Question::new(case)?;
    Ok(Plane::of(&question.suspension, &plane_options(case)))
}

/// What `[plane]` asks for.
fn plane_options(case: &Case) -> PlaneOptions {
    let asked = &case.plane;
    PlaneOptions {
        center: asked.center.map(Into::into),
        orientation: asked.orientation.map(|orientation| match orientation {
            crate::case::Orientation::Normal(normal) => PlaneOrientation::Normal(normal.into()),
            crate::case::Orientation::Directions { across, up } => PlaneOrientation::Directions {
                across: across.into(),
                up: up.into(),
            },
        }),
        size: asked.size,
        points: asked.points,
    }
}
