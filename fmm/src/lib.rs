//! Fast summation of Stokeslets, stresslets, rotlets and sources.

pub mod direct;
mod error;
mod flow;
mod gridding;
mod kernel;
mod near_field;
mod plan;
mod prolate;
mod splitting;
mod tree;
mod waves;
mod window;

#[doc(inline)]
pub use error::FmmError;
#[doc(inline)]
pub use flow::{Flow, Output, Strengths, Stresslets};
