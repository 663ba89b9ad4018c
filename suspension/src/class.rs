//! Classes of bodies that are alike in shape, resolution and equation. What it takes to solve for
//! one is made once.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;

use panel_quadrature::QuadratureError;
use rayon::prelude::*;

use super::coarse::RigidTractions;
use super::constraint::RigidResponse;
use super::error::SuspensionError;
use super::finer::FinerSurface;
use super::tables::Tables;
use bodies_of_revolution::Shape;
use stokes_body::dirichlet::{DirichletSolver, Formulation};
use stokes_body::discretization::Discretization;
use stokes_body::factors::{ModalFactors, Seconds};
use stokes_body::layers::LayerWeights;
use stokes_body::mobility::MobilitySolver;
use stokes_body::progress::{Progress, Silent};
use stokes_body::resolution::Resolution;
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
    pub shape: Shape,
    pub resolution: Arc<Resolution>,
    pub role: Role,
}

impl PartialEq for Kind {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.shape, &other.shape)
            && self.role == other.role
            && (Arc::ptr_eq(&self.resolution, &other.resolution)
                || self.resolution == other.resolution)
    }
}

impl Kind {
    pub fn discretization(&self) -> Result<Discretization, QuadratureError> {
        let Resolution { panels, order, .. } = &*self.resolution;
        Discretization::new(self.shape.clone(), panels.clone(), *order)
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
    solver: BodySolver,
    /// Made when they are first wanted: few problems need all.
    tractions: OnceLock<Arc<RigidTractions>>,
    response: OnceLock<Arc<RigidResponse>>,
    single_layer: OnceLock<Arc<Tables>>,
    finer: Mutex<Vec<Arc<FinerSurface>>>,
}

#[derive(Debug)]
enum BodySolver {
    Held(DirichletSolver),
    Free(MobilitySolver),
}

impl Class {
    fn new(kind: Kind) -> Result<Self, QuadratureError> {
        let discretization = kind.discretization()?;
        let modes = kind.resolution.modes.max(1);
        let (solver, weights) = match kind.role {
            Role::Held(formulation) => {
                let of = discretization.clone();
                let solver = DirichletSolver::new(of, formulation, modes, &Silent)?;
                let weights = solver.weights();
                (BodySolver::Held(solver), weights)
            }
            Role::Free => {
                let solver = MobilitySolver::new(discretization.clone(), modes, &Silent)?;
                (BodySolver::Free(solver), LayerWeights::DOUBLE)
            }
        };
        Ok(Self {
            tables: Arc::new(Tables::new(discretization, modes, weights)),
            kind,
            solver,
            tractions: OnceLock::new(),
            response: OnceLock::new(),
            single_layer: OnceLock::new(),
            finer: Mutex::default(),
        })
    }

    /// The factors of the equation.
    pub fn factors(&self) -> &ModalFactors {
        match &self.solver {
            BodySolver::Held(solver) => solver.factors(),
            BodySolver::Free(solver) => solver.factors(),
        }
    }

    /// How long its matrices took.
    fn seconds(&self) -> Seconds {
        match &self.solver {
            BodySolver::Held(solver) => solver.seconds(),
            BodySolver::Free(solver) => solver.seconds(),
        }
    }

    /// The solver of free bodies; none for held ones.
    pub fn free(&self) -> Option<&MobilitySolver> {
        match &self.solver {
            BodySolver::Held(_) => None,
            BodySolver::Free(solver) => Some(solver),
        }
    }

    /// The tractions of the rigid motions of held bodies; none for free ones.
    pub fn tractions(&self) -> Result<Option<Arc<RigidTractions>>, QuadratureError> {
        if self.free().is_some() {
            return Ok(None);
        }
        if let Some(made) = self.tractions.get() {
            return Ok(Some(made.clone()));
        }
        let tractions = Arc::new(RigidTractions::new(&self.tables.discretization)?);
        Ok(Some(self.tractions.get_or_init(|| tractions).clone()))
    }

