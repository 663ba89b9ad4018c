//! The plane that pictures and VTK files show.

use super::CaseError;
use super::node::Node;
use super::section::Section;

/// How far from orthogonal the two directions may be: relative rounding of their given digits.
const SLACK: f64 = 1e-12;
/// Largest ratio of width and height.
const LONGEST: f64 = 20.0;
/// Most grid points in one direction.
pub const MOST_PLANE_POINTS: usize = 1001;

/// What `[plane]` asks for; what is `None` is chosen.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct PlaneOptions {
    /// The middle; if not given, the only body's centre or that of all.
    pub center: Option<[f64; 3]>,
    /// How it lies in space.
    pub orientation: Option<Orientation>,
    /// Width and height.
    pub size: Option<[f64; 2]>,
    /// Grid points across and up, at least two each.
    pub points: Option<[usize; 2]>,
    /// Whom the velocities are relative to.
    pub frame: PlaneFrame,
}

/// How a plane lies in space; directions have length one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orientation {
    /// Orthogonal to a direction.
    Normal([f64; 3]),
    /// Two orthogonal directions in it, which the picture shows to the right and upwards.
    Directions {
        /// To the right.
        across: [f64; 3],
        /// Upwards.
        up: [f64; 3],
    },
}

/// Whom the velocities in the plane are relative to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PlaneFrame {
    /// The laboratory.
    #[default]
    Laboratory,
    /// An observer who moves with the centre of the first body, and does not turn.
    Body,
}

/// Reads `[plane]`.
pub(super) fn read_plane(node: Node<'_>) -> Result<PlaneOptions, CaseError> {
    let keys = [
        "center", "normal", "across", "up", "size", "points", "frame",
    ];
    let section = Section::new(node, &keys)?;
    let frames = [("lab", PlaneFrame::Laboratory), ("body", PlaneFrame::Body)];
    Ok(PlaneOptions {
        center: section.read("center", Node::vector)?,
        orientation: read_orientation(&section)?,
        size: section.read("size", read_size)?,
        points: section.read("points", read_points)?,
        frame: section
            .read("frame", |node| node.choice(&frames))?
            .unwrap_or_default(),
    })
}

fn read_orientation(section: &Section<'_>) -> Result<Option<Orientation>, CaseError> {
    let [normal, across, up] = ["normal", "across", "up"].map(|key| section.optional(key));
    match (normal, across, up) {
        (None, None, None) => Ok(None),
        (Some(normal), None, None) => Ok(Some(Orientation::Normal(normal.direction()?))),
        (None, Some(across_node), Some(up_node)) => {
            let (across, up) = (across_node.direction()?, up_node.direction()?);
            let along: f64 = across.iter().zip(&up).map(|(a, b)| a * b).sum();
            if along.abs() > SLACK {
                return Err(up_node.expected("across and up orthogonal to each other"));
            }
            Ok(Some(Orientation::Directions { across, up }))
        }
        (Some(normal), Some(other), _) | (Some(normal), None, Some(other)) => {
            let later = if normal.line > other.line {
                &normal
            } else {
                &other
            };
            Err(later.error(format!(
                "both {} and {} are given: expected normal alone, or across and up",
                normal.key, other.key
            )))
        }
        (None, Some(_), None) => section
            .required("up", "across and up, or normal alone")
            .map(|_| None),
        (None, None, Some(_)) => section
            .required("across", "across and up, or normal alone")
            .map(|_| None),
    }
}

/// One length for a square, or width and height.
fn read_size(node: &Node<'_>) -> Result<[f64; 2], CaseError> {
    let what = "a length, or [width, height]";
    let Ok(items) = node.array(what) else {
        return node.positive(what).map(|length| [length; 2]);
    };
    let lengths: Vec<f64> = items
        .iter()
        .map(|item| item.positive("a length"))
        .collect::<Result<_, _>>()?;
    let [width, height]: [f64; 2] = lengths.try_into().map_err(|_| node.expected(what))?;
    if width.max(height) > LONGEST * width.min(height) {
        return Err(node.expected(format_args!(
            "a width and a height that differ by a factor of at most {LONGEST}"
        )));
    }
    Ok([width, height])
}

/// One number for both directions, or one for each.
fn read_points(node: &Node<'_>) -> Result<[usize; 2], CaseError> {
    let what = "a number of points, or [across, up]";
    let range = 2..=MOST_PLANE_POINTS;
    let Ok(items) = node.array(what) else {
        return node.integer(what, range).map(|count| [count; 2]);
    };
    let counts: Vec<usize> = items
        .iter()
        .map(|item| item.integer("a number of points", range.clone()))
        .collect::<Result<_, _>>()?;
    counts.try_into().map_err(|_| node.expected(what))
}
