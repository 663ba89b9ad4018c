//! Stokes flow around axisymmetric bodies, by boundary integral equations, with an error that is estimated.
//!
//! A body is given by its generating curve, by what moves it and by what its surface does. In the azimuth the equations on the surface
//! fall apart into Fourier modes; each is solved on the curve by a Nyström method whose quadrature is exact to rounding
//! also where the kernels are singular. The answer is the force and torque on the fluid, or the motion of a free
//! body, and the flow at any points. The drag of a sphere is $6\pi$:
//!
//! ```
//! use axistokes::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let sphere = std::sync::Arc::new(Spheroid::sphere(1.0)?);
//! let problem = Problem {
//!     motion: Motion::Given(RigidMotion {
//!         velocity: nalgebra::Vector3::z(),
//!         angular_velocity: nalgebra::Vector3::zeros(),
//!     }),
//!     targets: &[nalgebra::Point3::new(0.0, 0.0, 2.0)],
//!     ..Problem::new(sphere)
//! };
//! let answer = problem.to_tolerance(1e-10, &Silent)?;
//! assert!(answer.error_estimate <= 1e-10);
//! assert!((answer.wrench.force.z - 6.0 * std::f64::consts::PI).abs() < 1e-9);
//! assert!((answer.flow[0].velocity.z - 11.0 / 16.0).abs() < 1e-10);
//! # Ok(())
//! # }
//! ```
//!
//! Any velocity on the surface will do. Here it is the flow of a point force inside a torus, which must come out again
//! in the fluid; the matrices are assembled and factored once, and serve every right-hand side:
//!
//! ```
//! use axistokes::*;
//! use nalgebra::{Point3, Vector3};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let inside = Stokeslet { at: Vector3::new(1.0, 0.1, 0.0), force: Vector3::new(0.2, -1.0, 0.5) };
//! let torus = std::sync::Arc::new(Torus::new(1.0, 0.4)?);
//! let panels = Panels::equal_arcs(&*torus, 8)?;
//! let nodes = Discretization::new(torus, panels, 16)?;
//! let solver = DirichletSolver::new(nodes, Formulation::CombinedField, 60, &Silent)?;
//!
//! let boundary = SurfaceModes::sample(solver.discretization(), 60, |x| inside.velocity(x));
//! let density = solver.solve(&boundary.modes);
//! let point = Point3::new(0.0, 0.0, 1.0);
//! let flow = solver.flow(&density).at(&[point], 1e-12)?[0];
//! assert!((flow.velocity - inside.velocity(point.coords)).norm() < 1e-9);
//! assert!((solver.wrench(&density).force - inside.force).norm() < 1e-9);
//! # Ok(())
//! # }
//! ```
//!
//! # Modules
//!
//! From the ground up; a module uses those above it in the table only. Quadrature on panels is a crate of its own,
//! [`panel_quadrature`].
//!
//! | module | what |
//! |---|---|
//! | [`geometry`] | bodies of revolution: curves, panels, frames, gaps |
//! | [`body`] | one body, in its own frame and for viscosity 1 |
//! | [`krylov`] | Krylov methods for operators known by their products |
//! | [`multibody`] | suspensions: many bodies, in the laboratory and for viscosity 1 |
//! | [`case`] | case files |
//! | [`output`] | reports as tables and JSON, plots; on top of [`plane`], pictures and VTK files |
//! | [`mod@solve`] | from a case to its report: frames and viscosity |
//! | [`plane`] | the flow in a plane: grids, sections, streamlines |
//! | [`mod@resistance`] | from a case to the resistance of its shapes |
//! | [`study`] | the convergence study |
//! | [`progress`] | how a long computation tells where it is |
//!
//! The types of most programs are here at the root too, and [`nalgebra`], whose vectors and points they take.

pub mod case;
pub mod output;
pub mod plane;
pub mod resistance;
pub mod solve;
pub mod study;

pub use bodies_of_revolution as geometry;
pub use inexact_krylov as krylov;
pub use nalgebra;
pub use stokes_body as body;
pub use stokes_body::progress;
pub use stokes_suspension as multibody;

#[doc(inline)]
pub use bodies_of_revolution::{
    Biconcave, Capsule, CurveError, Frame, FunctionCurve, GeneratingCurve, Meridian, Outline,
    Panels, Polar, Profile, RigidMotion, Shape, Spheroid, Torus, Wrench,
};
#[doc(inline)]
pub use body::body_flow::BodyFlow;
#[doc(inline)]
pub use body::dirichlet::{DirichletSolver, Formulation};
#[doc(inline)]
pub use body::discretization::Discretization;
#[doc(inline)]
pub use body::flow::{Flow, FlowError};
#[doc(inline)]
pub use body::kernel::{FlowAt, FlowGradientAt, Stokeslet};
#[doc(inline)]
pub use body::linear_flow::LinearFlow;
#[doc(inline)]
pub use body::mobility::MobilitySolver;
#[doc(inline)]
pub use body::problem::{Answer, Motion, Problem, ProblemError, Resolution};
#[doc(inline)]
pub use body::resistance::{MobilityMatrix, ResistanceMatrix, RigidBodyMatrices, ScalarFunctions};
#[doc(inline)]
pub use body::slip::{pole_to_pole, squirmer};
#[doc(inline)]
pub use body::surface::SurfaceModes;
#[doc(inline)]
pub use multibody::suspension::{Body, Suspension};
#[doc(inline)]
pub use progress::{Progress, Silent};

/// The example of the README is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
