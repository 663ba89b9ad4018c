//! From a case to its answer and its files, through the command line and the library.

mod cluster;
mod converge;
mod examples;
mod free_bodies;
mod many_bodies;
mod picture;
mod readme;
mod regressions;
mod report;
mod resistance;
mod solved;
mod vtk;
