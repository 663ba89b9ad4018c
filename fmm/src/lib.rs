//! Fast summation of Stokeslets, stresslets, rotlets and sources.

mod direct;
mod error;
mod gridding;
mod kernel;
mod near_field;
mod parameters;
mod plan;
mod polynomial;
mod prolate;
mod splitting;
mod tree;
mod waves;
mod window;

#[doc(inline)]
pub use error::FmmError;
