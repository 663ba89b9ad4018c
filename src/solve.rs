//! From a case to its answer.

use std::sync::Arc;

use nalgebra::{Matrix3, Point3, Unit, Vector3};
use panel_quadrature::QuadratureError;
use rayon::prelude::*;

use crate::body::body_flow::BodyFlow;
use crate::body::dirichlet;
use crate::body::flow::meridian;
use crate::body::frame::Frame;
use crate::body::linear_flow::LinearFlow;
use crate::body::problem::{self, Answer, Problem, ProblemError, Resolution, evaluation_tolerance};
use crate::body::rigid::{RigidMotion, Wrench};
use crate::body::slip::{pole_to_pole, squirmer};
use crate::case::{Accuracy, Background, Body, Case, CaseError, Formulation, Motion, Slip};
use crate::curve::{GeneratingCurve, Outline, Panels};
use crate::kernel::{FlowAt, Stokeslet};
use crate::output::{BodyReport, Discretization, KnownFlowReport, ProbeReport, Report, Timings};
use crate::progress::{Progress, Silent};

/// Why a case has no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The case is at fault: its geometry, or a part of the format that is not built.
    #[error(transparent)]
    Case(#[from] CaseError),
    /// The computation itself failed.
    #[error("{0}")]
    Failed(String),
}

/// A case that was solved: its report, and the flow to look at more closely. Everything is in the laboratory's frame.
#[derive(Clone, Debug)]
pub struct Solved {
    /// What the case asked for.
    pub report: Report,
    /// The bodies in the order of the case.
    pub bodies: Vec<SolvedBody>,
    /// Tolerance of the flow's quadrature.
    tolerance: f64,
}

/// One body of a case that was solved.
#[derive(Clone, Debug)]
pub struct SolvedBody {
    frame: Frame,
    viscosity: f64,
    flow: BodyFlow,
}

impl Solved {
    /// Velocity and pressure of the whole flow at any points, `None` inside a body.
    ///
    /// # Errors
    /// If a point is not finite.
    pub fn flow_at(&self, points: &[Point3<f64>]) -> Result<Vec<Option<FlowAt>>, SolveError> {
        self.evaluate(points, self.tolerance, &Silent)
    }

    /// The same to another tolerance, telling where it is.
    pub(crate) fn evaluate(
        &self,
        points: &[Point3<f64>],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<Option<FlowAt>>, SolveError> {
        let failed = |error: &dyn std::fmt::Display| SolveError::Failed(error.to_string());
        let mut flow = vec![None; points.len()];
        for body in &self.bodies {
            let curve = body.flow.discretization.curve();
            let outline = Outline::new(&**curve).map_err(|error| failed(&error))?;
            let outside = |(place, &point): (usize, &Point3<f64>)| {
                let target = body.frame.point_to_body(point);
                (!outline.contains(meridian(&target))).then_some((place, target))
            };
            let (places, targets): (Vec<usize>, Vec<Point3<f64>>) =
                points.par_iter().enumerate().filter_map(outside).unzip();
            let found = body.flow.evaluate(&targets, tolerance, progress);
            let found = found.map_err(|error| failed(&error))?;
            for (place, at) in places.into_iter().zip(found) {
                flow[place] = Some(FlowAt {
                    velocity: body.frame.vector_to_lab(at.velocity),
                    pressure: body.viscosity * at.pressure,
                });
            }
        }
        Ok(flow)
    }
}

impl SolvedBody {
    /// Where the body is.
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// The fluid's viscosity.
    pub fn viscosity(&self) -> f64 {
        self.viscosity
    }

