//! Boundary-integral solver for Stokes flow around axisymmetric bodies.

pub mod case;
pub mod curve;
