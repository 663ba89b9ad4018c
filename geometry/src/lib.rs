//! Bodies of revolution: their generating curves, panels on them, where bodies are and how they
//! move, and the gaps between them.
//!
//! ```
//! use bodies_of_revolution::*;
//! use nalgebra::{Point3, Vector3};
//!
//! let rod = Spheroid::new(1.0, 0.5)?.shape();
//! let across = Frame::along(Point3::new(0.0, 0.0, 2.0), Vector3::x_axis());
//! let upright = Frame::at(Point3::origin());
//! let placed = [upright, across].map(|frame| Placed { curve: &*rod, frame, reach: 1.0 });
//! let gap = gaps(&placed)?[0];
//! assert!((gap.distance - 0.5).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module | what |
//! |---|---|
//! | [`curve`] | generating curves and panels on them |
//! | [`frame`] | where a body is: centre, orientation, scale |
//! | [`rigid`] | rigid motions, forces and torques |
//! | [`gaps`](mod@gaps) | distances between bodies, contact and overlap |
//! | [`neighbours`] | which of many balls are near a point or a ball |
//! | [`inside`] | which body a point is in |

pub mod curve;
pub mod frame;
pub mod gaps;
pub mod inside;
pub mod neighbours;
pub mod rigid;

pub use curve::{
    Biconcave, Capsule, CurveError, FunctionCurve, GeneratingCurve, Meridian, Outline, Panel,
    Panels, Polar, Profile, Shape, Spheroid, Topology, Torus,
};
pub use frame::Frame;
pub use gaps::{ContactError, Depth, Gap, Placed, Relation, TOUCHING, gaps};
pub use inside::Insides;
pub use neighbours::{Ball, Neighbours};
pub use rigid::{RigidMotion, Wrench};
