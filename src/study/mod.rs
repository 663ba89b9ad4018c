//! The thesis's numerical study of one body (section 3.6.1), repeated.
//!
//! The flow of random Stokeslets inside a prolate spheroid is found again from its values on the
//! surface, under a random rotation, and compared with the exact flow on a grid around the body.
//! Nothing here reads or writes files.
//!
//! | module | what |
//! |---|---|
//! | [`setup`] | the known flow, its targets, and the errors of equations 3.140 and 3.141 |
//! | [`errors`] | errors over panels and modes (figure 3.2), observed order in panels |
//! | [`timing`] | time of each stage against unknowns (figure 3.3) |
//! | [`power_law`] | least-squares exponents |
//! | [`plan`] | how much of it to do |

mod error;
pub mod errors;
pub mod plan;
pub mod power_law;
pub mod setup;
mod size;
mod spheroid;
pub mod timing;

pub use error::StudyError;
pub use size::{bytes, points};
pub use spheroid::{EQUATORIAL, POLAR};