    /// The rigid motions of held bodies and what they take; none for free ones.
    pub fn response(&self) -> Option<Arc<RigidResponse>> {
        let BodySolver::Held(solver) = &self.solver else {
            return None;
        };
        let make = || Arc::new(RigidResponse::new(solver));
        Some(self.response.get_or_init(make).clone())
    }

    /// The tables of single layers on the same points: those of free bodies carry force and torque.
    pub fn single_layer_tables(&self) -> &Arc<Tables> {
        let make = || Arc::new(self.new_single_layer_tables());
        self.single_layer.get_or_init(make)
    }

    /// The same, not kept.
    pub fn new_single_layer_tables(&self) -> Tables {
        let tables = &self.tables;
        Tables::new(
            tables.discretization.clone(),
            tables.n_max,
            LayerWeights::SINGLE,
        )
    }

    /// The finer surface with modes up to `n_max`, `kept` for the next time.
    pub fn finer(&self, n_max: usize, kept: bool) -> Result<Arc<FinerSurface>, QuadratureError> {
        let mut made = self.finer.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(finer) = made.iter().find(|finer| finer.n_max == n_max) {
            return Ok(finer.clone());
        }
        let is_free = self.free().is_some();
        let finer = Arc::new(FinerSurface::new(&self.tables, n_max, is_free)?);
        if kept {
            made.push(finer.clone());
        }
        Ok(finer)
    }
}

/// The classes of some bodies.
#[derive(Clone, Debug, Default)]
pub(crate) struct Classes {
    classes: Vec<Arc<Class>>,
    /// Each body's class.
    of: Vec<usize>,
    /// What was assembled and factored for these bodies.
    seconds: Seconds,
}

impl Classes {
    /// Makes what the bodies need and `known` does not have.
    pub fn new(
        kinds: &[Kind],
        known: &[Arc<Class>],
        progress: &dyn Progress,
    ) -> Result<Self, SuspensionError> {
        let mut distinct: Vec<&Kind> = Vec::new();
        let of = kinds.iter().map(|kind| {
            let before = distinct.iter().position(|other| *other == kind);
            before.unwrap_or_else(|| {
                distinct.push(kind);
                distinct.len() - 1
            })
        });
        let of: Vec<usize> = of.collect();
        let start = Instant::now();
        progress.begin("factoring", distinct.len());
        let make = |kind: &&Kind| {
            let known = known.iter().find(|class| class.kind == **kind);
            if progress.is_cancelled() {
                return Err(SuspensionError::Interrupted);
            }
            let class = match known {
                Some(class) => (class.clone(), Seconds::default()),
                None => {
                    let class = Arc::new(Class::new((*kind).clone())?);
                    let seconds = class.seconds();
                    (class, seconds)
                }
            };
            progress.advance(1);
            Ok(class)
        };
        let made: Vec<(Arc<Class>, Seconds)> =
            (distinct.par_iter().map(make)).collect::<Result<_, SuspensionError>>()?;
        let spent = start.elapsed().as_secs_f64();
        // Classes are made side by side: the wall clock is shared out as the work was.
        let (assemble, factor) = made.iter().fold((0.0, 0.0), |(a, f), (_, of)| {
            (a + of.assemble, f + of.factor)
        });
        let part = factor / (assemble + factor).max(f64::MIN_POSITIVE);
        Ok(Self {
            classes: made.into_iter().map(|(class, _)| class).collect(),
            of,
            seconds: Seconds {
                assemble: (1.0 - part) * spent,
                factor: part * spent,
            },
        })
    }

    /// The wall clock that assembling and factoring took.
    pub fn spent(&self) -> Seconds {
        self.seconds
    }

    /// The class of a body.
    pub fn of(&self, body: usize) -> &Arc<Class> {
        &self.classes[self.of[body]]
    }

    /// The place of a body's class among them.
    pub fn index_of(&self, body: usize) -> usize {
        self.of[body]
    }

    /// Every class.
    pub fn all(&self) -> &[Arc<Class>] {
        &self.classes
    }

    /// The kind of every body.
    pub fn kinds(&self) -> Vec<Kind> {
        self.of
            .iter()
            .map(|&class| self.classes[class].kind.clone())
            .collect()
    }
}
