//! The resistance of spheroids, from disc to needle, against the closed forms of Oberbeck and
//! Jeffery (Kim & Karrila, Microhydrodynamics, 1991, tables 3.4 and 3.6).
//!
//!     cargo run --release --example drag

use std::error::Error;
use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::body::{DirichletSolver, Discretization, Formulation};
use axistokes::nalgebra::Vector3;
use axistokes::{Panels, RigidMotion, Silent, Spheroid};

/// Tolerance for the panels: how well they resolve the curve.
const TOLERANCE: f64 = 1e-10;

/// Force along and across the axis, torque along and across it, for unit (angular) velocity and
/// viscosity 1.
type Resistance = [f64; 4];

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "polar : equatorial  panels     along    across     about  about across  largest relative error"
    );
    for (polar, equatorial) in [
        (0.1, 1.0),
        (0.25, 1.0),
        (0.5, 1.0),
        (1.0, 0.5),
        (1.0, 0.25),
        (1.0, 0.1),
        (1.0, 0.01),
    ] {
        let (panels, computed) = resistance(polar, equatorial)?;
        let exact = closed_form(polar, equatorial);
        let error = std::iter::zip(computed, exact).map(|(c, e)| (c / e - 1.0).abs());
        let error = error.fold(0.0, f64::max);
        let [along, across, about, about_across] = computed;
        println!(
            "{polar:5} : {equatorial:<10}  {panels:6} {along:9.5} {across:9.5} {about:9.5} {about_across:13.5}  {error:22.1e}"
        );
        assert!(error <= TOLERANCE, "{error:e} exceeds the tolerance");
    }
    Ok(())
}

/// The number of panels used, and the resistance. The matrices are factored once and serve all four
/// motions.
fn resistance(polar: f64, equatorial: f64) -> Result<(usize, Resistance), Box<dyn Error>> {
    let curve = Arc::new(Spheroid::new(polar, equatorial)?);
    let panels = Panels::resolving(&*curve, 16, TOLERANCE)?;
    let count = panels.len();
    let nodes = Discretization::new(curve, panels, 16)?;
    // A rigid motion has azimuthal modes 0 and 1 only.
    let solver = DirichletSolver::new(nodes, Formulation::CombinedField, 1, &Silent)?;
    let still = Vector3::zeros();
    let moving = |velocity, angular_velocity| {
        solver.resistance(&RigidMotion {
            velocity,
            angular_velocity,
        })
    };
    Ok((
        count,
        [
            moving(Vector3::z(), still).force.z,
            moving(Vector3::x(), still).force.x,
            moving(still, Vector3::z()).torque.z,
            moving(still, Vector3::x()).torque.x,
        ],
    ))
}

/// The same in closed form, for semi-axes that differ.
fn closed_form(polar: f64, equatorial: f64) -> Resistance {
    let large = polar.max(equatorial);
    let e = ((polar - equatorial).abs() * (polar + equatorial)).sqrt() / large;
    let (e2, e3) = (e * e, e * e * e);
    let [xa, ya, xc, yc] = if polar > equatorial {
        let l = 2.0 * e.atanh();
        let f = 1.0 - e2;
        [
            8.0 * e3 / 3.0 / ((1.0 + e2) * l - 2.0 * e),
            16.0 * e3 / 3.0 / (2.0 * e + (3.0 * e2 - 1.0) * l),
            4.0 * e3 / 3.0 * f / (2.0 * e - f * l),
            4.0 * e3 / 3.0 * (2.0 - e2) / ((1.0 + e2) * l - 2.0 * e),
        ]
    } else {
        let (c, s) = (e.asin(), (1.0 - e2).sqrt());
        [
            4.0 * e3 / 3.0 / ((2.0 * e2 - 1.0) * c + e * s),
            8.0 * e3 / 3.0 / ((2.0 * e2 + 1.0) * c - e * s),
            2.0 * e3 / 3.0 / (c - e * s),
            2.0 * e3 / 3.0 * (2.0 - e2) / (e * s - (1.0 - 2.0 * e2) * c),
        ]
    };
    let (force, torque) = (6.0 * PI * large, 8.0 * PI * large.powi(3));
    [force * xa, force * ya, torque * xc, torque * yc]
}
