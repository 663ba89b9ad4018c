//! What an answer looks like: as JSON, as tables for people, as CSV, as plots and pictures, and as
//! VTK files.

#[cfg(feature = "cli")]
pub mod digits;
#[cfg(feature = "cli")]
mod input;
#[cfg(feature = "pictures")]
pub mod picture;
#[cfg(feature = "pictures")]
pub mod plot;
#[cfg(feature = "cli")]
mod report;
#[cfg(feature = "cli")]
mod resistance;
#[cfg(feature = "cli")]
mod scales;
#[cfg(feature = "cli")]
pub mod study;
#[cfg(feature = "cli")]
mod table;
mod view;
#[cfg(feature = "vtk")]
pub mod vtk;

#[cfg(feature = "cli")]
pub use input::{Imposed, Input, Place};
#[cfg(feature = "cli")]
pub use report::{BodyReport, Discretization, KnownFlowReport, ProbeReport, Report, Stop, Timings};
#[cfg(feature = "cli")]
pub use resistance::{ResistanceReport, ShapeReport};
#[cfg(feature = "cli")]
use table::error_line;
#[cfg(feature = "cli")]
pub use table::{FEW_BODIES, exact, table};
pub use view::{View, ViewError};
