//! One body: solved for directly, in its own frame.

use nalgebra::Point3;
use panel_quadrature::QuadratureError;

use super::setting::{Found, Setting};
use super::{SolveError, Solved, SolvedBody, Whole, formulation};
use crate::case::Accuracy;
use crate::output::{Report, Stop, Timings};
use bodies_of_revolution::Panels;
use stokes_body::kernel::FlowAt;
use stokes_body::problem::{
    Answer, Motion, Problem, ProblemError, Resolution, evaluation_tolerance,
};
use stokes_body::progress::Progress;

/// Solves a case of one body.
pub(super) fn solve(setting: &Setting<'_>, progress: &dyn Progress) -> Result<Solved, SolveError> {
    let (case, placed) = (setting.case, &setting.bodies[0]);
    let frame = placed.frame;
    let probes = setting.probes.iter();
    let targets: Vec<Point3<f64>> = probes.map(|&x| frame.point_to_body(x)).collect();
    let problem = Problem {
        motion: match setting.motion(placed) {
            Motion::Given(motion) => Motion::Given(frame.motion_to_body(motion)),
            Motion::Free(wrench) => Motion::Free(frame.wrench_to_body(wrench)),
        },
        slip: placed.slip.as_deref(),
        background: setting.background().in_frame(&frame),
        targets: &targets,
        formulation: formulation(case),
        ..Problem::new(placed.curve.clone())
    };
    let answer = match case.accuracy {
        Accuracy::Tolerance(tolerance) => problem.to_tolerance(tolerance, progress),
        Accuracy::ByHand {
            panels,
            order,
            modes,
        } => Panels::equal_arcs(&*placed.curve, panels)
            .map_err(ProblemError::from)
            .and_then(|panels| {
                let resolution = Resolution {
                    panels,
                    order,
                    modes,
                };
                problem.at_resolution(resolution, progress)
            }),
    };
    let answer = answer.map_err(|error| match error {
        ProblemError::Curve(error) => setting.at_shape(0, &error).into(),
        ProblemError::Interrupted => SolveError::Interrupted,
        other => SolveError::Failed(other.to_string()),
    })?;
    Ok(Solved {
        report: report(setting, &answer)?,
        bodies: vec![SolvedBody {
            frame,
            velocity: answer.body_flow.surface_velocity(),
            modes: answer.body_flow.layers.modes(),
            discretization: answer.body_flow.discretization.clone(),
        }],
        flow: Whole::One(Box::new(answer.body_flow)),
        viscosity: case.viscosity,
        tolerance: evaluation_tolerance(case.tolerance()),
    })
}

fn report(setting: &Setting<'_>, answer: &Answer) -> Result<Report, SolveError> {
    let frame = setting.bodies[0].frame;
    let scale = frame.scale();
    let failed = |error: QuadratureError| SolveError::Failed(error.to_string());
    let (power, power_error) = match setting.case.test {
        Some(_) => (None, None),
        None => (
            Some(answer.body_flow.power().map_err(failed)?),
            Some(answer.power_error().map_err(failed)?),
        ),
    };
    let area = scale * scale;
    let found = Found {
        motion: frame.motion_to_lab(answer.motion),
        wrench: frame.wrench_to_lab(answer.wrench),
        stresslet: area * frame.tensor_to_lab(&answer.body_flow.stresslet()),
        stresslet_error: area * answer.further_errors.stresslet,
        power: power.map(|power| scale * power),
        power_error: power_error.map(|error| scale * error),
    };
    let in_lab = |flow: &FlowAt| FlowAt {
        velocity: frame.vector_to_lab(flow.velocity),
        pressure: flow.pressure / scale,
    };
    let probes = setting.probe_reports(answer.flow.iter().map(in_lab));
    let t = answer.timings;
    Ok(Report {
        bodies: setting.body_reports([found]),
        test: setting.test_report(&probes, answer.largest_speed),
        probes,
        error_estimate: answer.error_estimate,
        pressure_error_estimate: setting.case.viscosity * answer.further_errors.pressure / scale,
        iterations: 0,
        products: 0,
        residual: None,
        stop: Stop::Direct,
        unknowns: answer.unknowns,
        points: None,
        discretization: setting.discretizations([&answer.resolution]),
        timings: Timings {
            assemble: t.assemble,
            factor: t.factor,
            iterate: t.solve,
            evaluate: t.evaluate,
            estimate: t.estimate,
        },
    })
}
