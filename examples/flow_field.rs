//! The flow past a tilted spheroid, seen by an observer who moves with it, as a picture.
//!
//!     cargo run --release --example flow_field -- flow.svg
//!
//! This is what `axistokes solve CASE.toml --picture flow.svg` does, step by step.

use std::error::Error;

use axistokes::case::Case;
use axistokes::nalgebra::Vector3;
use axistokes::output::picture::{Quantity, picture};
use axistokes::plane::{Plane, PlaneFlow};
use axistokes::progress::Silent;
use axistokes::solve::solve;

const CASE: &str = "
    [shapes.lens]
    kind = 'spheroid'
    polar = 1.0
    equatorial = 0.4

    [[bodies]]
    shape = 'lens'
    axis = [1.0, 0.0, 0.8]
    velocity = [-1.0, 0.0, 0.0]

    [plane]
    size = [6.0, 4.0]
    points = [241, 161]
";

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or("flow.svg".into());
    let case = Case::parse(CASE, "flow_field")?;
    let solved = solve(&case, &Silent)?;

    // Of the body's half length only the size of the plane depends, and that is given.
    let plane = Plane::of_case(&case, &[1.0]);
    let velocity = Vector3::from(solved.report.bodies[0].velocity);
    let flow = PlaneFlow::sample(&solved, plane, &Silent)?.relative_to(velocity);
    let drawn = picture(&flow, &solved.sections(&plane)?, Quantity::Speed)?;
    std::fs::write(&path, drawn)?;
    println!("written to {path}");
    Ok(())
}
