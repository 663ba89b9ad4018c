//! Fast summation of Stokeslets, stresslets, rotlets and sources of Stokes flow, and of Laplace
//! charges, in free space.
//!
//! | subject | items |
//! |---|---|
//! | sums planned for given points and applied to any strengths | [`StokesSum`], [`LaplaceSum`] |
//! | places of sources and targets | [`Points`] |
//! | what is summed | [`Singularities`], [`Strengths`], [`Stresslets`] |
//! | results | [`Output`], [`Flow`] |
//! | sums pair by pair | [`direct`] |
//! | a tree code, for comparison | [`TreeCode`] |
//! | errors | [`FmmError`] |
//!
//! The method is dual-space multilevel kernel splitting (af Klinteberg, Greengard, Jiang, Tornberg
//! 2025, arXiv 2509.21471) on uniform grids. The modules, from those that do not depend on the
//! points to those that do:
//!
//! * prolate functions, and the splitting of $B = r/8\pi$ by them: `prolate`, `splitting`,
//!   `polynomial`;
//! * kernels, pair by pair and among plane waves: `kernel`, `far`, `symbol`, `dispatch`;
//! * between points, grids and plane waves: `window`, `gridding`, `transform`, `transfer`,
//!   `translate`, `gemm`;
//! * sizes for a tolerance, and all operators of these sizes: `parameters`, `operators`;
//! * the boxes that have grids: `tree`;
//! * the two halves of a sum, and both together: `near_field`, `far_field`, `plan`.

mod across;
pub mod direct;
mod dispatch;
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
mod tree_code;
mod window;

#[doc(inline)]
pub use error::FmmError;
#[doc(inline)]
pub use fast::{LaplaceSum, Points, StokesSum};
#[doc(inline)]
pub use flow::{Flow, Output, Singularities, Strengths, Stresslets};
#[doc(inline)]
pub use tree_code::TreeCode;

/// The examples of the README are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
