//! Bodies that are alike: their shape, their resolution, and whether they are held or free. What that takes to solve is made once.

use std::sync::Arc;

use panel_quadrature::QuadratureError;
use rayon::prelude::*;

use super::coarse::RigidTractions;
use super::tables::Tables;
use bodies_of_revolution::GeneratingCurve;
use stokes_body::dirichlet::{DirichletSolver, Formulation};
use stokes_body::discretization::Discretization;
use stokes_body::factors::{ModalFactors, Seconds};
use stokes_body::layers::LayerWeights;
use stokes_body::mobility::MobilitySolver;
use stokes_body::problem::Resolution;
use stokes_body::progress::{Progress, Silent};
use stokes_body::surface_grid::azimuths;

/// What is known of a body: its motion, or the force and torque on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// Its motion, and this equation.
    Held(Formulation),
    /// Force and torque.
    Free,
}

/// What tells bodies apart.
#[derive(Clone, Debug)]
pub(crate) struct Kind {
    pub curve: Arc<dyn GeneratingCurve>,
    pub resolution: Arc<Resolution>,
    pub role: Role,
}

impl PartialEq for Kind {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.curve, &other.curve)
            && self.role == other.role
            && (Arc::ptr_eq(&self.resolution, &other.resolution)
                || self.resolution == other.resolution)
    }
}

impl Kind {
    pub fn discretization(&self) -> Result<Discretization, QuadratureError> {
        let Resolution { panels, order, .. } = &*self.resolution;
        Discretization::new(self.curve.clone(), panels.clone(), *order)
    }

    /// Points of one body.
    pub fn points(&self) -> usize {
        let Resolution {
            panels,
            order,
            modes,
        } = &*self.resolution;
        panels.len() * order * azimuths(*modes)
    }

    /// Entries of the matrices of one class.
    pub fn entries(&self) -> f64 {
        let Resolution {
            panels,
            order,
            modes,
        } = &*self.resolution;
        let unknowns = (3 * panels.len() * order) as f64;
        unknowns * unknowns * (modes + 1) as f64
    }
}

/// A kind of bodies, factored.
#[derive(Debug)]
pub(crate) struct Class {
    pub kind: Kind,
    pub tables: Arc<Tables>,
    solver: Solver,
    /// Of held bodies that move rigidly in the coarse space.
    pub tractions: Option<Arc<RigidTractions>>,
}

#[derive(Debug)]
enum Solver {
    Held(DirichletSolver),
    Free(MobilitySolver),
}

impl Class {
    fn new(kind: Kind) -> Result<Self, QuadratureError> {
        let discretization = kind.discretization()?;
        let modes = kind.resolution.modes;
        let (solver, weights) = match kind.role {
            Role::Held(formulation) => {
                let solver =
                    DirichletSolver::new(discretization.clone(), formulation, modes, &Silent)?;
                let weights = solver.weights();
                (Solver::Held(solver), weights)
            }
            Role::Free => (
                Solver::Free(MobilitySolver::new(discretization.clone(), modes, &Silent)?),
                LayerWeights::DOUBLE,
            ),
        };
        let tractions = match kind.role {
            Role::Held(_) => Some(Arc::new(RigidTractions::new(&discretization)?)),
            Role::Free => None,
        };
        Ok(Self {
            tables: Arc::new(Tables::new(discretization, modes.max(1), weights)?),
            kind,
            solver,
            tractions,
        })
    }

    /// The factors of the equation.
    pub fn factors(&self) -> &ModalFactors {
        match &self.solver {
            Solver::Held(solver) => solver.factors(),
            Solver::Free(solver) => solver.factors(),
        }
    }

    /// How long its matrices took.
    fn seconds(&self) -> Seconds {
        match &self.solver {
            Solver::Held(solver) => solver.seconds(),
            Solver::Free(solver) => solver.seconds(),
        }
    }

    /// How free bodies are solved for; nothing for held ones.
    pub fn free(&self) -> Option<&MobilitySolver> {
        match &self.solver {
            Solver::Held(_) => None,
            Solver::Free(solver) => Some(solver),
        }
    }
}

/// The classes of some bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Classes {
    classes: Vec<Arc<Class>>,
    /// Each body's class.
    of: Vec<usize>,
}

impl Classes {
    /// Makes what the bodies need and `before` does not have.
    pub fn new(
        kinds: &[Kind],
        before: &Self,
        progress: &dyn Progress,
    ) -> Result<Self, QuadratureError> {
        let mut distinct: Vec<&Kind> = Vec::new();
        let of = kinds.iter().map(|kind| {
            let known = distinct.iter().position(|other| *other == kind);
            known.unwrap_or_else(|| {
                distinct.push(kind);
                distinct.len() - 1
            })
        });
        let of: Vec<usize> = of.collect();
        progress.begin("factoring", distinct.len());
        let make = |kind: &&Kind| {
            let known = before.classes.iter().find(|class| class.kind == **kind);
            let class = match known {
                Some(class) => Ok(class.clone()),
                None => Class::new((*kind).clone()).map(Arc::new),
            };
            progress.advance(1);
            class
        };
        let classes = distinct.par_iter().map(make).collect::<Result<_, _>>()?;
        Ok(Self { classes, of })
    }

    /// Which part of the time that the matrices took went into their factors.
    pub fn share_of_factoring(&self) -> f64 {
        let seconds = self.classes.iter().map(|class| class.seconds());
        let [assemble, factor] = seconds.fold([0.0, f64::MIN_POSITIVE], |[a, f], of| {
            [a + of.assemble, f + of.factor]
        });
        factor / (assemble + factor)
    }

    /// The class of a body.
    pub fn of(&self, body: usize) -> &Arc<Class> {
        &self.classes[self.of[body]]
    }

    /// The place of a body's class among them.
    pub fn index_of(&self, body: usize) -> usize {
        self.of[body]
    }

    /// Classes.
    pub fn len(&self) -> usize {
        self.classes.len()
    }

    /// Every class.
    pub fn iter(&self) -> impl Iterator<Item = &Arc<Class>> {
        self.classes.iter()
    }
}
