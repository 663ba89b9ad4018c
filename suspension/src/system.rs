//! The equations of all bodies together, preconditioned.
//!
//! With the factors of each body's own equation, $A_{ii}$, as a right preconditioner the system is
//!
//! $$ y_i + \sum_{j \ne i} A_{ij} A_{jj}^{-1} y_j = f_i, \qquad \sigma_i = A_{ii}^{-1} y_i , $$
//!
//! whose unknown $y$ is what each body's layers make on its own surface. A body's own matrix is
//! never applied. For a body that is free in some directions, what the others do to it is projected
//! (see [`constraint`](super::constraint)).

use panel_quadrature::QuadratureError;

use super::batches::Batches;
use super::class::Classes;
use super::coarse::Coarse;
use super::constraint::Constraint;
use super::interactions::{InteractionError, Interactions};
use super::options::Levels;
use inexact_krylov::Operator;

/// The operator of the iteration.
pub(crate) struct System {
    classes: Classes,
    pub interactions: Interactions,
    batches: Batches,
    coarse: Option<Coarse>,
    constraints: Vec<Option<Constraint>>,
    density: Vec<f64>,
    /// Products made.
    pub products: usize,
}

impl System {
    /// The system, with as many levels of the preconditioner.
    pub fn new(
        classes: Classes,
        interactions: Interactions,
        constraints: Vec<Option<Constraint>>,
        levels: Levels,
    ) -> Result<Self, QuadratureError> {
        let members = interactions.members();
        let coarse = match levels {
            Levels::One => None,
            Levels::Two => {
                let tractions = (0..members.len()).map(|body| classes.of(body).tractions());
                let tractions = tractions.collect::<Result<Vec<_>, QuadratureError>>()?;
                Coarse::new(members, tractions, &constraints)
            }
        };
        Ok(Self {
            coarse,
            constraints,
            batches: Batches::new(members),
            density: Vec::new(),
            classes,
            interactions,
            products: 0,
        })
    }

    /// Frees the buffers of products.
    pub fn free_buffers(&mut self) {
        self.density = Vec::new();
        self.interactions.free_buffers();
    }

    /// The velocities that the densities make on their own bodies, from the unknown of the
    /// preconditioned iteration.
    pub fn improved(&self, unknown: &[f64]) -> Vec<f64> {
        let mut improved = unknown.to_vec();
        self.improve(&mut improved);
        improved
    }

    fn improve(&self, unknown: &mut [f64]) {
        if let Some(coarse) = &self.coarse {
            coarse.apply(self.interactions.layout(), unknown);
        }
    }

    /// The densities that make these velocities on their own bodies.
    pub fn densities(&self, velocities: &[f64]) -> Vec<f64> {
        let mut densities = velocities.to_vec();
        self.solve_bodies(&mut densities);
        densities
    }

    fn solve_bodies(&self, fields: &mut [f64]) {
        let layout = self.interactions.layout();
        self.batches.apply(layout, fields, |body, n, columns, _| {
            self.classes.of(body).factors().solve_scaled(n, columns);
        });
    }

    /// The product without the second level of the preconditioner.
    pub fn apply_without_coarse(
        &mut self,
        x: &[f64],
        y: &mut [f64],
        tolerance: f64,
    ) -> Result<(), InteractionError> {
        y.copy_from_slice(x);
        self.add_interactions(y, tolerance)
    }

    /// The velocities that the layers which make `velocities` on their own bodies make on all
    /// others.
    pub fn velocities_of_others(
        &mut self,
        velocities: &[f64],
        tolerance: f64,
    ) -> Result<Vec<f64>, InteractionError> {
        let density = self.densities(velocities);
        let mut of_others = vec![0.0; velocities.len()];
        let interactions = &mut self.interactions;
        interactions.add_velocities(&[&density], &mut of_others, tolerance)?;
        Ok(of_others)
    }

    /// Adds what the layers that make `velocities` on their own bodies make on the others, as far
    /// as the constraints let it act.
    fn add_interactions(
        &mut self,
        velocities: &mut [f64],
        tolerance: f64,
    ) -> Result<(), InteractionError> {
        self.products += 1;
        let mut density = std::mem::take(&mut self.density);
        density.clear();
        density.extend_from_slice(velocities);
        let layout = self.interactions.layout();
        let before: Vec<(usize, Vec<f64>)> = (self.constraints.iter().enumerate())
            .filter_map(|(body, constraint)| {
                let first = constraint.as_ref()?.len();
                Some((body, velocities[layout.of(body)][..first].to_vec()))
            })
            .collect();
        self.solve_bodies(&mut density);
        let added = self
            .interactions
            .add_velocities(&[&density], velocities, tolerance);
        self.density = density;
        let layout = self.interactions.layout();
        for (body, before) in before {
            if let Some(constraint) = &self.constraints[body] {
                let now = &mut velocities[layout.of(body)][..before.len()];
                let mut of_others: Vec<f64> = now.iter().zip(&before).map(|(a, b)| a - b).collect();
                constraint.project(&mut of_others);
                for ((now, before), of_others) in now.iter_mut().zip(before).zip(of_others) {
                    *now = before + of_others;
                }
            }
        }
        added
    }
}

impl Operator for System {
    type Error = InteractionError;

    fn apply(&mut self, x: &[f64], y: &mut [f64], tolerance: f64) -> Result<(), InteractionError> {
        y.copy_from_slice(x);
        self.improve(y);
        self.add_interactions(y, tolerance)
    }
}
