//! What can be typed.

use super::streams;
use axistokes::output::picture::Quantity;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;
use std::process::ExitCode;

const EXAMPLES: &str = "\
Examples:
  axistokes solve sphere-drag.toml            the answer as a table
  axistokes solve sphere-drag.toml --json     the answer as one JSON object
  axistokes solve sphere-drag.toml --picture flow.svg
                                              speed and streamlines as a picture, too
  axistokes resistance sphere-drag.toml       resistance and mobility of its shapes
  axistokes --threads 4 converge --quick      the convergence study, small, on four threads

Exit status: 0 solved, 2 bad input (one line on stderr, nothing written),
3 solved but the error estimate misses the tolerance, 130 interrupted (Ctrl-C),
1 anything else.";

const SOLVE_EXAMPLE: &str = "\
A first case, the drag of a sphere (the force is 6 pi in z):

  [shapes.ball]
  kind = \"sphere\"
  radius = 1.0

  [[bodies]]
  shape = \"ball\"
  velocity = [0.0, 0.0, 1.0]

  [accuracy]
  tolerance = 1e-10

  [probes]
  points = [[0.0, 0.0, 2.0]]";

const RESISTANCE_NOTE: &str = "\
About each shape's origin, its axis along z: six by six matrices from velocity and
angular velocity to the force and torque exerted on the fluid, and back; the functions
XA YA YB XC YC, those in a strain XG YG YH XM YM ZM, and xa ya yb xc yc of Kim & Karrila
(1991, sections 5.2, 5.3) for viscosity 1; the centre of reaction, about which nothing
couples; the intrinsic viscosity and Bretherton's constant.";

const CONVERGE_NOTE: &str = "\
The study: a spheroid 0.5 x 1, boundary data from five random Stokeslets inside,
errors on a grid outside, everything randomly rotated. Full: 2 to 30 panels, modes
up to 10 to 150, a few minutes and 5 GB; quick: up to 12 panels and 80 modes.
Tables go to stdout; convergence.svg, convergence.csv, timing.svg and timing.csv
to the folder, once all is done.";

/// Stokes flow around axisymmetric bodies, with an error that is checked.
#[derive(Debug, Parser)]
#[command(name = "axistokes", version, after_help = EXAMPLES)]
pub struct Arguments {
    /// Threads to use; 0 takes one per core.
    #[arg(long, global = true, default_value_t = 0, value_name = "N", allow_negative_numbers = true,
          value_parser = clap::value_parser!(u16).range(0..=1024))]
    pub threads: u16,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The subcommands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve a case once: motions, forces and torques, velocities and pressure at the probes.
    #[command(after_help = SOLVE_EXAMPLE)]
    Solve(Solve),
    /// Resistance and mobility matrices of the shapes of a case, with their scalar functions.
    #[command(after_help = RESISTANCE_NOTE)]
    Resistance(Resistance),
    /// Repeat the convergence study: errors over panels and modes, time over unknowns.
    #[command(after_help = CONVERGE_NOTE)]
    Converge(Converge),
    /// Grand resistance and mobility matrices of all bodies of a case together.
    Grand(Grand),
    /// Gaps between the bodies of a case: distances, nearest points, normals.
    Gaps(Gaps),
    /// Advance the bodies of a case in time (not built yet).
    #[command(hide = true)]
    Simulate {
        /// Whatever was typed.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        ignored: Vec<std::ffi::OsString>,
    },
}

/// Arguments of `solve`.
#[derive(Args, Debug)]
pub struct Solve {
    /// The case file; - reads the case from standard input.
    #[arg(value_name = "CASE.toml")]
    pub case: PathBuf,
    /// Print one JSON object and nothing else on stdout.
    #[arg(long)]
    pub json: bool,
    /// Show every body in the table, also if there are more than twenty.
    #[arg(long, conflicts_with = "json")]
    pub all: bool,
    /// Draw the flow in a plane: colours, streamlines, bodies. The plane is [plane] of the case, or
    /// one in which much is to be seen. FILE.png needs a build with the feature png.
    #[arg(long, value_name = "FILE.svg")]
    pub picture: Option<PathBuf>,
    /// What the colours of the picture show.
    #[arg(
        long,
        value_name = "QUANTITY",
        value_enum,
        default_value_t,
        requires = "picture"
    )]
    pub picture_of: PictureOf,
    /// Write VTK files of surfaces and plane, as [output] vtk = true does.
    #[arg(long)]
    pub vtk: bool,
}

