//! Case files: what is asked, as validated values.
//!
//! [`Case::read`] turns a TOML file into a [`Case`] or into one [`CaseError`] that names the key, its line, the
//! offending value and what was expected. The whole format is read; what cannot be solved yet is refused
//! afterwards, by name, in [`Case::check_supported`]. Geometry (a curve that meets itself, a probe inside a body)
//! is checked where curves are known; [`Case::error`] points such an error at the line of its cause.
//!
//! ```
//! # use axistokes::case::{Case, ShapeSpec};
//! let text = "
//!     [shapes.ball]
//!     kind = 'sphere'
//!     radius = 1
//!     [[bodies]]
//!     shape = 'ball'
//!     velocity = [0, 0, 1]
//! ";
//! let case = Case::parse(text, "ball.toml").unwrap();
//! assert_eq!(case.shapes["ball"].value, ShapeSpec::Sphere { radius: 1.0 });
//!
//! let error = Case::parse("viscosity = -1", "bad.toml").unwrap_err();
//! assert_eq!(
//!     error.to_string(),
//!     "bad.toml:1: viscosity = -1: expected a viscosity, a finite number greater than zero (1e-30 to 1e30)"
//! );
//! ```

mod accuracy;
mod background;
mod body;
mod curve;
mod error;
mod file;
mod known_flow;
mod located;
mod motion;
mod node;
mod orientation;
mod output;
mod plane;
mod probes;
mod section;
mod shape;
mod slip;
mod solver;
mod source;
mod suggest;
mod support;
mod time;
mod warnings;

pub use accuracy::{Accuracy, MOST_MODES, MOST_PANELS, SMALLEST_TOLERANCE};
pub use background::Background;
pub use body::Body;
pub use error::CaseError;
pub use file::{LARGEST_FILE, check_regular, read_text};
pub use known_flow::{KnownFlow, Stokeslet};
pub use located::Located;
pub use motion::{Component, Motion};
pub use orientation::BodyOrientation;
pub use output::OutputOptions;
pub use plane::{MOST_PLANE_POINTS, Orientation, PlaneFrame, PlaneOptions};
pub use shape::ShapeSpec;
pub use slip::Slip;
pub use solver::{Formulation, Method, SolverOptions};
pub use time::{Steps, TimeSpan};

use file::text_of;
use section::Section;
use source::Source;
use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::{Path, PathBuf};

const KEYS: &[&str] = &[
    "viscosity",
    "shapes",
    "bodies",
    "background",
    "accuracy",
    "solver",
    "probes",
    "test",
    "time",
    "output",
    "plane",
];

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
    /// Whether errors are estimated, which takes a second solution; true if not given.
    pub estimate: bool,
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
    /// Reads a case file. Anything but a regular UTF-8 file of at most [`LARGEST_FILE`] bytes is
    /// refused unread. The path `-` stands for standard input: the case is then named `stdin`, and
    /// lies in the current folder.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CaseError> {
        let path = path.as_ref();
        if path == Path::new("-") {
            let stdin = Path::new("stdin");
            return Self::parse(&text_of(std::io::stdin(), stdin)?, stdin);
        }
        Self::parse(&read_text(path)?, path)
    }

    /// Parses the text of a case; `path` names it in errors, and its folder is where profiles are looked for.
    pub fn parse(text: &str, path: impl AsRef<Path>) -> Result<Self, CaseError> {
        let path = path.as_ref();
        let source = Source::new(path.display().to_string(), text);
        let document = source.parse()?;
        let root = Section::new(source.root(&document), KEYS)?;
        if root.is_empty() {
            return Err(source.error(
                None,
                "the file is empty: expected [shapes.NAME] and [[bodies]]",
            ));
        }
        Self::from_root(&root, path)
    }

    fn from_root(root: &Section<'_>, path: &Path) -> Result<Self, CaseError> {
        let missing = |what| root.node.source.error(None, what);
        let viscosity = root.read("viscosity", |node| node.positive("a viscosity"))?;
        let accuracy = root
            .read("accuracy", |node| accuracy::read_accuracy(node.clone()))?
            .unwrap_or_default();
        let solver = root.read("solver", |node| solver::read_solver(node.clone()))?;
        let background = root.read("background", |node| {
            Ok(node.located(background::read_background(node.clone())?))
        })?;
        let probes = root.read("probes", |node| probes::read_probes(node.clone()))?;
        let test = root.read("test", |node| {
            Ok(node.located(known_flow::read_known_flow(node.clone())?))
        })?;
        let time = root.read("time", |node| {
            Ok(node.located(time::read_time(node.clone())?))
        })?;
        let output = root.read("output", |node| {
            Ok(node.located(output::read_output(node.clone())?))
        })?;
        let plane = root.read("plane", |node| plane::read_plane(node.clone()))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let shapes = match root.optional("shapes") {
            Some(node) => shape::read_shapes(node, folder)?,
            None => {
                let message = "[shapes] is missing: expected at least one [shapes.NAME]";
                return Err(missing(message));
            }
        };
        let Some(bodies) = root.optional("bodies") else {
            return Err(missing("no bodies: expected at least one [[bodies]]"));
        };
        let case = Self {
            path: path.to_owned(),
            viscosity: viscosity.unwrap_or(1.0),
            bodies: body::read_bodies(&bodies, &shapes)?,
            shapes,
            background,
            accuracy: accuracy.accuracy,
            tolerance_by_hand: accuracy.tolerance_by_hand,
            estimate: accuracy.estimate.unwrap_or(true),
            solver: solver.unwrap_or_default(),
            probes: probes.unwrap_or_default(),
            test,
            time,
            output,
            plane: plane.unwrap_or_default(),
        };
        match &case.test {
            Some(test) if case.probes.is_empty() => {
                let message = "[test] compares at the probes: expected [probes] with points";
                Err(case.error(test.line, message))
            }
            _ => Ok(case),
        }
    }

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

    /// What is valid in this case but seldom meant, one line each.
    pub fn warnings(&self) -> Vec<String> {
        warnings::warnings(self)
    }

    /// Refuses, by name, the parts of the format that cannot be solved yet.
    pub fn check_supported(&self) -> Result<(), CaseError> {
        support::check(self)
    }
}
