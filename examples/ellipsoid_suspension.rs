//! 125 ellipsoids of random shape and direction in a 5 x 5 x 5 grid, each driving the fluid over
//! its surface from pole to pole with 10 units of velocity at the equator.
//!
//!     cargo run --release --example ellipsoid_suspension
//!
//! writes to `ellipsoids/` (or `--directory`): motions and forces of all bodies as a table;
//! surfaces and middle plane for ParaView; a picture of the streamlines. `--side 3` has 27 of them,
//! `--free` lets them swim, `--tolerance 1e-6` is more accurate.

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use axistokes::nalgebra::{Point3, Vector3};
use axistokes::output::picture::Quantity;
use axistokes::output::vtk::{Mesh, plane_file};
use axistokes::plane::{Plane, PlaneOptions, PlaneOrientation};
use axistokes::progress::Progress;
use axistokes::suspension::SolveError;
use axistokes::{
    Answer, Body, CurveError, GeneratingCurve, Options, Slip, Solver, Spheroid, Suspension, View,
};
use clap::Parser;
use indicatif::{ProgressBar, ProgressStyle};

/// Ellipsoids of random shape and direction in a cubic grid, with slip from pole to pole.
#[derive(Parser)]
struct Arguments {
    /// Bodies on a side of the cube.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=20))]
    side: u32,
    /// Largest error of the velocity, over the largest speed.
    #[arg(long, default_value_t = 1e-4)]
    tolerance: f64,
    /// Let them swim instead of holding them.
    #[arg(long)]
    free: bool,
    /// What their shapes and directions are drawn from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Where the files go.
    #[arg(long, default_value = "ellipsoids")]
    directory: PathBuf,
}

/// Distance of the centres; half axes are between 0.5 and 1.
const SPACING: f64 = 2.4;
/// Azimuths of the surfaces' meshes.
const AZIMUTHS: usize = 48;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Arguments::parse();
    let suspension = suspension(&arguments)?;
    let bar = Bar::new();

    let mut solver = Solver::new(Options::tolerance(arguments.tolerance));
    let answer = solver.solve_with(&suspension, None, &bar);
    let answer = answer.or_else(SolveError::answer)?;
    let plane = middle(&suspension, arguments.side);
    let view = View::in_plane(&answer.flow, plane, &bar)?;
    let drawn = view.picture(Quantity::Speed)?;
    let surfaces = Mesh::of(&answer, |_| AZIMUTHS, &bar)?.file()?;
    bar.0.finish_and_clear();

    fs::create_dir_all(&arguments.directory)?;
    let files = [
        ("bodies.csv", bodies(&suspension, &answer).into_bytes()),
        ("bodies.vtu", surfaces),
        ("plane.vts", plane_file(&view.flow)?),
        ("streamlines.svg", drawn.into_bytes()),
    ];
    for (name, bytes) in files {
        fs::write(arguments.directory.join(name), bytes)?;
    }
    print!("{}", summary(&answer));
    println!("written to {}", arguments.directory.display());
    Ok(())
}

/// The bodies.
fn suspension(arguments: &Arguments) -> Result<Suspension, CurveError> {
    let mut chance = fastrand::Rng::with_seed(arguments.seed);
    let side = arguments.side;
    let places = (0..side.pow(3)).map(|i| [i % side, i / side % side, i / side / side]);
    let body = |place: [u32; 3]| {
        // One half axis is 1, the other shorter: rods and discs.
        let shorter = 0.5 + 0.5 * chance.f64();
        let [polar, equatorial] = if chance.bool() {
            [1.0, shorter]
        } else {
            [shorter, 1.0]
        };
        let shape = Spheroid::new(polar, equatorial)?.shape();
        let body = if arguments.free {
            Body::free(&shape)
        } else {
            Body::held(&shape)
        };
        Ok(body
            .at(place.map(|k| SPACING * f64::from(k)))
            .along(direction(&mut chance))
            .with_slip(Slip::pole_to_pole(polar, equatorial, 10.0)))
    };
    let bodies: Vec<Body> = places.map(body).collect::<Result<_, CurveError>>()?;
    Ok(Suspension::new(bodies))
}

/// The plane through the middle layer of bodies.
fn middle(suspension: &Suspension, side: u32) -> Plane {
    let center = 0.5 * SPACING * f64::from(side - 1);
    let options = PlaneOptions {
        center: Some(Point3::new(center, SPACING * f64::from(side / 2), center)),
        orientation: Some(PlaneOrientation::Normal(Vector3::y())),
        size: Some([SPACING * f64::from(side); 2]),
        points: Some([301; 2]),
    };
    Plane::of(suspension, &options)
}

/// Every body on a line.
fn bodies(suspension: &Suspension, answer: &Answer) -> String {
    let mut text = "x,y,z,axis x,axis y,axis z,velocity x,velocity y,velocity z,angular velocity x,\
                    angular velocity y,angular velocity z,force x,force y,force z,torque x,torque y,torque z\n"
        .to_owned();
    for (body, found) in suspension.bodies.iter().zip(&answer.bodies) {
        let (frame, motion, wrench) = (&body.frame, &found.motion, &found.wrench);
        let vectors = [
            frame.center().coords,
            *frame.axis(),
            motion.velocity,
            motion.angular_velocity,
            wrench.force,
            wrench.torque,
        ];
        let numbers = vectors.iter().flat_map(|v| v.iter());
        let cells: Vec<String> = numbers.map(|x| format!("{x:e}")).collect();
        // Writing to a string does not fail.
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

fn summary(answer: &Answer) -> String {
    let (statistics, t) = (&answer.statistics, &answer.statistics.timings);
    format!(
        "{answer}: relative to the largest speed, {:.3}\n\
         {} unknowns, {} points, {} iterations, {} rounds of refinement\n\
         seconds: assemble {:.1}, factor {:.1}, near rows {:.1}, iterate {:.1}, \
         error estimate {:.1}, other {:.1}\n",
        answer.largest_speed,
        statistics.unknowns,
        statistics.points,
        statistics.iterations,
        statistics.rounds,
        t.assemble,
        t.factor,
        t.near,
        t.iterate,
        t.estimate,
        t.other,
    )
}

/// Every direction as likely as any other.
fn direction(chance: &mut fastrand::Rng) -> [f64; 3] {
    loop {
        let v = [(); 3].map(|()| 2.0 * chance.f64() - 1.0);
        let square: f64 = v.iter().map(|x| x * x).sum();
        if square > 0.01 && square <= 1.0 {
            return v.map(|x| x / square.sqrt());
        }
    }
}

/// A progress bar.
struct Bar(ProgressBar);

impl Bar {
    fn new() -> Self {
        let bar = ProgressBar::new(0);
        if let Ok(style) = ProgressStyle::with_template("{msg:12} {wide_bar} {elapsed}") {
            bar.set_style(style);
        }
        Self(bar)
    }
}

impl Progress for Bar {
    fn begin(&self, stage: &'static str, steps: usize) {
        self.0.set_message(stage);
        self.0.set_length(steps as u64);
        self.0.set_position(0);
    }

    fn advance(&self, steps: usize) {
        self.0.inc(steps as u64);
    }
}
