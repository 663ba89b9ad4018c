//! The equations of all bodies together, preconditioned.
//!
//! With the factors of each body's own equation, $A_{ii}$, as a right preconditioner the system is
//!
//! $$ y_i + \sum_{j \ne i} A_{ij} A_{jj}^{-1} y_j = f_i, \qquad \sigma_i = A_{ii}^{-1} y_i , $$
//!
//! whose unknown $y$ is what each body's layers make on its own surface. A body's own matrix is never applied.

use super::class::Classes;
use super::coarse::Coarse;
use super::interactions::{InteractionError, Interactions};
use super::tables::Batches;
use inexact_krylov::Operator;

/// The operator of the iteration.
pub(crate) struct System {
    classes: Classes,
    pub interactions: Interactions,
    batches: Batches,
    coarse: Option<Coarse>,
    density: Vec<f64>,
    /// Products made.
    pub products: usize,
}

impl System {
    /// The system, with the second level of the preconditioner if `two_level`.
    pub fn new(classes: Classes, interactions: Interactions, two_level: bool) -> Self {
        let members = interactions.members();
        let tractions = (0..members.len()).map(|body| classes.of(body).tractions.clone());
        Self {
            coarse: two_level
                .then(|| Coarse::new(members, tractions.collect()))
                .flatten(),
            batches: Batches::new(members),
            density: Vec::new(),
            classes,
            interactions,
            products: 0,
        }
    }

    /// Gives back what only products need.
    pub fn rest(&mut self) {
        self.density = Vec::new();
        self.interactions.rest();
    }

    /// What the densities make on their own bodies, from the unknown of the preconditioned iteration.
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
    pub fn solve_alone_of(&self, velocities: &[f64]) -> Vec<f64> {
        let mut densities = velocities.to_vec();
        self.solve_alone(&mut densities);
        densities
    }

    fn solve_alone(&self, fields: &mut [f64]) {
        let layout = self.interactions.layout();
        self.batches.apply(layout, fields, |body, n, columns, _| {
            self.classes.of(body).factors().solve_scaled(n, columns);
        });
    }

    /// The product without the second level of the preconditioner.
    pub fn apply_alone(
        &mut self,
        x: &[f64],
        y: &mut [f64],
        tolerance: f64,
    ) -> Result<(), InteractionError> {
        y.copy_from_slice(x);
        self.add_interactions(y, tolerance)
    }

    /// Adds what the layers that make `velocities` on their own bodies make on the others.
    fn add_interactions(
        &mut self,
        velocities: &mut [f64],
        tolerance: f64,
    ) -> Result<(), InteractionError> {
        self.products += 1;
        let mut density = std::mem::take(&mut self.density);
        density.clear();
        density.extend_from_slice(velocities);
        self.solve_alone(&mut density);
        let added = self
            .interactions
            .add_velocities(&density, velocities, tolerance);
        self.density = density;
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
