//! Panels from a tolerance.

use super::error::CurveError;
use super::legendre::Transform;
use super::{GeneratingCurve, MOST_PANELS, Meridian, Panel, Panels};

/// Fewest and most nodes per panel.
const ORDERS: (usize, usize) = (4, 64);
/// Smallest tolerance that double precision meets, and the largest that says anything.
const TOLERANCES: (f64, f64) = (1e-14, 0.1);
/// Panels to start from, so that no symmetry hides what one panel misses.
const FIRST_PANELS: usize = 4;
/// Shortest panel, as a fraction of the domain, before the curve counts as not smooth.
const SHORTEST_PANEL: f64 = 1e-10;

impl Panels {
    /// Panels on which `order` Gauss-Legendre nodes represent the curve to `tolerance`: each is
    /// bisected until the last two Legendre coefficients of r and z (in relation to the body's
    /// size), of the speed (to the panel's largest) and of the unit normal are below it; then
    /// graded, see [`Panels::graded`].
    ///
    /// This resolves the geometry; a density on it may need more. Cost: some `order` points per
    /// panel.
    ///
    /// # Errors
    /// If `order` is not in 4..=64 or `tolerance` not in 1e-14..=0.1, or if the curve is not smooth
    /// enough: a panel would be shorter than 1e-10 of the domain, or more than [`MOST_PANELS`] be
    /// needed.
    pub fn resolving(
        curve: &(impl GeneratingCurve + ?Sized),
        order: usize,
        tolerance: f64,
    ) -> Result<Self, CurveError> {
        if !(ORDERS.0..=ORDERS.1).contains(&order) {
            return Err(CurveError::Order {
                order,
                least: ORDERS.0,
                limit: ORDERS.1,
            });
        }
        if !(TOLERANCES.0..=TOLERANCES.1).contains(&tolerance) {
            return Err(CurveError::Tolerance {
                tolerance,
                least: TOLERANCES.0,
                limit: TOLERANCES.1,
            });
        }
        let pieces = Self::pieces(curve)?.len();
        let mut panels = Self::uniform(curve, pieces.max(FIRST_PANELS))?;
        let domain: f64 = panels.iter().map(Panel::length).sum();
        let transform = Transform::new(order);
        let size = size(curve, &panels, &transform);
        // Panels known to be resolved are not looked at again.
        let mut resolved = vec![false; panels.len()];
        loop {
            for (panel, done) in panels.iter().zip(&mut resolved) {
                *done = *done || tail(curve, panel, &transform, size)? <= tolerance;
            }
            if !resolved.contains(&false) {
                return Ok(panels.graded());
            }
            let unresolved = |s| CurveError::Unresolved {
                s,
                order,
                tolerance,
            };
            for (panel, done) in panels.iter().zip(&resolved) {
                if !done && panel.length() < SHORTEST_PANEL * domain {
                    return Err(unresolved(panel.at(0.0)));
                }
            }
            panels = panels.bisected(|index| !resolved[index]);
            if panels.len() > MOST_PANELS {
                return Err(unresolved(panels.as_slice()[0].start));
            }
            resolved = resolved
                .iter()
                .flat_map(|&d| if d { vec![true] } else { vec![false; 2] })
                .collect();
        }
    }
}

/// Half the diagonal of the smallest rectangle around the curve's nodes.
fn size(curve: &(impl GeneratingCurve + ?Sized), panels: &Panels, transform: &Transform) -> f64 {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for panel in panels {
        for &x in transform.rule.nodes() {
            let p = curve.point(panel.at(x));
            low = [low[0].min(p.r), low[1].min(p.z)];
            high = [high[0].max(p.r), high[1].max(p.z)];
        }
    }
    0.5 * (high[0] - low[0]).hypot(high[1] - low[1])
}

