//! Boundary-integral solver for Stokes flow around axisymmetric bodies.

pub mod curve;
