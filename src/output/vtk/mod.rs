//! VTK files for ParaView and its relatives: XML with binary data in doubles.
//!
//! - the surfaces of all bodies, `.vtu`: quadrilaterals between rings, triangles at the poles;
//!   closed, normals outward; point data `traction`, `velocity`, `normal`, `pressure`, `body` (its
//!   number)
//! - the plane, `.vts`: structured, as in [`Plane`](crate::plane::Plane); point data `velocity`,
//!   `pressure`, `inside`, `vtkGhostType`
//!
//! Inside a body velocity and pressure are NaN, `inside` is 1, and `vtkGhostType` is 2 (hidden
//! point), by which ParaView blanks the points.

mod file;
mod plane;
mod surface;

pub use file::VtkError;
pub use plane::plane_file;
pub use surface::Mesh;
