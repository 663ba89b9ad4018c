//! Where a point lies in relation to a body.

use std::ops::Deref;

use super::error::CurveError;
use super::{GeneratingCurve, Meridian, Panels};

/// Largest distance of the polygon from the curve, over the curve's size.
const SAG: f64 = 1e-6;
/// Largest turn of the tangent between two corners, in radians.
const TURN: f64 = 0.05;
/// Most corners; beyond them the polygon is no longer refined.
const MOST_CORNERS: usize = 1_000_000;

/// Distance from the surface, in units of the body's size, up to which a point is on it: rounding
/// of its coordinates.
pub const ON_SURFACE: f64 = 1e-13;

/// A curve with an adaptive polygon on it, to answer many questions about the body.
///
/// `P` points to the curve: a reference, or a [`Shape`](super::Shape) for an outline that owns what
/// it needs.
#[derive(Clone, Debug)]
pub struct Outline<P> {
    curve: P,
    parameters: Vec<f64>,
    corners: Vec<Meridian>,
    /// Bound of the distance between the curve and the polygon.
    slack: f64,
    /// Up to which distance from the curve a point is on it.
    on_surface: f64,
}

impl<P: Deref<Target: GeneratingCurve>> Outline<P> {
    /// The outline of a curve; about a thousand points and tangents of it.
    ///
    /// # Errors
    /// If a point or tangent of the curve is not finite, or a tangent vanishes.
    pub fn new(curve: P) -> Result<Self, CurveError> {
        let pieces = Panels::pieces(&*curve)?;
        let parts = (256 / pieces.len()).max(8);
        let mut starts = Vec::new();
        for piece in &pieces {
            starts
                .extend((0..parts).map(|k| piece.start + piece.length() * k as f64 / parts as f64));
        }
        let end = pieces.as_slice()[pieces.len() - 1].end;
        starts.push(end);
        let corners = starts
            .iter()
            .map(|&s| Corner::new(&*curve, s))
            .collect::<Result<Vec<_>, _>>()?;
        let size = extent(&corners);
        let domain = end - starts[0];
        let mut outline = Self {
            curve,
            parameters: vec![starts[0]],
            corners: vec![corners[0].point],
            slack: 4.0 * SAG * size,
            on_surface: 0.5 * ON_SURFACE * size,
        };
        // Depth first, so that the corners come out in order.
        for pair in corners.windows(2) {
            let mut ends = vec![pair[1]];
            let mut from = pair[0];
            while let Some(&to) = ends.last() {
                let room = to.s - from.s > 1e-9 * domain && outline.corners.len() < MOST_CORNERS;
                let middle = Corner::new(&*outline.curve, from.s + 0.5 * (to.s - from.s))?;
                if room && !flat(from, middle, to, SAG * size) {
                    ends.push(middle);
                    continue;
                }
                outline.parameters.push(to.s);
                outline.corners.push(to.point);
                from = to;
                ends.pop();
            }
        }
        Ok(outline)
    }

    /// The corners of the polygon, on the curve, in its order.
    pub fn corners(&self) -> &[Meridian] {
        &self.corners
    }

    /// The parameters of the corners.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Whether the point lies in the body, and not [on its surface](ON_SURFACE); a point at r < 0
    /// stands for its mirror image.
    pub fn contains(&self, point: Meridian) -> bool {
        let point = Meridian {
            r: point.r.abs(),
            z: point.z,
        };
        let inside = self.polygon_contains(point);
        if self.polygon_distance(point) > self.slack {
            return inside;
        }
        // So near the curve the side of the nearest tangent decides.
        let (distance, s) = self.nearest(point);
        if distance <= self.on_surface {
            return false;
        }
        let (foot, tangent) = (self.curve.point(s), self.curve.tangent(s));
        let outward = -(point.r - foot.r) * tangent.z + (point.z - foot.z) * tangent.r;
        outward < 0.0
    }

    /// The distance from the point to the curve, and the parameter of the nearest curve point.
    ///
    /// The distance is good to about 1e-10 of the curve's size or better. Not a number gives not a
    /// number.
    pub fn nearest(&self, point: Meridian) -> (f64, f64) {
        let point = Meridian {
            r: point.r.abs(),
            z: point.z,
        };
        if !(point.r.is_finite() && point.z.is_finite()) {
            return (
                if point.r.is_nan() || point.z.is_nan() {
                    f64::NAN
                } else {
                    f64::INFINITY
                },
                self.parameters[0],
            );
        }
        let reach = self.polygon_distance(point) + 2.0 * self.slack;
        let mut best = (f64::INFINITY, self.parameters[0]);
        for i in 1..self.corners.len() {
            if segment_distance(point, self.corners[i - 1], self.corners[i]) <= reach {
                let found = self.nearest_between(point, self.parameters[i - 1], self.parameters[i]);
                if found.0 < best.0 {
                    best = found;
                }
            }
        }
        best
    }

