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

mod plane;
mod surface;

pub use plane::plane_file;
pub use surface::Mesh;

use nalgebra::Vector3;
use vtkio::model::{Attribute, ByteOrder, DataArray, DataSet, Version, Vtk};

/// Why there is no VTK file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot write the VTK file: {0}")]
pub struct VtkError(String);

/// The bytes of a file.
fn bytes(title: &str, data: DataSet) -> Result<Vec<u8>, VtkError> {
    let file = Vtk {
        version: Version::new_xml(1, 0),
        title: title.to_owned(),
        byte_order: ByteOrder::LittleEndian,
        data,
        file_path: None,
    };
    let mut bytes = Vec::new();
    file.write_xml(&mut bytes)
        .map_err(|error| VtkError(error.to_string()))?;
    Ok(bytes)
}

/// Numbers one after the other.
fn flat<'a>(vectors: impl IntoIterator<Item = &'a Vector3<f64>>) -> Vec<f64> {
    let components = vectors.into_iter().flat_map(|v| [v.x, v.y, v.z]);
    components.collect()
}

fn vectors(name: &str, values: &[Vector3<f64>]) -> Attribute {
    Attribute::DataArray(DataArray::vectors(name).with_vec(flat(values)))
}
