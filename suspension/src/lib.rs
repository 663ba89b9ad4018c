//! Stokes flow around many bodies of revolution, one included: the question, the solver and its
//! answer.
//!
//! A [`Suspension`] says where bodies are and what is known of their motions, a [`Solver`] answers
//! it with an estimate of the error, and the [`Answer`] gives forces, motions and the flow at any
//! points. On body $i$
//!
//! $$ \bigl(\tfrac12 + D_i + \eta_i S_i\bigr)\\, \sigma_i + \sum_{j \ne i} u_j
//! = U_i + \Omega_i \times x + u_{s,i} - u_\infty \quad \text{(held)}, $$
//! $$ \bigl(\tfrac12 + D_i + P_i\bigr)\\, \sigma_i + S_i[\varrho_i]
//! {} + \sum_{j \ne i} u_j = u_{s,i} - u_\infty \quad \text{(free)}, $$
//!
//! where $u_j$ is the flow of body $j$'s layers: $(D_j + \eta_j S_j)\sigma_j$, or $D_j\sigma_j +
//! S_j\varrho_j$ with the density $\varrho_j$ of its force and torque (see
//! [`stokes_body::mobility`]). A body that is held in some directions and free in others has the
//! first equation with unknown velocities. A body alone is solved for directly, many by iteration.
//!
//! | module | what |
//! |---|---|
//! | [`suspension`], [`motion`], [`slip`] | the question |
//! | [`options`], [`solver`] | how it is answered |
//! | [`answer`], [`flow`], [`surface`], `further_errors` | the answer |
//! | [`grand`] | grand resistance and mobility matrices |
//! | `arrangement`, `resolution`, `refine`, `estimate` | resolutions, and the error |
//! | `class`, `tables`, `finer` | what belongs to a shape at a resolution |
//! | `assembly`, `system`, `coarse`, `constraint`, `iteration`, `solution` | the linear system |
//! | `interactions`, `points`, `sums`, `near`, `upsampling`, `batches`, `layout` | one product |
//! | `check` | by how much a solution misses the boundary velocity |

pub mod answer;
mod arrangement;
mod assembly;
mod batches;
mod check;
mod class;
mod coarse;
mod constraint;
pub mod error;
mod estimate;
mod finer;
pub mod flow;
mod further_errors;
pub mod grand;
mod imposed;
mod interactions;
mod iteration;
mod layout;
mod memory;
pub mod motion;
mod near;
pub mod options;
mod points;
mod refine;
mod resolution;
pub mod slip;
mod solution;
mod solve_error;
pub mod solver;
mod sums;
pub mod surface;
pub mod suspension;
mod system;
mod tables;
mod tolerances;
mod upsampling;

pub use answer::{Answer, BodyAnswer, Statistics, Timings};
pub use error::SuspensionError;
pub use flow::{BodyFlow, Flow, StressAt};
pub use grand::GrandMatrix;
pub use inexact_krylov::{Method, Stop};
pub use interactions::InteractionError;
pub use iteration::Iteration;
pub use memory::default_memory;
pub use motion::{Component, Mixed, Motion};
pub use options::{Accuracy, Levels, Options};
pub use slip::Slip;
pub use solve_error::SolveError;
pub use solver::Solver;
pub use surface::Surface;
pub use suspension::{Body, Suspension};