    /// The distance from the point to the curve.
    pub fn distance(&self, point: Meridian) -> f64 {
        self.nearest(point).0
    }

    fn polygon_distance(&self, point: Meridian) -> f64 {
        self.corners
            .windows(2)
            .map(|c| segment_distance(point, c[0], c[1]))
            .fold(f64::INFINITY, f64::min)
    }

    /// Crossings of a ray away from the axis; the axis itself is never crossed, so open curves need
    /// no closing.
    fn polygon_contains(&self, p: Meridian) -> bool {
        let crossings = self.corners.windows(2).filter(|c| {
            let (a, b) = (c[0], c[1]);
            (a.z > p.z) != (b.z > p.z) && a.r + (b.r - a.r) * ((p.z - a.z) / (b.z - a.z)) > p.r
        });
        crossings.count() % 2 == 1
    }

    /// The nearest point of a short arc: the zero of `(gamma - p) . gamma'` by safeguarded false
    /// position.
    fn nearest_between(&self, point: Meridian, start: f64, end: f64) -> (f64, f64) {
        let offset = |s: f64| {
            let (p, t) = (self.curve.point(s), self.curve.tangent(s));
            (
                (p.r - point.r).hypot(p.z - point.z),
                (p.r - point.r) * t.r + (p.z - point.z) * t.z,
            )
        };
        let (mut a, mut b) = (start, end);
        let ((distance_a, mut slope_a), (distance_b, mut slope_b)) = (offset(a), offset(b));
        let mut best = if distance_a <= distance_b {
            (distance_a, a)
        } else {
            (distance_b, b)
        };
        if slope_a >= 0.0 || slope_b <= 0.0 {
            return best;
        }
        for step in 0..80 {
            // Every third step halves the bracket, whatever the slopes say.
            let weight = if step % 3 == 2 {
                0.5
            } else {
                slope_a / (slope_a - slope_b)
            };
            let s = a + (b - a) * weight;
            let (distance, slope) = offset(s);
            if distance < best.0 {
                best = (distance, s);
            }
            if s <= a || s >= b || slope == 0.0 {
                break;
            }
            if slope < 0.0 {
                (a, slope_a) = (s, slope);
            } else {
                (b, slope_b) = (s, slope);
            }
        }
        best
    }
}

/// A sample of the curve.
#[derive(Clone, Copy)]
struct Corner {
    s: f64,
    point: Meridian,
    tangent: Meridian,
}

impl Corner {
    fn new(curve: &(impl GeneratingCurve + ?Sized), s: f64) -> Result<Self, CurveError> {
        let (point, tangent) = (curve.point(s), curve.tangent(s));
        if !(point.r.is_finite() && point.z.is_finite()) {
            return Err(CurveError::NotFinite {
                quantity: "point",
                s,
            });
        }
        if !(tangent.r.is_finite() && tangent.z.is_finite()) {
            return Err(CurveError::NotFinite {
                quantity: "tangent",
                s,
            });
        }
        if tangent.r == 0.0 && tangent.z == 0.0 {
            return Err(CurveError::Stationary { s });
        }
        Ok(Self { s, point, tangent })
    }
}

/// Whether the curve hardly leaves the straight line between two corners.
fn flat(from: Corner, middle: Corner, to: Corner, sag: f64) -> bool {
    let angle =
        |u: Meridian, v: Meridian| (u.r * v.z - u.z * v.r).atan2(u.r * v.r + u.z * v.z).abs();
    segment_distance(middle.point, from.point, to.point) <= sag
        && angle(from.tangent, middle.tangent) + angle(middle.tangent, to.tangent) <= TURN
}

fn extent(corners: &[Corner]) -> f64 {
    let first = corners[0].point;
    corners
        .iter()
        .map(|c| (c.point.r - first.r).hypot(c.point.z - first.z))
        .fold(0.0, f64::max)
}

fn segment_distance(p: Meridian, a: Meridian, b: Meridian) -> f64 {
    let off = off_segment(p, a, b);
    off.r.hypot(off.z)
}

