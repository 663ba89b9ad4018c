//! Star-shaped bodies: the distance from the centre as a cosine series.

use std::f64::consts::PI;

use super::error::{CurveError, LARGEST_ASPECT, LONGEST, SHORTEST};
use super::fourier::Fourier;
use super::{GeneratingCurve, Meridian, Topology};

/// Most coefficients accepted.
const MOST_COEFFICIENTS: usize = 1000;

/// The body whose surface is at the distance `d(theta) = sum_k c_k cos(k theta)` from the centre,
/// theta from the axis: `r = d sin theta`, `z = d cos theta`, `0 <= theta <= pi`.
#[derive(Clone, Debug, PartialEq)]
pub struct Polar {
    coefficients: Vec<f64>,
    series: Fourier,
}

impl Polar {
    /// The body of the given coefficients `c_0, c_1, ...`
    ///
    /// # Errors
    /// If there is none or more than 1000, if one is not finite, or if the distance is anywhere
    /// less than 1e-6 of `sum |c_k|` (in particular zero or negative).
    pub fn new(coefficients: &[f64]) -> Result<Self, CurveError> {
        if coefficients.is_empty() {
            return Err(CurveError::NoCoefficients);
        }
        if coefficients.len() > MOST_COEFFICIENTS {
            return Err(CurveError::TooManyCoefficients {
                count: coefficients.len(),
                limit: MOST_COEFFICIENTS,
            });
        }
        for (index, &value) in coefficients.iter().enumerate() {
            if !value.is_finite() || value.abs() > LONGEST {
                return Err(CurveError::Coefficient { index, value });
            }
        }
        check_positive(coefficients)?;
        Ok(Self {
            coefficients: coefficients.to_vec(),
            series: series(coefficients),
        })
    }

    /// The coefficients of the distance.
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// The distance from the centre at the angle `theta` from the axis.
    pub fn distance(&self, theta: f64) -> f64 {
        distance(&self.coefficients, theta)
    }
}

fn distance(coefficients: &[f64], theta: f64) -> f64 {
    coefficients
        .iter()
        .enumerate()
        .map(|(k, c)| c * (k as f64 * theta).cos())
        .sum()
}

/// `2 cos(k t) sin t = sin((k+1) t) - sin((k-1) t)`,
/// `2 cos(k t) cos t = cos((k+1) t) + cos((k-1) t)`.
fn series(coefficients: &[f64]) -> Fourier {
    let mut sines = vec![0.0; coefficients.len() + 1];
    let mut cosines = sines.clone();
    for (k, &c) in coefficients.iter().enumerate() {
        sines[k + 1] += 0.5 * c;
        cosines[k + 1] += 0.5 * c;
        let (below, sign) = if k == 0 { (1, 1.0) } else { (k - 1, -1.0) };
        sines[below] += sign * 0.5 * c;
        cosines[below] += 0.5 * c;
    }
    Fourier { sines, cosines }
}

/// Proves that the distance exceeds 1e-6 of its bound, with `|d''| <= sum k^2 |c_k|` between
/// samples.
fn check_positive(coefficients: &[f64]) -> Result<(), CurveError> {
    let bound: f64 = coefficients.iter().map(|c| c.abs()).sum();
    let bend: f64 = coefficients
        .iter()
        .enumerate()
        .map(|(k, c)| (k * k) as f64 * c.abs())
        .sum();
    let least = (bound / LARGEST_ASPECT).max(SHORTEST);
    let sample = |theta: f64| {
        let distance = distance(coefficients, theta);
        if distance > least {
            Ok(distance)
        } else {
            Err(CurveError::DistanceNotPositive {
                theta,
                distance,
                least,
            })
        }
    };
    let parts = 4 * coefficients.len();
    let mut intervals = Vec::with_capacity(parts + 64);
    for k in 0..parts {
        let at = |k: usize| PI * k as f64 / parts as f64;
        intervals.push((at(k), sample(at(k))?, at(k + 1), sample(at(k + 1))?));
    }
    while let Some((a, at_a, b, at_b)) = intervals.pop() {
        let width = b - a;
        if at_a.min(at_b) - bend * width * width / 8.0 > least {
            continue;
        }
        let middle = 0.5 * (a + b);
        let at_middle = sample(middle)?;
        // A minimum that touches the bound to rounding cannot be told from one that passes it.
        if width < 1e-9 {
            return Err(CurveError::DistanceNotPositive {
                theta: middle,
                distance: at_middle,
                least,
            });
        }
        intervals.push((a, at_a, middle, at_middle));
        intervals.push((middle, at_middle, b, at_b));
    }
    Ok(())
}

