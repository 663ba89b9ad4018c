//! What a generating curve is.

use std::fmt::Debug;
use std::sync::Arc;

use nalgebra::Point3;

/// A point, or a vector, of the meridian half plane; lengths in the units of the case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meridian {
    /// Distance from the symmetry axis (or radial component).
    pub r: f64,
    /// Height along the symmetry axis (or axial component).
    pub z: f64,
}

impl Meridian {
    /// Where a point of the body's frame lies in the half plane.
    pub fn of(point: &Point3<f64>) -> Self {
        Self {
            r: point.x.hypot(point.y),
            z: point.z,
        }
    }
}

/// A generating curve that bodies share. Bodies with the same `Arc` share all that depends on the
/// shape alone.
pub type Shape = Arc<dyn GeneratingCurve>;

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
    /// Ends of the smooth pieces in the parameter `s`, ascending; the first and the last are the
    /// curve's ends.
    fn breakpoints(&self) -> Vec<f64>;

    /// How the curve closes.
    fn topology(&self) -> Topology;

    /// The point `(r(s), z(s))`.
    fn point(&self, s: f64) -> Meridian;

    /// The derivative `(dr/ds, dz/ds)`.
    fn tangent(&self, s: f64) -> Meridian;

    /// The difference `gamma(s + ds) - gamma(s)`, to full *relative* precision however small `ds`
    /// is.
    fn chord(&self, s: f64, ds: f64) -> Meridian;

    /// The curve as a shape that bodies share.
    fn shape(self) -> Shape
    where
        Self: Sized + 'static,
    {
        Arc::new(self)
    }

    /// The largest distance of the curve from the origin, from 65 points of it.
    fn extent(&self) -> f64 {
        let ends = self.breakpoints();
        let (first, last) = (ends[0], ends[ends.len() - 1]);
        let far = (0..=64).map(|k| {
            let point = self.point(first + (last - first) * f64::from(k) / 64.0);
            point.r.hypot(point.z)
        });
        far.fold(0.0, f64::max)
    }
}
