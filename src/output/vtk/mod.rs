//! VTK files for ParaView and its relatives: XML with compressed binary data in doubles.
//!
//! - the surfaces of all bodies, `.vtu`: quadrilaterals between rings, triangles at the poles;
//!   closed, normals outward; point data `traction`, `velocity`, `normal`, `pressure`, `weight`
//!   (share of the area), `body` (its number); field data `viscosity`, `estimated_error` and, a row
//!   for each body, `center`, `axis`, `orientation_wxyz`, `body_velocity`, `body_angular_velocity`,
//!   `force_on_fluid`, `torque_on_fluid` (about the centre)
//! - the plane, `.vts`: structured, as in [`Plane`](crate::plane::Plane); point data `velocity`,
//!   `pressure`, `inside`, `vtkGhostType`
//!
//! The traction is what the fluid exerts on the body, force and torque are what the body exerts on
//! the fluid. A sphere without slip may have another axis than was given.
//!
//! Inside a body velocity and pressure are NaN, `inside` is 1, and `vtkGhostType` is 2 (hidden
//! point), by which ParaView blanks the points.

mod field;
mod file;
mod plane;
mod surface;

pub use file::VtkError;
pub use plane::plane_file;
pub use surface::Mesh;
