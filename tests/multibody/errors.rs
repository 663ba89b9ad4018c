//! What cannot be answered is refused with an error that says why.

use axistokes::body::flow::FlowError;
use axistokes::body::linear_flow::LinearFlow;
use axistokes::geometry::ContactError;
use axistokes::suspension::SolveError;
use axistokes::{
    Answer, Body, Frame, Motion, Options, Progress, Silent, Slip, Solver, Suspension,
    SuspensionError, Wrench,
};
use nalgebra::{Point3, Unit, Vector3};

use super::common::{answer, at, ball, given, moving, spheroid, try_with};

fn pair(distance: f64) -> Suspension {
    Suspension::new(
        [0.0, distance]
            .map(|z| Body::new(ball(), at(0.0, 0.0, z)))
            .to_vec(),
    )
}

/// The error and its message.
fn refused(result: Result<Answer, SuspensionError>) -> (SuspensionError, String) {
    let Err(error) = result else {
        panic!("an answer instead of an error");
    };
    let message = error.to_string();
    println!("{message}");
    (error, message)
}

fn of(suspension: &Suspension) -> (SuspensionError, String) {
    refused(try_with(suspension, &Options::tolerance(1e-6)))
}

#[test]
fn no_bodies() {
    let (error, _) = of(&Suspension::new(Vec::new()));
    assert!(matches!(error, SuspensionError::Empty));
    let none = Suspension::new(Vec::new());
    assert!(matches!(
        Solver::new(Options::tolerance(1e-6)).grand_mobility(&none, &Silent),
        Err(SuspensionError::Empty)
    ));
    assert!(matches!(
        try_with(&none, &given(&[], 1e-6)),
        Err(SuspensionError::Empty)
    ));
}

#[test]
fn places() {
    let (error, _) = of(&pair(1.5));
    assert!(matches!(
        error,
        SuspensionError::Contact(ContactError::Overlap {
            first: 0,
            second: 1,
            ..
        })
    ));
    let (error, _) = of(&pair(2.0));
    assert!(matches!(
        error,
        SuspensionError::Contact(ContactError::Touch {
            first: 0,
            second: 1
        })
    ));
    let mut inside = pair(0.1);
    inside.bodies[1].frame = inside.bodies[1].frame.scaled(0.2);
    let (error, _) = of(&inside);
    assert!(matches!(
        error,
        SuspensionError::Contact(ContactError::Inside { inner: 1, outer: 0 })
    ));
    for (frame, _what) in [
        (at(0.0, f64::NAN, 5.0), "center"),
        (at(0.0, f64::INFINITY, 5.0), "center"),
        (at(0.0, 0.0, 5.0).scaled(-1.0), "scale"),
        (at(0.0, 0.0, 5.0).scaled(f64::NAN), "scale"),
        (
            Frame::along(
                Point3::new(0.0, 0.0, 5.0),
                Unit::new_unchecked(Vector3::repeat(f64::NAN)),
            ),
            "axis",
        ),
    ] {
        let mut wrong = pair(3.0);
        wrong.bodies[1].frame = frame;
        let (error, _) = of(&wrong);
        assert!(matches!(
            error,
            SuspensionError::Contact(ContactError::Place { body: 1, .. })
        ));
    }
}

#[test]
fn velocities_that_are_not_finite() {
    let nan = Vector3::new(0.0, f64::NAN, 0.0);
    let rest = Vector3::zeros();
    let slip = Slip::new(move |x| if x.z > 0.9 { nan } else { Vector3::x() });
    let mut wrong = pair(3.0);
    wrong.bodies[1].slip = Some(slip);
    let (error, _) = of(&wrong);
    assert!(matches!(error, SuspensionError::Velocity { body: 1 }));
    for motion in [
        moving(nan, rest),
        moving(rest, nan),
        moving(f64::INFINITY * Vector3::x(), rest),
    ] {
        let mut wrong = pair(3.0);
        wrong.bodies[1].motion = motion;
        let (error, _) = of(&wrong);
        assert!(matches!(error, SuspensionError::Motion { body: 1, .. }));
    }
    let mut wrong = pair(3.0);
    wrong.background = LinearFlow::uniform(nan);
    let (error, _) = of(&wrong);
    assert!(matches!(error, SuspensionError::Background));
}

#[test]
fn forces_that_are_not_finite() {
    for wrench in [
        Wrench {
            force: f64::NAN * Vector3::x(),
            torque: Vector3::zeros(),
        },
        Wrench {
            force: Vector3::zeros(),
            torque: f64::INFINITY * Vector3::x(),
        },
    ] {
        let mut wrong = pair(3.0);
        wrong.bodies[1].motion = Motion::Free(wrench);
        let (error, message) = of(&wrong);
        assert!(matches!(error, SuspensionError::Motion { body: 1, .. }));
        assert!(message.starts_with("motion, force and torque of bodies[1] must be finite, got "));
    }
}

