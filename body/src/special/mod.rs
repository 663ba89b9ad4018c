//! Special functions: the toroidal Legendre functions the modal kernels are made of.

pub mod toroidal;
