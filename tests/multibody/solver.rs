//! One solver for many questions: what it keeps, and where it starts.

use axistokes::suspension::{SolveError, SuspensionError};
use axistokes::{
    Accuracy, Answer, Body, Component, Frame, Motion, Options, Silent, Slip, Solver, Suspension,
    Wrench,
};
use nalgebra::{Point3, UnitQuaternion, Vector3};

use super::common::{direction, moving, pushed, random, spheroid, try_with};

fn uniform(panels: usize, order: usize, modes: usize, tolerance: f64) -> Options {
    Options::new(Accuracy::Uniform {
        panels,
        order,
        modes,
        tolerance,
    })
}

/// A swimmer whose slip looks different from all sides: its velocities turn with it, and never
/// jump.
#[test]
fn a_swimmer_turns_with_its_slip() {
    let slip = Slip::new(|x| {
        let e = Vector3::new(1.0 + x.y, x.z * x.x, 0.3 - x.x);
        e + Vector3::new((2.0 * x.y).sin(), x.z * x.z, x.x * x.y)
    });
    let swimmer = Body::free(&spheroid(1.0, 0.6)).with_slip(slip);
    let mut solver = Solver::new(uniform(4, 10, 8, 1e-14));
    let mut solve = |frame: Frame| {
        let body = Body {
            frame,
            ..swimmer.clone()
        };
        let answer = solver.solve(&Suspension::new([body])).expect("an answer");
        answer.bodies[0].motion
    };
    let first = solve(Frame::at(Point3::origin()));
    assert!(first.velocity.norm() > 0.1 && first.angular_velocity.norm() > 0.1);
    let mut rng = fastrand::Rng::with_seed(51);
    let mut frame = Frame::at(Point3::origin());
    let mut worst = 0.0f64;
    for step in 0..1000 {
        // About its own axis, then about others, through -z too.
        let rotation = match step / 250 {
            0 => 0.02 * *frame.axis(),
            1 => 0.02 * Vector3::x(),
            2 => 0.02 * Vector3::y(),
            _ => 0.05 * random(&mut rng),
        };
        frame = frame.moved(0.01 * random(&mut rng), rotation);
        let found = solve(frame);
        let turned = frame.orientation();
        let velocity = found.velocity - turned * first.velocity;
        let angular = found.angular_velocity - turned * first.angular_velocity;
        worst = worst.max(velocity.norm()).max(angular.norm());
    }
    println!("worst {worst:.1e}");
    assert!(worst <= 9e-15);
}

/// The same directions given as an axis and as a quaternion are the same rotation.
#[test]
fn an_axis_is_the_smallest_rotation() {
    let body = Body::held(&spheroid(1.0, 0.5));
    let axis = Vector3::new(0.3, -0.5, -0.8);
    let rotation = UnitQuaternion::rotation_between(&Vector3::z(), &axis).expect("a rotation");
    let [a, b] = [body.clone().along(axis), body.oriented(rotation)];
    assert!(a.frame.orientation().angle_to(&b.frame.orientation()) < 1e-7);
}

fn cube(side: usize) -> Suspension {
    let mut rng = fastrand::Rng::with_seed(61);
    let shapes = [spheroid(1.0, 0.5), spheroid(0.5, 1.0)];
    let bodies = (0..side.pow(3)).map(|k| {
        let cell = [k % side, k / side % side, k / side / side];
        let shape = shapes[cell.iter().sum::<usize>() % 2].clone();
        let center = Point3::from(cell.map(|i| 2.6 * i as f64));
        let motion = if k % 2 == 0 {
            moving(random(&mut rng), random(&mut rng))
        } else {
            pushed(10.0 * random(&mut rng), random(&mut rng))
        };
        Body::new(shape, Frame::along(center, direction(&mut rng))).with_motion(motion)
    });
    Suspension::new(bodies.collect::<Vec<_>>())
}

fn apart(a: &Answer, b: &Answer) -> f64 {
    let speed = b.largest_speed;
    let largest = (b.bodies.iter()).fold(0.0f64, |most, body| most.max(body.wrench.force.norm()));
    let both = a.bodies.iter().zip(&b.bodies);
    both.fold(0.0, |most, (a, b)| {
        let (wrench, motion) = (a.wrench - b.wrench, a.motion - b.motion);
        most.max(wrench.force.norm().max(wrench.torque.norm()) / largest)
            .max(motion.velocity.norm().max(motion.angular_velocity.norm()) / speed)
    })
}

/// A random walk answered with one solver, each answer starting the next, and by fresh solvers.
#[test]
fn earlier_answers_start_later_ones() {
    let tolerance = 1e-4;
    let mut suspension = cube(2);
    let mut rng = fastrand::Rng::with_seed(62);
    let mut solver = Solver::new(Options::tolerance(tolerance));
    let mut before = solver.solve(&suspension).expect("an answer");
    let (mut from_start, mut fresh_iterations) = (0, 0);
    for _ in 0..2 {
        for body in &mut suspension.bodies {
            body.frame = body
                .frame
                .moved(0.04 * random(&mut rng), 0.04 * random(&mut rng));
        }
        let found = solver.solve_from(&suspension, &before).expect("an answer");
        let fresh = try_with(&suspension, &Options::tolerance(tolerance)).expect("an answer");
        let error = apart(&found, &fresh);
        assert!(
            error <= found.error_estimate + fresh.error_estimate,
            "{error:e}"
        );
        from_start += found.statistics.iterations;
        fresh_iterations += fresh.statistics.iterations;
        assert_eq!(found.statistics.rounds, 1);
        before = found;
    }
    println!("{from_start} iterations from a start, {fresh_iterations} fresh");
    assert!(from_start < fresh_iterations);
}

