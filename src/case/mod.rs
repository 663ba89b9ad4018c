//! Case files: what is asked, as validated values.
//!
//! [`Case::read`] turns a TOML file into a [`Case`] or into one [`CaseError`] that names the key,
//! its line, the offending value and what was expected. The whole format is read; what cannot be
//! solved yet is refused afterwards, by name, in [`Case::check_supported`]. Geometry (a curve that
//! meets itself, a probe inside a body) is checked where curves are known; [`Case::error`] points
//! such an error at the line of its cause.
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
//! assert_eq!(error.line(), Some(1));
//! assert!(error.to_string().starts_with("bad.toml:1: viscosity = -1: expected a viscosity"));
//! ```

mod accuracy;
mod background;
mod body;
mod curve;
mod definition;
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
mod read;
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
pub use definition::Case;
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
