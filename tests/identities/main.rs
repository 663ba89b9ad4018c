//! What holds exactly: known flows, integral identities, special functions, and bounds of the
//! error.

#[path = "../common/mod.rs"]
mod ask;
mod close;
mod condition;
mod error_estimate;
mod flows;
mod sphere_harmonics;
mod thesis;
mod threads;
mod toroidal;
mod traction;
