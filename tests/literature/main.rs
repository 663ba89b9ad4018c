//! Resistance, mobility and swimming of bodies against values that were found in other ways.

#[path = "../common/mod.rs"]
mod ask;
mod bodies;
mod faxen;
mod jeffery;
mod keller_wu;
mod matrices;
mod reciprocity;
mod resistance;
mod spheroids;
mod squirmer;
mod stresslet;
