//! Generating curves: the meridian of a body of revolution, in the half plane `(r, z)` with `r >= 0`.
//!
//! A curve is traversed so that `(-dz/ds, dr/ds)` points out of the body: from the upper pole (`z > 0`)
//! to the lower one, or clockwise in the `(r, z)` plane's outside sense for a closed loop off the axis.

mod biconcave;
mod capsule;
#[cfg(test)]
mod checks;
mod chord;
mod error;
mod fourier;
mod function;
mod legendre;
mod measures;
mod outline;
mod panels;
mod polar;
mod polygon;
mod profile;
mod profile_file;
mod quintic;
mod resolution;
mod spheroid;
mod torus;
mod validate;

use std::fmt::Debug;

pub use biconcave::Biconcave;
pub use capsule::Capsule;
pub use chord::chord_by_quadrature;
pub use error::{CurveError, LARGEST_ASPECT, LONGEST, SHORTEST};
pub use function::FunctionCurve;
pub use measures::{arc_length, surface_area, volume};
pub use outline::{Outline, contains, distance};
pub use panels::{MOST_PANELS, Panel, Panels};
pub use polar::Polar;
pub use profile::{MOST_POINTS, Profile};
pub use profile_file::MOST_BYTES;
pub use spheroid::Spheroid;
pub use torus::Torus;
pub use validate::check_simple;

/// A point, or a vector, of the meridian half plane; lengths in the units of the case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meridian {
    /// Distance from the symmetry axis (or radial component).
    pub r: f64,
    /// Height along the symmetry axis (or axial component).
    pub z: f64,
}

/// How a generating curve closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topology {
    /// Both ends lie on the symmetry axis (sphere-like bodies).
    PoleToPole,
    /// The curve is a closed loop off the axis (ring-like bodies).
    Loop,
}

/// A generating curve `s -> (r(s), z(s))`, smooth on each piece between two breakpoints.
pub trait GeneratingCurve: Debug + Send + Sync {
    /// Ends of the smooth pieces in the parameter `s`, ascending; the first and the last are the curve's ends.
    fn breakpoints(&self) -> Vec<f64>;

    /// How the curve closes.
    fn topology(&self) -> Topology;

    /// The point `(r(s), z(s))`.
    fn point(&self, s: f64) -> Meridian;

    /// The derivative `(dr/ds, dz/ds)`.
    fn tangent(&self, s: f64) -> Meridian;

    /// The difference `gamma(s + ds) - gamma(s)`, to full *relative* precision however small `ds` is.
    fn chord(&self, s: f64, ds: f64) -> Meridian;
}
