//! Fast summation of Stokeslets, stresslets, rotlets and sources.

mod across;
pub mod direct;
mod error;
mod far;
mod far_field;
mod fast;
mod flow;
mod gemm;
mod gridding;
mod kernel;
mod near_field;
mod operators;
mod parameters;
mod plan;
mod polynomial;
mod prolate;
mod splitting;
mod symbol;
mod transfer;
mod transform;
mod translate;
mod tree;
mod window;

#[doc(inline)]
pub use error::FmmError;
#[doc(inline)]
pub use fast::{LaplaceSum, Points, StokesSum};
#[doc(inline)]
pub use flow::{Flow, Output, Singularities, Strengths, Stresslets};
