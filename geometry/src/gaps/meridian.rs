//! Distances from one meridian, fast enough for many points, and from the body where it lies in the
//! laboratory.

use nalgebra::{Point3, Vector3};

use super::convexity::is_convex;
use crate::curve::{CurveError, GeneratingCurve, Meridian, Outline, off_segment};
use crate::frame::Frame;

/// Segments per group; points far from a group are told from its bounding circle.
const GROUP: usize = 16;
/// Distance of the outline's polygon from the curve, over the curve's size, with some to spare.
const SLACK: f64 = 4e-6;

/// A meridian with what distances from it need; lengths in its own units.
pub(super) struct Shape<'a> {
    curve: &'a dyn GeneratingCurve,
    parameters: Vec<f64>,
    corners: Vec<Meridian>,
    /// Length of the polygon up to each corner.
    lengths: Vec<f64>,
    /// Centre and radius of the circle around each group of segments.
    circles: Vec<(Meridian, f64)>,
    /// Where on the axis the bounding sphere has its centre.
    middle: f64,
    radius: f64,
    slack: f64,
    /// Whether the body is convex, and smooth.
    convex: bool,
}

impl<'a> Shape<'a> {
    pub(super) fn new(curve: &'a dyn GeneratingCurve) -> Result<Self, CurveError> {
        let outline = Outline::new(curve)?;
        let corners = outline.corners().to_vec();
        let apart = |a: Meridian, b: Meridian| (a.r - b.r).hypot(a.z - b.z);
        let mut lengths = vec![0.0];
        for pair in corners.windows(2) {
            lengths.push(lengths[lengths.len() - 1] + apart(pair[0], pair[1]));
        }
        let starts = (0..corners.len() - 1).step_by(GROUP);
        let circles = starts.map(|start| {
            let group = &corners[start..=(start + GROUP).min(corners.len() - 1)];
            let (a, b) = (group[0], group[group.len() - 1]);
            let center = Meridian {
                r: 0.5 * (a.r + b.r),
                z: 0.5 * (a.z + b.z),
            };
            let radius = group.iter().map(|&c| apart(c, center)).fold(0.0, f64::max);
            (center, radius)
        });
        let circles = circles.collect();
        let least = corners.iter().fold(f64::INFINITY, |m, c| m.min(c.z));
        let most = corners.iter().fold(f64::NEG_INFINITY, |m, c| m.max(c.z));
        let middle = 0.5 * (least + most);
        let reach = |c: &Meridian| c.r.hypot(c.z - middle);
        let radius = corners.iter().map(reach).fold(0.0, f64::max);
        let slack = SLACK * 2.0 * radius;
        Ok(Self {
            curve,
            parameters: outline.parameters().to_vec(),
            corners,
            lengths,
            circles,
            middle,
            radius: radius + slack,
            slack,
            convex: is_convex(curve, outline.parameters()),
        })
    }

    fn segments(&self, group: usize) -> std::ops::Range<usize> {
        group * GROUP..((group + 1) * GROUP).min(self.corners.len() - 1)
    }

    /// The square of the distance from a segment.
    fn square(&self, segment: usize, p: Meridian) -> f64 {
        let off = off_segment(p, self.corners[segment], self.corners[segment + 1]);
        off.r.powi(2) + off.z.powi(2)
    }

    fn below(&self, group: usize, p: Meridian) -> f64 {
        let (center, radius) = self.circles[group];
        ((p.r - center.r).hypot(p.z - center.z) - radius).max(0.0)
    }

    /// The nearest segment and the square of its distance.
    fn nearest_segment(&self, p: Meridian) -> (usize, f64) {
        let mut first = (0, f64::INFINITY);
        for group in 0..self.circles.len() {
            let below = self.below(group, p);
            if below < first.1 {
                first = (group, below);
            }
        }
        let mut best = (0, f64::INFINITY);
        let mut look = |group: usize| {
            if self.below(group, p).powi(2) < best.1 {
                for segment in self.segments(group) {
                    let square = self.square(segment, p);
                    if square < best.1 {
                        best = (segment, square);
                    }
                }
            }
        };
        look(first.0);
        (0..self.circles.len()).for_each(&mut look);
        best
    }

