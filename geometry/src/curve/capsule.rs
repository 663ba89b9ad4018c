//! Capsules: a cylinder between two hemispherical caps.

use std::f64::consts::{FRAC_PI_2, PI};

use super::error::{CurveError, aspect, length};
use super::spheroid::arc_chord;
use super::{GeneratingCurve, Meridian, Topology};

/// A cylinder of radius `a` and length `l` between two hemispheres, parametrised by arc length over
/// `a`.
///
/// The pieces are the upper cap `0 <= s <= pi/2`, the cylinder up to `pi/2 + l/a`, and the lower
/// cap up to `pi + l/a`. Curvature jumps at the joints; a capsule of length zero is a sphere of one
/// piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    radius: f64,
    length: f64,
}

impl Capsule {
    /// The capsule of the given `radius` and `length` of its cylinder.
    ///
    /// # Errors
    /// If the radius is not a positive length, or the length is neither zero nor a positive length
    /// within a factor 1e6 of the radius.
    pub fn new(radius: f64, length: f64) -> Result<Self, CurveError> {
        let radius = self::length("radius", radius)?;
        if length != 0.0 {
            self::length("length", length)?;
            aspect(("length", length), ("radius", radius))?;
        }
        Ok(Self {
            radius,
            length: length.abs(),
        })
    }

    /// Radius of the caps and of the cylinder.
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// Length of the cylinder.
    pub fn length(&self) -> f64 {
        self.length
    }

    /// Parameters of the two joints.
    fn joints(&self) -> [f64; 2] {
        [FRAC_PI_2, FRAC_PI_2 + self.length / self.radius]
    }

    /// The angle from the upper pole, as if the cylinder were left out; exact to rounding near the
    /// joints.
    fn angle(&self, s: f64) -> (f64, f64) {
        let [upper, lower] = self.joints();
        if s <= upper {
            s.sin_cos()
        } else if s <= lower {
            (1.0, 0.0)
        } else {
            // sin(pi/2 + x) = cos x, cos(pi/2 + x) = -sin x.
            let (sin, cos) = (s - lower).sin_cos();
            (cos, -sin)
        }
    }

    /// The chord between two parameters of one piece, in units of the radius.
    fn chord_on_piece(&self, piece: usize, s: f64, ds: f64) -> Meridian {
        match piece {
            0 => arc_chord(s, ds),
            1 => Meridian { r: 0.0, z: -ds },
            _ => {
                let unit = arc_chord(s - self.joints()[1], ds);
                Meridian {
                    r: unit.z,
                    z: -unit.r,
                }
            }
        }
    }
}

impl GeneratingCurve for Capsule {
    fn breakpoints(&self) -> Vec<f64> {
        if self.length == 0.0 {
            return vec![0.0, PI];
        }
        let [upper, lower] = self.joints();
        vec![0.0, upper, lower, PI + self.length / self.radius]
    }

    fn topology(&self) -> Topology {
        Topology::PoleToPole
    }

    fn point(&self, s: f64) -> Meridian {
        let [upper, lower] = self.joints();
        let (sin, cos) = self.angle(s);
        // Height of the centre of the cross-section or cap that s belongs to.
        let centre = 0.5 * self.length - self.radius * (s.clamp(upper, lower) - upper);
        Meridian {
            r: self.radius * sin,
            z: centre + self.radius * cos,
        }
    }

    fn tangent(&self, s: f64) -> Meridian {
        let (sin, cos) = self.angle(s);
        Meridian {
            r: self.radius * cos,
            z: -self.radius * sin,
        }
    }

    fn chord(&self, s: f64, ds: f64) -> Meridian {
        let [upper, lower] = self.joints();
        let piece = if s <= upper {
            0
        } else if s <= lower {
            1
        } else {
            2
        };
        let mut sum = Meridian { r: 0.0, z: 0.0 };
        let (mut s, mut left, mut piece) = (s, ds, piece);
        // From joint to joint, without forming s + ds; at most two joints lie between.
        loop {
            let joint = match (piece, ds > 0.0) {
                (0, true) | (1, false) => Some(upper),
                (1, true) | (2, false) => Some(lower),
                _ => None,
            };
            let step = match joint {
                Some(joint) if (joint - s).abs() < left.abs() => joint - s,
                _ => left,
            };
            let part = self.chord_on_piece(piece, s, step);
            sum = Meridian {
                r: sum.r + part.r,
                z: sum.z + part.z,
            };
            match joint {
                Some(joint) if step != left => {
                    (s, left) = (joint, left - step);
                    piece = if ds > 0.0 { piece + 1 } else { piece - 1 };
                }
                _ => break,
            }
        }
        Meridian {
            r: self.radius * sum.r,
            z: self.radius * sum.z,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks;
    use super::*;

    #[test]
    fn obeys_the_contract_of_a_curve() {
        for (radius, length) in [(1.0, 2.0), (0.5, 0.0), (1.0, 0.01), (0.1, 20.0)] {
            checks::contract(&Capsule::new(radius, length).unwrap());
        }
    }

    #[test]
    fn area_and_volume() {
        for (a, l) in [(1.0, 2.0), (0.5, 0.0), (0.1, 20.0)] {
            let area = 4.0 * PI * a * a + 2.0 * PI * a * l;
            let volume = 4.0 / 3.0 * PI * a * a * a + PI * a * a * l;
            checks::measures(&Capsule::new(a, l).unwrap(), area, volume);
        }
    }

    #[test]
    fn ends_and_joints() {
        let capsule = Capsule::new(1.0, 3.0).unwrap();
        let at = capsule.breakpoints();
        for (s, r, z) in [
            (at[0], 0.0, 2.5),
            (at[1], 1.0, 1.5),
            (at[2], 1.0, -1.5),
            (at[3], 0.0, -2.5),
        ] {
            let point = capsule.point(s);
            assert!(
                (point.r - r).abs() < 1e-15 && (point.z - z).abs() < 1e-15,
                "{point:?}"
            );
        }
        assert_eq!(Capsule::new(1.0, 0.0).unwrap().breakpoints(), vec![0.0, PI]);
    }

    #[test]
    fn bad_lengths_are_refused() {
        for bad in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(
                Capsule::new(bad, 1.0),
                Err(CurveError::Length {
                    quantity: "radius",
                    ..
                })
            ));
            assert!(matches!(
                Capsule::new(1.0, bad),
                Err(CurveError::Length {
                    quantity: "length",
                    ..
                })
            ));
        }
        assert!(matches!(
            Capsule::new(0.0, 1.0),
            Err(CurveError::Length { .. })
        ));
        assert!(matches!(
            Capsule::new(1.0, 1e-9),
            Err(CurveError::Aspect {
                smaller: "length",
                ..
            })
        ));
        assert!(matches!(
            Capsule::new(1.0, 1e9),
            Err(CurveError::Aspect {
                larger: "length",
                ..
            })
        ));
    }
}
