//! The biconcave disc of the human red cell.

use std::f64::consts::PI;

use super::error::{CurveError, length};
use super::fourier::Fourier;
use super::{GeneratingCurve, Meridian, Topology};

/// C_0, C_2, C_4 over the radius: 0.81, 7.83 and -4.39 um over 3.91 um.
const COEFFICIENTS: [f64; 3] = [0.207161, 2.002558, -1.122762];

/// The average red cell of Evans & Fung (Microvasc. Res. 4, 335, 1972): thickness
/// `R sqrt(1 - x^2) (c_0 + c_2 x^2 + c_4 x^4)` at the distance `x R` from the axis, half of it on
/// either side.
///
/// With `x = sin s`, `0 <= s <= pi`, this is analytic: `r = R sin s`,
/// `z = (R/2) cos s (c_0 + c_2 sin^2 s + c_4 sin^4 s)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Biconcave {
    radius: f64,
    series: Fourier,
}

impl Biconcave {
    /// The cell of the given radius (3.91 um in the paper).
    ///
    /// # Errors
    /// If the radius is not a positive length.
    pub fn new(radius: f64) -> Result<Self, CurveError> {
        let radius = length("radius", radius)?;
        let [c0, c2, c4] = COEFFICIENTS;
        // c_0 + c_2 sin^2 + c_4 sin^4 = constant + double cos 2s + quadruple cos 4s.
        let constant = c0 + c2 / 2.0 + 3.0 * c4 / 8.0;
        let double = -(c2 + c4) / 2.0;
        let quadruple = c4 / 8.0;
        let half = 0.5 * radius;
        let cosines = vec![
            0.0,
            half * (constant + double / 2.0),
            0.0,
            half * (double + quadruple) / 2.0,
            0.0,
            half * quadruple / 2.0,
        ];
        let sines = vec![0.0, radius, 0.0, 0.0, 0.0, 0.0];
        Ok(Self {
            radius,
            series: Fourier { sines, cosines },
        })
    }

    /// The largest distance from the axis.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl GeneratingCurve for Biconcave {
    fn breakpoints(&self) -> Vec<f64> {
        vec![0.0, PI]
    }

    fn topology(&self) -> Topology {
        Topology::PoleToPole
    }

    fn point(&self, s: f64) -> Meridian {
        self.series.point(s)
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
    use super::super::{Panels, checks, surface_area, volume};
    use super::*;

    #[test]
    fn obeys_the_contract_of_a_curve() {
        checks::contract_to(&Biconcave::new(1.0).unwrap(), 1e-14);
        checks::contract_to(&Biconcave::new(3.91).unwrap(), 1e-14);
    }

    #[test]
    fn thickness_area_and_volume_of_the_paper() {
        let cell = Biconcave::new(3.91).unwrap();
        let thickness = |s: f64| 2.0 * cell.point(s).z;
        assert!((thickness(0.0) - 0.81).abs() < 1e-5);
        let thickest = (0..1000)
            .map(|k| thickness(PI * f64::from(k) / 2000.0))
            .fold(0.0, f64::max);
        assert!((thickest - 2.57).abs() < 0.01, "{thickest}");
        let panels = Panels::resolving(&cell, 16, 1e-12).unwrap();
        let (area, volume) = (surface_area(&cell, &panels), volume(&cell, &panels));
        assert!((area - 135.0).abs() < 1.0, "{area}");
        assert!((volume - 94.0).abs() < 0.5, "{volume}");
        // 2 pi R^3 (c_0/3 + 2 c_2/15 + 8 c_4/105).
        let [c0, c2, c4] = COEFFICIENTS;
        let exact = 2.0 * PI * 3.91f64.powi(3) * (c0 / 3.0 + 2.0 * c2 / 15.0 + 8.0 * c4 / 105.0);
        assert!((volume / exact - 1.0).abs() < 1e-13);
    }

    #[test]
    fn bad_radii_are_refused() {
        for bad in [0.0, -3.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Biconcave::new(bad),
                Err(CurveError::Length {
                    quantity: "radius",
                    ..
                })
            ));
        }
    }
}
