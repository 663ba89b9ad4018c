//! From the text of a case file to the case.

use super::accuracy::read_accuracy;
use super::background::read_background;
use super::body::read_bodies;
use super::file::{read_text, text_of};
use super::known_flow::read_known_flow;
use super::node::Node;
use super::output::read_output;
use super::plane::read_plane;
use super::probes::read_probes;
use super::section::Section;
use super::shape::read_shapes;
use super::solver::read_solver;
use super::source::Source;
use super::time::read_time;
use super::{Case, CaseError};
use std::path::Path;

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

impl Case {
    /// Reads a case file. Anything but a regular UTF-8 file of at most
    /// [`LARGEST_FILE`](super::LARGEST_FILE) bytes is refused unread. The path `-` stands for
    /// standard input: the case is then named `stdin`, and lies in the current folder.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, CaseError> {
        let path = path.as_ref();
        if path == Path::new("-") {
            let stdin = Path::new("stdin");
            return Self::parse(&text_of(std::io::stdin(), stdin)?, stdin);
        }
        Self::parse(&read_text(path)?, path)
    }

    /// Parses the text of a case; `path` names it in errors, and its folder is where profiles are
    /// looked for.
    pub fn parse(text: &str, path: impl AsRef<Path>) -> Result<Self, CaseError> {
        let path = path.as_ref();
        let source = Source::new(path.display().to_string(), text);
        let document = source.parse()?;
        let root = Section::new(Node::root(&source, &document), KEYS)?;
        if root.is_empty() {
            return Err(source.error(
                None,
                "the file is empty: expected [shapes.NAME] and [[bodies]]",
            ));
        }
        Self::from_root(&root, path)
    }

    fn from_root(root: &Section<'_>, path: &Path) -> Result<Self, CaseError> {
        let missing = |what| root.node.error_of_file(what);
        let viscosity = root.read("viscosity", |node| node.positive("a viscosity"))?;
        let solver = root.read("solver", |node| read_solver(node.clone()))?;
        let memory = solver.as_ref().and_then(|solver| solver.memory);
        let accuracy = root
            .read("accuracy", |node| read_accuracy(node.clone(), memory))?
            .unwrap_or_default();
        let background = root.read("background", |node| {
            Ok(node.located(read_background(node.clone())?))
        })?;
        let probes = root.read("probes", |node| read_probes(node.clone()))?;
        let test = root.read("test", |node| {
            Ok(node.located(read_known_flow(node.clone())?))
        })?;
        let time = root.read("time", |node| Ok(node.located(read_time(node.clone())?)))?;
        let output = root.read(
            "output",
            |node| Ok(node.located(read_output(node.clone())?)),
        )?;
        let plane = root.read("plane", |node| read_plane(node.clone()))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let shapes = match root.optional("shapes") {
            Some(node) => read_shapes(node, folder)?,
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
            bodies: read_bodies(&bodies, &shapes)?,
            shapes,
            background,
            accuracy: accuracy.accuracy,
            tolerance_by_hand: accuracy.tolerance_by_hand,
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
}
