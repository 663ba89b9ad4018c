//! The report of a case from its answer.

use std::collections::BTreeMap;

use nalgebra::{Point3, Vector3};

use super::question::{Question, known_velocity};
use crate::case::{Case, Component, ShapeSpec};
use crate::output::{
    BodyReport, Discretization, Imposed, Input, KnownFlowReport, Place, ProbeReport, Report, Stop,
    Timings,
};
use stokes_body::progress::Progress;
use stokes_body::resolution::Resolution;
use stokes_suspension::{self as suspension, Answer, SuspensionError};

pub(super) fn report(
    case: &Case,
    question: &Question,
    answer: &Answer,
    progress: &dyn Progress,
) -> Result<Report, SuspensionError> {
    let statistics = &answer.statistics;
    let probes = probes(case, answer);
    let t = statistics.timings;
    Ok(Report {
        input: Input::of(case),
        background: (case.background.as_ref()).map(|background| background.value.clone()),
        shapes: shapes(case),
        bodies: bodies(case, question, answer, progress)?,
        test: known_flow(case, &probes, answer.largest_speed),
        probes,
        error_estimate: answer.error_estimate,
        largest_speed: answer.largest_speed,
        pressure_error_estimate: answer.pressure_error(&question.suspension.probes),
        iterations: statistics.iterations,
        products: statistics.products,
        residual: (!answer.is_direct()).then_some(statistics.iteration.residual),
        stop: match answer.stop() {
            _ if answer.is_direct() => Stop::Direct,
            suspension::Stop::Converged => Stop::Converged,
            suspension::Stop::MaxIterations => Stop::Exhausted,
            _ => Stop::Stagnated,
        },
        unknowns: statistics.unknowns,
        points: (!answer.is_direct()).then_some(statistics.points),
        discretization: discretizations(case, answer),
        timings: Timings {
            assemble: t.assemble + t.near,
            factor: t.factor,
            iterate: t.iterate,
            evaluate: t.evaluate,
            estimate: t.estimate + t.other,
        },
    })
}

fn shapes(case: &Case) -> BTreeMap<String, ShapeSpec> {
    let shapes = case.shapes.iter();
    let named = shapes.map(|(name, shape)| (name.clone(), shape.value.clone()));
    named.collect()
}

fn bodies(
    case: &Case,
    question: &Question,
    answer: &Answer,
    progress: &dyn Progress,
) -> Result<Vec<BodyReport>, SuspensionError> {
    // The tractions of a known flow would cost more than its answer.
    let (powers, errors) = match case.test {
        Some(_) => (
            vec![None; answer.bodies.len()],
            vec![None; answer.bodies.len()],
        ),
        None => {
            let powers = answer.flow.powers(progress)?;
            let errors = answer.power_errors(progress)?;
            (powers.into_iter().map(Some).collect(), errors)
        }
    };
    let reports = answer.bodies.iter().enumerate().map(|(i, found)| {
        let body = &case.bodies[i];
        let velocities = [found.motion.velocity, found.motion.angular_velocity].map(Into::into);
        let forces = [found.wrench.force, found.wrench.torque].map(Into::into);
        // What is given comes back as it was.
        let ([velocity, angular_velocity], [force, torque]) = match case.test {
            Some(_) => ([[0.0; 3]; 2], forces),
            None => given_back(&body.components, velocities, forces),
        };
        Ok(BodyReport {
            place: Place::of(body, &question.suspension.bodies[i]),
            imposed: case.test.is_none().then(|| Imposed::on(body)),
            velocity,
            angular_velocity,
            force,
            torque,
            stresslet: found.stresslet.transpose().into(),
            stresslet_error_estimate: answer.stresslet_error(i)?,
            power: powers[i],
            power_error_estimate: errors[i],
        })
    });
    reports.collect()
}

/// What was found, but where the case gave a number that number.
fn given_back(
    components: &[Component; 6],
    mut velocities: [[f64; 3]; 2],
    mut forces: [[f64; 3]; 2],
) -> ([[f64; 3]; 2], [[f64; 3]; 2]) {
    for (k, component) in components.iter().enumerate() {
        match *component {
            Component::Imposed(value) => velocities[k / 3][k % 3] = value,
            Component::Free(value) => forces[k / 3][k % 3] = value,
        }
    }
    (velocities, forces)
}

fn probes(case: &Case, answer: &Answer) -> Vec<ProbeReport> {
    let probes = case.probes.iter().zip(&answer.probes);
    let report = probes.map(|(probe, flow)| ProbeReport {
        point: probe.value,
        velocity: flow.velocity.into(),
        pressure: flow.pressure,
    });
    report.collect()
}

/// The error of the velocities at the probes against the known flow, if there is one.
fn known_flow(case: &Case, probes: &[ProbeReport], largest_speed: f64) -> Option<KnownFlowReport> {
    case.test.as_ref()?;
    let errors = probes.iter().map(|probe| {
        let exact = known_velocity(case, Point3::from(probe.point));
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
fn discretizations(case: &Case, answer: &Answer) -> Vec<Discretization> {
    let mut known: Vec<(&str, &Resolution, usize)> = Vec::new();
    for (body, found) in case.bodies.iter().zip(&answer.bodies) {
        let (shape, resolution) = (&*body.shape, &found.resolution);
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
