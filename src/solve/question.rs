//! What a case asks, in the library's terms.

use std::collections::BTreeMap;

use nalgebra::{Matrix3, Point3, Quaternion, Unit, UnitQuaternion, Vector3};

use crate::case::{
    self, Accuracy, Background, BodyOrientation, Case, CaseError, Formulation, Method,
};
use bodies_of_revolution::{Frame, Insides, RigidMotion, Shape};
use stokes_body::dirichlet;
use stokes_body::kernel::Stokeslet;
use stokes_body::linear_flow::LinearFlow;
use stokes_suspension::{self as suspension, Body, Component, Motion, Options, Slip, Suspension};

/// A case, ready to be solved.
pub(super) struct Question {
    pub suspension: Suspension,
    pub options: Options,
}

impl Question {
    /// Builds the shapes and checks that the probes are outside of all bodies and the Stokeslets
    /// inside of some.
    pub fn new(case: &Case) -> Result<Self, CaseError> {
        let mut shapes: BTreeMap<&str, Shape> = BTreeMap::new();
        let mut bodies = Vec::with_capacity(case.bodies.len());
        for body in &case.bodies {
            let shape = match shapes.get(&*body.shape) {
                Some(shape) => shape.clone(),
                None => {
                    let curve = case.shape_of(body).value.curve();
                    let shape = curve.map_err(|error| at_shape(case, body, &error))?;
                    shapes.insert(&body.shape, shape.clone());
                    shape
                }
            };
            let frame = frame(body);
            bodies.push(Body {
                shape,
                frame,
                motion: motion(case, body),
                slip: slip(case, body, frame),
            });
        }
        let question = Self {
            suspension: Suspension {
                bodies,
                background: background(case),
                viscosity: case.viscosity,
                probes: case.probes.iter().map(|probe| probe.value.into()).collect(),
            },
            options: options(case),
        };
        question.check_points(case)?;
        Ok(question)
    }

    fn check_points(&self, case: &Case) -> Result<(), CaseError> {
        let bodies = self.suspension.bodies.iter();
        let insides = Insides::new(bodies.map(|body| (&body.shape, body.frame)))
            .map_err(|(body, error)| at_shape(case, &case.bodies[body], &error))?;
        let one = case.bodies.len() == 1;
        for (number, probe) in (1..).zip(&case.probes) {
            if let Some(body) = insides.body_at(probe.value.into()) {
                let name = if one {
                    "the body".into()
                } else {
                    name(case, body)
                };
                let message = format!(
                    "probes.points: point {number}, {:?}, lies inside {name}: expected a point in the fluid",
                    probe.value
                );
                return Err(case.error(probe.line, message));
            }
        }
        for stokeslet in case.test.iter().flat_map(|test| &test.stokeslets) {
            if insides.body_at(stokeslet.at.into()).is_none() {
                let (outside, inside) = match one {
                    true => ("the body", "inside"),
                    false => ("all bodies", "inside one"),
                };
                let message = format!(
                    "test.stokeslets: at = {:?} lies outside {outside}: expected a point {inside}",
                    stokeslet.at
                );
                return Err(case.error(stokeslet.line, message));
            }
        }
        Ok(())
    }
}

/// How messages call a body: its number, from 1, and its shape.
pub(super) fn name(case: &Case, body: usize) -> String {
    format!("body {} (`{}`)", body + 1, case.bodies[body].shape)
}

/// An error of a body's generating curve.
pub(super) fn at_shape(case: &Case, body: &case::Body, error: &dyn std::fmt::Display) -> CaseError {
    let line = case.shape_of(body).line;
    case.error(line, format!("shapes.{}: {error}", body.shape))
}

fn motion(case: &Case, body: &case::Body) -> Motion {
    // The known flow takes the place of all that is imposed.
    if case.test.is_some() {
        return Motion::Given(RigidMotion::rest());
    }
    Motion::components(body.components.map(|component| match component {
        case::Component::Imposed(value) => Component::Imposed(value),
        case::Component::Free(value) => Component::Free(value),
    }))
}

/// Where a body is.
fn frame(body: &case::Body) -> Frame {
    let center = body.center.into();
    let frame = match body.orientation {
        BodyOrientation::Axis(axis) => Frame::along(center, Unit::new_normalize(axis.into())),
        BodyOrientation::Quaternion([w, x, y, z]) => {
            let rotation = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z));
            Frame::new(center, rotation)
        }
    };
    frame.scaled(body.scale)
}

/// The slip of a body, or the known flow in its place; in the body's frame.
fn slip(case: &Case, body: &case::Body, frame: Frame) -> Option<Slip> {
    if case.test.is_some() {
        let known = known_flow(case, &frame);
        let velocity = move |x: Vector3<f64>| known.iter().map(|s| s.velocity(x)).sum();
        return Some(Slip::new(velocity));
    }
    Some(match &body.slip.as_ref()?.value {
        case::Slip::Squirmer { b } => Slip::squirmer(b.clone()),
        &case::Slip::PoleToPole {
            polar,
            equatorial,
            speed,
        } => Slip::pole_to_pole(polar, equatorial, speed),
    })
}

/// The Stokeslets of `[test]` in a body's frame, as strong as they are there at viscosity 1.
fn known_flow(case: &Case, frame: &Frame) -> Vec<Stokeslet> {
    let stokeslets = case.test.iter().flat_map(|test| &test.stokeslets);
    let in_frame = stokeslets.map(|s| Stokeslet {
        at: frame.point_to_body(s.at.into()).coords,
        force: frame.vector_to_body(s.force.into()) / (case.viscosity * frame.scale()),
    });
    in_frame.collect()
}

/// The velocity of the known flow at a point of the laboratory.
pub(super) fn known_velocity(case: &Case, point: Point3<f64>) -> Vector3<f64> {
    let known = known_flow(case, &Frame::at(Point3::origin()));
    known.iter().map(|s| s.velocity(point.coords)).sum()
}

/// The undisturbed flow.
fn background(case: &Case) -> LinearFlow {
    match case.background.as_deref() {
        None => LinearFlow::rest(),
        Some(&Background::Uniform { velocity }) => LinearFlow::uniform(velocity.into()),
        Some(&Background::Shear {
            rate,
            flow,
            gradient,
        }) => LinearFlow::shear(rate, flow.into(), gradient.into()),
        Some(&Background::Linear { gradient }) => LinearFlow {
            gradient: Matrix3::from_fn(|i, j| gradient[i][j]),
            ..LinearFlow::rest()
        },
    }
}

/// How the case wants it solved.
pub(crate) fn options(case: &Case) -> Options {
    let accuracy = match case.accuracy {
        Accuracy::Tolerance(tolerance) => suspension::Accuracy::Tolerance(tolerance),
        Accuracy::ByHand {
            panels,
            order,
            modes,
        } => suspension::Accuracy::Uniform {
            panels,
            order,
            modes,
            tolerance: case
                .tolerance_by_hand
                .unwrap_or(suspension::Accuracy::BY_HAND),
        },
    };
    let mut options = Options::new(accuracy);
    options.formulation = match case.solver.formulation {
        Formulation::SingleLayer => dirichlet::Formulation::SingleLayer,
        Formulation::Combined => dirichlet::Formulation::CombinedField,
    };
    if case.solver.method == Method::BiCgStab {
        options.method = suspension::Method::BiCgStab;
    }
    options.max_iterations = case.solver.max_iterations;
    options.residual = case.solver.tolerance;
    let bytes = |gib: f64| (gib * f64::from(1 << 30)) as usize;
    options.memory = case.solver.memory.map(bytes);
    options
}