    /// The distance from the polygon, negative inside.
    fn coarse(&self, p: Meridian) -> f64 {
        let (segment, square) = self.nearest_segment(p);
        let (a, b) = (self.corners[segment], self.corners[segment + 1]);
        // The polygon turns so little that the nearest segment tells the side, even if an end of it
        // is nearest.
        let outward = -(p.r - a.r) * (b.z - a.z) + (p.z - a.z) * (b.r - a.r);
        square.sqrt().copysign(outward)
    }

    /// The parameter of the nearest point of the curve.
    fn foot(&self, p: Meridian) -> f64 {
        let (_, square) = self.nearest_segment(p);
        let reach = square.sqrt() + 2.0 * self.slack;
        let mut best = (self.parameters[0], f64::INFINITY);
        for group in 0..self.circles.len() {
            if self.below(group, p) > reach {
                continue;
            }
            for segment in self.segments(group) {
                if self.square(segment, p) <= reach * reach {
                    let found = self.foot_between(p, segment);
                    if found.1 < best.1 {
                        best = found;
                    }
                }
            }
        }
        best.0
    }

    /// The nearest point of a short arc, and its distance: zero of `(gamma - p) . gamma'` by false
    /// position (Illinois rule).
    fn foot_between(&self, p: Meridian, segment: usize) -> (f64, f64) {
        let offset = |s: f64| {
            let (x, t) = (self.curve.point(s), self.curve.tangent(s));
            let d = (x.r - p.r, x.z - p.z);
            (d.0.hypot(d.1), d.0 * t.r + d.1 * t.z)
        };
        let (mut a, mut b) = (self.parameters[segment], self.parameters[segment + 1]);
        let ((distance_a, mut slope_a), (distance_b, mut slope_b)) = (offset(a), offset(b));
        if slope_a >= 0.0 || slope_b <= 0.0 {
            return if distance_a <= distance_b {
                (a, distance_a)
            } else {
                (b, distance_b)
            };
        }
        let narrow = 4.0 * f64::EPSILON * a.abs().max(b.abs());
        let mut last = (a, distance_a);
        for _ in 0..100 {
            let s = a + (b - a) * (slope_a / (slope_a - slope_b));
            let moved = (s - last.0).abs();
            let (distance, slope) = offset(s);
            last = (s, distance);
            if slope == 0.0 || moved <= narrow || b - a <= narrow {
                break;
            }
            if slope < 0.0 {
                (a, slope_a, slope_b) = (s, slope, 0.5 * slope_b);
            } else {
                (b, slope_b, slope_a) = (s, slope, 0.5 * slope_a);
            }
        }
        last
    }
}

/// A shape in the laboratory.
#[derive(Clone, Copy)]
pub(super) struct Located<'a> {
    pub(super) shape: &'a Shape<'a>,
    pub(super) frame: Frame,
    pub(super) scale: f64,
}

/// The nearest point of a surface.
#[derive(Clone, Copy)]
pub(super) struct Foot {
    /// Distance from the surface, negative inside.
    pub(super) distance: f64,
    pub(super) point: Point3<f64>,
    /// Outward.
    pub(super) normal: Vector3<f64>,
}

