//! Plots of the convergence study as SVG: readable without the fonts of any system, with colours
//! that the colour-blind tell apart.

mod canvas;
pub(super) mod colour;
mod convergence;
mod frame;
mod timing;

pub use canvas::PlotError;
pub use convergence::convergence;
pub use timing::timing;
