//! One body: its modal matrices and their factors, boundary problems on it, and the flow around it.
//!
//! Everything here is in the body's own frame: symmetry axis `z`, centre at the origin of its
//! generating curve.
//!
//! | module | what |
//! |---|---|
//! | [`special`] | toroidal functions |
//! | [`kernel`] | kernels of the layer potentials in space and mode by mode: signs, scaling |
//! | [`dirichlet`] | Dirichlet problems: equations and solver |
//! | [`mobility`] | bodies that are free to move |
//! | [`discretization`] | panels and nodes on the generating curve |
//! | [`matrix`] | modal Nyström matrices |
//! | [`surface`], `fft` | vector fields on the surface and their modes |
//! | [`factors`] | factors of the modal matrices, which belong to the shape |
//! | [`layers`] | the layer potentials that make up a flow |
//! | [`flow`] | velocity, pressure and stress at any point |
//! | [`linear_flow`] | undisturbed flows |
//! | [`resolution`] | how finely a body is discretised |
//! | [`resistance`] | all resistance and mobility functions, to a tolerance |
//! | `rigid_matrices` | resistance and mobility matrices and their scalar functions |
//! | `rigid` | rigid motions of the surface, force and torque of a density |
//! | [`shell`] | the projection onto rigid motions |
//! | [`strain`] | resistance and mobility functions of strain, intrinsic viscosity |
//! | [`stresslet`] | the stresslet |
//! | [`progress`] | how a long computation tells where it is |

mod close;
mod densities;
pub mod dirichlet;
pub mod discretization;
pub mod error;
pub mod factors;
pub mod far;
mod fft;
pub mod flow;
pub mod influence;
pub mod kernel;
pub mod layers;
pub mod linear_flow;
pub mod matrix;
pub mod mobility;
mod near;
#[cfg(test)]
mod near_tests;
mod point_sums;
pub mod progress;
pub mod refinement;
pub mod resistance;
pub mod resolution;
pub mod rigid;
mod rigid_matrices;
pub mod shell;
pub mod special;
mod storage;
pub mod strain;
pub mod stresslet;
pub mod surface;
pub mod surface_grid;

pub use dirichlet::{DirichletSolver, Formulation};
pub use discretization::Discretization;
pub use error::BodyError;
pub use flow::{Flow, FlowError};
pub use kernel::{FlowAt, FlowGradientAt, Stokeslet};
pub use linear_flow::LinearFlow;
pub use mobility::MobilitySolver;
pub use resistance::RigidBodyMatrices;
pub use resolution::Resolution;
pub use surface::SurfaceModes;
