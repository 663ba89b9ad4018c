//! The flow in a plane.

use nalgebra::Vector3;
use vtkio::model::{Attributes, DataSet, Extent, Piece, StructuredGridPiece};

use super::file::{VtkError, bytes, flat, scalars, vectors};
use crate::plane::PlaneFlow;

/// What VTK calls a hidden point.
const HIDDEN: u8 = 2;

/// The `.vts` file of the flow at the grid points of a plane.
///
/// # Errors
/// If the writer fails.
pub fn plane_file(flow: &PlaneFlow) -> Result<Vec<u8>, VtkError> {
    let missing = Vector3::repeat(f64::NAN);
    let values = || flow.values.iter();
    let velocity: Vec<Vector3<f64>> = values()
        .map(|value| value.map_or(missing, |at| at.velocity))
        .collect();
    let pressure: Vec<f64> = values()
        .map(|value| value.map_or(f64::NAN, |at| at.pressure))
        .collect();
    let inside: Vec<u8> = values().map(|value| u8::from(value.is_none())).collect();
    let hidden: Vec<u8> = inside.iter().map(|inside| HIDDEN * inside).collect();
    let point = vec![
        vectors("velocity", &velocity),
        scalars("pressure", pressure),
        scalars("inside", inside),
        scalars("vtkGhostType", hidden),
    ];
    let [columns, rows] = flow.plane.points.map(|count| count as i32 - 1);
    let extent = Extent::Ranges([0..=columns, 0..=rows, 0..=0]);
    let points: Vec<Vector3<f64>> = flow.plane.grid().iter().map(|x| x.coords).collect();
    let piece = StructuredGridPiece {
        extent: extent.clone(),
        points: flat(&points).into(),
        data: Attributes {
            point,
            cell: Vec::new(),
        },
    };
    let data = DataSet::StructuredGrid {
        extent,
        meta: None,
        pieces: vec![Piece::Inline(Box::new(piece))],
    };
    bytes("flow in a plane", data, &[])
}
