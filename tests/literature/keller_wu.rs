//! Spheroids that swim by slip from pole to pole (Keller & Wu 1977), and the same formula continued
//! to oblate ones.

use std::f64::consts::PI;

use axistokes::nalgebra::{Point3, Vector3};
use axistokes::{Body, GeneratingCurve, Slip, Spheroid, Suspension};

use super::ask::answer;

/// Swimming speed over slip speed: with $\tau_0$ the inverse eccentricity, $\tau_0 (\tau_0 -
/// (\tau_0^2 - 1) \operatorname{arcoth} \tau_0)$.
fn speed(polar: f64, equatorial: f64) -> f64 {
    let square = polar * polar / ((polar - equatorial) * (polar + equatorial));
    let tau = square.abs().sqrt();
    if polar > equatorial {
        tau * (tau - (square - 1.0) * (1.0 / tau).atanh())
    } else {
        // tau_0 is imaginary.
        tau * ((tau * tau + 1.0) * (1.0 / tau).atan() - tau)
    }
}

/// The same by the reciprocal theorem: $\frac{1}{3V} \int (1 - \nu_z^2)\, x \cdot \nu\, d\Gamma$,
/// since the traction of a translating ellipsoid is in proportion to $x \cdot \nu$; midpoint rule
/// in $\cos$ of the eccentric angle.
fn speed_by_reciprocity(polar: f64, equatorial: f64) -> f64 {
    let n = 100_000;
    let sum = (0..n).map(|k| {
        let cos = (2.0 * f64::from(k) + 1.0) / f64::from(n) - 1.0;
        let (across, along) = (
            (1.0 - cos * cos) * polar * polar,
            cos * cos * equatorial * equatorial,
        );
        across / (across + along)
    });
    sum.sum::<f64>() / f64::from(n)
}

#[test]
fn every_aspect_swims_as_in_closed_form() {
    for (polar, equatorial) in [
        (1.0, 0.1),
        (1.0, 0.25),
        (2.0, 1.0),
        (1.0, 0.9),
        (0.9, 1.0),
        (0.5, 1.0),
        (0.25, 1.0),
        (0.1, 1.0),
    ] {
        let exact = 1.5 * speed(polar, equatorial);
        assert!((exact - 1.5 * speed_by_reciprocity(polar, equatorial)).abs() < 1e-8);
        let shape = Spheroid::new(polar, equatorial)
            .expect("a spheroid")
            .shape();
        let swimmer = Body::free(&shape).with_slip(Slip::pole_to_pole(polar, equatorial, 1.5));
        let probe = Point3::new(0.0, 2.0, 2.0);
        let answer = answer(&Suspension::new([swimmer]).with_probes([probe]), 1e-12);
        let body = &answer.bodies[0];
        let error = (body.motion.velocity - exact * Vector3::z()).norm();
        println!(
            "{polar} : {equatorial}, {} panels: error {error:.1e}, estimate {:.1e}",
            body.resolution.panels.len(),
            answer.error_estimate
        );
        assert!(error <= 9e-15 && body.motion.angular_velocity.norm() <= 1e-14);
    }
    assert!((speed(1.0 + 1e-4, 1.0) - 2.0 / 3.0).abs() < PI * 1e-4);
}
