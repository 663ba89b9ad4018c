//! What holds exactly: known flows, integral identities, special functions, and bounds of the
//! error.

mod close;
mod condition;
mod error_estimate;
mod flows;
mod sphere_harmonics;
mod thesis;
mod threads;
mod toroidal;
mod traction;
