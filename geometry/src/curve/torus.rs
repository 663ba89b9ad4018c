//! Circular tori.

use std::f64::consts::TAU;

use super::error::{CurveError, aspect, length};
use super::spheroid::arc_chord;
use super::{GeneratingCurve, Meridian, Topology};

/// A torus `r = R + a sin s`, `z = a cos s`, `0 <= s <= 2 pi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    major: f64,
    minor: f64,
}

impl Torus {
    /// The torus whose tube of radius `minor` (a) is centred on the circle of radius `major` (R).
    ///
    /// # Errors
    /// If a radius is not a positive length, if `minor >= major`, or if the tube or the hole is
    /// more than 1e6 times smaller than `major`.
    pub fn new(major: f64, minor: f64) -> Result<Self, CurveError> {
        let major = length("major", major)?;
        let minor = length("minor", minor)?;
        if minor >= major {
            return Err(CurveError::TubeOnAxis { major, minor });
        }
        aspect(("major", major), ("minor", minor))?;
        aspect(("major", major), ("major - minor", major - minor))?;
        Ok(Self { major, minor })
    }

    /// Distance of the tube's centre from the axis.
    pub fn major(&self) -> f64 {
        self.major
    }

    /// Radius of the tube.
    pub fn minor(&self) -> f64 {
        self.minor
    }
}

impl GeneratingCurve for Torus {
    fn breakpoints(&self) -> Vec<f64> {
        vec![0.0, TAU]
    }

    fn topology(&self) -> Topology {
        Topology::Loop
    }

    fn point(&self, s: f64) -> Meridian {
        let (sin, cos) = s.sin_cos();
        Meridian {
            r: self.major + self.minor * sin,
            z: self.minor * cos,
        }
    }

    fn tangent(&self, s: f64) -> Meridian {
        let (sin, cos) = s.sin_cos();
        Meridian {
            r: self.minor * cos,
            z: -self.minor * sin,
        }
    }

    fn chord(&self, s: f64, ds: f64) -> Meridian {
        let unit = arc_chord(s, ds);
        Meridian {
            r: self.minor * unit.r,
            z: self.minor * unit.z,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::super::checks;
    use super::*;

    #[test]
    fn obeys_the_contract_of_a_curve() {
        for (major, minor) in [(1.0, 0.5), (1.0, 0.9), (1.0, 1e-3), (7e10, 2e9)] {
            checks::contract(&Torus::new(major, minor).unwrap());
        }
    }

    #[test]
    fn area_and_volume_by_pappus() {
        for (major, minor) in [(1.0, 0.25), (1.0, 0.9)] {
            let torus = Torus::new(major, minor).unwrap();
            checks::measures(
                &torus,
                4.0 * PI * PI * major * minor,
                2.0 * PI * PI * major * minor * minor,
            );
        }
    }

    #[test]
    fn bad_radii_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Torus::new(bad, 0.1),
                Err(CurveError::Length {
                    quantity: "major",
                    ..
                })
            ));
            assert!(matches!(
                Torus::new(1.0, bad),
                Err(CurveError::Length {
                    quantity: "minor",
                    ..
                })
            ));
        }
        assert!(matches!(
            Torus::new(1.0, 1.0),
            Err(CurveError::TubeOnAxis { .. })
        ));
        assert!(matches!(
            Torus::new(1.0, 2.0),
            Err(CurveError::TubeOnAxis { .. })
        ));
        assert!(matches!(
            Torus::new(1.0, 1e-7),
            Err(CurveError::Aspect {
                smaller: "minor",
                ..
            })
        ));
        assert!(matches!(
            Torus::new(1.0, 1.0 - 1e-9),
            Err(CurveError::Aspect { .. })
        ));
    }
}
