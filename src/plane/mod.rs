//! The flow in a plane: which plane, its values, the bodies' sections, and streamlines.
//!
//! | module | what |
//! |---|---|
//! | `choice` | the plane asked for, or chosen |
//! | `grid` | planes, and the flow at their grid points |
//! | `heads` | where the heads of swimmers are |
//! | [`section`] | where a plane cuts a body of revolution |
//! | [`streamlines`] | evenly spaced streamlines |

mod choice;
mod grid;
mod heads;
pub mod section;
pub mod streamlines;

pub use choice::{PlaneOptions, PlaneOrientation};
pub use grid::{Continued, Plane, PlaneFlow};
pub use heads::heads;
