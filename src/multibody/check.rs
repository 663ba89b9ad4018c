//! By how much a solution misses the velocity on the bodies, between the nodes.
//!
//! The layers are put on finer surfaces: four more nodes on each panel, more modes, and therefore other quadrature for everything. There the velocity that
//! they make is compared with the one that was imposed. The difference is the boundary velocity of the error, which solves the Stokes
//! equations too: all that went wrong is in it, be it resolution, quadrature, summation or iteration.

use std::f64::consts::PI;
use std::sync::Arc;

use rayon::prelude::*;

use super::SuspensionError;
use super::class::Class;
use super::interactions::Interactions;
use super::resolution::are_coaxial;
use super::solution::{Imposed, Solution};
use super::sums::Operators;
use super::suspension::{Motion, Suspension};
use super::tables::{Member, Tables};
use crate::body::discretization::Discretization;
use crate::body::layers::{LayerWeights, Layers};
use crate::body::matrix::{LayerPotential, ModalMatrices};
use crate::body::problem::checking_modes;
use crate::body::refinement::EXTRA_ORDER;
use crate::body::surface::SurfaceModes;
use crate::kernel::{CombinedField, DoubleLayer};
use crate::progress::Progress;

/// What one body's boundary velocity is off by.
#[derive(Clone, Debug)]
pub(crate) struct Miss {
    /// The largest speed.
    pub largest: f64,
    /// The same on each panel, of the modes that the solution has.
    pub panels: Vec<f64>,
    /// The largest coefficient of each mode, the finer surface's included.
    pub modes: Vec<f64>,
}

/// A class on its finer surface.
struct Finer {
    class: Arc<Class>,
    discretization: Discretization,
    n_max: usize,
}

/// What every body's boundary velocity is off by; sums to `tolerance`.
pub(crate) fn misses(
    suspension: &Suspension<'_>,
    solution: &Solution,
    tolerance: f64,
    operators: &Operators,
    progress: &dyn Progress,
) -> Result<Vec<Miss>, SuspensionError> {
    let classes = &solution.classes;
    let bodies = &suspension.bodies;
    progress.begin("checking", classes.len() + bodies.len());
    // With one axis for all, the modes of rigid motions and linear flows are all there are.
    let exact = are_coaxial(bodies) && bodies.iter().all(|body| body.slip.is_none());
    let finer: Vec<Finer> = classes
        .iter()
        .map(|class| {
            let from = &class.tables.discretization;
            Ok(Finer {
                class: class.clone(),
                discretization: from.with_order(from.order() + EXTRA_ORDER)?,
                n_max: if exact {
                    class.tables.n_max
                } else {
                    checking_modes(class.tables.n_max)
                },
            })
        })
        .collect::<Result<_, SuspensionError>>()?;
    let of = |body: usize| {
        let class = classes.of(body);
        finer.iter().position(|f| Arc::ptr_eq(&f.class, class))
    };
    let finer_of: Vec<usize> = (0..bodies.len()).filter_map(of).collect();
    let layers: Vec<Layers> = (0..bodies.len())
        .into_par_iter()
        .map(|i| {
            let Finer {
                class,
                discretization,
                n_max,
            } = &finer[finer_of[i]];
            let resampled = |field: &SurfaceModes| {
                field.resampled(&class.tables.discretization, discretization, *n_max)
            };
            Ok(Layers {
                double: resampled(&solution.layers[i].double)?,
                single: resampled(&solution.layers[i].single)?,
            })
        })
        .collect::<Result<_, SuspensionError>>()?;
    let mut own: Vec<Option<SurfaceModes>> = vec![None; bodies.len()];
    for (index, of_class) in finer.iter().enumerate() {
        let alike: Vec<usize> = (0..bodies.len())
            .filter(|&i| finer_of[i] == index)
            .collect();
        let alone = alone(of_class, &alike, &layers)?;
        for (body, velocity) in alike.into_iter().zip(alone) {
            own[body] = Some(velocity);
        }
        progress.advance(1);
        if progress.is_cancelled() {
            return Err(SuspensionError::Interrupted);
        }
    }
    let others = from_others(
        suspension, &finer, &finer_of, &layers, tolerance, operators, progress,
    )?;
    let misses = own.into_iter().flatten().zip(others).enumerate();
    Ok(misses
        .map(|(i, (own, others))| {
            let Finer {
                class,
                discretization,
                n_max,
            } = &finer[finer_of[i]];
            let body = &bodies[i];
            let imposed = Imposed::new(body, &suspension.background, discretization, *n_max, None);
            let mut miss = own.plus(1.0, &others).plus(-1.0, &imposed.velocity);
            if let Motion::Free(_) = body.motion {
                miss = miss.plus(-1.0, &solution.motions[i].on(discretization));
            }
            Miss::of(discretization, &miss, class.tables.n_max)
        })
        .collect())
}

