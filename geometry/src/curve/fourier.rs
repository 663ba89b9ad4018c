//! Meridians that are trigonometric polynomials: `r = sum_m b_m sin(m s)`,
//! `z = sum_m a_m cos(m s)`.

use super::Meridian;
use super::spheroid::arc_chord;

/// The coefficients of one such meridian, both indexed by the frequency m from 0.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fourier {
    pub sines: Vec<f64>,
    pub cosines: Vec<f64>,
}

impl Fourier {
    fn terms(&self) -> impl Iterator<Item = (f64, f64, f64)> {
        self.sines
            .iter()
            .zip(&self.cosines)
            .enumerate()
            .map(|(m, (&b, &a))| (m as f64, b, a))
    }

    pub fn point(&self, s: f64) -> Meridian {
        self.terms()
            .fold(Meridian { r: 0.0, z: 0.0 }, |sum, (m, b, a)| {
                let (sin, cos) = (m * s).sin_cos();
                Meridian {
                    r: sum.r + b * sin,
                    z: sum.z + a * cos,
                }
            })
    }

    pub fn tangent(&self, s: f64) -> Meridian {
        self.terms()
            .fold(Meridian { r: 0.0, z: 0.0 }, |sum, (m, b, a)| {
                let (sin, cos) = (m * s).sin_cos();
                Meridian {
                    r: sum.r + m * b * cos,
                    z: sum.z - m * a * sin,
                }
            })
    }

    /// Term by term the chord of a circle run through m times as fast.
    pub fn chord(&self, s: f64, ds: f64) -> Meridian {
        self.terms()
            .fold(Meridian { r: 0.0, z: 0.0 }, |sum, (m, b, a)| {
                let unit = arc_chord(m * s, m * ds);
                Meridian {
                    r: sum.r + b * unit.r,
                    z: sum.z + a * unit.z,
                }
            })
    }
}
