//! The error estimate against the true error: never below, at most a hundred times above.

use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::body::Stokeslet;
use axistokes::geometry::Outline;
use axistokes::nalgebra::{Matrix3, Point3, Vector3};
use axistokes::{
    Answer, Biconcave, Body, Capsule, GeneratingCurve, LinearFlow, Meridian, Motion, Options,
    Panels, Polar, Resolution, RigidMotion, Silent, Slip, Spheroid, Suspension, Torus, Wrench,
};
use fastrand::Rng;

use super::ask::{given, try_with};

fn uniform(rng: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * rng.f64()
}

fn random_vector(rng: &mut Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| uniform(rng, -1.0, 1.0))
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

/// A flow of Stokeslets inside a body that is wanted at targets outside.
#[derive(Clone)]
struct KnownFlow {
    curve: Arc<dyn GeneratingCurve>,
    stokeslets: Vec<Stokeslet>,
    targets: Vec<Point3<f64>>,
    /// Half the body's largest extent.
    size: f64,
}

impl KnownFlow {
    fn random(rng: &mut Rng) -> Self {
        let curve = random_curve(rng);
        let mut depth = uniform(rng, 0.15, 0.3);
        let outline = Outline::new(&*curve).expect("an outline");
        let meridian = |x: Vector3<f64>| Meridian {
            r: x.x.hypot(x.y),
            z: x.z,
        };
        let mut stokeslets = Vec::new();
        while stokeslets.len() < 3 {
            let at = beside(rng, &*curve, -depth);
            // A ring may be too thin for the depth.
            depth *= 0.99;
            if outline.contains(meridian(at)) && outline.distance(meridian(at)) > 0.8 * depth {
                let force = random_vector(rng);
                stokeslets.push(Stokeslet { at, force });
            }
        }
        let mut targets = Vec::new();
        while targets.len() < 10 {
            let distance = uniform(rng, 0.2, 2.0);
            let x = beside(rng, &*curve, distance);
            if !outline.contains(meridian(x)) && outline.distance(meridian(x)) > 0.15 {
                targets.push(Point3::from(x));
            }
        }
        let corners = outline.corners().iter();
        let size = corners.map(|c| c.r.hypot(c.z)).fold(0.0, f64::max);
        Self {
            curve: curve.clone(),
            stokeslets,
            targets,
            size,
        }
    }

    fn velocity(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.stokeslets.iter().map(|s| s.velocity(x)).sum()
    }

    fn wrench(&self) -> Wrench {
        Wrench {
            force: self.stokeslets.iter().map(|s| s.force).sum(),
            torque: self.stokeslets.iter().map(|s| s.at.cross(&s.force)).sum(),
        }
    }
}

/// The answer at a random tolerance, or to a random resolution.
fn answer(asked: &Suspension, rng: &mut Rng) -> (Answer, String) {
    if rng.bool() {
        let tolerance = 10f64.powf(uniform(rng, -9.0, -3.0));
        let answer = try_with(asked, &Options::tolerance(tolerance));
        (answer.expect("an answer"), format!("{tolerance:.1e}"))
    } else {
        let order = [10, 16][rng.usize(0..2)];
        let resolution = Resolution {
            panels: Panels::equal_arcs(&*asked.bodies[0].shape, rng.usize(4..14)).expect("panels"),
            order,
            modes: rng.usize(8..60),
        };
        let answer = try_with(asked, &given(&[Arc::new(resolution)], 1e-14));
        (answer.expect("an answer"), "by hand".into())
    }
}

/// The largest error of the velocities at targets, in the units of the estimate.
fn error_of_flow(
    answer: &Answer,
    targets: &[Point3<f64>],
    exact: impl Fn(Vector3<f64>) -> Vector3<f64>,
) -> f64 {
    let errors = targets
        .iter()
        .zip(&answer.probes)
        .map(|(x, f)| (f.velocity - exact(x.coords)).norm());
    errors.fold(0.0, f64::max) / answer.largest_speed
}

/// The error of the rigid motion, in the units of the estimate.
fn error_of_motion(answer: &Answer, exact: RigidMotion, size: f64) -> f64 {
    let in_velocity = |motion: RigidMotion| {
        motion
            .velocity
            .norm()
            .max(size * motion.angular_velocity.norm())
    };
    in_velocity(answer.bodies[0].motion - exact)
        / in_velocity(exact).max(1e-2 * answer.largest_speed)
}

