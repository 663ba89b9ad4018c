//! `axistokes resistance`.

use super::args::Resistance;
use super::failure::Failure;
use super::progress_bar::StderrBar;
use super::solve::missed;
use super::streams;
use axistokes::case::{Case, CaseError};
use axistokes::resistance::resistance;
use axistokes::solve::SolveError;

/// Prints resistance and mobility of the shapes of a case; what misses its tolerance is printed
/// too, then fails.
pub fn run(arguments: &Resistance) -> Result<(), Failure> {
    let case = Case::read(&arguments.case).map_err(SolveError::from)?;
    let bar = StderrBar::new();
    let report = resistance(&case, &bar)?;
    drop(bar);
    let line = |message: &str| CaseError::new(case.path.display(), None, message).to_string();
    if let Some(name) = report.not_finite() {
        return Err(Failure::Other(line(&format!("{name}: not finite"))));
    }
    let text = if arguments.json {
        let json = report.json();
        json.map(|json| json + "\n")
            .map_err(|error| Failure::Other(error.to_string()))?
    } else {
        report.table(&case)
    };
    streams::print(&text)?;
    match missed(&case, report.error_estimate()) {
        Some(message) => Err(Failure::Missed(line(&message))),
        None => Ok(()),
    }
}