#[test]
fn targets_that_are_not_finite() {
    let probes = [Point3::new(0.0, 0.0, 10.0), Point3::new(0.0, f64::NAN, 0.0)];
    let wrong = pair(3.0).with_probes(probes);
    let (error, _) = of(&wrong);
    assert!(matches!(
        error,
        SuspensionError::Flow(FlowError::Target { index: 1, value }) if value.is_nan()
    ));
}

#[test]
fn tolerances_of_flows_out_of_range() {
    let answer = Solver::new(Options::tolerance(1e-3))
        .solve(&pair(3.0))
        .expect("an answer");
    let at = [Point3::new(0.0, 0.0, 10.0)];
    for tolerance in [0.0, -1.0, 1.0, f64::NAN, f64::INFINITY] {
        let found = answer.flow.at_with(&at, tolerance, &Silent);
        assert!(matches!(found, Err(SuspensionError::FlowTolerance(_))));
    }
}

#[test]
fn memory() {
    let mut options = Options::tolerance(1e-6);
    options.memory = Some(1000);
    let (error, _) = refused(try_with(&pair(3.0), &options));
    assert!(matches!(error, SuspensionError::Memory { .. }));
}

fn moved() -> Suspension {
    let mut pair = pair(2.5);
    pair.bodies[0].motion = moving(Vector3::new(1.0, 2.0, 3.0), Vector3::x());
    pair.bodies[1].shape = spheroid(1.0, 0.6);
    pair.bodies[1].frame = Frame::along(
        Point3::new(0.0, 0.3, 2.5),
        Unit::new_normalize(Vector3::new(1.0, 2.0, 0.5)),
    );
    pair
}

#[test]
fn iterations_that_end_too_soon() {
    let mut options = Options::tolerance(1e-6);
    let refused_with = |options: &Options| refused(try_with(&moved(), options));
    options.max_iterations = 2;
    let (error, _) = refused_with(&options);
    assert!(matches!(
        error,
        SuspensionError::NotConverged { iterations: 2, .. }
    ));
    options.max_iterations = 0;
    refused_with(&options);
    options.max_iterations = 100;
    options.method = axistokes::krylov::Method::Gmres { restart: 0 };
    refused_with(&options);
}

#[test]
fn tolerances_out_of_range() {
    for tolerance in [0.0, -1.0, f64::NAN] {
        refused(try_with(&moved(), &Options::tolerance(tolerance)));
    }
}

#[test]
fn resolutions_that_are_too_few() {
    let pair = moved();
    let answer = answer(&pair, 1e-3);
    let one = std::sync::Arc::new(answer.bodies[0].resolution.clone());
    let (_error, _) = refused(try_with(&pair, &given(&[one], 1e-3)));
}

/// It is no equation for the fluid outside.
#[test]
fn an_interior_formulation() {
    let mut options = Options::tolerance(1e-3);
    options.formulation = axistokes::body::dirichlet::Formulation::InteriorDoubleLayer;
    let (error, _) = refused(try_with(&moved(), &options));
    assert!(matches!(error, SuspensionError::Interior));
}

/// Has lost interest from a stage on.
struct Impatient(&'static str, std::sync::atomic::AtomicBool);

impl Progress for Impatient {
    fn begin(&self, stage: &'static str, _steps: usize) {
        if stage == self.0 {
            self.1.store(true, std::sync::atomic::Ordering::Relaxed);
        }
    }

    fn advance(&self, _steps: usize) {}

    fn is_cancelled(&self) -> bool {
        self.1.load(std::sync::atomic::Ordering::Relaxed)
    }
}

#[test]
fn interruptions() {
    let pair = moved().with_probes([Point3::new(0.0, 0.0, 10.0)]);
    for stage in ["gaps", "near points", "iterating", "checking", "evaluating"] {
        let impatient = Impatient(stage, false.into());
        let mut solver = Solver::new(Options::tolerance(1e-6));
        let found = solver.solve_with(&pair, None, &impatient);
        let (error, _) = refused(found.or_else(SolveError::answer));
        assert!(matches!(error, SuspensionError::Interrupted), "{stage}");
    }
}

/// An answer that misses its tolerance is an error, with the answer inside.
#[test]
fn tolerances_that_are_missed() {
    let mut options = Options::tolerance(1e-9);
    options.residual = Some(1e-4);
    let missed = Solver::new(options).solve(&moved());
    let Err(SolveError::Missed { answer, tolerance }) = missed else {
        panic!("a residual of 1e-4 was good enough");
    };
    assert!(answer.error_estimate > tolerance && tolerance == 1e-9);
}

#[test]
fn a_surface_that_is_not_there() {
    let answer = answer(&pair(3.0), 1e-3);
    assert!(matches!(
        answer.surface(2),
        Err(SuspensionError::NoBody { body: 2, bodies: 2 })
    ));
}
