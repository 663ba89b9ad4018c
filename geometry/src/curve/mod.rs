//! Generating curves: the meridian of a body of revolution, in the half plane `(r, z)` with
//! `r >= 0`.
//!
//! A curve is traversed so that `(-dz/ds, dr/ds)` points out of the body: from the upper pole
//! (`z > 0`) to the lower one; a closed loop off the axis clockwise, with r to the right and z up.
//!
//! | curve | type |
//! |---|---|
//! | sphere, spheroid | [`Spheroid`] |
//! | cylinder with hemispherical caps | [`Capsule`] |
//! | torus | [`Torus`] |
//! | red cell | [`Biconcave`] |
//! | cosine series of the distance from the centre | [`Polar`] |
//! | smooth spline through points, from memory or a file | [`Profile`] |
//! | any function | [`FunctionCurve`] |
//!
//! [`Panels`] cut a curve into intervals for quadrature, by hand or from a tolerance; [`Outline`]
//! tells inside from outside and measures distances; [`check_simple`] says whether a curve bounds a
//! body.
//!
//! ```
//! use bodies_of_revolution::{Panels, Spheroid, curve::surface_area};
//!
//! let sphere = Spheroid::sphere(1.0)?;
//! let panels = Panels::resolving(&sphere, 16, 1e-12)?;
//! assert!((surface_area(&sphere, &panels) - 4.0 * std::f64::consts::PI).abs() < 1e-12);
//! # Ok::<(), bodies_of_revolution::CurveError>(())
//! ```

mod arc_length;
mod biconcave;
mod capsule;
#[cfg(test)]
mod checks;
mod chord;
mod error;
mod fourier;
mod function;
mod generating_curve;
mod legendre;
mod measures;
mod outline;
mod panel;
mod panels;
mod polar;
mod polygon;
mod profile;
mod profile_file;
mod quintic;
mod resolution;
mod shares;
mod spheroid;
mod torus;
mod validate;

pub use arc_length::arc_length;
pub use biconcave::Biconcave;
pub use capsule::Capsule;
pub use chord::chord_by_quadrature;
pub use error::{CurveError, LARGEST_ASPECT, LONGEST, SHORTEST};
pub use function::FunctionCurve;
pub use generating_curve::{GeneratingCurve, Meridian, Shape, Topology};
pub use measures::{surface_area, volume};
pub(crate) use outline::off_segment;
pub use outline::{ON_SURFACE, Outline, contains, distance};
pub use panel::Panel;
pub use panels::{MOST_PANELS, Panels};
pub use polar::Polar;
pub use profile::{MOST_POINTS, Profile};
pub use profile_file::MOST_BYTES;
pub use spheroid::Spheroid;
pub use torus::Torus;
pub use validate::check_simple;