    /// The flow in the body's own frame and for viscosity 1, with panels and nodes of its generating curve.
    pub fn flow(&self) -> &BodyFlow {
        &self.flow
    }
}

/// Solves a case once.
///
/// The report is returned even when its error estimate exceeds the tolerance: the caller compares.
///
/// # Errors
/// [`SolveError::Case`] if the case asks for the impossible or for what is not built.
pub fn solve(case: &Case, progress: &dyn Progress) -> Result<Solved, SolveError> {
    case.check_supported()?;
    let [body] = &case.bodies[..] else {
        return Err(case.error(0, "expected one body").into());
    };
    let setting = Setting::new(case, body)?;
    let targets: Vec<Point3<f64>> = case
        .probes
        .iter()
        .map(|probe| setting.frame.point_to_body(probe.value.into()))
        .collect();
    let known = setting.known_flow()?;
    let field = |x: Vector3<f64>| known.iter().map(|s| s.velocity(x)).sum::<Vector3<f64>>();
    let slip = setting.slip();
    let problem = Problem {
        motion: setting.motion(),
        slip: match (&case.test, &slip) {
            (Some(_), _) => Some(&field),
            (None, slip) => slip.as_deref(),
        },
        background: setting.background(),
        targets: &targets,
        formulation: match case.solver.formulation {
            Formulation::SingleLayer => dirichlet::Formulation::SingleLayer,
            _ => dirichlet::Formulation::CombinedField,
        },
        ..Problem::new(setting.curve.clone())
    };
    let answer = match case.accuracy {
        Accuracy::Tolerance(tolerance) => problem.to_tolerance(tolerance, progress),
        Accuracy::ByHand {
            panels,
            order,
            modes,
        } => Panels::equal_arcs(&*setting.curve, panels)
            .map_err(ProblemError::from)
            .and_then(|panels| {
                problem.at_resolution(
                    Resolution {
                        panels,
                        order,
                        modes,
                    },
                    progress,
                )
            }),
    }
    .map_err(|error| setting.problem_error(error))?;
    let mut report = setting.report(&answer)?;
    if case.test.is_some() {
        let exact = targets.iter().map(|&x| field(x.coords));
        let errors = exact
            .zip(&answer.flow)
            .map(|(exact, computed)| (exact - computed.velocity).amax());
        let absolute_error = errors.fold(0.0, f64::max);
        report.test = Some(KnownFlowReport {
            absolute_error,
            // Stokeslets without force, or that cancel, leave nothing to relate to.
            relative_error: if absolute_error == 0.0 {
                0.0
            } else {
                absolute_error / answer.largest_speed
            },
        });
    }
    Ok(Solved {
        report,
        bodies: vec![SolvedBody {
            frame: setting.frame,
            viscosity: case.viscosity,
            flow: answer.body_flow,
        }],
        tolerance: evaluation_tolerance(case.tolerance()),
    })
}

/// A velocity as a function of the point.
type Velocity<'a> = dyn Fn(Vector3<f64>) -> Vector3<f64> + Sync + 'a;

/// A case's one body, ready to be computed with.
struct Setting<'a> {
    case: &'a Case,
    body: &'a Body,
    frame: Frame,
    curve: Arc<dyn GeneratingCurve>,
}

impl<'a> Setting<'a> {
    /// Builds the curve and checks that the probes are outside of the body and the Stokeslets inside.
    fn new(case: &'a Case, body: &'a Body) -> Result<Self, CaseError> {
        let shape = case.shape_of(body);
        let at_shape = |error: &dyn std::fmt::Display| {
            case.error(shape.line, format!("shapes.{}: {error}", body.shape))
        };
        let curve = shape.value.curve().map_err(|error| at_shape(&error))?;
        let frame = Frame::new(body.center.into(), Unit::new_normalize(body.axis.into()));
        let outline = Outline::new(&*curve).map_err(|error| at_shape(&error))?;
        let inside =
            |point: [f64; 3]| outline.contains(meridian(&frame.point_to_body(point.into())));
        for probe in &case.probes {
            if inside(probe.value) {
                let message = format!(
                    "probes.points: {:?} lies inside the body: expected a point in the fluid",
                    probe.value
                );
                return Err(case.error(probe.line, message));
            }
        }
        for stokeslet in case.test.iter().flat_map(|test| &test.stokeslets) {
            if !inside(stokeslet.at) {
                let message = format!(
                    "test.stokeslets: at = {:?} lies outside the body: expected a point inside",
                    stokeslet.at
                );
                return Err(case.error(stokeslet.line, message));
            }
        }
        drop(outline);
        Ok(Self {
            case,
            body,
            frame,
            curve,
        })
    }

    /// The Stokeslets of `[test]` in the body's frame, as strong as they are at viscosity 1.
    fn known_flow(&self) -> Result<Vec<Stokeslet>, CaseError> {
        let stokeslets = self.case.test.iter().flat_map(|test| &test.stokeslets);
        Ok(stokeslets
            .map(|s| Stokeslet {
                at: self.frame.point_to_body(s.at.into()).coords,
                force: self.frame.vector_to_body(s.force.into()) / self.case.viscosity,
            })
            .collect())
    }

