//! `axistokes solve`.

use super::args::Solve;
use super::failure::Failure;
use super::files::Files;
use super::progress_bar::StderrBar;
use super::streams;
use axistokes::case::{Case, CaseError};
use axistokes::output::table;
use axistokes::solve::{SolveError, solve};

/// Solves a case and prints its report; one that misses its tolerance is printed too, then fails.
pub fn run(arguments: &Solve) -> Result<(), Failure> {
    let case = Case::read(&arguments.case).map_err(SolveError::from)?;
    for warning in case.warnings() {
        streams::complain(&format!("{}: warning: {warning}", case.path.display()));
    }
    let files = Files::asked(arguments, &case)?;
    let bar = StderrBar::stopped_by_ctrl_c()?;
    let solved = solve(&case, &bar)?;
    let line = |message: &str| CaseError::new(case.path.display(), None, message).to_string();
    let report = &solved.report;
    if let Some(name) = report.not_finite() {
        return Err(Failure::Other(line(&format!("{name} is not finite"))));
    }
    let written = files.write(&case, &solved, &bar)?;
    drop(bar);
    let text = if arguments.json {
        let json = report.json();
        json.map(|json| json + "\n")
            .map_err(|error| Failure::Other(error.to_string()))?
    } else {
        table(&case, report, arguments.all) + &written
    };
    streams::print(&text)?;
    match missed(&case, report.error_estimate) {
        Some(message) => Err(Failure::Missed(line(&message))),
        None => Ok(()),
    }
}

/// Relative residuals below this part of the tolerance do as a rule.
const ENOUGH: f64 = 0.1;

/// By how much an error estimate misses the tolerance of the case, if it does.
pub fn missed(case: &Case, estimate: f64) -> Option<String> {
    let tolerance = case.promised_tolerance().filter(|&t| estimate > t)?;
    let factor = estimate / tolerance;
    let residual = case.solver.tolerance.filter(|&r| r > ENOUGH * tolerance);
    let why = residual.map_or(String::new(), |residual| {
        format!("; solver.tolerance = {residual:e} may be why")
    });
    Some(format!(
        "the error estimate {estimate:.3e} misses the tolerance {tolerance:e} by a factor of {factor:.3}{why}"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_by_how_much_a_tolerance_is_missed() {
        let text = "[shapes.ball]\nkind = 'sphere'\nradius = 1\n[[bodies]]\nshape = 'ball'";
        let case = Case::parse(text, "ball.toml").unwrap();
        assert_eq!(missed(&case, 5e-9), None);
        let message = missed(&case, 4e-8).unwrap();
        assert!(
            message.ends_with("misses the tolerance 1e-8 by a factor of 4.000"),
            "{message}"
        );
        let loose = format!("{text}\n[solver]\ntolerance = 1e-4");
        let message = missed(&Case::parse(&loose, "ball.toml").unwrap(), 4e-8).unwrap();
        assert!(
            message.ends_with("; solver.tolerance = 1e-4 may be why"),
            "{message}"
        );
    }
}
