//! Plots of the convergence study as SVG: readable without the fonts of any system, with colours
//! that the colour-blind tell apart.

#[cfg(feature = "cli")]
mod canvas;
pub(super) mod colour;
#[cfg(feature = "cli")]
mod convergence;
#[cfg(feature = "cli")]
mod frame;
#[cfg(feature = "cli")]
mod timing;

#[cfg(feature = "cli")]
pub use canvas::PlotError;
#[cfg(feature = "cli")]
pub use convergence::convergence;
#[cfg(feature = "cli")]
pub use timing::timing;
