//! Shapes: the generating curves a case names.

use super::file::check_regular;
use super::node::Node;
use super::section::Section;
use super::{CaseError, Located};
use serde::{Deserialize, Serialize, Serializer};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Most coefficients of a polar curve.
const MOST_COEFFICIENTS: usize = 1000;

const KINDS: &[(&str, &[&str])] = &[
    ("sphere", &["kind", "radius"]),
    ("spheroid", &["kind", "polar", "equatorial"]),
    ("capsule", &["kind", "radius", "length"]),
    ("torus", &["kind", "major", "minor"]),
    ("biconcave", &["kind", "radius"]),
    ("polar", &["kind", "coefficients"]),
    ("profile", &["kind", "file"]),
];

/// A generating curve with validated numbers: symmetry axis z, centred at the origin, lengths in
/// units of the case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
#[non_exhaustive]
pub enum ShapeSpec {
    /// A sphere.
    Sphere {
        /// Radius, positive.
        radius: f64,
    },
    /// A spheroid.
    Spheroid {
        /// Semi-axis along the symmetry axis, positive.
        polar: f64,
        /// Semi-axis across the symmetry axis, positive.
        equatorial: f64,
    },
    /// A cylinder between two hemispherical caps.
    Capsule {
        /// Radius of cylinder and caps, positive.
        radius: f64,
        /// Length of the cylinder alone, positive.
        length: f64,
    },
    /// A ring of circular section.
    Torus {
        /// Distance of the section's centre from the axis.
        major: f64,
        /// Radius of the section, positive and less than `major`.
        minor: f64,
    },
    /// The red-cell profile of Evans and Fung.
    Biconcave {
        /// Largest distance from the axis, positive.
        radius: f64,
    },
    /// Distance from the centre `sum_k c_k cos(k theta)`, `theta` from the axis.
    Polar {
        /// The coefficients `c_0, c_1, ...`, finite and not all zero. That the distance is positive
        /// everywhere is for the curve to check.
        coefficients: Vec<f64>,
    },
    /// A curve through the points of a file.
    Profile {
        /// Path of an existing regular file with columns `r,z`; already resolved against the folder
        /// of the case.
        #[serde(serialize_with = "as_text")]
        file: PathBuf,
    },
}

/// A path as text, also one that is not UTF-8.
fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(&path.display())
}

/// Reads `[shapes.NAME]`; `folder` is where the case lies.
pub(super) fn read_shapes(
    node: Node<'_>,
    folder: &Path,
) -> Result<BTreeMap<String, Located<ShapeSpec>>, CaseError> {
    let mut shapes = BTreeMap::new();
    for (name, node) in Section::open(node)?.entries() {
        if name.contains(char::is_control) {
            let message =
                format!("the shape's name {name:?}: expected one without control characters");
            return Err(node.error(message));
        }
        let shape = read_shape(&node, folder)?;
        shapes.insert(name.to_owned(), node.located(shape));
    }
    Ok(shapes)
}

fn read_shape(node: &Node<'_>, folder: &Path) -> Result<ShapeSpec, CaseError> {
    let section = Section::open(node.clone())?;
    let kinds: Vec<&str> = KINDS.iter().map(|(kind, _)| *kind).collect();
    let kind = section.kind(&format!("one of {}", kinds.join(", ")))?;
    let choices: Vec<_> = KINDS.iter().map(|pair| (pair.0, *pair)).collect();
    let (kind, known) = kind.choice(&choices)?;
    section.check(known)?;
    let length = |key: &str, what: &str| section.required(key, what)?.positive(what);
    Ok(match kind {
        "sphere" => ShapeSpec::Sphere {
            radius: length("radius", "a radius")?,
        },
        "spheroid" => ShapeSpec::Spheroid {
            polar: length("polar", "a semi-axis")?,
            equatorial: length("equatorial", "a semi-axis")?,
        },
        "capsule" => ShapeSpec::Capsule {
            radius: length("radius", "a radius")?,
            length: length("length", "the cylinder's length")?,
        },
        "torus" => read_torus(&section)?,
        "biconcave" => ShapeSpec::Biconcave {
            radius: length("radius", "a radius")?,
        },
        "polar" => read_polar(&section)?,
        _ => read_profile(&section, folder)?,
    })
}

fn read_torus(section: &Section<'_>) -> Result<ShapeSpec, CaseError> {
    let major = section
        .required("major", "a radius")?
        .positive("the ring's radius")?;
    let minor_node = section.required("minor", "a radius")?;
    let minor = minor_node.positive("the section's radius")?;
    if minor >= major {
        return Err(minor_node.expected(format_args!("a radius less than major = {major}")));
    }
    Ok(ShapeSpec::Torus { major, minor })
}

fn read_polar(section: &Section<'_>) -> Result<ShapeSpec, CaseError> {
    let node = section.required("coefficients", "a list of numbers")?;
    let coefficients = node.numbers()?;
    if coefficients.len() > MOST_COEFFICIENTS {
        let given = coefficients.len();
        return Err(node.error(format!(
            "{} has {given} numbers: expected at most {MOST_COEFFICIENTS}",
            node.key
        )));
    }
    if coefficients.iter().all(|&c| c == 0.0) {
        return Err(node.expected("a distance from the centre that is positive"));
    }
    Ok(ShapeSpec::Polar { coefficients })
}

fn read_profile(section: &Section<'_>, folder: &Path) -> Result<ShapeSpec, CaseError> {
    let node = section.required("file", "the path of a file with columns r,z")?;
    let file = folder.join(node.string("the path of a file with columns r,z")?);
    match check_regular(&file) {
        Ok(()) => Ok(ShapeSpec::Profile { file }),
        Err(why) => {
            let file = file.display();
            Err(node.expected(format_args!("a readable file ({file}: {why})")))
        }
    }
}
