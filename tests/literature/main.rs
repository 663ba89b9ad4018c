//! Resistance of bodies against values that were found in other ways.

mod bodies;
mod reciprocity;
mod resistance;
mod spheroids;
