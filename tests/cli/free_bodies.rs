//! Cases of free bodies, swimmers and background flows, from the file to the report, against closed
//! forms and the matrices.

use std::f64::consts::PI;

use axistokes::case::Case;
use axistokes::nalgebra::{Matrix3, Unit, Vector3, Vector6};
use axistokes::output::Report;
use axistokes::solve::solve;
use axistokes::{Capsule, Frame, RigidBodyMatrices, Silent};

fn report(text: &str) -> Report {
    let case = Case::parse(text, "case.toml").expect("a case");
    solve(&case, &Silent).expect("an answer").report
}

fn near(a: impl Into<Vector3<f64>>, b: Vector3<f64>, tolerance: f64) {
    let a = a.into();
    assert!((a - b).norm() <= tolerance, "{a} and {b}");
}

/// The case file's way to the motion of a sinking capsule, and the mobility matrix's.
#[test]
fn a_tilted_capsule_sinks_as_its_mobility_says() {
    let text = include_str!("../data/cases/capsule.toml");
    let body = &report(&format!("viscosity = 3.0\n{text}")).bodies[0];
    let curve = std::sync::Arc::new(Capsule::new(0.5, 2.0).expect("a capsule"));
    let matrices = RigidBodyMatrices::to_tolerance(curve, 1e-10, &Silent).expect("matrices");
    let axis = Unit::new_normalize(Vector3::new(0.5, 0.0, 0.75f64.sqrt()));
    let frame = Frame::along([0.0; 3].into(), axis);
    let force = frame.vector_to_body(-Vector3::z()) / 3.0;
    let motion = matrices.mobility.0 * Vector6::new(force.x, force.y, force.z, 0.0, 0.0, 0.0);
    let velocity = frame.vector_to_lab(motion.fixed_rows::<3>(0).into());
    near(body.velocity, velocity, 1e-10);
    near(body.angular_velocity, Vector3::zeros(), 1e-10);
    assert!(velocity.x < -1e-4, "it drifts along its axis: {velocity}");
    assert_eq!((body.force, body.torque), ([0.0, 0.0, -1.0], [0.0; 3]));
}

#[test]
fn a_rod_in_shear_turns_in_the_laboratory_too() {
    let report = report(include_str!("../data/cases/jeffery.toml"));
    let exact = 0.5 - 15.0 / 34.0 * (0.64 - 0.36);
    near(
        report.bodies[0].angular_velocity,
        exact * Vector3::y(),
        1e-9,
    );
    near(report.bodies[0].velocity, Vector3::zeros(), 1e-9);
    assert!(report.error_estimate <= 1e-9);
}

/// Viscosity, frame and place all enter: a tilted squirmer away from the origin, in a shear.
#[test]
fn a_squirmer_in_shear_is_carried_along() {
    let report = report(
        "viscosity = 2.5\n\
         [shapes.cell]\nkind = 'sphere'\nradius = 2.0\n\
         [[bodies]]\nshape = 'cell'\ncenter = [1.0, -2.0, 0.5]\naxis = [1.0, 2.0, 2.0]\nforce = [0.0, 0.0, 0.3]\n\
         slip = { kind = 'squirmer', b = [1.5, -1.0, 0.2] }\n\
         [background]\nkind = 'shear'\nrate = 0.4\nflow = [0.0, 1.0, 0.0]\ngradient = [0.0, 0.0, 1.0]\n\
         [accuracy]\ntolerance = 1e-11\n[probes]\npoints = [[1.0, -2.0, 1e4]]\n",
    );
    let body = &report.bodies[0];
    let e = Vector3::new(1.0, 2.0, 2.0) / 3.0;
    let sinking = 0.3 / (6.0 * PI * 2.5 * 2.0);
    let carried = 0.4 * 0.5 * Vector3::y();
    near(body.velocity, e + carried + sinking * Vector3::z(), 1e-10);
    near(body.angular_velocity, -0.2 * Vector3::x(), 1e-10);
    let strain =
        0.2 * (Vector3::y() * Vector3::z().transpose() + Vector3::z() * Vector3::y().transpose());
    let swimming = 3.0 * e * e.transpose() - Matrix3::identity();
    let exact: Matrix3<f64> = 2.5 * PI * (20.0 / 3.0 * 8.0 * strain - 4.0 / 3.0 * 4.0 * swimming);
    let stresslet: Matrix3<f64> = Matrix3::from_fn(|i, j| body.stresslet[i][j]);
    assert!(
        (stresslet - exact).amax() <= 1e-10 * exact.amax(),
        "{stresslet} and {exact}"
    );
    // Far away little is left but the shear and the force's Stokeslet.
    let far = Vector3::from(report.probes[0].velocity);
    let exact: Vector3<f64> =
        0.4 * 1e4 * Vector3::y() + 0.3 / (4.0 * PI * 2.5 * 1e4) * Vector3::z();
    assert!((far - exact).norm() <= 1e-7, "{far}");
    assert!(report.error_estimate <= 1e-11);
}

/// On the axis a squirmer's flow is a short sum (Blake 1971), also a thousandth of a radius above
/// its pole.
#[test]
fn next_to_a_squirmer_the_flow_is_as_exact_as_elsewhere() {
    let report = report(include_str!("../data/cases/squirmer.toml"));
    let [probe, ..] = &report.probes[..] else {
        panic!("no probes");
    };
    let x = 1.0 / probe.point[2];
    let exact = x.powi(3) + 3.0 * (x.powi(4) - x.powi(2));
    near(probe.velocity, exact * Vector3::z(), 1e-9);
    let body = &report.bodies[0];
    near(body.velocity, Vector3::z(), 1e-9);
    assert!((body.power.expect("a power") / (36.0 * PI) - 1.0).abs() < 1e-9);
    assert_eq!(body.force, [0.0; 3]);
}

#[test]
fn a_spheroid_swims_from_pole_to_pole() {
    let report = report(
        "[shapes.rod]\nkind = 'spheroid'\npolar = 2.0\nequatorial = 1.0\n\
         [[bodies]]\nshape = 'rod'\naxis = [0.0, 1.0, 0.0]\ntorque = [0.0, 0.0, 0.0]\n\
         slip = { kind = 'pole-to-pole', speed = 10.0 }\n",
    );
    let tau = 2.0 / 3f64.sqrt();
    let speed = 10.0 * tau * (tau - (tau * tau - 1.0) * (1.0 / tau).atanh());
    near(report.bodies[0].velocity, speed * Vector3::y(), 1e-9);
}

/// In its own stream a held body feels what a moving one does in a fluid at rest.
#[test]
fn a_held_body_in_a_stream() {
    let case = |imposed: &str| {
        format!(
            "{imposed}[shapes.ball]\nkind = 'sphere'\nradius = 1.0\n[[bodies]]\nshape = 'ball'\n\
             [accuracy]\ntolerance = 1e-11\n[probes]\npoints = [[0.0, 2.0, 0.0]]\n"
        )
    };
    let report = report(&case(
        "background = { kind = 'uniform', velocity = [0.0, 0.0, 1.0] }\n",
    ));
    near(report.bodies[0].force, -6.0 * PI * Vector3::z(), 1e-10);
    near(
        report.probes[0].velocity,
        (1.0 - 13.0 / 32.0) * Vector3::z(),
        1e-11,
    );
}
