//! Many bodies: a suspension in the laboratory.

use std::sync::Arc;

use super::setting::{Found, Placed, Setting};
use super::{SolveError, Solved, SolvedBody, Whole, formulation};
use crate::case::{Accuracy, Case, CaseError, Method};
use crate::output::{Report, Stop, Timings};
use bodies_of_revolution::ContactError;
use bodies_of_revolution::{GeneratingCurve, Panels};
use inexact_krylov as krylov;
use stokes_body::problem::{Resolution, evaluation_tolerance};
use stokes_body::progress::Progress;
use stokes_body::surface::SurfaceModes;
use stokes_suspension::SuspensionError;
use stokes_suspension::flow::BodyLayers;
use stokes_suspension::suspension::{Answer, Body, Options, Suspension};

/// Tolerance of sums and iterations where panels, order and modes are chosen by hand.
const BY_HAND: f64 = 1e-10;

/// Solves a case of more than one body.
pub(super) fn solve(setting: &Setting<'_>, progress: &dyn Progress) -> Result<Solved, SolveError> {
    let case = setting.case;
    let bodies = setting.bodies.iter().map(|placed| Body {
        curve: placed.curve.clone(),
        frame: placed.frame,
        motion: setting.motion(placed),
        slip: placed.slip.as_deref(),
    });
    let suspension = Suspension {
        bodies: bodies.collect(),
        background: setting.background(),
        targets: &setting.probes,
        formulation: formulation(case),
        options: options(case),
    };
    let tolerance = case.tolerance().unwrap_or(BY_HAND);
    let answer = match case.accuracy {
        Accuracy::Tolerance(tolerance) => suspension.to_tolerance(tolerance, progress),
        Accuracy::ByHand {
            panels,
            order,
            modes,
        } => suspension.at_resolutions(
            &by_hand(setting, panels, order, modes)?,
            tolerance,
            progress,
        ),
    };
    let answer = answer.map_err(|error| explain(setting, error))?;
    let tolerance = evaluation_tolerance(Some(tolerance));
    Ok(Solved {
        report: report(setting, &answer, tolerance, progress)?,
        bodies: surfaces(setting, &answer),
        flow: Whole::Many(answer.flow),
        viscosity: case.viscosity,
        tolerance,
    })
}

fn options(case: &Case) -> Options {
    let default = Options::default();
    Options {
        method: match case.solver.method {
            Method::Gmres => default.method,
            Method::BiCgStab => krylov::Method::BiCgStab,
        },
        max_iterations: case.solver.max_iterations,
        residual: case.solver.tolerance,
        memory: case
            .solver
            .memory
            .map(|gib| (gib * f64::from(1 << 30)) as usize),
        ..default
    }
}

/// The same resolution for all bodies, shared by those of one shape.
fn by_hand(
    setting: &Setting<'_>,
    panels: usize,
    order: usize,
    modes: usize,
) -> Result<Vec<Arc<Resolution>>, CaseError> {
    let mut known: Vec<(&Arc<dyn GeneratingCurve>, Arc<Resolution>)> = Vec::new();
    let mut resolutions = Vec::with_capacity(setting.bodies.len());
    for (index, placed) in setting.bodies.iter().enumerate() {
        let mut shared = known.iter();
        let shared = match shared.find(|(curve, _)| Arc::ptr_eq(curve, &placed.curve)) {
            Some((_, shared)) => shared.clone(),
            None => {
                let panels = Panels::equal_arcs(&*placed.curve, panels)
                    .map_err(|error| setting.at_shape(index, &error))?;
                let shared = Arc::new(Resolution {
                    panels,
                    order,
                    modes,
                });
                known.push((&placed.curve, shared.clone()));
                shared
            }
        };
        resolutions.push(shared);
    }
    Ok(resolutions)
}

/// The bodies' surfaces as they move.
fn surfaces(setting: &Setting<'_>, answer: &Answer) -> Vec<SolvedBody> {
    let bodies = setting
        .bodies
        .iter()
        .zip(&answer.bodies)
        .zip(&answer.flow.bodies);
    let surface = bodies.map(|((placed, found), layers)| {
        let discretization = &layers.discretization;
        let motion =
            SurfaceModes::of_motion(discretization, &layers.frame.motion_to_body(found.motion));
        SolvedBody {
            frame: layers.frame,
            velocity: match slip(placed, layers) {
                Some(slip) => motion.plus(1.0, &slip),
                None => motion,
            },
            modes: layers.layers.modes(),
            discretization: discretization.clone(),
        }
    });
    surface.collect()
}

/// A body's slip at the nodes, with as many modes as its densities.
fn slip(placed: &Placed<'_>, layers: &BodyLayers) -> Option<SurfaceModes> {
    let slip = placed.slip.as_deref()?;
    let last = layers.layers.modes().max(2) - 1;
    Some(SurfaceModes::sample(&layers.discretization, last, slip).modes)
}