/// How estimates compare with errors, case by case.
struct Ratios {
    least: f64,
    most: f64,
    failures: Vec<usize>,
}

impl Ratios {
    fn new() -> Self {
        Self {
            least: f64::INFINITY,
            most: 0.0,
            failures: Vec::new(),
        }
    }

    fn compare(&mut self, case: usize, asked: &str, answer: &Answer, truth: f64) {
        let ratio = answer.error_estimate / truth;
        self.least = self.least.min(ratio);
        self.most = self.most.max(ratio);
        println!(
            "{case} {asked}: estimate {:.2e}, error {truth:.2e}, ratio {ratio:.2}; {} panels x {}, {} modes, {:.2} s; {:?}",
            answer.error_estimate,
            answer.bodies[0].resolution.panels.len(),
            answer.bodies[0].resolution.order,
            answer.bodies[0].resolution.modes,
            answer.statistics.timings.estimate,
            answer.flow.bodies()[0].shape(),
        );
        if !(1.0..=100.0).contains(&ratio) {
            self.failures.push(case);
        }
    }

    fn check(self) {
        println!(
            "estimate / error from {:.2} to {:.2}",
            self.least, self.most
        );
        assert!(self.failures.is_empty(), "cases {:?}", self.failures);
    }
}

#[test]
fn bounds_the_true_error_tightly_in_fifty_random_cases() {
    let mut rng = Rng::with_seed(1);
    let mut ratios = Ratios::new();
    for case in 0..50 {
        let known = KnownFlow::random(&mut rng);
        let field = |x: Vector3<f64>| known.velocity(x);
        let of_slip = known.clone();
        let slip = Slip::new(move |x| of_slip.velocity(x));
        let body = Body::held(&known.curve).with_slip(slip);
        let suspension = Suspension::new([body]).with_probes(known.targets.clone());
        let (answer, asked) = answer(&suspension, &mut rng);
        let wrench = known.wrench();
        let in_force = |w: Wrench| w.force.norm().max(w.torque.norm() / known.size);
        let of_wrench = in_force(answer.bodies[0].wrench - wrench) / in_force(wrench);
        let truth = error_of_flow(&answer, &known.targets, field).max(of_wrench);
        ratios.compare(case, &asked, &answer, truth);
    }
    ratios.check();
}

/// A free body whose slip is a known flow in a linear one, less a rigid motion, moves with that
/// rigid motion.
#[test]
fn bounds_the_true_error_of_free_bodies_too() {
    let mut rng = Rng::with_seed(3);
    let mut ratios = Ratios::new();
    for case in 0..40 {
        let known = KnownFlow::random(&mut rng);
        let motion = RigidMotion {
            velocity: 0.3 * random_vector(&mut rng),
            angular_velocity: 0.3 * random_vector(&mut rng),
        };
        let gradient = 0.3 * Matrix3::from_columns(&[(); 3].map(|()| random_vector(&mut rng)));
        let background = LinearFlow {
            velocity: 0.3 * random_vector(&mut rng),
            gradient: gradient - Matrix3::from_diagonal_element(gradient.trace() / 3.0),
        };
        let whole = |x: Vector3<f64>| known.velocity(x) + background.at(x);
        let of_slip = known.clone();
        let slip = Slip::new(move |x| of_slip.velocity(x) + background.at(x) - motion.at(x));
        let body = Body::free(&known.curve)
            .with_motion(Motion::Free(known.wrench()))
            .with_slip(slip);
        let suspension = Suspension::new([body])
            .in_flow(background)
            .with_probes(known.targets.clone());
        let (answer, asked) = answer(&suspension, &mut rng);
        let truth = error_of_flow(&answer, &known.targets, whole)
            .max(error_of_motion(&answer, motion, known.size));
        ratios.compare(case, &asked, &answer, truth);
    }
    ratios.check();
}

