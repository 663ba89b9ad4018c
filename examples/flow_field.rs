//! The flow past a tilted spheroid, seen by an observer who moves with it, as a picture.
//!
//!     cargo run --release --example flow_field -- flow.svg
//!
//! This is what `axistokes solve CASE.toml --picture flow.svg` does, step by step.

use std::error::Error;

use axistokes::nalgebra::Vector3;
use axistokes::output::picture::Quantity;
use axistokes::plane::{Plane, PlaneOptions};
use axistokes::{Body, GeneratingCurve, Options, Silent, Solver, Spheroid, Suspension, View};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or("flow.svg".into());
    let velocity = Vector3::new(-1.0, 0.0, 0.0);
    let lens = Spheroid::new(1.0, 0.4)?.shape();
    let tilted = Body::held(&lens).along([1.0, 0.0, 0.8]).moving(velocity);
    let suspension = Suspension::new([tilted]);
    let flow = Solver::new(Options::tolerance(1e-8))
        .solve(&suspension)?
        .flow;

    let options = PlaneOptions {
        size: Some([6.0, 4.0]),
        points: Some([241, 161]),
        ..PlaneOptions::default()
    };
    let plane = Plane::of(&suspension, &options);
    let view = View::in_plane(&flow, plane, &Silent)?.relative_to(velocity);
    let drawn = view.picture(Quantity::Speed)?;
    std::fs::write(&path, drawn)?;
    println!("written to {path}");
    Ok(())
}
