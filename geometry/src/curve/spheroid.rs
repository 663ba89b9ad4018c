//! Spheroids and spheres.

use std::f64::consts::PI;

use super::error::{CurveError, aspect, length};
use super::{GeneratingCurve, Meridian, Topology};

/// A spheroid `r = b sin s`, `z = a cos s`, `0 <= s <= pi`, from the upper pole to the lower.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spheroid {
    polar: f64,
    equatorial: f64,
}

impl Spheroid {
    /// The spheroid of semi-axes `polar` (a, along z) and `equatorial` (b).
    ///
    /// # Errors
    /// If a semi-axis is not a positive length, or the two differ by more than a factor 1e6.
    pub fn new(polar: f64, equatorial: f64) -> Result<Self, CurveError> {
        let polar = length("polar", polar)?;
        let equatorial = length("equatorial", equatorial)?;
        aspect(("polar", polar), ("equatorial", equatorial))?;
        Ok(Self { polar, equatorial })
    }

    /// The sphere of the given radius.
    ///
    /// # Errors
    /// If the radius is not a positive length.
    pub fn sphere(radius: f64) -> Result<Self, CurveError> {
        let radius = length("radius", radius)?;
        Ok(Self {
            polar: radius,
            equatorial: radius,
        })
    }

    /// The semi-axis along z.
    pub fn polar(&self) -> f64 {
        self.polar
    }

    /// The semi-axis across z.
    pub fn equatorial(&self) -> f64 {
        self.equatorial
    }
}

impl GeneratingCurve for Spheroid {
    fn breakpoints(&self) -> Vec<f64> {
        vec![0.0, PI]
    }

    fn topology(&self) -> Topology {
        Topology::PoleToPole
    }

    fn point(&self, s: f64) -> Meridian {
        let (sin, cos) = s.sin_cos();
        Meridian {
            r: self.equatorial * sin,
            z: self.polar * cos,
        }
    }

    fn tangent(&self, s: f64) -> Meridian {
        let (sin, cos) = s.sin_cos();
        Meridian {
            r: self.equatorial * cos,
            z: -self.polar * sin,
        }
    }

    fn chord(&self, s: f64, ds: f64) -> Meridian {
        let unit = arc_chord(s, ds);
        Meridian {
            r: self.equatorial * unit.r,
            z: self.polar * unit.z,
        }
    }
}

/// The chord of the unit circle `(sin s, cos s)`: `sin(s + ds) - sin s = 2 cos m sin(ds/2)` and
/// `cos(s + ds) - cos s = -2 sin m sin(ds/2)`, with `m = s + ds/2`.
///
/// The sum m is never rounded: its sine and cosine come from the addition theorem, so that the
/// error is a few roundings of the component's own terms also where sin m or cos m is small.
pub(super) fn arc_chord(s: f64, ds: f64) -> Meridian {
    let (sin, cos) = s.sin_cos();
    let (sin_half, cos_half) = (0.5 * ds).sin_cos();
    let cos_middle = cos * cos_half - sin * sin_half;
    let sin_middle = sin * cos_half + cos * sin_half;
    Meridian {
        r: 2.0 * cos_middle * sin_half,
        z: -2.0 * sin_middle * sin_half,
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks;
    use super::*;

    #[test]
    fn obeys_the_contract_of_a_curve() {
        for (polar, equatorial) in [(1.0, 0.5), (0.01, 1.0), (3e5, 3.0), (2.0, 2.0)] {
            checks::contract(&Spheroid::new(polar, equatorial).unwrap());
        }
    }

    #[test]
    fn area_and_volume() {
        let sphere = Spheroid::sphere(1.5).unwrap();
        checks::measures(&sphere, 4.0 * PI * 2.25, 4.0 / 3.0 * PI * 3.375);
        // Prolate: e = sqrt(1 - b^2/a^2), A = 2 pi b^2 (1 + a/(b e) asin e).
        let (a, b): (f64, f64) = (1.0, 0.5);
        let e = (1.0 - b * b / a / a).sqrt();
        let area = 2.0 * PI * b * b * (1.0 + a / b / e * e.asin());
        checks::measures(
            &Spheroid::new(a, b).unwrap(),
            area,
            4.0 / 3.0 * PI * a * b * b,
        );
        // Oblate: e = sqrt(1 - a^2/b^2), A = 2 pi b^2 (1 + (1 - e^2)/e atanh e).
        let (a, b): (f64, f64) = (0.01, 1.0);
        let e = (1.0 - a * a / b / b).sqrt();
        let area = 2.0 * PI * b * b * (1.0 + a * a / b / b / e * ((1.0 + e) / (a / b)).ln());
        checks::measures(
            &Spheroid::new(a, b).unwrap(),
            area,
            4.0 / 3.0 * PI * a * b * b,
        );
    }

    #[test]
    fn bad_lengths_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200, 1e200] {
            assert!(matches!(
                Spheroid::new(bad, 1.0),
                Err(CurveError::Length {
                    quantity: "polar",
                    ..
                })
            ));
            assert!(matches!(
                Spheroid::new(1.0, bad),
                Err(CurveError::Length {
                    quantity: "equatorial",
                    ..
                })
            ));
            assert!(matches!(
                Spheroid::sphere(bad),
                Err(CurveError::Length {
                    quantity: "radius",
                    ..
                })
            ));
        }
        assert!(matches!(
            Spheroid::new(1e7, 1.0),
            Err(CurveError::Aspect {
                larger: "polar",
                ..
            })
        ));
        assert_eq!(
            Spheroid::sphere(-2.0).unwrap_err().to_string(),
            "radius must be a positive length between 1e-100 and 1e100, got -2"
        );
    }
}
