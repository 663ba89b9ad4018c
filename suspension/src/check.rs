//! By how much a solution misses the velocity on the bodies, between the nodes.
//!
//! The layers are put on [finer surfaces](super::finer): four more nodes on each panel, more modes,
//! and therefore other quadrature for everything. There the velocity that they make is compared
//! with the one that was imposed. The difference is the boundary velocity of the error, which
//! solves the Stokes equations too: all that went wrong is in it, be it resolution, quadrature,
//! summation or iteration.

use std::sync::Arc;

use panel_quadrature::QuadratureError;
use rayon::prelude::*;
use stokes_body::discretization::Discretization;
use stokes_body::layers::Layers;
use stokes_body::progress::Progress;
use stokes_body::resolution::{Resolution, checking_modes};
use stokes_body::surface::SurfaceModes;

use super::arrangement::are_coaxial;
use super::class::{Classes, Kind};
use super::error::SuspensionError;
use super::finer::{FinerSurface, Part};
use super::imposed::Imposed;
use super::interactions::{Interactions, Use};
use super::solution::Solution;
use super::sums::Operators;
use super::suspension::{Body, Suspension};
use super::tables::Member;
use super::tolerances::Tolerances;

/// By how much the velocity is off on one body.
#[derive(Clone, Debug)]
pub(crate) struct Miss {
    /// The largest speed.
    pub largest: f64,
    /// The same on each panel, of the lower modes: those that are missing are taken for the upper
    /// ones, whatever the panels are.
    pub panels: Vec<f64>,
    /// The largest coefficient of each mode, the finer surface's included.
    pub modes: Vec<f64>,
}

/// What of a check is kept for the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keep {
    /// Nothing.
    Nothing,
    /// What depends on shapes alone.
    Shapes,
    /// That, and what depends on places: rows of near points up to so many bytes.
    Places {
        /// Bytes.
        rows: usize,
    },
}

/// The finer surfaces of bodies in their places.
pub(crate) struct Checker {
    finer: Vec<Arc<FinerSurface>>,
    finer_of: Vec<usize>,
    keep: Keep,
    interactions: Option<Interactions>,
}

/// The last mode of a class on its finer surface. With one axis for all and no slip, the modes of
/// rigid motions and linear flows are all there are.
fn last_mode(bodies: &[Body], modes: usize) -> usize {
    if are_coaxial(bodies) && bodies.iter().all(|body| body.slip.is_none()) {
        modes
    } else {
        checking_modes(modes)
    }
}

/// The kinds of the bodies on their finer surfaces.
pub(crate) fn finer_kinds(
    bodies: &[Body],
    classes: &Classes,
) -> Result<Vec<Kind>, QuadratureError> {
    let finer: Vec<Kind> = (classes.all().iter())
        .map(|class| {
            let surface = class.finer(last_mode(bodies, class.tables.n_max), false)?;
            Ok(Kind {
                resolution: Arc::new(Resolution {
                    panels: surface.discretization.panels().clone(),
                    order: surface.discretization.order(),
                    modes: surface.n_max,
                }),
                ..class.kind.clone()
            })
        })
        .collect::<Result<_, QuadratureError>>()?;
    let of_bodies = (0..bodies.len()).map(|body| finer[classes.index_of(body)].clone());
    Ok(of_bodies.collect())
}

impl Checker {
    /// The finer surfaces of some bodies.
    pub fn new(bodies: &[Body], classes: &Classes, keep: Keep) -> Result<Self, QuadratureError> {
        let finer = classes.all().iter().map(|class| {
            let n_max = last_mode(bodies, class.tables.n_max);
            class.finer(n_max, keep != Keep::Nothing)
        });
        Ok(Self {
            finer: finer.collect::<Result<_, QuadratureError>>()?,
            finer_of: (0..bodies.len())
                .map(|body| classes.index_of(body))
                .collect(),
            keep,
            interactions: None,
        })
    }

    /// Keeps what depends on places from now on.
    pub fn keep_places(&mut self, rows: usize) {
        self.keep = Keep::Places { rows };
    }

    fn of(&self, body: usize) -> &FinerSurface {
        &self.finer[self.finer_of[body]]
    }

    /// By how much every body's boundary velocity is off.
    pub fn misses(
        &mut self,
        suspension: &Suspension,
        solution: &Solution,
        tolerances: &Tolerances,
        operators: &Operators,
        progress: &dyn Progress,
    ) -> Result<Vec<Miss>, SuspensionError> {
        let bodies = &suspension.bodies;
        progress.begin("checking", self.finer.len() + bodies.len());
        let layers: Vec<Layers> = (0..bodies.len())
            .into_par_iter()
            .map(|body| {
                let from = &solution.classes.of(body).tables.discretization;
                self.of(body).resampled(from, &solution.layers[body])
            })
            .collect::<Result<_, QuadratureError>>()?;
        let own = self.velocities_of_own(&layers, progress)?;
        let product = tolerances.product;
        let others = self.velocities_of_others(bodies, &layers, product, operators, progress)?;
        let misses = own.into_iter().zip(others).enumerate();
        Ok(misses
            .map(|(body, (own, others))| {
                let finer = self.of(body);
                let on = &finer.discretization;
                let asked = &bodies[body];
                let background = &suspension.background;
                let oversampling = tolerances.oversampling;
                let imposed = Imposed::new(asked, background, on, finer.n_max, oversampling, None);
                let mut miss = own.plus(1.0, &others).plus(-1.0, &imposed.velocity);
                if asked.motion.is_found() {
                    let given = asked.frame.motion_to_body(asked.motion.given());
                    let found = solution.motions[body] - given;
                    miss = miss.plus(-1.0, &SurfaceModes::of_motion(on, &found));
                }
                Miss::of(on, &miss, solution.classes.of(body).tables.n_max)
            })
            .collect())
    }

