//! Exact flows, and how far from them the computed ones are.

use std::f64::consts::PI;
use std::fmt;

use axistokes::body::{FlowGradientAt, Stokeslet};
use nalgebra::{Matrix3, Point3, Vector3};

/// The flow of several point forces.
#[derive(Clone, Debug)]
pub struct Stokeslets(pub Vec<Stokeslet>);

impl Stokeslets {
    /// With random forces of order one.
    pub fn at(places: &[[f64; 3]]) -> Self {
        let mut random = fastrand::Rng::with_seed(7);
        let force = |_| Vector3::from_fn(|_, _| 2.0 * random.f64() - 1.0);
        let forces: Vec<_> = places.iter().map(force).collect();
        let stokeslet = |(&at, force): (&[f64; 3], _)| Stokeslet {
            at: at.into(),
            force,
        };
        Self(places.iter().zip(forces).map(stokeslet).collect())
    }

    pub fn velocity(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.0.iter().map(|s| s.velocity(x)).sum()
    }

    pub fn flow(&self, x: Vector3<f64>) -> FlowGradientAt {
        FlowGradientAt {
            velocity: self.velocity(x),
            pressure: self.0.iter().map(|s| s.pressure(x)).sum(),
            gradient: self.0.iter().map(|s| gradient(s, x)).sum(),
        }
    }
}

/// $8\pi\, \partial_j u_i = (f_j d_i - f_i d_j + (d \cdot f)\, \delta_{ij})/d^3 - 3 (d \cdot f)\,
/// d_i d_j/d^5$, with $d$ from the force's place.
fn gradient(stokeslet: &Stokeslet, x: Vector3<f64>) -> Matrix3<f64> {
    let (d, f) = (x - stokeslet.at, stokeslet.force);
    let along = d.dot(&f);
    let bracket = d * f.transpose() - f * d.transpose() + Matrix3::from_diagonal_element(along)
        - d * d.transpose() * (3.0 * along / d.norm_squared());
    bracket / (8.0 * PI * d.norm().powi(3))
}

/// Largest errors in absolute terms; of NaN, infinity.
#[derive(Clone, Copy, Debug, Default)]
pub struct Errors {
    pub velocity: f64,
    pub pressure: f64,
    pub gradient: f64,
    /// The gradient's trace.
    pub divergence: f64,
}

impl Errors {
    pub fn of(
        targets: &[Point3<f64>],
        found: &[FlowGradientAt],
        exact: impl Fn(Vector3<f64>) -> FlowGradientAt,
    ) -> Self {
        assert_eq!(targets.len(), found.len());
        let mut errors = Self::default();
        for (x, found) in targets.iter().zip(found) {
            errors = errors.and(Self::between(found, &exact(x.coords)));
        }
        errors
    }

    pub fn between(found: &FlowGradientAt, exact: &FlowGradientAt) -> Self {
        let known = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
        Self {
            velocity: known((found.velocity - exact.velocity).norm()),
            pressure: known((found.pressure - exact.pressure).abs()),
            gradient: known((found.gradient - exact.gradient).norm()),
            divergence: known(found.gradient.trace().abs()),
        }
    }

    pub fn and(self, other: Self) -> Self {
        Self {
            velocity: self.velocity.max(other.velocity),
            pressure: self.pressure.max(other.pressure),
            gradient: self.gradient.max(other.gradient),
            divergence: self.divergence.max(other.divergence),
        }
    }

    /// Bars for velocity, for pressure, and for the gradient and its trace.
    pub fn are_below(&self, [velocity, pressure, gradient]: [f64; 3]) -> bool {
        self.velocity <= velocity
            && self.pressure <= pressure
            && self.gradient <= gradient
            && self.divergence <= gradient
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            velocity,
            pressure,
            gradient,
            divergence,
        } = self;
        write!(
            f,
            "velocity {velocity:.1e}, pressure {pressure:.1e}, gradient {gradient:.1e} (trace {divergence:.1e})"
        )
    }
}
