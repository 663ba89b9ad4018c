//! How well, and how, the equations are solved.

use std::sync::Arc;

use inexact_krylov::Method;
use stokes_body::dirichlet::Formulation;
use stokes_body::resolution::Resolution;

/// How well an answer is to be, or how finely the bodies are to be discretised.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Accuracy {
    /// The largest estimated error, as
    /// [`Answer::error_estimate`](super::answer::Answer::error_estimate) counts it, from 1e-14 to
    /// less than 1. Panels and modes are chosen.
    Tolerance(f64),
    /// The same panels and modes for all bodies.
    Uniform {
        /// Panels on each generating curve, of equal arc length on each of its smooth pieces.
        panels: usize,
        /// Nodes on each panel: 10 or 16.
        order: usize,
        /// Azimuthal modes.
        modes: usize,
        /// What sums and iterations are good to.
        tolerance: f64,
    },
    /// A resolution for each body.
    Resolutions {
        /// One for each body.
        of_bodies: Vec<Arc<Resolution>>,
        /// What sums and iterations are good to.
        tolerance: f64,
    },
}

impl Accuracy {
    /// Tolerance of sums and iterations where panels, order and modes are chosen by hand.
    pub const BY_HAND: f64 = 1e-10;

    /// What sums, iterations and the flow are to be good to.
    pub fn tolerance(&self) -> f64 {
        match *self {
            Self::Tolerance(tolerance)
            | Self::Uniform { tolerance, .. }
            | Self::Resolutions { tolerance, .. } => tolerance,
        }
    }

    /// What the estimated error is to be below, if anything.
    pub fn wanted(&self) -> Option<f64> {
        match *self {
            Self::Tolerance(tolerance) => Some(tolerance),
            Self::Uniform { .. } | Self::Resolutions { .. } => None,
        }
    }
}

/// How the equations are solved; the defaults are good.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// How well.
    pub accuracy: Accuracy,
    /// The equation for held bodies; an exterior one.
    pub formulation: Formulation,
    /// The Krylov method.
    pub method: Method,
    /// Most iterations of each solution.
    pub max_iterations: usize,
    /// Relative residual at which an iteration ends; if not given, what the tolerance needs.
    pub residual: Option<f64>,
    /// Levels of the preconditioner: each body by itself, and the rigid motions of all held bodies
    /// together.
    pub levels: Levels,
    /// How inexact the products of the iteration may become as the residual falls, relative to
    /// their results; 0 keeps all of them exact. There is seldom a reason to change it: it saves
    /// time, and the error estimate counts what it costs.
    pub loosest_product: f64,
    /// Bytes that everything together may take; if not given, seven tenths of what the
    /// machine has (feature `machine-memory`) or of 8 GiB.
    pub memory: Option<usize>,
}

/// Levels of the preconditioner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Levels {
    /// Every body by itself.
    One,
    /// And the rigid motions of all held bodies together.
    Two,
}

impl Options {
    /// The defaults for a tolerance.
    pub fn tolerance(tolerance: f64) -> Self {
        Self::new(Accuracy::Tolerance(tolerance))
    }

    /// The defaults for an accuracy.
    pub fn new(accuracy: Accuracy) -> Self {
        Self {
            accuracy,
            formulation: Formulation::CombinedField,
            method: Method::Gmres { restart: 200 },
            max_iterations: 200,
            residual: None,
            levels: Levels::Two,
            loosest_product: 1e-3,
            memory: None,
        }
    }
}

impl Default for Options {
    /// A tolerance of 1e-8, as in case files.
    fn default() -> Self {
        Self::tolerance(1e-8)
    }
}