impl Located<'_> {
    /// Centre of the bounding sphere.
    pub(super) fn center(&self) -> Point3<f64> {
        let on_axis = Point3::new(0.0, 0.0, self.scale * self.shape.middle);
        self.frame.point_to_lab(on_axis)
    }

    /// Radius of the bounding sphere.
    pub(super) fn radius(&self) -> f64 {
        self.scale * self.shape.radius
    }

    /// Bound of the distance between polygon and curve.
    pub(super) fn slack(&self) -> f64 {
        self.scale * self.shape.slack
    }

    /// Length of the meridian's polygon.
    pub(super) fn length(&self) -> f64 {
        self.scale * self.shape.lengths[self.shape.lengths.len() - 1]
    }

    /// The point of the polygon at this length from its start, and its distance from the axis.
    pub(super) fn at(&self, length: f64, azimuth: f64) -> (Point3<f64>, f64) {
        let shape = self.shape;
        let length = length / self.scale;
        let after = shape.lengths.partition_point(|&l| l < length);
        let k = after.clamp(1, shape.lengths.len() - 1);
        let (from, to) = (shape.lengths[k - 1], shape.lengths[k]);
        let t = if to > from {
            (length - from) / (to - from)
        } else {
            0.0
        };
        let (a, b) = (shape.corners[k - 1], shape.corners[k]);
        let r = self.scale * (a.r + t * (b.r - a.r));
        let z = self.scale * (a.z + t * (b.z - a.z));
        let (sin, cos) = azimuth.sin_cos();
        (self.frame.point_to_lab(Point3::new(r * cos, r * sin, z)), r)
    }

    /// Whether the body is convex, and smooth.
    pub(super) fn is_convex(&self) -> bool {
        self.shape.convex
    }

    /// The corner of the polygon that is farthest in a direction, turned about the axis towards it;
    /// for convex bodies.
    pub(super) fn farthest(&self, direction: Vector3<f64>) -> Point3<f64> {
        let along = self.frame.vector_to_body(direction);
        let across = along.x.hypot(along.y);
        let corners = &self.shape.corners;
        // The polygon turns one way: it first goes along the direction, and then against it.
        let (mut rising, mut falling) = (0, corners.len() - 1);
        while rising < falling {
            let k = (rising + falling) / 2;
            let (a, b) = (corners[k], corners[k + 1]);
            if (b.r - a.r) * across + (b.z - a.z) * along.z > 0.0 {
                rising = k + 1;
            } else {
                falling = k;
            }
        }
        let corner = corners[rising];
        let (cos, sin) = if across > 0.0 {
            (along.x / across, along.y / across)
        } else {
            (1.0, 0.0)
        };
        let point = Point3::new(corner.r * cos, corner.r * sin, corner.z);
        self.frame.point_to_lab(point * self.scale)
    }

    fn to_meridian(self, x: Point3<f64>) -> (Point3<f64>, Meridian) {
        let p = self.frame.point_to_body(x) / self.scale;
        (p, Meridian::of(&p))
    }

    /// The distance from the polygon, negative inside; within [`Self::slack`] of the distance from
    /// the surface.
    pub(super) fn coarse(&self, x: Point3<f64>) -> f64 {
        self.scale * self.shape.coarse(self.to_meridian(x).1)
    }

    pub(super) fn foot(&self, x: Point3<f64>) -> Foot {
        let (p, meridian) = self.to_meridian(x);
        let s = self.shape.foot(meridian);
        let (foot, tangent) = (self.shape.curve.point(s), self.shape.curve.tangent(s));
        let speed = tangent.r.hypot(tangent.z);
        let (cos, sin) = if meridian.r > 0.0 {
            (p.x / meridian.r, p.y / meridian.r)
        } else {
            (1.0, 0.0)
        };
        let (normal_r, normal_z) = (-tangent.z / speed, tangent.r / speed);
        let (dr, dz) = (meridian.r - foot.r, meridian.z - foot.z);
        let distance = dr.hypot(dz).copysign(dr * normal_r + dz * normal_z);
        let point = Point3::new(foot.r * cos, foot.r * sin, foot.z) * self.scale;
        let normal = Vector3::new(normal_r * cos, normal_r * sin, normal_z);
        Foot {
            distance: self.scale * distance,
            point: self.frame.point_to_lab(point),
            normal: self.frame.vector_to_lab(normal),
        }
    }
}
