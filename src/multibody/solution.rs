//! One solution of the equations of all bodies, at given resolutions.

use std::sync::Arc;
use std::time::Instant;

use nalgebra::Vector3;

use super::SuspensionError;
use super::class::{Class, Classes, Kind};
use super::interactions::{InteractionError, Interactions};
use super::suspension::{Body, Motion, Options, Suspension};
use super::system::System;
use super::tables::{Member, Tables};
use crate::body::discretization::Discretization;
use crate::body::layers::{LayerWeights, Layers};
use crate::body::linear_flow::LinearFlow;
use crate::body::rigid::{RigidMotion, Wrench};
use crate::body::surface::SurfaceModes;
use crate::krylov::{self, Control, KrylovError, Outcome, Stop};
use crate::progress::Progress;

/// Modes that the samples of a slip determine, over those kept.
const OVERSAMPLING: f64 = 1.5;

/// How well and with what the equations are to be solved.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Care {
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
        free: Option<&crate::body::shell::Shell>,
    ) -> Self {
        let frame = &body.frame;
        let undisturbed = frame.flow_to_body(background).on(discretization);
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
            (Motion::Free(wrench), Some(shell)) => Some(
                shell
                    .motion(frame.wrench_to_body(wrench))
                    .on(discretization),
            ),
            _ => None,
        };
        Self {
            largest: sampled.largest.max(undisturbed.largest),
            velocity: (sampled.modes.truncated(n_max.max(1))).plus(-1.0, &undisturbed.modes),
            single,
        }
    }
}

/// Solves for all bodies at the resolutions of `kinds`, from what an earlier solution says.
pub(crate) fn solve(
    suspension: &Suspension<'_>,
    kinds: &[Kind],
    care: Care,
    known: &Classes,
    before: Option<&Solution>,
    progress: &dyn Progress,
) -> Result<(Solution, f64), SuspensionError> {
    let start = Instant::now();
    let classes = Classes::new(kinds, known, progress)?;
    let spent = start.elapsed().as_secs_f64();
    let factoring = spent * classes.share_of_factoring();
    let mut seconds = Seconds {
        assemble: spent - factoring,
        factor: factoring,
        ..Seconds::default()
    };
    let start = Instant::now();
    let bodies = &suspension.bodies;
    let class = |body: usize| -> &Class { classes.of(body) };
    let members: Vec<Member> = (bodies.iter().enumerate())
        .map(|(i, body)| Member {
            tables: class(i).tables.clone(),
            frame: body.frame,
        })
        .collect();
    progress.begin("near points", bodies.len());
    let done = |steps: usize| progress.advance(steps);
    let interactions = Interactions::new(members, care.product, care.memory, &done)?;
    let (points, near_points, near_bytes) = (
        interactions.points(),
        interactions.near().points(),
        interactions.near().stored,
    );
    let imposed: Vec<Imposed> = (bodies.iter().enumerate())
        .map(|(i, body)| {
            let class = class(i);
            let shell = class.free().map(|solver| solver.shell());
            Imposed::new(
                body,
                &suspension.background,
                &class.tables.discretization,
                class.tables.n_max,
                shell,
            )
        })
        .collect();
    if let Some(body) = imposed.iter().position(|i| !i.largest.is_finite()) {
        return Err(SuspensionError::Velocity { body });
    }
    let largest = imposed.iter().fold(0.0f64, |most, i| most.max(i.largest));
    let layout = interactions.layout().clone();
    let mut data = vec![0.0; layout.len()];
    let mut forced = vec![0.0; layout.len()];
    for (i, imposed) in imposed.iter().enumerate() {
        let class = class(i);
        let discretization = &class.tables.discretization;
        let mut velocity = imposed.velocity.clone();
        if let (Some(single), Some(solver)) = (&imposed.single, class.free()) {
            velocity = velocity.plus(-1.0, &solver.single_layer(single));
            copy_modes(
                &mut forced[layout.of(i)],
                &single.scaled_by_roots(discretization),
            );
        }
        copy_modes(
            &mut data[layout.of(i)],
            &velocity.scaled_by_roots(discretization),
        );
    }
    if forced.iter().any(|&x| x != 0.0) {
        let mut velocities = vec![0.0; layout.len()];
        single_layers(bodies, &classes, care.product)?.add_velocities(
            &forced,
            &mut velocities,
            care.product,
        )?;
        for (data, velocity) in data.iter_mut().zip(&velocities) {
            *data -= velocity;
        }
    }
    seconds.near = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let mut system = System::new(&classes, interactions, suspension.options.two_level);
    let first = match before {
        Some(before) => Some(start_from(before, &classes, &layout)?),
        None => None,
    };
    let (unknown, iteration) = iterate(
        &mut system,
        &data,
        first,
        care,
        &suspension.options,
        progress,
    )?;
    let densities = system.solve_alone_of(&unknown);
    seconds.iterate = start.elapsed().as_secs_f64();
    seconds.sum = system.interactions.seconds_of_sums;
    let mut solution = Solution {
        unknown: Vec::new(),
        layers: Vec::new(),
        motions: Vec::new(),
        wrenches: Vec::new(),
        iteration,
        seconds,
        unknowns: (0..bodies.len())
            .map(|i| class(i).factors().unknowns())
            .sum(),
        points,
        near_points,
        near_bytes,
        classes: classes.clone(),
    };
    for (i, imposed) in imposed.into_iter().enumerate() {
        let class = class(i);
        let discretization = &class.tables.discretization;
        let of = |field: &[f64]| SurfaceModes::from_scaled(discretization, &field[layout.of(i)]);
        let density = of(&densities);
        let frame = &bodies[i].frame;
        let (motion, layers) = match (class.free(), imposed.single) {
            (Some(solver), Some(single)) => (
                -solver.shell().projection(discretization, &density),
                Layers {
                    double: density,
                    single,
                },
            ),
            _ => (
                match bodies[i].motion {
                    Motion::Given(motion) => frame.motion_to_body(motion),
                    Motion::Free(_) => RigidMotion::rest(),
                },
                Layers::weighted(&density, class.tables.weights),
            ),
        };
        solution.unknown.push(of(&unknown));
        solution.motions.push(motion);
        solution.wrenches.push(match bodies[i].motion {
            Motion::Given(_) => Wrench::of(discretization, &layers.single),
            Motion::Free(wrench) => frame.wrench_to_body(wrench),
        });
        solution.layers.push(layers);
    }
    Ok((solution, largest))
}

