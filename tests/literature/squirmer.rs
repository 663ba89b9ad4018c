//! The squirmer of Lighthill (1952) and Blake (1971): speed, stresslet, flow.

use std::f64::consts::PI;

use axistokes::nalgebra::{Matrix3, Point3, Vector3};
use axistokes::{Body, GeneratingCurve, Silent, Slip, Spheroid, Suspension};

use super::ask::answer;

#[test]
fn swims_as_in_closed_form() {
    for (radius, b) in [
        (1.0, vec![1.5, 3.0]),
        (2.0, vec![1.0, -2.0, 0.5]),
        (0.5, vec![0.0, 1.0]),
    ] {
        let above = Point3::new(0.0, 0.0, 1.5 * radius);
        let sphere = Spheroid::sphere(radius).expect("a sphere").shape();
        let swimmer = Body::free(&sphere).with_slip(Slip::squirmer(b.clone()));
        let answer = answer(&Suspension::new([swimmer]).with_probes([above]), 1e-12);
        let body = &answer.bodies[0];
        let swimming = Vector3::new(0.0, 0.0, 2.0 * b[0] / 3.0);
        let motion =
            (body.motion.velocity - swimming).norm() + radius * body.motion.angular_velocity.norm();
        let exact = 4.0 / 3.0
            * PI
            * radius
            * radius
            * b[1]
            * Matrix3::from_diagonal(&Vector3::new(-1.0, -1.0, 2.0));
        let stresslet = (body.stresslet - exact).amax() / exact.amax();
        // Only the first two modes have a power as simple as this: 8 pi a (2 b1^2 + b2^2)/3.
        if let [first, second] = b[..] {
            let exact = 8.0 / 3.0 * PI * radius * (2.0 * first * first + second * second);
            let power = answer.flow.powers(&Silent).expect("a power")[0] / exact - 1.0;
            println!("power {power:.1e}");
            assert!(power.abs() <= 6e-13);
        }
        // Blake 1971, equation 4, on the axis: P_n = 1 there.
        let x = radius / above.z;
        let modes = (b.iter().enumerate().skip(1)).map(|(k, b)| {
            let n = (k + 1) as i32;
            b * (x.powi(n + 2) - x.powi(n))
        });
        let exact = 2.0 / 3.0 * b[0] * x.powi(3) + modes.sum::<f64>();
        let flow = (answer.probes[0].velocity - exact * Vector3::z()).norm();
        println!(
            "squirmer {b:?}: motion {motion:.1e}, stresslet {stresslet:.1e}, flow {flow:.1e}, estimate {:.1e}",
            answer.error_estimate
        );
        assert!(motion <= 4e-15 && stresslet <= 1e-14 && flow <= 1e-14);
        assert!(answer.error_estimate <= 1e-12);
    }
}
