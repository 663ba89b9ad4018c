//! Many bodies: what each is asked, and what all of them do together. Everything is in the laboratory's frame and for viscosity 1.
//!
//! | module | what |
//! |---|---|
//! | [`suspension`] | the question and its answer, with an estimate of the error |
//! | [`flow`] | the flow at any points |
//! | [`interactions`] | what bodies do to each other |

pub(crate) mod assembly;
pub(crate) mod check;
pub(crate) mod class;
pub(crate) mod coarse;
pub mod error;
pub mod flow;
mod further;
pub mod grand;
pub mod interactions;
mod memory;
pub(crate) mod near;
mod resolution;
mod rounds;
pub(crate) mod solution;
mod spheres;
mod sums;
pub mod suspension;
pub(crate) mod system;
pub(crate) mod tables;
mod upsampling;

pub use error::SuspensionError;