/// Copies the modes that both have.
fn copy_modes(to: &mut [f64], from: &[f64]) {
    let count = to.len().min(from.len());
    to[..count].copy_from_slice(&from[..count]);
}

/// The interactions of single layers on the same points.
fn single_layers(
    bodies: &[Body<'_>],
    classes: &Classes,
    tolerance: f64,
) -> Result<Interactions, InteractionError> {
    let tables = classes.iter().map(|class| {
        let of = &class.tables;
        let single = Tables::new(of.discretization.clone(), of.n_max, LayerWeights::SINGLE)?;
        Ok((class, Arc::new(single)))
    });
    let tables: Vec<(&Arc<Class>, Arc<Tables>)> =
        tables.collect::<Result<_, InteractionError>>()?;
    let members = (bodies.iter().enumerate()).filter_map(|(i, body)| {
        let mine = |(class, _): &&(&Arc<Class>, Arc<Tables>)| Arc::ptr_eq(class, classes.of(i));
        Some(Member {
            tables: tables.iter().find(mine)?.1.clone(),
            frame: body.frame,
        })
    });
    Interactions::new(members.collect(), tolerance, 0, &|_| ())
}

/// The unknowns of an earlier solution at these resolutions.
fn start_from(
    before: &Solution,
    classes: &Classes,
    layout: &super::tables::Layout,
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

/// Iterates from a first unknown, if there is one: solves for what it lacks.
fn iterate(
    system: &mut System<'_>,
    data: &[f64],
    first: Option<Vec<f64>>,
    care: Care,
    options: &Options,
    progress: &dyn Progress,
) -> Result<(Vec<f64>, Iteration), SuspensionError> {
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let scale = norm(data);
    let mut lacking = data.to_vec();
    let mut reduced = 1.0;
    if let Some(first) = &first
        && scale > 0.0
    {
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
        return Ok((first.unwrap_or(lacking), iteration));
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
    let outcome = krylov::solve(
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
    Ok((unknown, iteration))
}
