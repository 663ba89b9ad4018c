//! `axistokes converge`.

use super::args::Converge;
use super::failure::Failure;

/// Repeats the convergence study.
pub fn run(arguments: &Converge) -> Result<(), Failure> {
    let size = if arguments.quick { "small" } else { "full" };
    Err(Failure::Input(format!(
        "not built yet: the {size} convergence study in {}",
        arguments.output.display()
    )))
}
