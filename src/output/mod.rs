//! What an answer looks like: as JSON and as a table for people.

mod report;
mod table;

pub use report::{BodyReport, Discretization, KnownFlowReport, ProbeReport, Report, Timings};
pub use table::table;
