//! By how much a solution misses the velocity on the bodies, between the nodes.
//!
//! The layers are put on finer surfaces: four more nodes on each panel, more modes, and therefore other quadrature for everything. There the velocity that
//! they make is compared with the one that was imposed. The difference is the boundary velocity of the error, which solves the Stokes
//! equations too: all that went wrong is in it, be it resolution, quadrature, summation or iteration.

use std::sync::Arc;

use rayon::prelude::*;

use super::SuspensionError;
use super::class::{Class, Classes, Kind};
use super::interactions::{Interactions, Use};
use super::resolution::are_coaxial;
use super::solution::{Imposed, Solution};
use super::sums::Operators;
use super::suspension::{Body, Motion, Suspension};
use super::tables::{Member, Tables};
use stokes_body::discretization::Discretization;
use stokes_body::layers::{LayerWeights, Layers};
use stokes_body::matrix::{LayerPotential, ModalMatrices};
use stokes_body::problem::{Resolution, checking_modes};
use stokes_body::progress::Progress;
use stokes_body::refinement::EXTRA_ORDER;
use stokes_body::surface::SurfaceModes;

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

/// What a body's layers make on its own surface, from outside.
enum Own {
    /// A held body's layers have one density.
    Both(ModalMatrices),
    /// It may have a single layer only.
    Single(ModalMatrices),
    /// A free body's single layer is a rigid motion.
    Free {
        double: ModalMatrices,
        single: ModalMatrices,
    },
}

/// What the densities of a sum are.
#[derive(Clone, Copy, Debug)]
enum Part {
    /// Those that were solved for.
    Solved,
    /// The single layers of free bodies.
    Forces,
}

const PARTS: [Part; 2] = [Part::Solved, Part::Forces];

/// What a check takes, whatever was asked of the bodies.
pub(crate) struct Checker {
    finer: Vec<Finer>,
    finer_of: Vec<usize>,
    /// Kept from one check to the next, if there are several.
    kept: Option<Kept>,
}

struct Kept {
    own: Vec<Own>,
    interactions: [Option<Interactions>; PARTS.len()],
    /// Bytes for the rows of near points, of each part.
    memory: usize,
}

