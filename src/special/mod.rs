//! Special functions: the toroidal Legendre functions the modal kernels are made of, and the SIMD
//! arithmetic they are computed in.

pub(crate) mod lanes;
pub mod toroidal;
