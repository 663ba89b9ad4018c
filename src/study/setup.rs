//! The known flow, where it is compared, and how.

use std::f64::consts::PI;

use fastrand::Rng;
use nalgebra::{Point3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use stokes_body::kernel::Stokeslet;

/// Stokeslets in the body.
pub const STOKESLETS: usize = 5;
/// Half axes (across, along) of the spheroid they lie on.
pub const STOKESLETS_ON: [f64; 2] = [0.3, 0.8];
/// Half axes of the spheroid the targets lie on.
pub const TARGETS_ON: [f64; 2] = [0.7, 1.2];
/// Targets from pole to pole and around.
pub const GRID: [usize; 2] = [12, 24];

/// A flow of random Stokeslets about a spheroid in a random attitude, known on a grid of targets.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Takes the body's frame to that of the Stokeslets and targets.
    rotation: Rotation3<f64>,
    stokeslets: Vec<Stokeslet>,
    targets: Vec<Point3<f64>>,
    exact: Vec<Vector3<f64>>,
}

/// Errors of the velocity on the targets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// The largest of any component (equation 3.140).
    pub absolute: f64,
    /// The largest of any component relative to that component (equation 3.141).
    pub relative: f64,
}

impl Setup {
    /// The flow that belongs to `seed`: places uniform in the parameters of the spheroid, forces
    /// normal with unit deviation, rotation uniform.
    pub fn random(seed: u64) -> Self {
        let mut random = Rng::with_seed(seed);
        let attitude = Quaternion::from_vector(std::array::from_fn(|_| normal(&mut random)).into());
        let rotation = UnitQuaternion::from_quaternion(attitude).to_rotation_matrix();
        let stokeslets: Vec<_> = (0..STOKESLETS)
            .map(|_| {
                let polar = (1.0 - 2.0 * random.f64()).acos();
                let at = rotation * on_spheroid(STOKESLETS_ON, polar, 2.0 * PI * random.f64());
                let force = Vector3::from_fn(|_, _| normal(&mut random));
                Stokeslet { at, force }
            })
            .collect();
        let [rows, columns] = GRID;
        let grid = (0..rows * columns).map(|k| {
            let polar = PI * ((k / columns) as f64 + 0.5) / rows as f64;
            let azimuth = 2.0 * PI * (k % columns) as f64 / columns as f64;
            Point3::from(rotation * on_spheroid(TARGETS_ON, polar, azimuth))
        });
        let mut setup = Self {
            rotation,
            stokeslets,
            targets: grid.collect(),
            exact: Vec::new(),
        };
        setup.exact = setup
            .targets
            .iter()
            .map(|x| setup.velocity(x.coords))
            .collect();
        setup
    }

    /// The Stokeslets.
    pub fn stokeslets(&self) -> &[Stokeslet] {
        &self.stokeslets
    }

    /// The exact velocity.
    pub fn velocity(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.stokeslets.iter().map(|s| s.velocity(x)).sum()
    }

    /// The largest speed on the targets.
    pub fn largest_speed(&self) -> f64 {
        self.exact.iter().map(|u| u.norm()).fold(0.0, f64::max)
    }

    /// The exact velocity in the body's frame.
    pub fn velocity_on_body(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.rotation.inverse() * self.velocity(self.rotation * x)
    }

    /// The targets in the body's frame.
    pub fn targets_of_body(&self) -> Vec<Point3<f64>> {
        self.targets
            .iter()
            .map(|x| self.rotation.inverse() * x)
            .collect()
    }

    /// The errors of velocities in the body's frame, target by target.
    pub fn errors(&self, velocities: impl Iterator<Item = Vector3<f64>>) -> Errors {
        let mut worst = Errors {
            absolute: 0.0,
            relative: 0.0,
        };
        for (velocity, exact) in velocities.zip(&self.exact) {
            let error = (self.rotation * velocity - exact).abs();
            worst.absolute = worst.absolute.max(error.max());
            worst.relative = worst.relative.max(error.component_div(&exact.abs()).max());
        }
        worst
    }
}

fn on_spheroid([across, along]: [f64; 2], polar: f64, azimuth: f64) -> Vector3<f64> {
    let (sin, cos) = polar.sin_cos();
    Vector3::new(
        across * sin * azimuth.cos(),
        across * sin * azimuth.sin(),
        along * cos,
    )
}

/// A normal deviate (Box and Muller).
fn normal(random: &mut Rng) -> f64 {
    let radius = (-2.0 * (1.0 - random.f64()).ln()).sqrt();
    radius * (2.0 * PI * random.f64()).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_fixes_the_flow() {
        let (one, again, two) = (Setup::random(1), Setup::random(1), Setup::random(2));
        assert_eq!(one.stokeslets(), again.stokeslets());
        assert_ne!(one.stokeslets(), two.stokeslets());
    }

    #[test]
    fn the_exact_flow_has_no_error() {
        let setup = Setup::random(3);
        assert!((setup.rotation.matrix().determinant() - 1.0).abs() < 1e-14);
        let targets = setup.targets_of_body();
        let errors = setup.errors(targets.iter().map(|x| setup.velocity_on_body(x.coords)));
        assert!(
            errors.absolute < 1e-14 && errors.relative < 1e-10,
            "{errors:?}"
        );
        for target in targets {
            let [across, along] = TARGETS_ON;
            let rho = target.x.hypot(target.y) / across;
            assert!((rho.hypot(target.z / along) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn errors_are_those_of_the_worst_component() {
        let setup = Setup::random(4);
        let inverse = setup.rotation.inverse();
        let off = Vector3::new(0.0, 1e-3, 0.0);
        let moved: Vec<_> = setup.exact.iter().map(|u| inverse * (u + off)).collect();
        let errors = setup.errors(moved.into_iter());
        assert!((errors.absolute - 1e-3).abs() < 1e-14);
        let least = setup
            .exact
            .iter()
            .map(|u| u.y.abs())
            .fold(f64::MAX, f64::min);
        assert!((errors.relative * least / 1e-3 - 1.0).abs() < 1e-8);
    }
}
