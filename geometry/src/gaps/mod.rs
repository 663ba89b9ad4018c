//! How far apart bodies are, and whether they touch or overlap.

mod contact;
mod descent;
mod meridian;

pub use contact::{ContactError, Gap, Placed, Relation, TOUCHING, gaps};