fn report(
    setting: &Setting<'_>,
    answer: &Answer,
    tolerance: f64,
    progress: &dyn Progress,
) -> Result<Report, SolveError> {
    let failed = |error| explain(setting, error);
    let slips = of_slips(setting, answer, tolerance, progress).map_err(failed)?;
    let found = answer
        .bodies
        .iter()
        .zip(slips)
        .enumerate()
        .map(|(i, (body, of_slip))| {
            let wrench = body.wrench;
            let of_motion = wrench.force.dot(&body.motion.velocity)
                + wrench.torque.dot(&body.motion.angular_velocity);
            let known = setting.case.test.is_none();
            let slips = setting.bodies[i].slip.is_some();
            Found {
                motion: body.motion,
                wrench,
                stresslet: body.stresslet,
                stresslet_error: answer.stresslet_error(i),
                power: known.then_some(of_motion + of_slip),
                power_error: (known && !slips).then(|| answer.power_error(i)),
            }
        });
    let bodies = setting.body_reports(found);
    let probes = setting.probe_reports(answer.targets.iter().copied());
    let t = answer.timings;
    Ok(Report {
        bodies,
        test: setting.test_report(&probes, answer.largest_speed),
        probes,
        error_estimate: answer.error_estimate,
        pressure_error_estimate: setting.case.viscosity * answer.pressure_error(&setting.probes),
        iterations: answer.iterations,
        products: answer.products,
        residual: Some(answer.iteration.residual),
        stop: match answer.iteration.stop {
            krylov::Stop::Converged => Stop::Converged,
            krylov::Stop::MaxIterations => Stop::Exhausted,
            _ => Stop::Stagnated,
        },
        unknowns: answer.unknowns,
        points: Some(answer.points),
        discretization: setting.discretizations(answer.bodies.iter().map(|b| &b.resolution)),
        timings: Timings {
            assemble: t.assemble + t.near,
            factor: t.factor,
            iterate: t.iterate,
            evaluate: t.evaluate,
            estimate: t.estimate + t.refine,
        },
    })
}

/// The rate of work of every body's slip, without a known flow; for viscosity 1.
fn of_slips(
    setting: &Setting<'_>,
    answer: &Answer,
    tolerance: f64,
    progress: &dyn Progress,
) -> Result<Vec<f64>, SuspensionError> {
    let mut powers = vec![0.0; setting.bodies.len()];
    if setting.case.test.is_some() {
        return Ok(powers);
    }
    let slips = |&body: &usize| setting.bodies[body].slip.is_some();
    let bodies: Vec<usize> = (0..powers.len()).filter(slips).collect();
    if bodies.is_empty() {
        return Ok(powers);
    }
    let tractions = answer.flow.tractions(&bodies, tolerance, progress)?;
    for (&body, traction) in bodies.iter().zip(&tractions) {
        let layers = &answer.flow.bodies[body];
        if let Some(slip) = slip(&setting.bodies[body], layers) {
            let work = slip.inner_product(&layers.discretization, traction);
            powers[body] = -layers.frame.scale().powi(2) * work;
        }
    }
    Ok(powers)
}

/// Errors with the bodies' names and their lines.
fn explain(setting: &Setting<'_>, error: SuspensionError) -> SolveError {
    let case = setting.case;
    let line = |a: usize, b: usize| setting.bodies[a.max(b)].body.line;
    let name = |body: usize| setting.name(body);
    let contact = |error: ContactError| match error {
        ContactError::Curve { body, source } => setting.at_shape(body, &source),
        ContactError::Touch { first, second } => case.error(
            line(first, second),
            format!(
                "{} and {} touch: expected bodies that are apart",
                name(first),
                name(second)
            ),
        ),
        ContactError::Overlap {
            first,
            second,
            depth,
        } => case.error(
            line(first, second),
            format!(
                "{} and {} overlap by {depth:.3e} or more: expected bodies that are apart",
                name(first),
                name(second)
            ),
        ),
        ContactError::Inside { inner, outer } => case.error(
            line(inner, outer),
            format!(
                "{} is inside {}: expected bodies that are apart",
                name(inner),
                name(outer)
            ),
        ),
        ContactError::Near {
            first,
            second,
            distance,
            needed,
        } => case.error(
            line(first, second),
            format!(
                "{} and {} are {distance:.3e} apart: expected at least {needed:.3e}",
                name(first),
                name(second)
            ),
        ),
        ContactError::Place {
            body,
            quantity,
            expected,
            value,
        } => case.error(
            line(body, body),
            format!("{}: {quantity} is {value}: expected {expected}", name(body)),
        ),
        other => CaseError::new(case.path.display(), None, other.to_string()),
    };
    match error {
        SuspensionError::Contact(error) => contact(error).into(),
        SuspensionError::Curve { body, error } => setting.at_shape(body, &error).into(),
        SuspensionError::Memory { .. } => {
            let message = format!("{error} (solver.memory)");
            CaseError::new(case.path.display(), None, message).into()
        }
        SuspensionError::Velocity { body } => SolveError::Failed(format!(
            "{}: the velocity imposed on {} is not finite everywhere",
            case.path.display(),
            name(body)
        )),
        SuspensionError::NotConverged {
            stop: krylov::Stop::MaxIterations,
            ..
        } => SolveError::Failed(format!(
            "{}: {error} by solver.max_iterations",
            case.path.display()
        )),
        SuspensionError::Interrupted => SolveError::Interrupted,
        other => SolveError::Failed(format!("{}: {other}", case.path.display())),
    }
}

/// For the interface of [`Solved`].
pub(super) fn failed(error: SuspensionError) -> SolveError {
    match error {
        SuspensionError::Interrupted => SolveError::Interrupted,
        other => SolveError::Failed(other.to_string()),
    }
}
