//! Profiles: smooth curves through given points.

use super::error::{CurveError, LONGEST, SHORTEST};
use super::legendre::SIXTEEN;
use super::polygon::{first_crossing, signed_volume};
use super::quintic::{Segment, spline};
use super::validate::{CLOSURE, check_simple};
use super::{GeneratingCurve, Meridian, Topology};

/// Most points of a profile.
pub const MOST_POINTS: usize = 100_000;
/// Fewest points from pole to pole, and of a loop (with the first repeated).
const FEWEST: (usize, usize) = (5, 7);
/// Largest ratio of two neighbouring steps.
const UNEVEN: f64 = 100.0;
/// Corrections of the knots from chord length to arc length; each gains two orders, and the first
/// is enough for order six.
const CORRECTIONS: usize = 2;

/// The quintic spline through points of the meridian, with four continuous derivatives.
///
/// Its error is O(h^6) in the spacing h of the points, also where they are unevenly spaced: the
/// knots are the arc lengths of the spline itself (chord lengths alone would give O(h^4)). At the
/// poles r is odd and z even in the arc length; loops are periodic. The whole curve counts as one
/// smooth piece.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    knots: Vec<f64>,
    points: Vec<Meridian>,
    segments: Vec<Segment>,
    topology: Topology,
}

impl Profile {
    /// The profile through `points`, either from pole to pole (first and last on the axis: `r = 0`
    /// to 1e-9 of the size) or a closed loop off the axis, whose last point repeats the first.
    /// Either direction will do.
    ///
    /// # Errors
    /// If there are too few or more than 100 000 points, or they are not finite, off the half
    /// plane, repeated, or very unevenly spaced; if the profile is open, or meets itself.
    pub fn from_points(points: &[Meridian]) -> Result<Self, CurveError> {
        let (points, topology) = checked(points)?;
        let mut knots = vec![0.0; points.len()];
        for i in 1..points.len() {
            let (a, b) = (points[i - 1], points[i]);
            knots[i] = knots[i - 1] + (b.r - a.r).hypot(b.z - a.z);
        }
        let mut segments = spline(&knots, &points, topology);
        for _ in 0..CORRECTIONS {
            let lengths: Vec<f64> = knots
                .windows(2)
                .zip(&segments)
                .map(|(k, segment)| length(segment, k[1] - k[0]))
                .collect();
            for (i, length) in lengths.iter().enumerate() {
                knots[i + 1] = knots[i] + length;
            }
            segments = spline(&knots, &points, topology);
        }
        let profile = Self {
            knots,
            points,
            segments,
            topology,
        };
        check_simple(&profile)?;
        Ok(profile)
    }

    /// The points, in the direction of traversal.
    pub fn points(&self) -> &[Meridian] {
        &self.points
    }

    fn domain(&self) -> (f64, f64) {
        (self.knots[0], self.knots[self.knots.len() - 1])
    }

    /// The segment of a parameter, and the position in it.
    fn locate(&self, s: f64) -> (usize, f64) {
        let index = self
            .knots
            .partition_point(|&k| k <= s)
            .clamp(1, self.segments.len())
            - 1;
        (index, s - self.knots[index])
    }

    /// The parameter in the domain of a loop.
    fn wrapped(&self, s: f64) -> f64 {
        let (first, last) = self.domain();
        if self.topology == Topology::PoleToPole || (first..=last).contains(&s) {
            return s;
        }
        s - (last - first) * ((s - first) / (last - first)).floor()
    }
}

