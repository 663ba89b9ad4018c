//! A case: what is asked, as validated values.

use super::{
    Accuracy, Background, Body, CaseError, KnownFlow, Located, OutputOptions, PlaneOptions,
    ShapeSpec, SolverOptions, TimeSpan,
};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::PathBuf;

/// A case: bodies, fluid and question, with every number validated.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Case {
    /// The file it came from, as given.
    pub path: PathBuf,
    /// Viscosity of the fluid, positive; 1 if not given.
    pub viscosity: f64,
    /// Shapes by name; some may be unused.
    pub shapes: BTreeMap<String, Located<ShapeSpec>>,
    /// Bodies in the order of the file, at least one.
    pub bodies: Vec<Body>,
    /// The undisturbed flow.
    pub background: Option<Located<Background>>,
    /// How accurate the answer must be; a tolerance of 1e-8 if not given.
    pub accuracy: Accuracy,
    /// Tolerance of sums and iterations if the discretisation is chosen by hand; `None` leaves it
    /// to the solver, and is always so if `accuracy` is a tolerance.
    pub tolerance_by_hand: Option<f64>,
    /// How the linear system is solved.
    pub solver: SolverOptions,
    /// Where velocity and pressure are wanted.
    pub probes: Vec<Located<[f64; 3]>>,
    /// A known flow that replaces what the bodies impose.
    pub test: Option<Located<KnownFlow>>,
    /// Time span, for a simulation.
    pub time: Option<Located<TimeSpan>>,
    /// What is written besides the answer.
    pub output: Option<Located<OutputOptions>>,
    /// The plane that pictures and VTK files show.
    pub plane: PlaneOptions,
}

impl Case {
    /// An error at a line of this case, for checks that need more than the file.
    pub fn error(&self, line: usize, message: impl Display) -> CaseError {
        CaseError::new(self.path.display(), Some(line), message)
    }

    /// The shape of a body of this case.
    pub fn shape_of(&self, body: &Body) -> &Located<ShapeSpec> {
        &self.shapes[&body.shape]
    }

    /// The tolerance asked for. If the discretisation was chosen by hand, it is that of sums and
    /// iterations, and `None` if not given.
    pub fn tolerance(&self) -> Option<f64> {
        self.promised_tolerance().or(self.tolerance_by_hand)
    }

    /// The tolerance that the answer must meet: none if the discretisation was chosen by hand.
    pub fn promised_tolerance(&self) -> Option<f64> {
        match self.accuracy {
            Accuracy::Tolerance(tolerance) => Some(tolerance),
            Accuracy::ByHand { .. } => None,
        }
    }
}
