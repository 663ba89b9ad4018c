//! What an answer looks like: as JSON, as tables for people, as CSV, as plots and pictures, and as VTK files.

pub mod picture;
pub mod plot;
mod report;
mod resistance;
pub mod study;
mod table;
pub mod vtk;

pub use report::{BodyReport, Discretization, KnownFlowReport, ProbeReport, Report, Stop, Timings};
pub use resistance::{ResistanceReport, ShapeReport};
use table::error_line;
pub use table::{FEW_BODIES, table};
