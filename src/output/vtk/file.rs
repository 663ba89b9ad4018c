//! What all files have in common.

use nalgebra::Vector3;
use vtkio::model::{Attribute, ByteOrder, DataArray, DataSet, IOBuffer, Version, Vtk};
use vtkio::xml::Compressor;

use super::field::Field;

/// From 1, fast, to 9, small: more than this gains little on doubles.
const COMPRESSION: u32 = 3;

/// Why there is no VTK file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot write the VTK file: {0}")]
pub struct VtkError(String);

/// The bytes of a file, compressed.
pub(super) fn bytes(title: &str, data: DataSet, fields: &[Field]) -> Result<Vec<u8>, VtkError> {
    let file = Vtk {
        version: Version::new_xml(1, 0),
        title: title.to_owned(),
        byte_order: ByteOrder::LittleEndian,
        data,
        file_path: None,
    };
    let failed = |error: vtkio::xml::Error| VtkError(error.to_string());
    let file = file
        .try_into_xml_format(Compressor::ZLib, COMPRESSION)
        .map_err(failed)?;
    let mut bytes = Vec::new();
    file.write(&mut bytes).map_err(failed)?;
    Field::insert(fields, &mut bytes);
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

/// A field of numbers at the points.
pub(super) fn scalars<T>(name: &str, values: Vec<T>) -> Attribute
where
    IOBuffer: From<Vec<T>>,
{
    Attribute::DataArray(DataArray::scalars(name, 1).with_data(values))
}
