//! Any user's function as a curve.

use std::fmt;

use super::error::CurveError;
use super::legendre::{SIXTEEN, Transform};
use super::validate::check_simple;
use super::{GeneratingCurve, MOST_PANELS, Meridian, Panels, Topology, chord_by_quadrature};

type Map = Box<dyn Fn(f64) -> Meridian + Send + Sync>;

/// Nodes on each interval of the interpolant.
const ORDER: usize = 16;
/// Legendre tail, over the curve's size, at which an interval of the interpolant is not cut
/// further.
const INTERPOLATION: f64 = 1e-13;
/// Legendre tail of a given tangent on the intervals over which it is integrated.
const INTEGRATION: f64 = 1e-12;
/// How far, over the curve's size, the integral of a given tangent may miss the points.
const AGREEMENT: f64 = 1e-9;
/// Shortest interval, as a fraction of the domain.
const SHORTEST_INTERVAL: f64 = 1e-9;

/// A curve given by functions of the parameter.
pub struct FunctionCurve {
    breakpoints: Vec<f64>,
    /// Ends of the intervals on which the curve is a polynomial to rounding.
    splits: Vec<f64>,
    topology: Topology,
    shape: Shape,
}

enum Shape {
    Functions {
        point: Map,
        tangent: Map,
    },
    /// Legendre coefficients of r and z, and of their derivatives, on each interval.
    Interpolant(Vec<Interval>),
}

struct Interval {
    start: f64,
    end: f64,
    r: Vec<f64>,
    z: Vec<f64>,
    dr: Vec<f64>,
    dz: Vec<f64>,
}

impl FunctionCurve {
    /// The curve `point(s)` with the derivative `tangent(s)`; `domain` lists the ends of the smooth
    /// pieces, ascending (two numbers for a smooth curve).
    ///
    /// # Errors
    /// If the curve does not bound a body, see [`super::check_simple`]; if `tangent` is not the
    /// derivative of `point`; or if panels do not resolve it.
    pub fn new(
        domain: &[f64],
        topology: Topology,
        point: impl Fn(f64) -> Meridian + Send + Sync + 'static,
        tangent: impl Fn(f64) -> Meridian + Send + Sync + 'static,
    ) -> Result<Self, CurveError> {
        let shape = Shape::Functions {
            point: Box::new(point),
            tangent: Box::new(tangent),
        };
        let mut curve = Self {
            breakpoints: domain.to_vec(),
            splits: domain.to_vec(),
            topology,
            shape,
        };
        check_simple(&curve)?;
        let panels = Panels::resolving(&curve, ORDER, INTEGRATION)?;
        curve.splits = panels
            .iter()
            .map(|p| p.start)
            .chain(domain.last().copied())
            .collect();
        curve.check_tangent(&panels)?;
        Ok(curve)
    }

    /// The curve `point(s)`, replaced by its interpolant of degree 15 on intervals so short that
    /// the Legendre tail is below 1e-13 of the size; points are as good, tangents to about 1e-11.
    /// `domain` as in [`Self::new`].
    ///
    /// # Errors
    /// If the curve does not bound a body, see [`super::check_simple`], or is not smooth between
    /// breakpoints.
    pub fn from_point(
        domain: &[f64],
        topology: Topology,
        point: impl Fn(f64) -> Meridian,
    ) -> Result<Self, CurveError> {
        let intervals = interpolate(domain, topology, &point)?;
        let splits = intervals
            .iter()
            .map(|i| i.start)
            .chain(domain.last().copied())
            .collect();
        let shape = Shape::Interpolant(intervals);
        let curve = Self {
            breakpoints: domain.to_vec(),
            splits,
            topology,
            shape,
        };
        check_simple(&curve)?;
        Ok(curve)
    }

