//! Boundary-integral solver for Stokes flow around axisymmetric bodies.

pub mod curve;
pub mod kernel;
pub mod special;
