//! What is imposed on the bodies, and the iteration that finds their densities.

use nalgebra::Vector3;

use super::SuspensionError;
use super::class::Classes;
use super::interactions::InteractionError;
use super::suspension::{Body, Motion, Options};
use super::system::System;
use super::tables::Layout;
use bodies_of_revolution::{RigidMotion, Wrench};
use inexact_krylov::{Control, KrylovError, Outcome, Stop};
use stokes_body::discretization::Discretization;
use stokes_body::layers::Layers;
use stokes_body::linear_flow::LinearFlow;
use stokes_body::progress::Progress;
use stokes_body::shell::Shell;
use stokes_body::surface::SurfaceModes;

/// Modes that the samples of a slip determine, over those kept.
const OVERSAMPLING: f64 = 1.5;

/// How well and with what the equations are to be solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Care {
    /// What all of it is for.
    pub tolerance: f64,
    /// Relative residual of the iteration.
    pub residual: f64,
    /// Tolerance of the products at their best, and of what is near.
    pub product: f64,
    /// Bytes for the rows of near points.
    pub memory: usize,
}

/// How an iteration went.
#[derive(Clone, Debug, PartialEq)]
pub struct Iteration {
    /// Iterations made.
    pub iterations: usize,
    /// Products made, those for true residuals among them.
    pub products: usize,
    /// The true residual, relative to the right-hand side.
    pub residual: f64,
    /// Why it ended.
    pub stop: Stop,
    /// The relative residual before the iteration and after each step, as the method believes.
    pub history: Vec<f64>,
}

/// Densities and motions.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    pub classes: Classes,
    /// What each body's layers make on its own surface: the unknown of the iteration.
    pub unknown: Vec<SurfaceModes>,
    pub layers: Vec<Layers>,
    /// Rigid motions and what the bodies exert on the fluid, in their frames.
    pub motions: Vec<RigidMotion>,
    pub wrenches: Vec<Wrench>,
    /// The largest speed that the iteration left on each body.
    pub left: Vec<f64>,
    /// The largest speed that was imposed.
    pub largest_imposed: f64,
    pub iteration: Iteration,
    pub seconds: Seconds,
    pub unknowns: usize,
    pub points: usize,
    /// Points near another body, and the bytes of their rows.
    pub near_points: usize,
    pub near_bytes: usize,
}

/// Wall-clock seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seconds {
    /// Assembling single bodies, and factoring them.
    pub assemble: f64,
    pub factor: f64,
    /// Finding what is near, and its rows.
    pub near: f64,
    pub iterate: f64,
    /// Of that, the sums over points.
    pub sum: f64,
}

/// What is imposed on a body, in its frame.
pub(crate) struct Imposed {
    /// $u_s - u_\infty$ and, of a held body, its motion.
    pub velocity: SurfaceModes,
    /// The density of a free body's single layer.
    pub single: Option<SurfaceModes>,
    /// The largest speed of motion and slip together, or of the background.
    pub largest: f64,
}

impl Imposed {
    pub fn new(
        body: &Body<'_>,
        background: &LinearFlow,
        discretization: &Discretization,
        n_max: usize,
        free: Option<&Shell>,
    ) -> Self {
        let frame = &body.frame;
        let undisturbed = background.in_frame(frame).on(discretization);
        let motion = match body.motion {
            Motion::Given(motion) => frame.motion_to_body(motion),
            Motion::Free(_) => RigidMotion::rest(),
        };
        let sampled = match body.slip {
            Some(slip) => {
                let most = (OVERSAMPLING * n_max as f64) as usize;
                let whole = |x: Vector3<f64>| motion.at(x) + slip(x);
                SurfaceModes::sample(discretization, most.max(1), whole)
            }
            None => SurfaceModes::sample(discretization, 1, |x| motion.at(x)),
        };
        let single = match (body.motion, free) {
            (Motion::Free(wrench), Some(shell)) => {
                let motion = shell.motion(frame.wrench_to_body(wrench));
                Some(SurfaceModes::of_motion(discretization, &motion))
            }
            _ => None,
        };
        Self {
            largest: sampled.largest.max(undisturbed.largest),
            velocity: (sampled.modes.truncated(n_max.max(1))).plus(-1.0, &undisturbed.modes),
            single,
        }
    }
}

