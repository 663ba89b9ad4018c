//! Time span of a simulation.

use super::CaseError;
use super::accuracy::read_tolerance;
use super::node::Node;
use super::section::Section;

/// What `[time]` asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct TimeSpan {
    /// Time at which the simulation ends; it begins at zero.
    pub end: f64,
    /// How steps are chosen.
    pub steps: Steps,
}

/// How time steps are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steps {
    /// Steps adapt to this relative tolerance.
    Adaptive(f64),
    /// Every step has this length.
    Fixed(f64),
}

/// Reads `[time]`.
pub(super) fn read_time(node: Node<'_>) -> Result<TimeSpan, CaseError> {
    let section = Section::new(node, &["end", "tolerance", "step"])?;
    let end = section.required("end", "a time")?.positive("a time")?;
    let steps = match (section.optional("tolerance"), section.optional("step")) {
        (Some(node), None) => Steps::Adaptive(read_tolerance(&node)?),
        (None, Some(node)) => {
            let step = node.positive("a time step")?;
            if step > end {
                return Err(node.expected(format_args!("a step no longer than end = {end}")));
            }
            Steps::Fixed(step)
        }
        (None, None) => {
            let message = "time.tolerance and time.step are missing: expected one of them";
            return Err(section.node.error(message));
        }
        (Some(tolerance), Some(step)) => {
            let later = if tolerance.line > step.line {
                tolerance
            } else {
                step
            };
            let message = "both time.tolerance and time.step are given: expected one of them";
            return Err(later.error(message));
        }
    };
    Ok(TimeSpan { end, steps })
}
