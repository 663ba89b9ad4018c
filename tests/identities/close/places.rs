//! Places on a surface, and points at a distance from them.

use std::f64::consts::PI;

use axistokes::Meridian;
use axistokes::body::Discretization;
use axistokes::body::flow::Side;
use axistokes::geometry::Outline;
use nalgebra::Point3;

/// Towards the fluid or into the body.
pub const SIDES: [Side; 2] = [Side::Exterior, Side::Interior];

/// A point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub s: f64,
    pub azimuth: f64,
}

/// So many places: both poles, the ends of some panels, some nodes, and the others at random.
pub fn places(discretization: &Discretization, count: usize, seed: u64) -> Vec<Place> {
    let mut random = fastrand::Rng::with_seed(seed);
    let panels = discretization.panels().as_slice();
    let (first, last) = (panels[0].start, panels[panels.len() - 1].end);
    (0..count)
        .map(|k| Place {
            s: match k {
                0 => first,
                1 => last,
                _ if k % 5 == 2 => random.choice(panels).expect("a panel").start,
                _ if k % 5 == 3 => random.choice(discretization.nodes()).expect("a node").s,
                _ => first + (last - first) * random.f64(),
            },
            azimuth: 2.0 * PI * random.f64(),
        })
        .collect()
}

/// The point at a distance along the normal, positive out of the body.
pub fn off(discretization: &Discretization, place: Place, distance: f64) -> Point3<f64> {
    let curve = discretization.curve();
    let Meridian { r, z } = curve.point(place.s);
    let t = curve.tangent(place.s);
    let step = distance / t.r.hypot(t.z);
    let (r, z) = (r - step * t.z, z + step * t.r);
    let (sin, cos) = place.azimuth.sin_cos();
    Point3::new(r * cos, r * sin, z)
}

/// Points at a distance from places, on one side; without those that are on the other one again, as
/// next to a thin rim.
pub fn targets(
    discretization: &Discretization,
    places: &[Place],
    side: Side,
    distance: f64,
) -> Vec<Point3<f64>> {
    let signed = match side {
        Side::Exterior => distance,
        Side::Interior => -distance,
    };
    let outline = Outline::new(&**discretization.curve()).expect("an outline");
    let stays = |x: &Point3<f64>| {
        let (r, z) = (x.x.hypot(x.y), x.z);
        distance < 1e-6 || outline.contains(Meridian { r, z }) == (side == Side::Interior)
    };
    let target = |&place: &Place| off(discretization, place, signed);
    places.iter().map(target).filter(stays).collect()
}
