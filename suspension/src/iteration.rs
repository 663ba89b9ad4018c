//! The iteration that finds the densities of all bodies.

use inexact_krylov::{Control, KrylovError, Outcome, Stop};
use stokes_body::progress::Progress;

use super::error::SuspensionError;
use super::interactions::InteractionError;
use super::options::Options;
use super::system::System;
use super::tolerances::Tolerances;

/// How an iteration went.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
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

impl Iteration {
    /// This one and what it was after.
    pub(crate) fn after(self, mut before: Self) -> Self {
        // It began where the other one ended.
        before.history.extend(self.history.into_iter().skip(1));
        Self {
            iterations: before.iterations + self.iterations,
            products: before.products + self.products,
            history: before.history,
            residual: self.residual,
            stop: self.stop,
        }
    }

    /// No iteration: the equations were solved directly.
    pub(crate) fn direct() -> Self {
        Self {
            iterations: 0,
            products: 0,
            residual: 0.0,
            stop: Stop::Converged,
            history: vec![0.0],
        }
    }
}

/// What an iteration ends with.
pub(crate) struct Iterated {
    pub unknown: Vec<f64>,
    /// The residual, as a vector.
    pub residual: Vec<f64>,
    pub iteration: Iteration,
}

/// Iterates from a first unknown, if there is one: solves for what it lacks.
pub(crate) fn iterate(
    system: &mut System,
    data: &[f64],
    first: Option<Vec<f64>>,
    tolerances: Tolerances,
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
        system.apply_without_coarse(first, &mut product, tolerances.product)?;
        for (lacking, product) in lacking.iter_mut().zip(&product) {
            *lacking -= product;
        }
        reduced = norm(&lacking) / scale;
    }
    let tolerance = tolerances.residual / reduced;
    if reduced <= tolerances.residual {
        let iteration = Iteration {
            iterations: 0,
            products: system.products,
            residual: reduced,
            stop: Stop::Converged,
            history: vec![reduced],
        };
        return Ok(Iterated {
            unknown: first.unwrap_or_else(|| vec![0.0; data.len()]),
            residual: lacking,
            iteration,
        });
    }
    let control = Control {
        tolerance,
        max_iterations: options.max_iterations,
        safety: (tolerances.product / tolerances.residual).min(0.5),
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
        residual: residual_vector,
        iteration,
    })
}