/// The velocity that the layers of some bodies of one class make on their own surface, from outside.
fn alone(
    finer: &Finer,
    bodies: &[usize],
    layers: &[Layers],
) -> Result<Vec<SurfaceModes>, SuspensionError> {
    let Finer {
        class,
        discretization,
        n_max,
    } = finer;
    let weights = class.tables.weights;
    let is_free = class.free().is_some();
    // A held body's layers have one density; a free body's single layer is a rigid motion.
    let (matrices, of_single) = if is_free {
        let double = ModalMatrices::assemble(discretization, &DoubleLayer, 0.5, *n_max, &|| ())?;
        let single = ModalMatrices::of(LayerPotential::Single, discretization, 1)?;
        (double, Some(single))
    } else if weights.double == 0.0 {
        let single = ModalMatrices::of(LayerPotential::Single, discretization, *n_max)?;
        return Ok(bodies
            .iter()
            .map(|&body| single.apply(discretization, &layers[body].single))
            .collect());
    } else {
        let kernel = CombinedField {
            eta: weights.single / weights.double,
        };
        let both = ModalMatrices::assemble(discretization, &kernel, 0.5, *n_max, &|| ())?;
        (both, None)
    };
    let velocity = |&body: &usize| {
        let both = matrices.apply(discretization, &layers[body].double);
        match &of_single {
            Some(single) => both.plus(1.0, &single.apply(discretization, &layers[body].single)),
            None => both,
        }
    };
    Ok(bodies.par_iter().map(velocity).collect())
}

/// What the densities of a sum are.
#[derive(Clone, Copy, Debug)]
enum Part {
    /// Those that were solved for.
    Solved,
    /// The single layers of free bodies.
    Forces,
}

/// Whether the density that was solved for is that of a double layer, and perhaps of a single layer too.
fn layers_have_double(finer: &Finer) -> bool {
    finer.class.tables.weights.double != 0.0
}

/// The velocity that the layers of all other bodies make on each.
fn from_others(
    suspension: &Suspension<'_>,
    finer: &[Finer],
    finer_of: &[usize],
    layers: &[Layers],
    tolerance: f64,
    operators: &Operators,
    progress: &dyn Progress,
) -> Result<Vec<SurfaceModes>, SuspensionError> {
    let discretization = |body: usize| &finer[finer_of[body]].discretization;
    let mut sum: Vec<SurfaceModes> = (0..layers.len())
        .map(|i| SurfaceModes::zero(0, discretization(i).nodes().len()))
        .collect();
    for part in [Part::Solved, Part::Forces] {
        let fields: Vec<Vec<f64>> = layers
            .iter()
            .enumerate()
            .map(|(i, layers)| {
                let is_free = finer[finer_of[i]].class.free().is_some();
                let density = match part {
                    Part::Solved if layers_have_double(&finer[finer_of[i]]) => &layers.double,
                    Part::Solved => &layers.single,
                    Part::Forces if is_free => &layers.single,
                    Part::Forces => &SurfaceModes::zero(0, discretization(i).nodes().len()),
                };
                let mut field = density.scaled_by_roots(discretization(i));
                field.resize(
                    6 * (finer[finer_of[i]].n_max + 1) * discretization(i).nodes().len(),
                    0.0,
                );
                field
            })
            .collect();
        let fields = fields.concat();
        if fields.iter().all(|&x| x == 0.0) {
            continue;
        }
        let tables: Vec<Arc<Tables>> = finer
            .iter()
            .map(|f| {
                let weights = match part {
                    Part::Solved => f.class.tables.weights,
                    Part::Forces => LayerWeights::SINGLE,
                };
                let tables = Tables::new(f.discretization.clone(), f.n_max, weights)?;
                Ok(Arc::new(tables))
            })
            .collect::<Result<_, SuspensionError>>()?;
        let members = suspension
            .bodies
            .iter()
            .zip(finer_of)
            .map(|(body, &index)| Member {
                tables: tables[index].clone(),
                frame: body.frame,
            });
        // The rows are needed once.
        let mut interactions =
            Interactions::new(members.collect(), tolerance, 0, operators.clone(), &|_| ())?;
        let mut velocities = vec![0.0; fields.len()];
        interactions.add_velocities(&fields, &mut velocities, tolerance)?;
        let layout = interactions.layout();
        for (i, sum) in sum.iter_mut().enumerate() {
            let mine = SurfaceModes::from_scaled(discretization(i), &velocities[layout.of(i)]);
            *sum = std::mem::replace(sum, SurfaceModes::zero(0, 0)).plus(1.0, &mine);
        }
        progress.advance(suspension.bodies.len() / 2);
    }
    Ok(sum)
}

impl Miss {
    /// What a field on the finer surface says, of a solution with modes up to `n_max`.
    fn of(discretization: &Discretization, field: &SurfaceModes, n_max: usize) -> Self {
        let order = discretization.order();
        let count = 2 * field.modes() + 1;
        let resolved = field.clone().truncated(n_max + 1);
        let magnitude = |field: &SurfaceModes, k: usize| {
            let speeds = (0..count).map(|l| {
                let [r, t, z] = field.at(k, 2.0 * PI * l as f64 / count as f64);
                (r * r + t * t + z * z).sqrt()
            });
            // `max` would pass over a NaN.
            speeds.fold(0.0, |most: f64, x| if x.is_nan() { x } else { most.max(x) })
        };
        let on_nodes = |field: &SurfaceModes| -> Vec<f64> {
            (0..discretization.nodes().len())
                .into_par_iter()
                .map(|k| magnitude(field, k))
                .collect()
        };
        let most = |speeds: &[f64]| speeds.iter().copied().fold(0.0, f64::max);
        Self {
            largest: most(&on_nodes(field)),
            panels: on_nodes(&resolved).chunks(order).map(most).collect(),
            modes: (0..field.modes()).map(|n| field.amplitude(n)).collect(),
        }
    }
}