/// How much of the curve a panel's nodes miss.
fn tail(
    curve: &(impl GeneratingCurve + ?Sized),
    panel: &Panel,
    transform: &Transform,
    size: f64,
) -> Result<f64, CurveError> {
    let parameters: Vec<f64> = transform
        .rule
        .nodes()
        .iter()
        .map(|&x| panel.at(x))
        .collect();
    let finite = |p: Meridian, quantity, s| {
        if p.r.is_finite() && p.z.is_finite() {
            Ok(p)
        } else {
            Err(CurveError::NotFinite { quantity, s })
        }
    };
    let (mut r, mut z, mut speed) = (Vec::new(), Vec::new(), Vec::new());
    let (mut normal_r, mut normal_z) = (Vec::new(), Vec::new());
    for &s in &parameters {
        let point = finite(curve.point(s), "point", s)?;
        let tangent = finite(curve.tangent(s), "tangent", s)?;
        let length = tangent.r.hypot(tangent.z);
        if length <= 0.0 {
            return Err(CurveError::Stationary { s });
        }
        r.push(point.r / size);
        z.push(point.z / size);
        speed.push(length);
        normal_r.push(-tangent.z / length);
        normal_z.push(tangent.r / length);
    }
    let fastest = speed.iter().copied().fold(0.0, f64::max);
    speed.iter_mut().for_each(|v| *v /= fastest);
    // Rounding alone leaves something in the last coefficients, and that is not part of the curve
    // that is missed. It is large enough to matter in a ring much thinner than wide.
    let missed = |f: &Vec<f64>| {
        let largest = f.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        (transform.tail(f) - 64.0 * f64::EPSILON * largest).max(0.0)
    };
    Ok([r, z, speed, normal_r, normal_z]
        .iter()
        .map(missed)
        .fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::super::{Capsule, Spheroid, Torus};
    use super::*;

    #[test]
    fn slender_tips_are_graded() {
        let sphere = Panels::resolving(&Spheroid::sphere(1.0).unwrap(), 16, 1e-12).unwrap();
        assert_eq!(sphere.len(), 4);
        for aspect in [10.0, 100.0, 1e4, 1e6] {
            let spheroid = Spheroid::new(aspect, 1.0).unwrap();
            let panels = Panels::resolving(&spheroid, 16, 1e-10).unwrap();
            let lengths: Vec<f64> = panels.iter().map(Panel::length).collect();
            assert!(panels.len() < 100, "{aspect}: {} panels", panels.len());
            let ratio = lengths.iter().copied().fold(0.0, f64::max) / lengths[0];
            assert!(ratio > 0.05 * aspect, "{aspect}: longest to tip {ratio}");
            assert!(
                lengths
                    .windows(2)
                    .all(|w| w[0] <= 2.001 * w[1] && w[1] <= 2.001 * w[0])
            );
        }
    }

    #[test]
    fn the_tolerance_is_kept_between_the_nodes() {
        let spheroid = Spheroid::new(0.05, 1.0).unwrap();
        for (order, tolerance) in [(10, 1e-6), (16, 1e-12)] {
            let panels = Panels::resolving(&spheroid, order, tolerance).unwrap();
            let transform = Transform::new(order);
            let speed = |s: f64| spheroid.tangent(s).r.hypot(spheroid.tangent(s).z);
            for panel in &panels {
                let values: Vec<f64> = transform
                    .rule
                    .nodes()
                    .iter()
                    .map(|&x| speed(panel.at(x)))
                    .collect();
                let largest = values.iter().copied().fold(0.0, f64::max);
                let coefficients = transform.coefficients(&values);
                for x in [-1.0, -0.7, 0.1, 0.95, 1.0] {
                    let (mut p, mut q, mut sum) = (1.0, 0.0, 0.0);
                    for (k, c) in coefficients.iter().enumerate() {
                        let k = k as f64;
                        sum += c * p;
                        (p, q) = (((2.0 * k + 1.0) * x * p - k * q) / (k + 1.0), p);
                    }
                    assert!((sum - speed(panel.at(x))).abs() < 10.0 * tolerance * largest);
                }
            }
        }
    }

    #[test]
    fn every_tolerance_ends() {
        for tolerance in [0.1, 1e-6, 1e-14] {
            for order in [4, 10, 16, 64] {
                for curve in [
                    &Torus::new(1.0, 0.9).unwrap() as &dyn GeneratingCurve,
                    &Capsule::new(0.1, 5.0).unwrap(),
                    &Spheroid::new(0.01, 1.0).unwrap(),
                ] {
                    let panels = Panels::resolving(curve, order, tolerance);
                    // Fourth order to the last digit takes more panels than there may be.
                    let hopeless = order == 4 && tolerance < 1e-13;
                    assert!(panels.is_ok() || hopeless, "{curve:?} {order} {tolerance}");
                }
            }
        }
    }

    #[test]
    fn common_bodies_need_few_panels() {
        let needed = |curve: &dyn GeneratingCurve, most: usize| {
            let panels = Panels::resolving(curve, 16, 1e-10).unwrap();
            println!("{curve:?}: {} panels", panels.len());
            assert!(panels.len() <= most, "{curve:?}: {} panels", panels.len());
        };
        needed(&Spheroid::new(1.0, 0.5).unwrap(), 8);
        needed(&Spheroid::new(0.01, 1.0).unwrap(), 24);
        needed(&Spheroid::new(100.0, 1.0).unwrap(), 24);
        needed(&Torus::new(1.0, 0.9).unwrap(), 8);
        needed(&Capsule::new(1.0, 2.0).unwrap(), 4);
        needed(&super::super::Biconcave::new(1.0).unwrap(), 16);
    }

    #[test]
    fn bad_orders_and_tolerances_are_refused() {
        let sphere = Spheroid::sphere(1.0).unwrap();
        for order in [0, 3, 65] {
            assert!(matches!(
                Panels::resolving(&sphere, order, 1e-8),
                Err(CurveError::Order { .. })
            ));
        }
        for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-17, 1.0] {
            let error = Panels::resolving(&sphere, 16, tolerance);
            assert!(matches!(error, Err(CurveError::Tolerance { .. })));
        }
    }
}
