//! The bodies of a case in their places, and the parts of its report that do not depend on how it
//! is solved.

use std::collections::BTreeMap;
use std::sync::Arc;

use nalgebra::{Matrix3, Point3, Unit, Vector3};

use crate::case::{self, Background, Case, CaseError, Slip};
use crate::output::{BodyReport, Discretization, KnownFlowReport, ProbeReport};
use bodies_of_revolution::Frame;
use bodies_of_revolution::GeneratingCurve;
use bodies_of_revolution::Insides;
use bodies_of_revolution::{RigidMotion, Wrench};
use stokes_body::kernel::{FlowAt, Stokeslet};
use stokes_body::linear_flow::LinearFlow;
use stokes_body::problem::{Motion, Resolution};
use stokes_body::slip::{pole_to_pole, squirmer};

/// A velocity as a function of the point.
pub(super) type Velocity<'a> = dyn Fn(Vector3<f64>) -> Vector3<f64> + Sync + 'a;

/// A case, ready to be computed with.
pub(super) struct Setting<'a> {
    pub case: &'a Case,
    pub bodies: Vec<Placed<'a>>,
    pub probes: Vec<Point3<f64>>,
}

/// A body in its place.
pub(super) struct Placed<'a> {
    pub body: &'a case::Body,
    pub frame: Frame,
    /// Shared with the bodies of the same shape.
    pub curve: Arc<dyn GeneratingCurve>,
    /// The slip, or whatever is imposed instead of motion and slip; in the body's frame.
    pub slip: Option<Box<Velocity<'a>>>,
}

/// What became of a body, in the laboratory and for viscosity 1.
pub(super) struct Found {
    pub motion: RigidMotion,
    pub wrench: Wrench,
    pub stresslet: Matrix3<f64>,
    pub stresslet_error: f64,
    pub power: Option<f64>,
    pub power_error: Option<f64>,
}

impl<'a> Setting<'a> {
    /// Builds the curves and checks that the probes are outside of all bodies and the Stokeslets
    /// inside of some.
    pub fn new(case: &'a Case) -> Result<Self, CaseError> {
        let mut curves: BTreeMap<&str, Arc<dyn GeneratingCurve>> = BTreeMap::new();
        let mut bodies = Vec::with_capacity(case.bodies.len());
        for body in &case.bodies {
            let curve = match curves.get(&*body.shape) {
                Some(curve) => curve.clone(),
                None => {
                    let shape = case.shape_of(body);
                    let curve = shape.value.curve();
                    let curve = curve.map_err(|error| at_shape(case, body, &error))?;
                    curves.insert(&body.shape, curve.clone());
                    curve
                }
            };
            let axis = Unit::new_normalize(body.axis.into());
            let frame = Frame::along(body.center.into(), axis).scaled(body.scale);
            bodies.push(Placed {
                body,
                frame,
                curve,
                slip: imposed(case, body, frame),
            });
        }
        let setting = Self {
            case,
            bodies,
            probes: case.probes.iter().map(|probe| probe.value.into()).collect(),
        };
        setting.check_points()?;
        Ok(setting)
    }

