//! Boundary-integral solver for Stokes flow around axisymmetric bodies.

pub mod body;
pub mod case;
pub mod curve;
pub mod kernel;
pub mod output;
pub mod progress;
pub mod solve;
pub mod special;
pub mod study;
