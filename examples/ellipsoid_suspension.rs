//! 125 ellipsoids of random shape and direction in a 5 x 5 x 5 grid, each driving the fluid over its surface from pole to pole with 10 units
//! of velocity at the equator.
//!
//!     cargo run --release --example ellipsoid_suspension
//!
//! writes to `ellipsoids/` (or `--directory`): the case, as `axistokes solve` would read it; its report; surfaces and middle plane for ParaView; a
//! picture of the streamlines. `--side 3` has 27 of them, `--free` lets them swim, `--tolerance 1e-6` is more accurate.

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::PathBuf;

use axistokes::case::Case;
use axistokes::output::picture::{Quantity, picture};
use axistokes::output::table;
use axistokes::output::vtk::{Surface, plane_file};
use axistokes::plane::{Plane, PlaneFlow};
use axistokes::progress::Progress;
use axistokes::solve::{SolvedBody, solve};
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
    let text = case(&arguments);
    let case = Case::parse(&text, "ellipsoids.toml")?;
    let bar = Bar::new();

    let solved = solve(&case, &bar)?;
    let sizes: Vec<f64> = solved.bodies.iter().map(SolvedBody::size).collect();
    let plane = Plane::of_case(&case, &sizes);
    let flow = PlaneFlow::sample(&solved, plane, &bar)?;
    let drawn = picture(&flow, &solved.sections(&plane)?, Quantity::Speed)?;
    let surfaces = Surface::of(&solved, |_| AZIMUTHS, &bar)?.file()?;
    let report = table(&case, &solved.report, true);
    bar.0.finish_and_clear();

    fs::create_dir_all(&arguments.directory)?;
    let files = [
        ("ellipsoids.toml", text.into_bytes()),
        ("report.txt", report.into_bytes()),
        ("bodies.vtu", surfaces),
        ("plane.vts", plane_file(&flow)?),
        ("streamlines.svg", drawn.into_bytes()),
    ];
    for (name, bytes) in files {
        fs::write(arguments.directory.join(name), bytes)?;
    }
    print!("{}", table(&case, &solved.report, false));
    println!("written to {}", arguments.directory.display());
    Ok(())
}

/// The case file.
fn case(arguments: &Arguments) -> String {
    let mut chance = fastrand::Rng::with_seed(arguments.seed);
    let side = arguments.side;
    let width = SPACING * f64::from(side);
    let middle = SPACING * f64::from(side / 2);
    let center = 0.5 * SPACING * f64::from(side - 1);
    let mut text = format!(
        "# {} ellipsoids of random shape and direction, with slip from pole to pole.\n\n[accuracy]\ntolerance = {:e}\n\n\
         [plane]\ncenter = [{center}, {middle}, {center}]\nnormal = [0.0, 1.0, 0.0]\nsize = {width}\npoints = 301\n",
        side.pow(3),
        arguments.tolerance,
    );
    let places = (0..side.pow(3)).map(|i| [i % side, i / side % side, i / side / side]);
    for (number, place) in (1..).zip(places) {
        // One half axis is 1, the other shorter: rods and discs.
        let shorter = 0.5 + 0.5 * chance.f64();
        let [polar, equatorial] = if chance.bool() {
            [1.0, shorter]
        } else {
            [shorter, 1.0]
        };
        let center = place.map(|k| SPACING * f64::from(k));
        let axis = direction(&mut chance);
        let motion = if arguments.free {
            "force = [0.0, 0.0, 0.0]\n"
        } else {
            ""
        };
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "\n[shapes.e{number}]\nkind = \"spheroid\"\npolar = {polar}\nequatorial = {equatorial}\n\n\
             [[bodies]]\nshape = \"e{number}\"\ncenter = {center:?}\naxis = {axis:?}\n{motion}\
             slip = {{ kind = \"pole-to-pole\", speed = 10.0 }}\n"
        );
    }
    text
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
