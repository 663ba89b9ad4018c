//! The flow of a point force, exactly.

use std::f64::consts::PI;

use nalgebra::Vector3;

/// A force at a point of an unbounded fluid of viscosity 1.
///
/// With $d = x - x_0$ from the place $x_0$ of the force $f$,
///
/// $$ u = \frac{1}{8\pi}
///    \left(\frac{f}{\lvert d\rvert} + \frac{d\\, (d\cdot f)}{\lvert d\rvert^3}\right), \qquad
///    p = \frac{d\cdot f}{4\pi\lvert d\rvert^3} . $$
///
/// The velocity for viscosity $\mu$ is $u/\mu$; the pressure does not depend on it. Both are
/// infinite at $x_0$ (or NaN).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stokeslet {
    /// Where the force acts.
    pub at: Vector3<f64>,
    /// The force on the fluid.
    pub force: Vector3<f64>,
}

impl Stokeslet {
    /// The velocity at `x`.
    pub fn velocity(&self, x: Vector3<f64>) -> Vector3<f64> {
        let d = x - self.at;
        let r = d.norm();
        (self.force + d * (d.dot(&self.force) / (r * r))) / (8.0 * PI * r)
    }

    /// The pressure at `x`.
    pub fn pressure(&self, x: Vector3<f64>) -> f64 {
        let d = x - self.at;
        d.dot(&self.force) / (4.0 * PI * d.norm().powi(3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STOKESLET: Stokeslet = Stokeslet {
        at: Vector3::new(0.1, -0.2, 0.3),
        force: Vector3::new(1.0, 2.0, -0.5),
    };

    #[test]
    fn along_and_across_the_force() {
        let Stokeslet { at, force } = STOKESLET;
        let unit = force.normalize();
        let along = STOKESLET.velocity(at + 2.0 * unit);
        assert!((along - force / (8.0 * PI)).amax() < 1e-16);
        let across = unit.cross(&Vector3::z()).normalize();
        assert!((STOKESLET.velocity(at + 2.0 * across) - force / (16.0 * PI)).amax() < 1e-16);
        assert!(STOKESLET.pressure(at + 2.0 * across).abs() < 1e-17);
        let pressure = force.norm() / (16.0 * PI);
        assert!((STOKESLET.pressure(at + 2.0 * unit) - pressure).abs() < 1e-16);
    }

    #[test]
    fn satisfies_the_stokes_equations() {
        let x = Vector3::new(0.9, 0.4, -0.6);
        let h = 1e-3;
        let u = |x| STOKESLET.velocity(x);
        let mut divergence = 0.0;
        let mut laplacian = -6.0 * u(x);
        let mut gradient = Vector3::zeros();
        for (i, e) in [Vector3::x(), Vector3::y(), Vector3::z()]
            .into_iter()
            .enumerate()
        {
            let (forth, back) = (x + h * e, x - h * e);
            divergence += (u(forth) - u(back))[i] / (2.0 * h);
            laplacian += u(forth) + u(back);
            gradient[i] = (STOKESLET.pressure(forth) - STOKESLET.pressure(back)) / (2.0 * h);
        }
        assert!(divergence.abs() < 1e-6);
        assert!((laplacian / (h * h) - gradient).amax() < 1e-6);
    }
}