    fn check_points(&self) -> Result<(), CaseError> {
        let case = self.case;
        let bodies = self
            .bodies
            .iter()
            .map(|placed| (&placed.curve, placed.frame));
        let insides = Insides::new(bodies)
            .map_err(|(body, error)| at_shape(case, self.bodies[body].body, &error))?;
        let one = self.bodies.len() == 1;
        for probe in &case.probes {
            if let Some(body) = insides.body_at(probe.value.into()) {
                let name = if one {
                    "the body".into()
                } else {
                    self.name(body)
                };
                let message = format!(
                    "probes.points: {:?} lies inside {name}: expected a point in the fluid",
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

    /// How messages call a body: its number, from 1, and its shape.
    pub fn name(&self, body: usize) -> String {
        format!("body {} (`{}`)", body + 1, self.bodies[body].body.shape)
    }

    /// An error of a body's generating curve.
    pub fn at_shape(&self, body: usize, error: &dyn std::fmt::Display) -> CaseError {
        at_shape(self.case, self.bodies[body].body, error)
    }

    /// What is known of a body's motion, in the laboratory and for viscosity 1.
    pub fn motion(&self, placed: &Placed<'_>) -> Motion {
        match placed.body.motion.value {
            // The known flow takes the place of all that is imposed.
            _ if self.case.test.is_some() => Motion::Given(RigidMotion::rest()),
            case::Motion::Rigid {
                velocity,
                angular_velocity,
            } => Motion::Given(RigidMotion {
                velocity: velocity.into(),
                angular_velocity: angular_velocity.into(),
            }),
            case::Motion::Free { force, torque } => Motion::Free(Wrench {
                force: Vector3::from(force) / self.case.viscosity,
                torque: Vector3::from(torque) / self.case.viscosity,
            }),
        }
    }

    /// The undisturbed flow.
    pub fn background(&self) -> LinearFlow {
        match self.case.background.as_deref() {
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

    /// The bodies' part of the report.
    pub fn body_reports(&self, found: impl IntoIterator<Item = Found>) -> Vec<BodyReport> {
        let viscosity = self.case.viscosity;
        let report = |(placed, found): (&Placed<'_>, Found)| {
            let velocities = [found.motion.velocity, found.motion.angular_velocity];
            let velocities = velocities.map(Into::into);
            let forces = [found.wrench.force, found.wrench.torque];
            let forces = forces.map(|force| (viscosity * force).into());
            // What is given comes back as it was.
            let ([velocity, angular_velocity], [force, torque]) = match placed.body.motion.value {
                _ if self.case.test.is_some() => ([[0.0; 3]; 2], forces),
                case::Motion::Rigid {
                    velocity,
                    angular_velocity,
                } => ([velocity, angular_velocity], forces),
                case::Motion::Free { force, torque } => (velocities, [force, torque]),
            };
            BodyReport {
                velocity,
                angular_velocity,
                force,
                torque,
                stresslet: (viscosity * found.stresslet).transpose().into(),
                stresslet_error_estimate: viscosity * found.stresslet_error,
                power: found.power.map(|power| viscosity * power),
                power_error_estimate: found.power_error.map(|error| viscosity * error),
            }
        };
        self.bodies.iter().zip(found).map(report).collect()
    }

    /// The probes' part of the report, from the flow in the laboratory for viscosity 1.
    pub fn probe_reports(&self, flow: impl IntoIterator<Item = FlowAt>) -> Vec<ProbeReport> {
        let probes = self.case.probes.iter().zip(flow);
        let report = probes.map(|(probe, flow)| ProbeReport {
            point: probe.value,
            velocity: flow.velocity.into(),
            pressure: self.case.viscosity * flow.pressure,
        });
        report.collect()
    }

    /// The error of the velocities at the probes against the known flow, if there is one.
    pub fn test_report(
        &self,
        probes: &[ProbeReport],
        largest_speed: f64,
    ) -> Option<KnownFlowReport> {
        self.case.test.as_ref()?;
        let known = known_flow(
            self.case,
            &Frame::along(Point3::origin(), Vector3::z_axis()),
        );
        let errors = probes.iter().map(|probe| {
            let exact: Vector3<f64> = known.iter().map(|s| s.velocity(probe.point.into())).sum();
            (exact - Vector3::from(probe.velocity)).amax()
        });
        let absolute_error = errors.fold(0.0, f64::max);
        Some(KnownFlowReport {
            absolute_error,
            // Stokeslets without force, or that cancel, leave nothing to relate to.
            relative_error: if absolute_error == 0.0 {
                0.0
            } else {
                absolute_error / largest_speed
            },
        })
    }

    /// The shapes and resolutions in use, each with its number of bodies, in the order of the case.
    pub fn discretizations<'r>(
        &self,
        resolutions: impl IntoIterator<Item = &'r Resolution>,
    ) -> Vec<Discretization> {
        let mut known: Vec<(&str, &Resolution, usize)> = Vec::new();
        for (placed, resolution) in self.bodies.iter().zip(resolutions) {
            let shape = &*placed.body.shape;
            let same =
                |entry: &&mut (&str, &Resolution, usize)| entry.0 == shape && entry.1 == resolution;
            match known.iter_mut().find(same) {
                Some((.., bodies)) => *bodies += 1,
                None => known.push((shape, resolution, 1)),
            }
        }
        let entries = known.into_iter();
        let report = entries.map(|(shape, resolution, bodies)| Discretization {
            shape: shape.to_owned(),
            panels: resolution.panels.len(),
            order: resolution.order,
            modes: resolution.modes,
            bodies: Some(bodies),
        });
        report.collect()
    }
}

fn at_shape(case: &Case, body: &case::Body, error: &dyn std::fmt::Display) -> CaseError {
    let line = case.shape_of(body).line;
    case.error(line, format!("shapes.{}: {error}", body.shape))
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

/// The slip of a body, or the known flow in its place; in the body's frame.
fn imposed<'a>(case: &'a Case, body: &'a case::Body, frame: Frame) -> Option<Box<Velocity<'a>>> {
    if case.test.is_some() {
        let known = known_flow(case, &frame);
        return Some(Box::new(move |x| known.iter().map(|s| s.velocity(x)).sum()));
    }
    let slip = body.slip.as_ref()?;
    Some(match &slip.value {
        Slip::Squirmer { b } => Box::new(squirmer(b)),
        &Slip::PoleToPole {
            polar,
            equatorial,
            speed,
        } => Box::new(pole_to_pole(polar, equatorial, speed)),
    })
}
