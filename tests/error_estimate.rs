//! The error estimate against the true error: never below, at most a hundred times above.

use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::body::problem::{Answer, Problem, Resolution};
use axistokes::curve::{
    Biconcave, Capsule, GeneratingCurve, Outline, Panels, Polar, Spheroid, Torus,
};
use axistokes::kernel::Stokeslet;
use axistokes::progress::Silent;
use fastrand::Rng;
use nalgebra::{Point3, Vector3};

fn uniform(rng: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * rng.f64()
}

fn random_curve(rng: &mut Rng) -> Arc<dyn GeneratingCurve> {
    match rng.usize(0..5) {
        0 => Arc::new(Spheroid::new(1.0, uniform(rng, 0.3, 3.0)).expect("a spheroid")),
        1 => Arc::new(Capsule::new(1.0, uniform(rng, 0.5, 3.0)).expect("a capsule")),
        2 => Arc::new(Torus::new(1.0, uniform(rng, 0.2, 0.7)).expect("a torus")),
        3 => Arc::new(Biconcave::new(1.0).expect("a red cell")),
        _ => {
            let c = [1.0, uniform(rng, -0.2, 0.2), uniform(rng, -0.2, 0.2)];
            Arc::new(Polar::new(&c).expect("a polar curve"))
        }
    }
}

/// A random point of the curve moved by `offset` along its normal and turned about the axis.
fn beside(rng: &mut Rng, curve: &dyn GeneratingCurve, offset: f64) -> Vector3<f64> {
    let ends = curve.breakpoints();
    let s = uniform(rng, ends[0], ends[ends.len() - 1]);
    let (point, tangent) = (curve.point(s), curve.tangent(s));
    let speed = tangent.r.hypot(tangent.z);
    let r = point.r - offset * tangent.z / speed;
    let (sin, cos) = uniform(rng, 0.0, 2.0 * PI).sin_cos();
    Vector3::new(r * cos, r * sin, point.z + offset * tangent.r / speed)
}

/// The true error of an answer whose flow is known, in the units of its estimate.
fn true_error(
    answer: &Answer,
    stokeslets: &[Stokeslet],
    targets: &[Point3<f64>],
    size: f64,
) -> f64 {
    let velocity = |x: Vector3<f64>| {
        stokeslets
            .iter()
            .map(|s| s.velocity(x))
            .sum::<Vector3<f64>>()
    };
    let errors = targets
        .iter()
        .zip(&answer.flow)
        .map(|(x, f)| (f.velocity - velocity(x.coords)).norm());
    let force: Vector3<f64> = stokeslets.iter().map(|s| s.force).sum();
    let torque: Vector3<f64> = stokeslets.iter().map(|s| s.at.cross(&s.force)).sum();
    let scale = force.norm().max(torque.norm() / size);
    let wrench = (answer.wrench.force - force)
        .norm()
        .max((answer.wrench.torque - torque).norm() / size);
    (errors.fold(0.0, f64::max) / answer.largest_speed).max(wrench / scale)
}

#[test]
fn bounds_the_true_error_tightly_in_fifty_random_cases() {
    let mut rng = Rng::with_seed(1);
    let (mut least, mut most) = (f64::INFINITY, 0.0f64);
    let mut failures = Vec::new();
    for case in 0..50 {
        let curve = random_curve(&mut rng);
        let depth = uniform(&mut rng, 0.15, 0.3);
        let outline = Outline::new(&*curve).expect("an outline");
        let mut stokeslets = Vec::new();
        while stokeslets.len() < 3 {
            let at = beside(&mut rng, &*curve, -depth);
            let meridian = axistokes::curve::Meridian {
                r: at.x.hypot(at.y),
                z: at.z,
            };
            if outline.contains(meridian) && outline.distance(meridian) > 0.8 * depth {
                let force = Vector3::from_fn(|_, _| uniform(&mut rng, -1.0, 1.0));
                stokeslets.push(Stokeslet { at, force });
            }
        }
        let mut targets = Vec::new();
        while targets.len() < 10 {
            let distance = uniform(&mut rng, 0.2, 2.0);
            let x = beside(&mut rng, &*curve, distance);
            let meridian = axistokes::curve::Meridian {
                r: x.x.hypot(x.y),
                z: x.z,
            };
            if !outline.contains(meridian) && outline.distance(meridian) > 0.15 {
                targets.push(Point3::from(x));
            }
        }
        let field = |x: Vector3<f64>| stokeslets.iter().map(|s| s.velocity(x)).sum();
        let problem = Problem {
            slip: Some(&field),
            targets: &targets,
            ..Problem::new(curve.clone())
        };
        let (answer, asked) = if rng.bool() {
            let tolerance = 10f64.powf(uniform(&mut rng, -9.0, -3.0));
            (
                problem.to_tolerance(tolerance, &Silent).expect("an answer"),
                format!("{tolerance:.1e}"),
            )
        } else {
            let order = [10, 16][rng.usize(0..2)];
            let resolution = Resolution {
                panels: Panels::equal_arcs(&*curve, rng.usize(4..14)).expect("panels"),
                order,
                modes: rng.usize(8..60),
            };
            (
                problem
                    .at_resolution(resolution, &Silent)
                    .expect("an answer"),
                "by hand".into(),
            )
        };
        let size = outline
            .corners()
            .iter()
            .map(|c| c.r.hypot(c.z))
            .fold(0.0, f64::max);
        let truth = true_error(&answer, &stokeslets, &targets, size);
        let ratio = answer.error_estimate / truth;
        least = least.min(ratio);
        most = most.max(ratio);
        println!(
            "{case} {asked}: estimate {:.2e}, error {truth:.2e}, ratio {ratio:.2}; {} panels x {}, {} modes, {:.2} s; {curve:?}",
            answer.error_estimate,
            answer.resolution.panels.len(),
            answer.resolution.order,
            answer.resolution.modes,
            answer.timings.estimate,
        );
        if !(1.0..=100.0).contains(&ratio) {
            failures.push(case);
        }
    }
    println!("estimate / error from {least:.2} to {most:.2}");
    assert!(failures.is_empty(), "cases {failures:?}");
}