    fn check_tangent(&self, panels: &Panels) -> Result<(), CurveError> {
        let differences: Vec<Meridian> = panels
            .iter()
            .map(|panel| {
                let (a, b) = (self.point(panel.start), self.point(panel.end));
                Meridian {
                    r: b.r - a.r,
                    z: b.z - a.z,
                }
            })
            .collect();
        let size: f64 = differences.iter().map(|d| d.r.hypot(d.z)).sum();
        for (panel, difference) in panels.iter().zip(differences) {
            let half = 0.5 * panel.length();
            let (mut r, mut z) = (-difference.r, -difference.z);
            for (x, w) in SIXTEEN.iter() {
                let tangent = self.tangent(panel.at(x));
                r += half * w * tangent.r;
                z += half * w * tangent.z;
            }
            if r.hypot(z).is_nan() || r.hypot(z) > AGREEMENT * size {
                return Err(CurveError::WrongTangent { s: panel.at(0.0) });
            }
        }
        Ok(())
    }

    fn interval<'a>(&self, intervals: &'a [Interval], s: f64) -> &'a Interval {
        let index = intervals.partition_point(|i| i.end < s);
        &intervals[index.min(intervals.len() - 1)]
    }
}

impl Interval {
    /// Position on [-1, 1].
    fn local(&self, s: f64) -> f64 {
        let half = 0.5 * (self.end - self.start);
        // From the nearer end, for precision there.
        if s - self.start < half {
            (s - self.start) / half - 1.0
        } else {
            1.0 - (self.end - s) / half
        }
    }
}

/// The sum of a Legendre series.
fn sum(coefficients: &[f64], x: f64) -> f64 {
    let (mut previous, mut value, mut sum) = (0.0, 1.0, 0.0);
    for (k, c) in coefficients.iter().enumerate() {
        sum += c * value;
        let k = k as f64;
        (previous, value) = (
            value,
            ((2.0 * k + 1.0) * x * value - k * previous) / (k + 1.0),
        );
    }
    sum
}

/// The Legendre series of the derivative: `c'_{k} / (2k+1) = c_{k+1} + c'_{k+2} / (2k+5)`.
fn derivative(coefficients: &[f64], scale: f64) -> Vec<f64> {
    let n = coefficients.len();
    let mut result = vec![0.0; n];
    for k in (0..n.saturating_sub(1)).rev() {
        let above = if k + 2 < n {
            result[k + 2] / (2 * k + 5) as f64
        } else {
            0.0
        };
        result[k] = (2 * k + 1) as f64 * (coefficients[k + 1] + above);
    }
    result.iter_mut().for_each(|c| *c *= scale);
    result
}

/// Intervals on which the interpolant of degree 15 is good to rounding, by bisection.
fn interpolate(
    domain: &[f64],
    topology: Topology,
    point: &impl Fn(f64) -> Meridian,
) -> Result<Vec<Interval>, CurveError> {
    let outer = Ends { domain, topology };
    let pieces = Panels::pieces(&outer)?;
    // Four intervals to begin with on each piece, so that no symmetry hides what one would miss.
    let mut waiting: Vec<_> = pieces
        .bisected(|_| true)
        .bisected(|_| true)
        .iter()
        .rev()
        .copied()
        .collect();
    let whole: f64 = pieces.iter().map(|p| p.length()).sum();
    let transform = Transform::new(ORDER);
    let sample = |s: f64| {
        let p = point(s);
        let finite = p.r.is_finite() && p.z.is_finite();
        if finite {
            Ok(p)
        } else {
            Err(CurveError::NotFinite {
                quantity: "point",
                s,
            })
        }
    };
    let origin = sample(domain[0])?;
    let mut size = 0.0f64;
    for panel in &waiting {
        for s in [panel.start, panel.at(0.0), panel.end] {
            let p = sample(s)?;
            size = size.max((p.r - origin.r).hypot(p.z - origin.z));
        }
    }
    if size == 0.0 {
        return Err(CurveError::Stationary { s: domain[0] });
    }
    let mut intervals = Vec::new();
    while let Some(panel) = waiting.pop() {
        let values = transform
            .rule
            .nodes()
            .iter()
            .map(|&x| sample(panel.at(x)))
            .collect::<Result<Vec<_>, _>>()?;
        let (r, z): (Vec<f64>, Vec<f64>) = values.iter().map(|p| (p.r, p.z)).unzip();
        if transform.tail(&r).max(transform.tail(&z)) <= INTERPOLATION * size {
            let (r, z) = (transform.coefficients(&r), transform.coefficients(&z));
            let scale = 2.0 / panel.length();
            let (dr, dz) = (derivative(&r, scale), derivative(&z, scale));
            intervals.push(Interval {
                start: panel.start,
                end: panel.end,
                r,
                z,
                dr,
                dz,
            });
            continue;
        }
        if panel.length() < SHORTEST_INTERVAL * whole
            || intervals.len() + waiting.len() > MOST_PANELS
        {
            return Err(CurveError::Unresolved {
                s: panel.at(0.0),
                order: ORDER,
                tolerance: INTERPOLATION,
            });
        }
        let middle = panel.at(0.0);
        waiting.push(super::Panel {
            start: middle,
            ..panel
        });
        waiting.push(super::Panel {
            end: middle,
            ..panel
        });
    }
    Ok(intervals)
}

