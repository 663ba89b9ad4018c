//! Many bodies.

pub(crate) mod interactions;
pub(crate) mod near;
pub(crate) mod tables;