impl GeneratingCurve for Polar {
    fn breakpoints(&self) -> Vec<f64> {
        vec![0.0, PI]
    }

    fn topology(&self) -> Topology {
        Topology::PoleToPole
    }

    fn point(&self, s: f64) -> Meridian {
        // Not from the series: next to the axis r is better as a product.
        let (sin, cos) = s.sin_cos();
        let distance = self.distance(s);
        Meridian {
            r: distance * sin,
            z: distance * cos,
        }
    }

    fn tangent(&self, s: f64) -> Meridian {
        self.series.tangent(s)
    }

    fn chord(&self, s: f64, ds: f64) -> Meridian {
        self.series.chord(s, ds)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::{Spheroid, checks};
    use super::*;

    #[test]
    fn obeys_the_contract_of_a_curve() {
        for coefficients in [
            vec![2.0],
            vec![1.0, 0.0, 0.5],
            vec![1.0, 0.3, -0.2, 0.1],
            vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.2],
        ] {
            checks::contract_to(&Polar::new(&coefficients).unwrap(), 1e-13);
        }
    }

    #[test]
    fn one_coefficient_is_a_sphere() {
        let (polar, sphere) = (Polar::new(&[1.5]).unwrap(), Spheroid::sphere(1.5).unwrap());
        for s in [0.0, 0.4, 2.0, 3.1] {
            assert_eq!(polar.point(s), sphere.point(s));
            assert_eq!(polar.chord(s, 1e-5), sphere.chord(s, 1e-5));
        }
    }

    #[test]
    fn volume_of_a_series() {
        // d = 1 + e cos t: V = (2 pi / 3) int d^3 sin t dt = (4 pi / 3)(1 + e^2).
        let curve = Polar::new(&[1.0, 0.3]).unwrap();
        let panels = super::super::Panels::resolving(&curve, 16, 1e-13).unwrap();
        let volume = super::super::volume(&curve, &panels);
        assert!((volume - 4.0 / 3.0 * PI * 1.09).abs() < 1e-12);
    }

    #[test]
    fn bad_coefficients_are_refused() {
        assert_eq!(Polar::new(&[]), Err(CurveError::NoCoefficients));
        assert!(matches!(
            Polar::new(&[1.0; 1001]),
            Err(CurveError::TooManyCoefficients { .. })
        ));
        assert!(matches!(
            Polar::new(&[1.0, f64::NAN]),
            Err(CurveError::Coefficient { index: 1, .. })
        ));
        assert!(matches!(
            Polar::new(&[f64::INFINITY]),
            Err(CurveError::Coefficient { index: 0, .. })
        ));
        let bad: [&[f64]; 6] = [
            &[0.0],
            &[-1.0],
            &[1.0, 1.0],
            &[0.5, 0.0, 1.0],
            &[1.0, 0.0, 0.0, 0.0, -1.01],
            &[1.0, 0.0, 1.0],
        ];
        for coefficients in bad {
            let error = Polar::new(coefficients);
            assert!(
                matches!(error, Err(CurveError::DistanceNotPositive { .. })),
                "{coefficients:?}"
            );
        }
    }

    proptest! {
        #[test]
        fn no_coefficients_panic(coefficients in prop::collection::vec(any::<f64>(), 0..20)) {
            let _ = Polar::new(&coefficients);
        }

        #[test]
        fn accepted_series_are_positive(coefficients in prop::collection::vec(-1.0..1.0f64, 1..8)) {
            if let Ok(curve) = Polar::new(&coefficients) {
                prop_assert!((0..=1000).all(|k| curve.distance(PI * f64::from(k) / 1000.0) > 0.0));
            }
        }
    }
}
