//! Many bodies against values that were found in other ways (`data/README.md`), against exact
//! flows, and against themselves.

#[path = "../common/mod.rs"]
mod ask;
mod chains;
mod clusters;
mod common;
mod constraints;
mod errors;
mod iterations;
mod methods;
mod mixed;
mod pairs;
mod solver;
mod threads;
mod two_spheres;