/// A domain without a curve on it yet.
#[derive(Debug)]
struct Ends<'a> {
    domain: &'a [f64],
    topology: Topology,
}

impl GeneratingCurve for Ends<'_> {
    fn breakpoints(&self) -> Vec<f64> {
        self.domain.to_vec()
    }

    fn topology(&self) -> Topology {
        self.topology
    }

    fn point(&self, _: f64) -> Meridian {
        Meridian {
            r: f64::NAN,
            z: f64::NAN,
        }
    }

    fn tangent(&self, s: f64) -> Meridian {
        self.point(s)
    }

    fn chord(&self, s: f64, _: f64) -> Meridian {
        self.point(s)
    }
}

impl fmt::Debug for FunctionCurve {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FunctionCurve")
            .field("breakpoints", &self.breakpoints)
            .field("topology", &self.topology)
            .field("intervals", &(self.splits.len() - 1))
            .finish_non_exhaustive()
    }
}

impl GeneratingCurve for FunctionCurve {
    fn breakpoints(&self) -> Vec<f64> {
        self.breakpoints.clone()
    }

    fn topology(&self) -> Topology {
        self.topology
    }

    fn point(&self, s: f64) -> Meridian {
        match &self.shape {
            Shape::Functions { point, .. } => point(s),
            Shape::Interpolant(intervals) => {
                let interval = self.interval(intervals, s);
                let x = interval.local(s);
                Meridian {
                    r: sum(&interval.r, x),
                    z: sum(&interval.z, x),
                }
            }
        }
    }

    fn tangent(&self, s: f64) -> Meridian {
        match &self.shape {
            Shape::Functions { tangent, .. } => tangent(s),
            Shape::Interpolant(intervals) => {
                let interval = self.interval(intervals, s);
                let x = interval.local(s);
                Meridian {
                    r: sum(&interval.dr, x),
                    z: sum(&interval.dz, x),
                }
            }
        }
    }

