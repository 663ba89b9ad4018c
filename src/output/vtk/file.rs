//! What all files have in common.

use nalgebra::Vector3;
use vtkio::model::{Attribute, ByteOrder, DataArray, DataSet, Version, Vtk};

/// Why there is no VTK file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot write the VTK file: {0}")]
pub struct VtkError(String);

/// The bytes of a file.
pub(super) fn bytes(title: &str, data: DataSet) -> Result<Vec<u8>, VtkError> {
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
pub(super) fn flat<'a>(vectors: impl IntoIterator<Item = &'a Vector3<f64>>) -> Vec<f64> {
    let components = vectors.into_iter().flat_map(|v| [v.x, v.y, v.z]);
    components.collect()
}

/// A field of vectors at the points.
pub(super) fn vectors(name: &str, values: &[Vector3<f64>]) -> Attribute {
    Attribute::DataArray(DataArray::vectors(name).with_vec(flat(values)))
}