/// Copies the modes that both have.
pub(crate) fn copy_modes(to: &mut [f64], from: &[f64]) {
    let count = to.len().min(from.len());
    to[..count].copy_from_slice(&from[..count]);
}

/// The unknowns of an earlier solution at these resolutions.
pub(crate) fn start_from(
    before: &Solution,
    classes: &Classes,
    layout: &Layout,
) -> Result<Vec<f64>, SuspensionError> {
    let mut start = vec![0.0; layout.len()];
    for (i, unknown) in before.unknown.iter().enumerate() {
        let from = &before.classes.of(i).tables.discretization;
        let to = &classes.of(i).tables;
        let resampled = unknown.resampled(from, &to.discretization, to.n_max)?;
        copy_modes(
            &mut start[layout.of(i)],
            &resampled.scaled_by_roots(&to.discretization),
        );
    }
    Ok(start)
}

/// What an iteration ends with.
pub(crate) struct Iterated {
    pub unknown: Vec<f64>,
    /// The residual.
    pub left: Vec<f64>,
    pub iteration: Iteration,
}

/// Iterates from a first unknown, if there is one: solves for what it lacks.
pub(crate) fn iterate(
    system: &mut System,
    data: &[f64],
    first: Option<Vec<f64>>,
    care: Care,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Iterated, SuspensionError> {
    system.products = 0;
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let scale = norm(data);
    let mut lacking = data.to_vec();
    let mut reduced = 1.0;
    // Nothing imposed has nothing for an answer, whatever was there before.
    let first = first.filter(|_| scale > 0.0);
    if let Some(first) = &first {
        let mut product = vec![0.0; first.len()];
        system.apply_alone(first, &mut product, care.product)?;
        for (lacking, product) in lacking.iter_mut().zip(&product) {
            *lacking -= product;
        }
        reduced = norm(&lacking) / scale;
    }
    let tolerance = care.residual / reduced;
    if reduced <= care.residual {
        let iteration = Iteration {
            iterations: 0,
            products: system.products,
            residual: reduced,
            stop: Stop::Converged,
            history: vec![reduced],
        };
        return Ok(Iterated {
            unknown: first.unwrap_or_else(|| vec![0.0; data.len()]),
            left: lacking,
            iteration,
        });
    }
    let control = Control {
        tolerance,
        max_iterations: options.max_iterations,
        safety: (care.product / care.residual).min(0.5),
        loosest: options.loosest_product,
    };
    let digits = -tolerance.log10();
    let steps = 1000;
    let mut shown = 0;
    progress.begin("iterating", steps);
    let outcome = inexact_krylov::solve(
        system,
        &lacking,
        None,
        options.method,
        &control,
        &mut |_, residual| {
            let part = (-residual.log10() / digits).clamp(0.0, 1.0);
            let now = (part * steps as f64) as usize;
            progress.advance(now.saturating_sub(shown));
            shown = shown.max(now);
            if progress.is_cancelled() {
                return Err(InteractionError::Interrupted);
            }
            Ok(())
        },
    );
    let Outcome {
        solution,
        iterations,
        residual,
        residual_vector,
        stop,
        history,
        ..
    } = outcome.map_err(|error| match error {
        KrylovError::Operator(error) => error.into(),
        other => SuspensionError::Iteration(other.to_string()),
    })?;
    let mut unknown = system.improved(&solution);
    for (unknown, first) in unknown.iter_mut().zip(first.iter().flatten()) {
        *unknown += first;
    }
    let iteration = Iteration {
        iterations,
        products: system.products,
        residual: residual * reduced,
        stop,
        history: history.iter().map(|residual| residual * reduced).collect(),
    };
    Ok(Iterated {
        unknown,
        left: residual_vector,
        iteration,
    })
}
