//! The command line: arguments, exit statuses, one line per error.

mod args;
mod cluster;
mod converge;
mod failure;
mod files;
mod folder;
mod progress_bar;
mod resistance;
mod solve;
mod streams;

use args::{Arguments, Command};
use clap::Parser;
use failure::Failure;
use std::process::ExitCode;

/// Runs the program; every error is one line on stderr.
pub fn run() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(message) => return args::explain(&message),
    };
    match dispatch(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            streams::complain(&failure.to_string());
            failure.status()
        }
    }
}

fn dispatch(arguments: &Arguments) -> Result<(), Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(usize::from(arguments.threads))
        .build_global()
        .map_err(|error| Failure::Input(format!("--threads {}: {error}", arguments.threads)))?;
    match &arguments.command {
        Command::Solve(solve) => solve::run(solve),
        Command::Resistance(arguments) => resistance::run(arguments),
        Command::Converge(converge) => converge::run(converge),
        Command::Gaps(gaps) => cluster::gaps(gaps),
        Command::Grand(grand) => cluster::grand(grand),
        Command::Simulate { .. } => Err(Failure::Input("not supported yet: simulate".into())),
    }
}
