//! Surface velocities of swimmers, relative to their rigid motion.

use std::fmt;
use std::sync::Arc;

use nalgebra::Vector3;

/// A velocity of the surface relative to the body's rigid motion, as a function of the point on it:
/// both in the body's own frame, where lengths are the shape's. It turns with the body.
#[derive(Clone)]
pub struct Slip(Arc<dyn Fn(Vector3<f64>) -> Vector3<f64> + Send + Sync>);

impl Slip {
    /// Any function of the point.
    pub fn new(velocity: impl Fn(Vector3<f64>) -> Vector3<f64> + Send + Sync + 'static) -> Self {
        Self(Arc::new(velocity))
    }

    /// The velocity at a point of the surface.
    pub fn at(&self, x: Vector3<f64>) -> Vector3<f64> {
        (self.0)(x)
    }

    /// Squirming modes of a sphere about the origin (Lighthill 1952, Blake 1971): the tangential
    /// velocity
    ///
    /// $$ u_\theta = \sum_{n \ge 1} b_n V_n(\cos\theta),
    /// \qquad V_n = \frac{2}{n(n+1)} \sin\theta\\, P_n'(\cos\theta), $$
    ///
    /// where $e_\theta$ points away from the upper pole and `b` holds $b_1, b_2, \dots$ in units of
    /// velocity. Alone in a fluid at rest the sphere swims with $\frac23 b_1 e_z$; $b_2 > 0$ makes
    /// a puller, $b_2 < 0$ a pusher.
    pub fn squirmer(b: impl Into<Vec<f64>>) -> Self {
        let b = b.into();
        Self::new(move |x| {
            let e = x.normalize();
            // P_{n+1}' = P_{n-1}' + (2n+1) P_n and (n+1) P_{n+1} = (2n+1) t P_n - n P_{n-1}.
            let t = e.z;
            let (mut p, mut p_before) = (t, 1.0);
            let (mut dp, mut dp_before) = (1.0, 0.0);
            let mut sum = 0.0;
            for (k, b) in b.iter().enumerate() {
                let n = (k + 1) as f64;
                sum += 2.0 * b / (n * (n + 1.0)) * dp;
                let p_next = ((2.0 * n + 1.0) * t * p - n * p_before) / (n + 1.0);
                let dp_next = dp_before + (2.0 * n + 1.0) * p;
                (p, p_before) = (p_next, p);
                (dp, dp_before) = (dp_next, dp);
            }
            // sin(theta) e_theta, smooth at the poles.
            sum * (t * e - Vector3::z())
        })
    }

    /// Slip from the upper pole of a spheroid about the origin to its lower one (Keller & Wu 1977):
    /// $u_s = -v\\, (s \cdot e_z)\\, s$ with the meridian's unit tangent $s$, so that the `speed`
    /// $v$ is reached at the equator. On a sphere this is the first squirming mode, $b_1 = v$. For
    /// $v > 0$ the spheroid swims up its axis.
    pub fn pole_to_pole(polar: f64, equatorial: f64, speed: f64) -> Self {
        // The components, scaled so that their squares neither overflow nor vanish.
        let [across, along] = [polar / equatorial, equatorial / polar];
        Self::new(move |x| {
            let normal = Vector3::new(across * x.x, across * x.y, along * x.z).normalize();
            // (s . e_z) s is the tangential part of e_z.
            speed * (normal.z * normal - Vector3::z())
        })
    }
}

impl fmt::Debug for Slip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Slip(a function)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_those_of_the_formula() {
        let theta = 0.7f64;
        let (sin, cos) = theta.sin_cos();
        let x = 2.0 * Vector3::new(0.0, sin, cos);
        let e_theta = Vector3::new(0.0, cos, -sin);
        // P_1' = 1, P_2' = 3 t, P_3' = (15 t^2 - 3)/2, P_4' = (35 t^3 - 15 t)/2.
        let derivatives = [
            1.0,
            3.0 * cos,
            7.5 * cos * cos - 1.5,
            17.5 * cos.powi(3) - 7.5 * cos,
        ];
        for (k, derivative) in derivatives.into_iter().enumerate() {
            let mut b = [0.0; 4];
            b[k] = 1.0;
            let n = (k + 1) as f64;
            let exact = 2.0 / (n * (n + 1.0)) * sin * derivative * e_theta;
            assert!((Slip::squirmer(b).at(x) - exact).norm() < 1e-15, "mode {n}");
        }
        assert_eq!(
            Slip::squirmer([1.0, 1.0]).at(Vector3::z()),
            Vector3::zeros()
        );
    }

    #[test]
    fn on_a_sphere_pole_to_pole_is_the_first_mode() {
        let x = 3.0 * Vector3::new(0.3, -0.2, 0.7).normalize();
        let [first, slip] = [
            Slip::squirmer([1.5]).at(x),
            Slip::pole_to_pole(3.0, 3.0, 1.5).at(x),
        ];
        assert!((first - slip).norm() < 1e-15);
        let equator = Slip::pole_to_pole(1.0, 0.1, 2.0).at(Vector3::new(0.0, 0.1, 0.0));
        let down: Vector3<f64> = -2.0 * Vector3::z();
        assert!((equator - down).norm() < 1e-15);
    }
}