    /// The velocity that each body's layers make on its own surface, from outside.
    fn velocities_of_own(
        &self,
        layers: &[Layers],
        progress: &dyn Progress,
    ) -> Result<Vec<SurfaceModes>, SuspensionError> {
        let mut velocities: Vec<(usize, SurfaceModes)> = Vec::with_capacity(layers.len());
        for (index, finer) in self.finer.iter().enumerate() {
            // A surface that is not kept is a copy: its matrices end with it.
            let passing;
            let finer = if self.keep == Keep::Nothing {
                passing = finer.copy();
                &passing
            } else {
                &**finer
            };
            let alike = (0..layers.len()).filter(|&body| self.finer_of[body] == index);
            let alike: Vec<usize> = alike.collect();
            let of = |&body: &usize| Ok((body, finer.velocity(&layers[body])?));
            let found = alike.par_iter().map(of);
            velocities.extend(found.collect::<Result<Vec<_>, QuadratureError>>()?);
            progress.advance(1);
            if progress.is_cancelled() {
                return Err(SuspensionError::Interrupted);
            }
        }
        velocities.sort_by_key(|&(body, _)| body);
        let velocities = velocities.into_iter().map(|(_, velocity)| velocity);
        Ok(velocities.collect())
    }

    /// The velocity that the layers of all other bodies make on each.
    fn velocities_of_others(
        &mut self,
        bodies: &[Body],
        layers: &[Layers],
        tolerance: f64,
        operators: &Operators,
        progress: &dyn Progress,
    ) -> Result<Vec<SurfaceModes>, SuspensionError> {
        let field = |part: Part| -> Vec<f64> {
            let of_body = |body: usize| self.of(body).field(part, &layers[body]);
            let fields: Vec<Vec<f64>> = (0..layers.len()).into_par_iter().map(of_body).collect();
            fields.concat()
        };
        let [solved, forces] = Part::ALL.map(field);
        let mut velocities = vec![0.0; solved.len()];
        // Bodies that are held, or that nothing pushes, have no layers of the second part.
        let mut fields = vec![&solved[..]];
        if forces.iter().any(|&x| x != 0.0) {
            fields.push(&forces);
        }
        let kept = self.interactions.take();
        let mut interactions = match kept.filter(|kept| kept.densities() == fields.len()) {
            Some(kept) => kept,
            None => self.interactions(bodies, fields.len(), tolerance, operators)?,
        };
        interactions.add_velocities(&fields, &mut velocities, tolerance)?;
        let of_body = |body: usize| {
            let modes = &velocities[interactions.layout().of(body)];
            SurfaceModes::from_scaled(&self.of(body).discretization, modes)
        };
        let of_bodies = (0..bodies.len()).map(of_body).collect();
        progress.advance(bodies.len());
        if let Keep::Places { .. } = self.keep {
            interactions.free_buffers();
            self.interactions = Some(interactions);
        }
        Ok(of_bodies)
    }

    /// The interactions of the first parts of the densities.
    fn interactions(
        &self,
        bodies: &[Body],
        parts: usize,
        tolerance: f64,
        operators: &Operators,
    ) -> Result<Interactions, SuspensionError> {
        let members = |part: Part| -> Vec<Member> {
            let members = bodies.iter().enumerate().map(|(i, body)| Member {
                tables: self.of(i).tables(part).clone(),
                frame: body.frame,
            });
            members.collect()
        };
        let uses = match self.keep {
            Keep::Nothing => Use::Once,
            Keep::Shapes => Use::Often { memory: 0 },
            Keep::Places { rows } => Use::Often {
                memory: rows / parts,
            },
        };
        let solved = members(Part::Solved);
        let of_solved = Interactions::new(solved, tolerance, uses, operators.clone(), &|_| ())?;
        Ok(match parts {
            1 => of_solved,
            _ => of_solved.with_density(members(Part::Forces), operators.clone())?,
        })
    }
}

impl Miss {
    /// What a field on the finer surface says, of a solution with modes up to `n_max`.
    fn of(discretization: &Discretization, field: &SurfaceModes, n_max: usize) -> Self {
        let order = discretization.order();
        let count = 2 * field.modes() + 1;
        let lower = if n_max < 4 { n_max } else { n_max / 2 };
        let resolved = field.clone().truncated(lower + 1);
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