/// The points in the right direction, ends exactly on the axis or equal.
fn checked(points: &[Meridian]) -> Result<(Vec<Meridian>, Topology), CurveError> {
    if points.len() > MOST_POINTS {
        return Err(CurveError::TooManyPoints { limit: MOST_POINTS });
    }
    for (i, p) in points.iter().enumerate() {
        if !(p.r.abs() <= LONGEST && p.z.abs() <= LONGEST) {
            return Err(CurveError::PointNotFinite {
                index: i + 1,
                r: p.r,
                z: p.z,
            });
        }
    }
    let too_few = |least| {
        Err(CurveError::TooFewPoints {
            count: points.len(),
            least,
        })
    };
    let [first, .., last] = points else {
        return too_few(FEWEST.0);
    };
    let size = points
        .iter()
        .map(|p| (p.r - first.r).hypot(p.z - first.z))
        .fold(0.0, f64::max);
    let slack = CLOSURE * size;
    let mut points = points.to_vec();
    let n = points.len();
    let topology = if first.r.abs() <= slack && last.r.abs() <= slack {
        points[0].r = 0.0;
        points[n - 1].r = 0.0;
        Topology::PoleToPole
    } else if (first.r - last.r).hypot(first.z - last.z) <= slack {
        points[n - 1] = points[0];
        Topology::Loop
    } else {
        return Err(CurveError::Open {
            r0: first.r,
            z0: first.z,
            r1: last.r,
            z1: last.z,
        });
    };
    let (least, off_axis) = match topology {
        Topology::PoleToPole => (FEWEST.0, 1..n - 1),
        Topology::Loop => (FEWEST.1, 0..n),
    };
    for i in off_axis {
        if points[i].r <= 0.0 {
            return Err(CurveError::PointNotOffAxis {
                index: i + 1,
                r: points[i].r,
            });
        }
    }
    let steps: Vec<f64> = points
        .windows(2)
        .map(|p| (p[1].r - p[0].r).hypot(p[1].z - p[0].z))
        .collect();
    if let Some(i) = steps
        .iter()
        .position(|&step| step <= 1e-12 * size || step < SHORTEST)
    {
        return Err(CurveError::Duplicate { index: i + 1 });
    }
    if n < least {
        return too_few(least);
    }
    for (i, pair) in steps.windows(2).enumerate() {
        let ratio = (pair[0] / pair[1]).max(pair[1] / pair[0]);
        if ratio > UNEVEN {
            return Err(CurveError::UnevenPoints {
                index: i + 2,
                ratio,
                limit: UNEVEN,
            });
        }
    }
    if let Some(place) = first_crossing(&points, topology == Topology::Loop) {
        return Err(CurveError::SelfIntersection {
            r: place.r,
            z: place.z,
        });
    }
    if signed_volume(&points) < 0.0 {
        points.reverse();
    }
    Ok((points, topology))
}

/// The Taylor coefficients of a segment about `t`, by repeated synthetic division.
fn taylor(segment: &Segment, t: f64) -> Segment {
    let mut shifted = *segment;
    for low in 0..5 {
        for k in (low..5).rev() {
            shifted[k].r += t * shifted[k + 1].r;
            shifted[k].z += t * shifted[k + 1].z;
        }
    }
    shifted
}

fn derivative(segment: &Segment, t: f64) -> Meridian {
    let mut sum = Meridian { r: 0.0, z: 0.0 };
    for k in (1..6).rev() {
        let factor = k as f64;
        sum = Meridian {
            r: sum.r * t + factor * segment[k].r,
            z: sum.z * t + factor * segment[k].z,
        };
    }
    sum
}

/// The difference of a segment's values at `t + dt` and `t`, exact to rounding for small `dt`.
fn difference(segment: &Segment, t: f64, dt: f64) -> Meridian {
    let about = taylor(segment, t);
    let mut sum = Meridian { r: 0.0, z: 0.0 };
    for k in (1..6).rev() {
        sum = Meridian {
            r: dt * (sum.r + about[k].r),
            z: dt * (sum.z + about[k].z),
        };
    }
    sum
}

/// Arc length of a segment.
fn length(segment: &Segment, h: f64) -> f64 {
    let half = 0.5 * h;
    let speeds = SIXTEEN.iter().map(|(x, w)| {
        let t = derivative(segment, half * (1.0 + x));
        w * t.r.hypot(t.z)
    });
    half * speeds.sum::<f64>()
}

impl GeneratingCurve for Profile {
    fn breakpoints(&self) -> Vec<f64> {
        let (first, last) = self.domain();
        vec![first, last]
    }

    fn topology(&self) -> Topology {
        self.topology
    }

    fn point(&self, s: f64) -> Meridian {
        let (index, t) = self.locate(self.wrapped(s));
        // From the nearer knot, where the point is exact.
        let h = self.knots[index + 1] - self.knots[index];
        let (knot, from) = if t < 0.5 * h {
            (index, 0.0)
        } else {
            (index + 1, h)
        };
        let d = difference(&self.segments[index], from, t - from);
        Meridian {
            r: self.points[knot].r + d.r,
            z: self.points[knot].z + d.z,
        }
    }

    fn tangent(&self, s: f64) -> Meridian {
        let (index, t) = self.locate(self.wrapped(s));
        derivative(&self.segments[index], t)
    }

