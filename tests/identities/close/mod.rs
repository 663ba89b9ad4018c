//! Close evaluation: velocity, pressure and velocity gradient at any distance from the surface,
//! zero included.

mod bodies;
mod exact;
mod gauss;
mod jumps;
mod known_flows;
mod odd_points;
mod places;
