//! One body: its modal matrices and their factors, boundary problems on it, and the flow around it.
//!
//! Everything here is in the body's own frame: symmetry axis `z`, centre at the origin of its generating curve.
//!
//! | module | what |
//! |---|---|
//! | [`dirichlet`] | Dirichlet problems: equations and solver |
//! | [`mobility`] | bodies that are free to move |
//! | [`discretization`] | panels and nodes on the generating curve |
//! | [`matrix`] | modal Nyström matrices |
//! | [`surface`] | vector fields on the surface and their modes |
//! | [`factors`] | factors of the modal matrices, which belong to the shape |
//! | [`frame`] | the body's frame and the laboratory's |
//! | [`layers`] | the layer potentials that make up a flow |
//! | [`flow`] | velocity, pressure and stress at any point |
//! | [`linear_flow`] | undisturbed flows |
//! | [`body_flow`] | the whole flow, as it was solved for |
//! | [`problem`] | exterior problems, answered with an estimate of the error |
//! | [`resistance`] | resistance and mobility matrices |
//! | [`rigid`] | rigid motions, force and torque |
//! | [`shell`] | the projection onto rigid motions |
//! | [`slip`] | surface velocities of swimmers |
//! | [`stresslet`] | the stresslet |

pub mod body_flow;
mod close;
mod densities;
pub mod dirichlet;
pub mod discretization;
pub mod factors;
pub(crate) mod far;
pub mod flow;
pub mod frame;
pub(crate) mod influence;
pub mod layers;
pub mod linear_flow;
pub mod matrix;
pub mod mobility;
mod near;
#[cfg(test)]
mod near_tests;
mod point_sums;
pub mod problem;
pub(crate) mod refinement;
pub mod resistance;
pub mod rigid;
pub mod shell;
pub mod slip;
mod storage;
pub mod stresslet;
pub mod surface;
pub(crate) mod surface_grid;