impl Checker {
    /// The finer surfaces of some bodies. If there will be more than one check, what does not depend on the densities is `kept`, rows
    /// of near points in so many bytes.
    pub fn new(
        bodies: &[Body<'_>],
        classes: &Classes,
        kept: Option<usize>,
    ) -> Result<Self, SuspensionError> {
        // With one axis for all, the modes of rigid motions and linear flows are all there are.
        let exact = are_coaxial(bodies) && bodies.iter().all(|body| body.slip.is_none());
        let finer = classes.iter().map(|class| {
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
        });
        Ok(Self {
            finer: finer.collect::<Result<_, SuspensionError>>()?,
            finer_of: (0..bodies.len())
                .map(|body| classes.index_of(body))
                .collect(),
            kept: kept.map(|memory| Kept {
                own: Vec::new(),
                interactions: [const { None }; PARTS.len()],
                memory: memory / PARTS.len(),
            }),
        })
    }

    /// The classes on their finer surfaces.
    pub fn kinds(&self) -> impl Iterator<Item = Kind> {
        self.finer.iter().map(|finer| Kind {
            resolution: Arc::new(Resolution {
                panels: finer.discretization.panels().clone(),
                order: finer.discretization.order(),
                modes: finer.n_max,
            }),
            ..finer.class.kind.clone()
        })
    }

    fn of(&self, body: usize) -> &Finer {
        &self.finer[self.finer_of[body]]
    }

    /// What every body's boundary velocity is off by; sums to `tolerance`.
    pub fn misses(
        &mut self,
        suspension: &Suspension<'_>,
        solution: &Solution,
        tolerance: f64,
        operators: &Operators,
        progress: &dyn Progress,
    ) -> Result<Vec<Miss>, SuspensionError> {
        let bodies = &suspension.bodies;
        progress.begin("checking", self.finer.len() + bodies.len());
        let layers: Vec<Layers> = (0..bodies.len())
            .into_par_iter()
            .map(|body| {
                let finer = self.of(body);
                let from = &finer.class.tables.discretization;
                let resampled = |field: &SurfaceModes| {
                    field.resampled(from, &finer.discretization, finer.n_max)
                };
                Ok(Layers {
                    double: resampled(&solution.layers[body].double)?,
                    single: resampled(&solution.layers[body].single)?,
                })
            })
            .collect::<Result<_, SuspensionError>>()?;
        let own = self.velocities_of_own(&layers, progress)?;
        let others = self.velocities_of_others(bodies, &layers, tolerance, operators, progress)?;
        let misses = own.into_iter().zip(others).enumerate();
        Ok(misses
            .map(|(body, (own, others))| {
                let Finer {
                    class,
                    discretization,
                    n_max,
                } = self.of(body);
                let asked = &bodies[body];
                let background = &suspension.background;
                let imposed = Imposed::new(asked, background, discretization, *n_max, None);
                let mut miss = own.plus(1.0, &others).plus(-1.0, &imposed.velocity);
                if let Motion::Free(_) = asked.motion {
                    miss = miss.plus(
                        -1.0,
                        &SurfaceModes::of_motion(discretization, &solution.motions[body]),
                    );
                }
                Miss::of(discretization, &miss, class.tables.n_max)
            })
            .collect())
    }

    /// The velocity that each body's layers make on its own surface, from outside.
    fn velocities_of_own(
        &mut self,
        layers: &[Layers],
        progress: &dyn Progress,
    ) -> Result<Vec<SurfaceModes>, SuspensionError> {
        let mut velocities: Vec<(usize, SurfaceModes)> = Vec::with_capacity(layers.len());
        for (index, finer) in self.finer.iter().enumerate() {
            let known = self.kept.as_ref().and_then(|kept| kept.own.get(index));
            let made = match known {
                Some(_) => None,
                None => Some(Own::new(finer)?),
            };
            if let Some(own) = known.or(made.as_ref()) {
                let alike = (0..layers.len()).filter(|&body| self.finer_of[body] == index);
                let alike: Vec<usize> = alike.collect();
                let of = |&body: &usize| (body, own.velocity(&finer.discretization, &layers[body]));
                velocities.par_extend(alike.par_iter().map(of));
            }
            if let (Some(kept), Some(made)) = (&mut self.kept, made) {
                kept.own.push(made);
            }
            progress.advance(1);
            if progress.is_cancelled() {
                return Err(SuspensionError::Interrupted);
            }
        }
        velocities.sort_by_key(|&(body, _)| body);
        Ok(velocities
            .into_iter()
            .map(|(_, velocity)| velocity)
            .collect())
    }

    /// The velocity that the layers of all other bodies make on each.
    fn velocities_of_others(
        &mut self,
        bodies: &[Body<'_>],
        layers: &[Layers],
        tolerance: f64,
        operators: &Operators,
        progress: &dyn Progress,
    ) -> Result<Vec<SurfaceModes>, SuspensionError> {
        let zero = |body: usize| SurfaceModes::zero(0, self.of(body).discretization.nodes().len());
        let mut sum: Vec<SurfaceModes> = (0..layers.len()).map(zero).collect();
        for part in PARTS {
            let fields: Vec<Vec<f64>> = (0..layers.len())
                .into_par_iter()
                .map(|body| self.of(body).field(part, &layers[body]))
                .collect();
            let fields = fields.concat();
            if fields.iter().all(|&x| x == 0.0) {
                continue;
            }
            let known = self
                .kept
                .as_mut()
                .and_then(|kept| kept.interactions[part as usize].take());
            let mut interactions = match known {
                Some(known) => known,
                None => self.interactions(bodies, part, tolerance, operators)?,
            };
            let mut velocities = vec![0.0; fields.len()];
            interactions.add_velocities(&fields, &mut velocities, tolerance)?;
            for (body, sum) in sum.iter_mut().enumerate() {
                let mine = &velocities[interactions.layout().of(body)];
                let mine = SurfaceModes::from_scaled(&self.of(body).discretization, mine);
                *sum = std::mem::replace(sum, SurfaceModes::zero(0, 0)).plus(1.0, &mine);
            }
            if let Some(kept) = &mut self.kept {
                interactions.rest();
                kept.interactions[part as usize] = Some(interactions);
            }
            progress.advance(bodies.len() / PARTS.len());
        }
        Ok(sum)
    }

    fn interactions(
        &self,
        bodies: &[Body<'_>],
        part: Part,
        tolerance: f64,
        operators: &Operators,
    ) -> Result<Interactions, SuspensionError> {
        let tables = self.finer.iter().map(|finer| {
            let weights = match part {
                Part::Solved => finer.class.tables.weights,
                Part::Forces => LayerWeights::SINGLE,
            };
            let tables = Tables::new(finer.discretization.clone(), finer.n_max, weights)?;
            Ok(Arc::new(tables))
        });
        let tables: Vec<Arc<Tables>> = tables.collect::<Result<_, SuspensionError>>()?;
        let members = bodies
            .iter()
            .zip(&self.finer_of)
            .map(|(body, &index)| Member {
                tables: tables[index].clone(),
                frame: body.frame,
            });
        let uses = self.kept.as_ref().map_or(Use::Once, |kept| Use::Often {
            memory: kept.memory,
        });
        Ok(Interactions::new(
            members.collect(),
            tolerance,
            uses,
            operators.clone(),
            &|_| (),
        )?)
    }
}

impl Finer {
    /// The scaled modes of a part of the densities.
    fn field(&self, part: Part, layers: &Layers) -> Vec<f64> {
        let nodes = self.discretization.nodes().len();
        let mut field = match part {
            Part::Solved if self.class.tables.weights.double != 0.0 => {
                layers.double.scaled_by_roots(&self.discretization)
            }
            Part::Forces if self.class.free().is_none() => Vec::new(),
            Part::Solved | Part::Forces => layers.single.scaled_by_roots(&self.discretization),
        };
        field.resize(6 * (self.n_max + 1) * nodes, 0.0);
        field
    }
}

impl Own {
    fn new(finer: &Finer) -> Result<Self, SuspensionError> {
        let Finer {
            class,
            discretization,
            n_max,
        } = finer;
        let weights = class.tables.weights;
        let matrices = ModalMatrices::from_outside(discretization, weights, *n_max)?;
        if class.free().is_some() {
            return Ok(Self::Free {
                double: matrices,
                single: ModalMatrices::of(LayerPotential::Single, discretization, 1)?,
            });
        }
        Ok(if weights.double == 0.0 {
            Self::Single(matrices)
        } else {
            Self::Both(matrices)
        })
    }

    fn velocity(&self, discretization: &Discretization, layers: &Layers) -> SurfaceModes {
        match self {
            Self::Both(both) => both.apply(discretization, &layers.double),
            Self::Single(single) => single.apply(discretization, &layers.single),
            Self::Free { double, single } => {
                let of_single = single.apply(discretization, &layers.single);
                double
                    .apply(discretization, &layers.double)
                    .plus(1.0, &of_single)
            }
        }
    }
}

impl Miss {
    /// What a field on the finer surface says, of a solution with modes up to `n_max`.
    fn of(discretization: &Discretization, field: &SurfaceModes, n_max: usize) -> Self {
        let order = discretization.order();
        let count = 2 * field.modes() + 1;
        let resolved = field.clone().truncated(n_max + 1);
        let on_nodes = |field: &SurfaceModes| -> Vec<f64> {
            (0..discretization.nodes().len())
                .into_par_iter()
                .map(|k| field.length_at(k, count))
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