    /// What is imposed on the body, in its own frame and at viscosity 1.
    fn motion(&self) -> problem::Motion {
        let to_body = |v: [f64; 3]| self.frame.vector_to_body(v.into());
        match self.body.motion.value {
            // The known flow takes the place of all that is imposed.
            _ if self.case.test.is_some() => problem::Motion::Given(RigidMotion::rest()),
            Motion::Rigid {
                velocity,
                angular_velocity,
            } => problem::Motion::Given(RigidMotion {
                velocity: to_body(velocity),
                angular_velocity: to_body(angular_velocity),
            }),
            Motion::Free { force, torque } => problem::Motion::Free(Wrench {
                force: to_body(force) / self.case.viscosity,
                torque: to_body(torque) / self.case.viscosity,
            }),
        }
    }

    /// The slip of the body, in its own frame.
    fn slip(&self) -> Option<Box<Velocity<'_>>> {
        let slip = self.body.slip.as_ref()?;
        Some(match &slip.value {
            Slip::Squirmer { b } => Box::new(squirmer(b)),
            &Slip::PoleToPole {
                polar,
                equatorial,
                speed,
            } => Box::new(pole_to_pole(polar, equatorial, speed)),
        })
    }

    /// The undisturbed flow in the body's frame.
    fn background(&self) -> LinearFlow {
        let flow = match self.case.background.as_ref().map(|b| &b.value) {
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
        };
        self.frame.flow_to_body(&flow)
    }

    fn report(&self, answer: &Answer) -> Result<Report, SolveError> {
        let viscosity = self.case.viscosity;
        let to_lab = |v: Vector3<f64>| self.frame.vector_to_lab(v).into();
        let velocities = [answer.motion.velocity, answer.motion.angular_velocity].map(to_lab);
        let forces = [answer.wrench.force, answer.wrench.torque].map(|f| to_lab(viscosity * f));
        // What is given comes back as it was.
        let ([velocity, angular_velocity], [force, torque]) = match self.body.motion.value {
            _ if self.case.test.is_some() => ([[0.0; 3]; 2], forces),
            Motion::Rigid {
                velocity,
                angular_velocity,
            } => ([velocity, angular_velocity], forces),
            Motion::Free { force, torque } => (velocities, [force, torque]),
        };
        let failed = |error: QuadratureError| SolveError::Failed(error.to_string());
        let (power, power_error) = match self.case.test {
            Some(_) => (None, None),
            None => (
                Some(answer.body_flow.power().map_err(failed)?),
                Some(answer.power_error().map_err(failed)?),
            ),
        };
        let stresslet = self.frame.tensor_to_lab(&answer.body_flow.stresslet());
        let probes = self
            .case
            .probes
            .iter()
            .zip(&answer.flow)
            .map(|(probe, flow)| ProbeReport {
                point: probe.value,
                velocity: to_lab(flow.velocity),
                pressure: viscosity * flow.pressure,
            });
        let t = answer.timings;
        Ok(Report {
            bodies: vec![BodyReport {
                velocity,
                angular_velocity,
                force,
                torque,
                stresslet: (viscosity * stresslet).transpose().into(),
                stresslet_error_estimate: viscosity * answer.further_errors.stresslet,
                power: power.map(|power| viscosity * power),
                power_error_estimate: power_error.map(|error| viscosity * error),
            }],
            probes: probes.collect(),
            error_estimate: answer.error_estimate,
            pressure_error_estimate: viscosity * answer.further_errors.pressure,
            iterations: 0,
            unknowns: answer.unknowns,
            discretization: vec![Discretization {
                shape: self.body.shape.clone(),
                panels: answer.resolution.panels.len(),
                order: answer.resolution.order,
                modes: answer.resolution.modes,
            }],
            timings: Timings {
                assemble: t.assemble,
                factor: t.factor,
                iterate: t.solve,
                evaluate: t.evaluate,
                estimate: t.estimate,
            },
            test: None,
        })
    }

    fn problem_error(&self, error: ProblemError) -> SolveError {
        let at_shape = |error: &dyn std::fmt::Display| {
            let line = self.case.shape_of(self.body).line;
            self.case
                .error(line, format!("shapes.{}: {error}", self.body.shape))
                .into()
        };
        match error {
            ProblemError::Curve(error) => at_shape(&error),
            other => SolveError::Failed(other.to_string()),
        }
    }
}