/// From the nearest point of a segment to a point.
pub(crate) fn off_segment(p: Meridian, a: Meridian, b: Meridian) -> Meridian {
    let (ab, ap) = ((b.r - a.r, b.z - a.z), (p.r - a.r, p.z - a.z));
    let square = ab.0 * ab.0 + ab.1 * ab.1;
    let along = if square > 0.0 {
        ((ap.0 * ab.0 + ap.1 * ab.1) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    Meridian {
        r: ap.0 - along * ab.0,
        z: ap.1 - along * ab.1,
    }
}

/// Whether the point lies in the body; see [`Outline`] for many points.
///
/// # Errors
/// If a point or tangent of the curve is not finite, or a tangent vanishes.
pub fn contains(
    curve: &(impl GeneratingCurve + ?Sized),
    point: Meridian,
) -> Result<bool, CurveError> {
    Ok(Outline::new(curve)?.contains(point))
}

/// The distance from the point to the curve; see [`Outline`] for many points.
///
/// # Errors
/// If a point or tangent of the curve is not finite, or a tangent vanishes.
pub fn distance(
    curve: &(impl GeneratingCurve + ?Sized),
    point: Meridian,
) -> Result<f64, CurveError> {
    Ok(Outline::new(curve)?.distance(point))
}

#[cfg(test)]
mod tests {
    use super::super::{Biconcave, Capsule, Spheroid, Torus};
    use super::*;

    #[test]
    fn distance_to_a_sphere_and_a_torus() {
        let (sphere, torus) = (
            Spheroid::sphere(1.0).unwrap(),
            Torus::new(2.0, 0.5).unwrap(),
        );
        let (sphere, torus) = (
            Outline::new(&sphere).unwrap(),
            Outline::new(&torus).unwrap(),
        );
        for (r, z) in [
            (0.0, 0.0),
            (1e-9, 0.0),
            (0.3, 0.4),
            (0.0, 2.0),
            (2.0, 0.0),
            (0.6, 0.8),
            (1.7, -0.2),
            (-3.0, 1.0),
        ] {
            let p = Meridian { r, z };
            let exact = (r.hypot(z) - 1.0).abs();
            assert!((sphere.distance(p) - exact).abs() < 1e-14, "{p:?}");
            assert!(
                sphere.contains(p) == (r.hypot(z) < 1.0) || exact < 1e-15,
                "{p:?}"
            );
            let from_tube = (r.abs() - 2.0).hypot(z);
            assert!(
                (torus.distance(p) - (from_tube - 0.5).abs()).abs() < 1e-14,
                "{p:?}"
            );
            assert_eq!(torus.contains(p), from_tube < 0.5, "{p:?}");
        }
    }

    #[test]
    fn points_next_to_the_curve_are_told_apart() {
        for curve in [
            &Spheroid::new(0.01, 1.0).unwrap() as &dyn GeneratingCurve,
            &Spheroid::new(100.0, 1.0).unwrap(),
            &Torus::new(1.0, 0.9).unwrap(),
            &Biconcave::new(1.0).unwrap(),
            &Capsule::new(1.0, 2.0).unwrap(),
        ] {
            let outline = Outline::new(curve).unwrap();
            let ends = curve.breakpoints();
            for k in 1..20 {
                let s = ends[0] + (ends[ends.len() - 1] - ends[0]) * f64::from(k) / 20.0;
                let (p, t) = (curve.point(s), curve.tangent(s));
                let speed = t.r.hypot(t.z);
                for height in [1e-3, 1e-6, 1e-9] {
                    let off = |h: f64| Meridian {
                        r: p.r - h * t.z / speed,
                        z: p.z + h * t.r / speed,
                    };
                    assert!(outline.contains(off(-height)), "{curve:?} {s} {height}");
                    assert!(!outline.contains(off(height)), "{curve:?} {s} {height}");
                    assert!(
                        (outline.distance(off(height)) - height).abs() < 1e-13,
                        "{curve:?} {s} {height}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_axis_and_odd_points() {
        let capsule = Capsule::new(1.0, 2.0).unwrap();
        assert_eq!(contains(&capsule, Meridian { r: 0.0, z: 1.9 }), Ok(true));
        assert_eq!(contains(&capsule, Meridian { r: 0.0, z: 2.1 }), Ok(false));
        assert_eq!(
            contains(
                &capsule,
                Meridian {
                    r: f64::NAN,
                    z: 0.0
                }
            ),
            Ok(false)
        );
        assert_eq!(
            distance(
                &capsule,
                Meridian {
                    r: f64::INFINITY,
                    z: 0.0
                }
            ),
            Ok(f64::INFINITY)
        );
        assert!(
            distance(
                &capsule,
                Meridian {
                    r: 0.0,
                    z: f64::NAN
                }
            )
            .unwrap()
            .is_nan()
        );
    }
}
