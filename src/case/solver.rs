//! How the linear system is formulated and solved.

use super::CaseError;
use super::accuracy::read_tolerance;
use super::node::Node;
use super::section::Section;

/// What `[solver]` asks for. One body is solved for directly, which uses only the formulation.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SolverOptions {
    /// The integral equation.
    pub formulation: Formulation,
    /// The Krylov method.
    pub method: Method,
    /// Relative residual at which iterations stop; `None` leaves it to the accuracy asked.
    pub tolerance: Option<f64>,
    /// Most iterations.
    pub max_iterations: usize,
    /// Most memory that many bodies may take, in GiB; `None` leaves it to what the machine has.
    pub memory: Option<f64>,
}

impl Default for SolverOptions {
    fn default() -> Self {
        Self {
            formulation: Formulation::default(),
            method: Method::default(),
            tolerance: None,
            max_iterations: 200,
            memory: None,
        }
    }
}

/// The integral equation of the exterior problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Formulation {
    /// Single and double layer together: second kind, well conditioned.
    #[default]
    Combined,
    /// The single layer alone, as in the thesis: first kind.
    SingleLayer,
}

/// The Krylov method of an iterative solve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// GMRES.
    #[default]
    Gmres,
    /// BiCGSTAB.
    BiCgStab,
}

/// Reads `[solver]`.
pub(super) fn read_solver(node: Node<'_>) -> Result<SolverOptions, CaseError> {
    let keys = [
        "formulation",
        "method",
        "tolerance",
        "max_iterations",
        "memory",
    ];
    let section = Section::new(node, &keys)?;
    let formulations = [
        ("combined", Formulation::Combined),
        ("single-layer", Formulation::SingleLayer),
    ];
    let methods = [("gmres", Method::Gmres), ("bicgstab", Method::BiCgStab)];
    let default = SolverOptions::default();
    Ok(SolverOptions {
        formulation: section
            .read("formulation", |node| node.choice(&formulations))?
            .unwrap_or_default(),
        method: section
            .read("method", |node| node.choice(&methods))?
            .unwrap_or_default(),
        tolerance: section.read("tolerance", read_tolerance)?,
        max_iterations: section
            .read("max_iterations", |node| {
                node.integer("a number of iterations", 1..=1_000_000)
            })?
            .unwrap_or(default.max_iterations),
        memory: section.read("memory", |node| node.positive("a number of GiB"))?,
    })
}
