//! Stokes flow around bodies of revolution, by boundary integral equations, with an error that is
//! estimated.
//!
//! A body is given by its generating curve, by what is known of its motion and by what its surface
//! does. In the azimuth the equations on the surface decouple into Fourier modes; each is solved on
//! the curve by a Nyström method whose quadrature is exact to rounding also where the kernels are
//! singular. Many bodies are solved for by iteration, with a fast summation. The answer is forces
//! and torques, or the motions of free bodies, and the flow at any points.
//!
//! Two rods, one held in the way of one that sinks: forces, the flow, a picture, a file for
//! ParaView, and the same a little later.
//!
//! ```
//! use axistokes::nalgebra::Point3;
//! use axistokes::output::{picture::Quantity, vtk::Mesh};
//! use axistokes::{Body, GeneratingCurve, Options, Solver, Spheroid, Suspension, View};
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let rod = Spheroid::new(1.0, 0.5)?.shape();
//!     let sinking = Body::free(&rod).at([0.4, 0.0, 2.4]).along([1.0, 0.0, 1.0]);
//!     let mut suspension = Suspension::new([Body::held(&rod), sinking.pushed([0.0, 0.0, -1.0])]);
//!
//!     let mut solver = Solver::new(Options::tolerance(1e-4));
//!     let answer = solver.solve(&suspension)?; // an error if the tolerance is missed
//!     println!("it sinks with {:?}", answer.bodies[1].motion.velocity);
//!     println!("force of the held rod on the fluid: {:?}", answer.bodies[0].wrench.force);
//!
//!     let flow = answer.flow.at(&[Point3::new(2.0, 0.0, 0.0), Point3::origin()])?;
//!     assert!(flow[0].is_some() && flow[1].is_none()); // in the fluid, inside a body
//!     let surface = answer.surface(0)?; // points, normals, weights, velocity, traction, pressure
//!     println!("traction at {:?}: {:?}", surface.points[0], surface.traction[0]);
//!     let folder = std::env::temp_dir();
//!     let picture = View::of(&suspension, &answer)?.picture(Quantity::Speed)?;
//!     std::fs::write(folder.join("rods.svg"), picture)?;
//!     std::fs::write(folder.join("rods.vtu"), Mesh::of_answer(&answer)?.file()?)?;
//!
//!     suspension.advance(answer.motions(), 0.5);
//!     let later = solver.solve_from(&suspension, &answer)?;
//!     assert!(later.bodies[1].motion.velocity.z < 0.0);
//!     Ok(())
//! }
//! ```
//!
//! # Modules
//!
//! | module | what |
//! |---|---|
//! | [`case`] | case files |
//! | [`output`] | reports as tables and JSON, plots; on top of [`plane`], pictures and VTK files |
//! | [`mod@solve`] | from a case to its report |
//! | [`plane`] | the flow in a plane: grids, sections, streamlines |
//! | [`mod@resistance`] | from a case to the resistance of its shapes |
//! | [`study`] | the convergence study |
//!
//! What they stand on are crates of their own, from the ground up:
//!
//! | crate | what |
//! |---|---|
//! | [`geometry`] | bodies of revolution: curves, panels, frames, gaps |
//! | [`krylov`] | Krylov methods for operators known by their products |
//! | [`body`] | one body in its own frame: modal kernels, matrices, factors, flow |
//! | [`suspension`] | any number of bodies: question, solver, answer |
//!
//! The types of most programs are here at the root, and [`nalgebra`], whose vectors and points they
//! take.

#[cfg(feature = "cli")]
pub mod case;
pub mod output;
pub mod plane;
#[cfg(feature = "cli")]
pub mod resistance;
#[cfg(feature = "cli")]
pub mod solve;
#[cfg(feature = "cli")]
pub mod study;

pub use bodies_of_revolution as geometry;
pub use inexact_krylov as krylov;
pub use nalgebra;
pub use stokes_body as body;
pub use stokes_body::progress;
pub use stokes_suspension as suspension;

#[doc(inline)]
pub use bodies_of_revolution::{
    Biconcave, Capsule, CurveError, Frame, FunctionCurve, Gap, GeneratingCurve, Meridian, Panels,
    Polar, Profile, RigidMotion, Shape, Spheroid, Torus, Wrench,
};
#[doc(inline)]
pub use body::kernel::FlowAt;
#[doc(inline)]
pub use body::linear_flow::LinearFlow;
#[doc(inline)]
pub use body::resistance::RigidBodyMatrices;
#[doc(inline)]
pub use body::resolution::Resolution;
#[doc(inline)]
pub use output::View;
#[doc(inline)]
pub use progress::{Progress, Silent};
#[doc(inline)]
pub use suspension::{
    Accuracy, Answer, Body, BodyAnswer, BodyFlow, Component, Flow, GrandMatrix, Motion, Options,
    Slip, SolveError, Solver, StressAt, Surface, Suspension, SuspensionError,
};

/// The example of the README is a test.
#[cfg(all(doctest, feature = "cli"))]
#[doc = include_str!("../README.md")]
struct Readme;