/// Arguments of `grand`.
#[derive(Args, Debug)]
pub struct Grand {
    /// The case file; what is asked of its bodies does not matter.
    #[arg(value_name = "CASE.toml")]
    pub case: PathBuf,
    /// Print one JSON object and nothing else on stdout.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `gaps`.
#[derive(Args, Debug)]
pub struct Gaps {
    /// The case file; what is asked of its bodies does not matter.
    #[arg(value_name = "CASE.toml")]
    pub case: PathBuf,
    /// Show pairs at most LENGTH apart; if not given, at most as far apart as the larger is long.
    #[arg(long, value_name = "LENGTH", value_parser = length, allow_negative_numbers = true)]
    pub within: Option<f64>,
    /// Print one JSON object and nothing else on stdout.
    #[arg(long)]
    pub json: bool,
}

/// What the colours of a picture show.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub enum PictureOf {
    /// The magnitude of the velocity.
    #[default]
    Speed,
    /// The pressure.
    Pressure,
    /// The speed of the flow without its background.
    Disturbance,
}

impl From<PictureOf> for Quantity {
    fn from(of: PictureOf) -> Self {
        match of {
            PictureOf::Speed => Self::Speed,
            PictureOf::Pressure => Self::Pressure,
            PictureOf::Disturbance => Self::Disturbance,
        }
    }
}

/// Arguments of `resistance`.
#[derive(Args, Debug)]
pub struct Resistance {
    /// The case file, or - for standard input; only its shapes, accuracy and viscosity matter.
    #[arg(value_name = "CASE.toml")]
    pub case: PathBuf,
    /// Print one JSON object and nothing else on stdout.
    #[arg(long)]
    pub json: bool,
}

/// Arguments of `converge`.
#[derive(Args, Debug)]
pub struct Converge {
    /// Folder for convergence.svg, timing.svg and the same numbers as CSV; made if it does not
    /// exist.
    #[arg(long, value_name = "DIR", default_value = "convergence")]
    pub output: PathBuf,
    /// Few resolutions only: seconds instead of minutes.
    #[arg(long)]
    pub quick: bool,
    /// Nodes per panel, 10 or 16; both if not given.
    #[arg(long, value_name = "NODES", value_parser = order)]
    pub order: Option<usize>,
    /// What the random Stokeslets and rotation come from.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        allow_negative_numbers = true
    )]
    pub seed: u64,
    /// For tests: as few resolutions as show convergence.
    #[arg(long, hide = true)]
    pub tiny: bool,
}

/// Zero or a positive length.
fn length(text: &str) -> Result<f64, String> {
    let length = text.parse::<f64>().ok();
    let length = length.filter(|length| *length >= 0.0 && length.is_finite());
    length.ok_or_else(|| "expected a length, zero or more".into())
}

/// Nodes per panel for which there are quadrature rules.
fn order(text: &str) -> Result<usize, String> {
    match text {
        "10" => Ok(10),
        "16" => Ok(16),
        _ => Err("expected 10 or 16".into()),
    }
}

/// Prints help or version on stdout; an error of usage as one line on stderr.
pub fn explain(message: &clap::Error) -> ExitCode {
    use clap::error::{ContextKind, ContextValue, ErrorKind};
    if message.kind() == ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand {
        streams::complain(
            "no command: expected solve, resistance, grand, gaps, converge or --help \
             (see axistokes --help)",
        );
        return ExitCode::from(2);
    }
    if let (ErrorKind::InvalidSubcommand, Some(ContextValue::String(word))) =
        (message.kind(), message.get(ContextKind::InvalidSubcommand))
        && word.ends_with(".toml")
    {
        streams::complain(&format!(
            "no command: expected axistokes solve {} (see axistokes --help)",
            word.escape_default()
        ));
        return ExitCode::from(2);
    }
    if !message.use_stderr() {
        // a closed pipe is not an error here
        let _ = message.print();
        return ExitCode::SUCCESS;
    }
    let text = message.to_string();
    let hint = ["Usage:", "For more information"];
    let lines = (text.lines()).take_while(|line| !hint.iter().any(|hint| line.starts_with(hint)));
    // How to pass what is no option as a value: nobody means that here.
    let lines = lines.filter(|line| !line.trim_start().starts_with("tip: to pass"));
    let words: Vec<&str> = lines.flat_map(str::split_whitespace).collect();
    let line = words.join(" ");
    let line = line.trim_start_matches("error: ");
    streams::complain(&format!("{line} (see axistokes --help)"));
    ExitCode::from(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn arguments_are_consistent() {
        Arguments::command().debug_assert();
    }
}