    fn chord(&self, s: f64, ds: f64) -> Meridian {
        chord_by_quadrature(self, &self.splits, s, ds)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::super::{Spheroid, Torus, checks};
    use super::*;

    fn egg(s: f64) -> Meridian {
        Meridian {
            r: s.sin() * (1.0 + 0.2 * s.cos()),
            z: 1.5 * s.cos(),
        }
    }

    fn egg_tangent(s: f64) -> Meridian {
        Meridian {
            r: s.cos() + 0.2 * (2.0 * s).cos(),
            z: -1.5 * s.sin(),
        }
    }

    #[test]
    fn obeys_the_contract_of_a_curve() {
        let ends = [0.0, PI];
        checks::contract(
            &FunctionCurve::new(&ends, Topology::PoleToPole, egg, egg_tangent).unwrap(),
        );
        checks::contract_to(
            &FunctionCurve::from_point(&ends, Topology::PoleToPole, egg).unwrap(),
            1e-11,
        );
    }

    #[test]
    fn the_interpolant_is_good_to_rounding() {
        let slender = Spheroid::new(1.0, 0.02).unwrap();
        let copy =
            FunctionCurve::from_point(&[0.0, PI], Topology::PoleToPole, move |s| slender.point(s))
                .unwrap();
        let torus = Torus::new(1.0, 0.5).unwrap();
        let ring = FunctionCurve::from_point(&[0.0, TAU], Topology::Loop, move |s| torus.point(s))
            .unwrap();
        for k in 0..=100 {
            for (curve, exact, s) in [
                (
                    &copy,
                    &slender as &dyn GeneratingCurve,
                    PI * f64::from(k) / 100.0,
                ),
                (&ring, &torus, TAU * f64::from(k) / 100.0),
            ] {
                let (p, q) = (curve.point(s), exact.point(s));
                assert!((p.r - q.r).hypot(p.z - q.z) < 1e-14, "{s}: {p:?} {q:?}");
                let (p, q) = (curve.tangent(s), exact.tangent(s));
                assert!((p.r - q.r).hypot(p.z - q.z) < 1e-11, "{s}: {p:?} {q:?}");
            }
        }
        assert!((ring.chord(6.2, 0.2).r - torus.chord(6.2, 0.2).r).abs() < 1e-14);
    }

    #[test]
    fn what_is_no_curve_is_refused() {
        use Topology::{Loop, PoleToPole};
        let make = |topology, f: fn(f64) -> Meridian| {
            FunctionCurve::from_point(&[0.0, PI], topology, f).unwrap_err()
        };
        assert!(matches!(make(Loop, egg), CurveError::Open { .. }));
        assert!(matches!(
            make(PoleToPole, |s| egg(0.9 * s)),
            CurveError::Open { .. }
        ));
        assert!(matches!(
            make(PoleToPole, |s| egg(PI - s)),
            CurveError::Backwards
        ));
        assert!(matches!(
            make(PoleToPole, |s| egg(1.0 / s)),
            CurveError::NotFinite { .. }
        ));
        assert!(matches!(
            make(PoleToPole, |s| egg((s - 1.0).abs() + s)),
            CurveError::Unresolved { .. }
        ));
        let cone = |s: f64| Meridian {
            r: s * (PI - s),
            z: 1.0 - s,
        };
        assert!(matches!(
            make(PoleToPole, cone),
            CurveError::ConicalPole { .. }
        ));
        let left = |s: f64| Meridian {
            r: s.sin() * (0.5 + (2.0 * s).cos()),
            z: s.cos(),
        };
        assert!(matches!(
            make(PoleToPole, left),
            CurveError::CrossesAxis { .. }
        ));
        let eight = |s: f64| Meridian {
            r: 2.0 + (2.0 * s).sin(),
            z: (4.0 * s).sin(),
        };
        assert!(matches!(
            make(Loop, eight),
            CurveError::SelfIntersection { .. }
        ));
        assert!(matches!(
            make(PoleToPole, |_| egg(0.0)),
            CurveError::Stationary { .. }
        ));
        for domain in [
            &[][..],
            &[0.0],
            &[0.0, 0.0],
            &[1.0, 0.0],
            &[0.0, f64::NAN],
            &[0.0, f64::INFINITY],
        ] {
            assert_eq!(
                FunctionCurve::from_point(domain, PoleToPole, egg).unwrap_err(),
                CurveError::Domain
            );
            let error = FunctionCurve::new(domain, PoleToPole, egg, egg_tangent).unwrap_err();
            assert_eq!(error, CurveError::Domain);
        }
        let wrong = |s: f64| Meridian {
            r: s.cos(),
            z: -1.5 * s.sin(),
        };
        let error = FunctionCurve::new(&[0.0, PI], PoleToPole, egg, wrong).unwrap_err();
        assert!(matches!(error, CurveError::WrongTangent { .. }));
    }
}
