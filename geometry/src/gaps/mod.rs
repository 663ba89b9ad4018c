//! How far apart bodies are, and whether they touch or overlap.

mod contact;
mod convexity;
mod deepest;
mod depth;
mod descent;
mod directions;
mod gap;
mod least_first;
mod meridian;
mod patches;
mod placed;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_of_depth;

pub use contact::gaps;
pub use gap::{ContactError, Depth, Gap, Relation, TOUCHING};
pub use placed::Placed;