    fn chord(&self, s: f64, ds: f64) -> Meridian {
        let (first, last) = self.domain();
        let s = self.wrapped(s);
        let (i, t) = self.locate(s);
        let h = self.knots[i + 1] - self.knots[i];
        let (at_start, at_end) = (-t, h - t);
        if (at_start..=at_end).contains(&ds) {
            return difference(&self.segments[i], t, ds);
        }
        // To the knot, from knot to knot (points are exact), and on from there.
        let (knot, to_knot) = if ds > 0.0 {
            (i + 1, at_end)
        } else {
            (i, at_start)
        };
        let left = ds - to_knot;
        let mut end = self.knots[knot] + left;
        let mut seam = 0.0;
        if self.topology == Topology::Loop && !(first..=last).contains(&end) {
            // Whole periods, so that the step itself is not rounded.
            let period = last - first;
            seam = -period * ((end - first) / period).floor();
            end += seam;
        }
        let (j, _) = self.locate(end);
        let target = if ds > 0.0 { j } else { j + 1 };
        let on = (self.knots[knot] - self.knots[target]) + seam + left;
        let from = self.knots[target] - self.knots[j];
        let parts = [
            difference(&self.segments[i], t, to_knot),
            Meridian {
                r: self.points[target].r - self.points[knot].r,
                z: self.points[target].z - self.points[knot].z,
            },
            difference(&self.segments[j], from, on),
        ];
        Meridian {
            r: parts.iter().map(|p| p.r).sum(),
            z: parts.iter().map(|p| p.z).sum(),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use proptest::prelude::*;

    use super::super::{Outline, Panels, Spheroid, Torus, checks, surface_area, volume};
    use super::*;

    /// Points of a curve at a smooth uneven spacing plus a jitter.
    fn sample(curve: &dyn GeneratingCurve, count: u32) -> Vec<Meridian> {
        let ends = curve.breakpoints();
        let (first, last) = (ends[0], ends[ends.len() - 1]);
        (0..=count)
            .map(|k| {
                let jitter = if k == 0 || k == count {
                    0.0
                } else {
                    0.2 * (f64::from(k) * 12.9898).sin()
                };
                curve.point(first + (last - first) * (f64::from(k) + jitter) / f64::from(count))
            })
            .collect()
    }

    /// Largest distance of the spline through `count` points from the curve.
    fn error(curve: &dyn GeneratingCurve, count: u32) -> f64 {
        let profile = Profile::from_points(&sample(curve, count)).unwrap();
        let outline = Outline::new(curve).unwrap();
        let end = profile.domain().1;
        (0..500)
            .map(|k| outline.distance(profile.point(end * f64::from(k) / 500.0)))
            .fold(0.0, f64::max)
    }

    #[test]
    fn the_error_is_of_order_six() {
        for curve in [
            &Spheroid::new(1.0, 0.5).unwrap() as &dyn GeneratingCurve,
            &Torus::new(1.0, 0.5).unwrap(),
        ] {
            let errors = [20, 40, 80].map(|count| error(curve, count));
            println!("{curve:?}: {errors:?}");
            let order = (errors[0] / errors[2]).log2() / 2.0;
            assert!(order > 5.5, "{errors:?}: order {order}");
            assert!(errors[2] < 1e-8, "{errors:?}");
        }
    }

    #[test]
    fn obeys_the_contract_of_a_curve() {
        for curve in [
            &Spheroid::new(1.0, 0.5).unwrap() as &dyn GeneratingCurve,
            &Torus::new(1.0, 0.5).unwrap(),
        ] {
            // The short chord crosses no knot to speak of; where it does, the curve is C^4 only.
            checks::contract_to(&Profile::from_points(&sample(curve, 64)).unwrap(), 1e-14);
        }
    }

    #[test]
    fn short_chords_across_knots_and_the_seam_are_precise() {
        for curve in [
            &Spheroid::new(1.0, 0.5).unwrap() as &dyn GeneratingCurve,
            &Torus::new(1.0, 0.5).unwrap(),
        ] {
            let profile = Profile::from_points(&sample(curve, 64)).unwrap();
            let mut knots = profile.knots.clone();
            if profile.topology == Topology::PoleToPole {
                knots = knots[1..64].to_vec();
            }
            for knot in knots {
                for (back, ds) in [
                    (1e-9, 3e-9),
                    (-1e-9, -3e-9),
                    (0.0, 1e-8),
                    (0.0, -1e-8),
                    (1e-10, 1e-10),
                ] {
                    let (chord, tangent) = (profile.chord(knot - back, ds), profile.tangent(knot));
                    let middle = 0.5 * ds - back;
                    let (on, off) = (profile.tangent(knot + 1e-4), profile.tangent(knot - 1e-4));
                    let bent = [on.r - off.r, on.z - off.z].map(|d| d / 2e-4 * middle);
                    let error = (chord.r / ds - tangent.r - bent[0])
                        .hypot(chord.z / ds - tangent.z - bent[1]);
                    assert!(error < 1e-13, "{curve:?} at {knot}, {back} {ds}: {error:e}");
                }
            }
        }
    }

    #[test]
    fn panels_resolve_a_coarse_spline() {
        for (count, tolerance) in [(20, 1e-8), (100, 1e-10), (2000, 1e-12)] {
            let profile =
                Profile::from_points(&sample(&Spheroid::new(1.0, 0.5).unwrap(), count)).unwrap();
            let panels = Panels::resolving(&profile, 16, tolerance).unwrap();
            println!("{count} points to {tolerance:e}: {} panels", panels.len());
            assert!(
                panels.len() < 1000,
                "{count}, {tolerance}: {}",
                panels.len()
            );
        }
    }

    #[test]
    fn area_and_volume_converge() {
        let sphere = Profile::from_points(&sample(&Spheroid::sphere(1.0).unwrap(), 200)).unwrap();
        let panels = Panels::resolving(&sphere, 16, 1e-10).unwrap();
        assert!((volume(&sphere, &panels) - 4.0 / 3.0 * PI).abs() < 1e-10);
        assert!((surface_area(&sphere, &panels) - 4.0 * PI).abs() < 1e-10);
    }

    #[test]
    fn many_points_take_little_time() {
        let profile =
            Profile::from_points(&sample(&Torus::new(2.0, 1.0).unwrap(), 99_999)).unwrap();
        let end = profile.domain().1;
        assert!((end - TAU).abs() < 1e-10);
    }

    #[test]
    fn either_direction_will_do() {
        let points = sample(&Spheroid::new(1.0, 0.5).unwrap(), 30);
        let reversed: Vec<Meridian> = points.iter().rev().copied().collect();
        assert_eq!(
            Profile::from_points(&points),
            Profile::from_points(&reversed)
        );
    }

    #[test]
    fn bad_points_are_refused() {
        let good = sample(&Spheroid::sphere(1.0).unwrap(), 20);
        let changed = |change: &dyn Fn(&mut Vec<Meridian>)| {
            let mut points = good.clone();
            change(&mut points);
            Profile::from_points(&points).unwrap_err()
        };
        assert!(matches!(
            changed(&|p| p[3].r = f64::NAN),
            CurveError::PointNotFinite { index: 4, .. }
        ));
        assert!(matches!(
            changed(&|p| p[3].z = f64::INFINITY),
            CurveError::PointNotFinite { index: 4, .. }
        ));
        assert!(matches!(
            changed(&|p| p[3].r = -0.1),
            CurveError::PointNotOffAxis { index: 4, .. }
        ));
        assert!(matches!(
            changed(&|p| p[4] = p[3]),
            CurveError::Duplicate { index: 4 }
        ));
        assert!(matches!(
            changed(&|p| p.truncate(12)),
            CurveError::Open { .. }
        ));
        assert!(matches!(
            changed(&|p| p.swap(5, 12)),
            CurveError::SelfIntersection { .. }
        ));
        assert!(matches!(
            changed(&|p| p.clear()),
            CurveError::TooFewPoints { count: 0, .. }
        ));
        assert!(matches!(
            changed(&|p| {
                p.drain(2..19);
            }),
            CurveError::TooFewPoints { count: 4, least: 5 }
        ));
        let many = vec![Meridian { r: 1.0, z: 0.0 }; MOST_POINTS + 1];
        assert!(matches!(
            Profile::from_points(&many),
            Err(CurveError::TooManyPoints { .. })
        ));
    }

    proptest! {
        #[test]
        fn no_points_panic(points in prop::collection::vec((any::<f64>(), any::<f64>()), 0..12)) {
            let points: Vec<Meridian> = points.iter().map(|&(r, z)| Meridian { r, z }).collect();
            let _ = Profile::from_points(&points);
        }

        #[test]
        fn no_plausible_points_panic(inner in prop::collection::vec((0.01..1.0f64, -1.0..1.0f64), 3..12)) {
            let mut points = vec![Meridian { r: 0.0, z: 1.5 }];
            points.extend(inner.iter().map(|&(r, z)| Meridian { r, z }));
            points.push(Meridian { r: 0.0, z: -1.5 });
            let _ = Profile::from_points(&points);
        }
    }
}