/// Loads that are others ask for right-hand sides only: the same answer to the last bit as from a
/// fresh solver.
#[test]
fn loads_do_not_remember_each_other() {
    let options = uniform(3, 10, 8, 1e-6);
    let mut suspension = cube(2);
    let mut solver = Solver::new(options.clone());
    let solve = |solver: &mut Solver, suspension: &Suspension| {
        let answer = solver.solve_with(suspension, None, &Silent);
        answer.or_else(SolveError::answer).expect("an answer")
    };
    solve(&mut solver, &suspension);
    for body in &mut suspension.bodies {
        if let Motion::Free(wrench) = &mut body.motion {
            *wrench = Wrench::force(Vector3::z());
        }
    }
    let kept = solve(&mut solver, &suspension);
    let fresh = solve(&mut Solver::new(options), &suspension);
    let t = kept.statistics.timings;
    assert_eq!(apart(&kept, &fresh), 0.0);
    assert!(t.assemble + t.factor == 0.0, "{t:?}");
}

/// Forces and pressures are in proportion to the viscosity, the velocities of free bodies to its
/// inverse.
#[test]
fn viscosity_scales() {
    let mut thin = cube(2).with_probes([Point3::new(-2.0, 0.0, 1.0)]);
    let options = uniform(3, 10, 8, 1e-6);
    let one = try_with(&thin, &options).expect("an answer");
    thin.viscosity = 5.0;
    for body in &mut thin.bodies {
        if let Motion::Free(wrench) = &mut body.motion {
            wrench.force *= 5.0;
            wrench.torque *= 5.0;
        }
    }
    let five = try_with(&thin, &options).expect("an answer");
    let mut worst = 0.0f64;
    for (a, b) in one.bodies.iter().zip(&five.bodies) {
        worst = worst
            .max((5.0 * a.wrench.force - b.wrench.force).norm())
            .max((a.motion.velocity - b.motion.velocity).norm())
            .max((5.0 * a.stresslet - b.stresslet).norm());
    }
    worst = worst.max((5.0 * one.probes[0].pressure - five.probes[0].pressure).abs());
    // Seen: 1.5e-14.
    assert!(worst < 1e-13, "{worst:.1e}");
    let surface = five.surface(1).expect("a surface");
    let force: Vector3<f64> = surface
        .traction
        .iter()
        .zip(&surface.weights)
        .map(|(t, w)| *w * t)
        .sum();
    // Seen: 7.3e-7; the iteration ends at 1e-6.
    let missed = (force + five.bodies[1].wrench.force).norm() / force.norm();
    assert!(missed < 5e-6, "{missed:.1e}");
}

/// Lengths have no unit: a pair held near each other, the second free along one line and to turn,
/// at sizes where forces and torques differ by many powers of ten.
#[test]
fn lengths_scale() {
    let of = |size: f64| {
        let rod = spheroid(size, 0.75 * size);
        let free = Component::Free;
        let still = Component::Imposed(0.0);
        let line = [
            still,
            still,
            free(-size),
            free(0.0),
            free(size * size),
            free(0.0),
        ];
        let bodies = [
            Body::held(&rod).moving([0.0, 0.0, 1.0]),
            (Body::held(&rod).at([0.3 * size, 0.0, 2.1 * size]))
                .along([0.2, 0.0, 1.0])
                .with_motion(Motion::components(line)),
        ];
        let probes = [Point3::new(0.0, 0.0, -size)];
        let pair = Suspension::new(bodies).with_probes(probes);
        try_with(&pair, &Options::tolerance(1e-6)).expect("an answer")
    };
    let one = of(1.0);
    for size in [-66, 66].map(|exponent| f64::from(exponent).exp2()) {
        let other = of(size);
        for (a, b) in one.bodies.iter().zip(&other.bodies) {
            let force = (a.wrench.force - b.wrench.force / size).norm();
            let torque = (a.wrench.torque - b.wrench.torque / (size * size)).norm();
            let velocity = (a.motion.velocity - b.motion.velocity).norm();
            let turn = (a.motion.angular_velocity - size * b.motion.angular_velocity).norm();
            let worst = [force / 20.0, torque / 20.0, velocity, turn];
            // Seen: 2.2e-17.
            assert!(worst.iter().all(|&x| x < 2e-16), "{size:e}: {worst:?}");
        }
        let [a, b] = [&one, &other].map(|answer| answer.probes[0].velocity);
        // Seen: 7.3e-18.
        assert!((a - b).norm() < 7e-17, "{size:e}: {a} and {b}");
        let iterations = [&one, &other].map(|answer| answer.statistics.iterations);
        assert_eq!(iterations[0], iterations[1], "{size:e}");
    }
}

/// A body asked for many times has the stress that it has when asked for once, although so many
/// points would be summed fast; one that is not there is an error.
#[test]
fn stresses_of_any_bodies_may_be_asked_for() {
    let options = uniform(3, 10, 8, 1e-6);
    let stresses = |bodies: &[usize]| {
        let answer = try_with(&cube(2), &options).expect("an answer");
        let found = answer.flow.surface_stresses(bodies, &Silent);
        found.map(|found| found.into_iter().cloned().collect::<Vec<_>>())
    };
    let once = stresses(&[1]).expect("a stress");
    let often = stresses(&[1; 100]).expect("stresses");
    assert_eq!(often.len(), 100);
    assert!(often.iter().all(|stress| *stress == once[0]));
    let error = stresses(&[0, 8]).expect_err("there is no such body");
    assert!(
        matches!(error, SuspensionError::NoBody { body: 8, bodies: 8 }),
        "{error}"
    );
}