/// Free spheroids in shear, on coarse panels: the error is that of the angular velocity (Jeffery
/// 1922).
#[test]
fn bounds_the_true_error_in_shear() {
    let mut rng = Rng::with_seed(4);
    for case in 0..20 {
        let aspect = 10f64.powf(uniform(&mut rng, -0.7, 0.7));
        let axes = if aspect > 1.0 {
            [1.0, 1.0 / aspect]
        } else {
            [aspect, 1.0]
        };
        let curve = Spheroid::new(axes[0], axes[1]).expect("a spheroid").shape();
        let [flow, other] = [(); 2].map(|()| random_vector(&mut rng).normalize());
        let background = LinearFlow::shear(1.0, flow, flow.cross(&other).normalize());
        let resolution = Resolution {
            panels: Panels::equal_arcs(&*curve, rng.usize(2..5)).expect("panels"),
            order: 10,
            modes: 2,
        };
        let suspension = Suspension::new([Body::free(&curve)]).in_flow(background);
        let answer = try_with(&suspension, &given(&[Arc::new(resolution)], 1e-14));
        let answer = answer.expect("an answer");
        let lambda = (aspect * aspect - 1.0) / (aspect * aspect + 1.0);
        let axis = Vector3::z();
        let turning = axis.cross(&(background.strain_rate() * axis));
        let exact = RigidMotion {
            velocity: Vector3::zeros(),
            angular_velocity: background.angular_velocity() + lambda * turning,
        };
        let truth = error_of_motion(&answer, exact, 1.0);
        // The density is a polynomial: coarse panels do, and what is left is rounding, as the
        // estimate must see.
        let estimate = answer.error_estimate;
        println!("{case}: estimate {estimate:.1e}, error {truth:.1e}");
        assert!(truth <= estimate && estimate <= 1e-12);
    }
}

/// A squirmer's flow in closed form (Blake 1971): $p = -2 b_2 P_2(\cos\theta)/r^3$ and the
/// stresslet $4\pi b_2 (e e - I/3)$, with coarse panels.
#[test]
fn pressures_and_stresslets_are_within_their_estimates() {
    let slip = Slip::squirmer([1.5, 3.0]);
    let targets: Vec<Point3<f64>> = (0..40)
        .map(|k| {
            let theta = 0.08 * f64::from(k);
            let r = 1.0 + 10f64.powf(-0.15 * f64::from(k));
            Point3::new(r * theta.sin(), 0.0, r * theta.cos())
        })
        .collect();
    for panels in [1, 2, 3, 4] {
        let sphere = Spheroid::sphere(1.0).expect("a sphere").shape();
        let resolution = Resolution {
            panels: Panels::equal_arcs(&*sphere, panels).expect("panels"),
            order: 10,
            modes: 1,
        };
        let swimmer = Body::free(&sphere).with_slip(slip.clone());
        let suspension = Suspension::new([swimmer]).with_probes(targets.clone());
        let answer = try_with(&suspension, &given(&[Arc::new(resolution)], 1e-14));
        let answer = answer.expect("an answer");
        let pressure = (targets.iter().zip(&answer.probes))
            .map(|(x, at)| {
                let r = x.coords.norm();
                let p2 = 1.5 * (x.z / r).powi(2) - 0.5;
                (at.pressure + 6.0 * p2 / r.powi(3)).abs()
            })
            .fold(0.0, f64::max);
        let e = Vector3::z();
        let exact = (e * e.transpose() - Matrix3::identity() / 3.0) * 12.0 * PI;
        let stresslet = (answer.bodies[0].stresslet - exact).norm();
        let of_pressure = answer.pressure_error(&targets);
        let of_stresslet = answer.stresslet_error(0).expect("an estimate");
        println!(
            "{panels} panels: pressure {pressure:.1e} of {:.1e}, stresslet {stresslet:.1e} of {:.1e}",
            of_pressure, of_stresslet
        );
        assert!(pressure <= of_pressure && of_pressure <= 100.0 * pressure);
        assert!(stresslet <= of_stresslet);
        // 8 pi (2 b1^2 + b2^2)/3.
        let power = (answer.flow.powers(&Silent).expect("a power")[0] - 36.0 * PI).abs();
        let estimate =
            answer.power_errors(&Silent).expect("an estimate")[0].expect("of a body alone");
        println!("    power {power:.1e} of {estimate:.1e}");
        assert!(power <= estimate);
    }
}
