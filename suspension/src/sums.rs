//! Sums over points, fast where that pays, to the tolerance at hand.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use stokes_fmm::{Flow, FmmError, Output, Points, Singularities, StokesSum, Strengths};

/// The least tolerance of a fast sum, and the largest that is worth having: beyond it sums become
/// no cheaper.
const TOLERANCES: [f64; 2] = [1e-12, 1e-3];
/// Tolerances are taken in steps of this factor, so that plans last.
const STEP: f64 = 100.0;
/// Pairs up to which nothing is planned.
const FEW: f64 = 1e8;

/// What fast sums need that does not depend on the points: made once for each kind and tolerance.
#[derive(Clone, Default)]
pub(crate) struct Operators(Arc<Mutex<Vec<Made>>>);

impl fmt::Debug for Operators {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Operators")
    }
}

struct Made {
    singularities: Singularities,
    output: Output,
    /// Over one point: what is wanted of it are the operators.
    sum: StokesSum,
}

impl Operators {
    fn plan(
        &self,
        singularities: Singularities,
        output: Output,
        tolerance: f64,
        points: Points<'_>,
    ) -> Result<StokesSum, FmmError> {
        let mut made = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let serves = |made: &Made| {
            (made.singularities, made.output) == (singularities, output)
                && are_alike(made.sum.tolerance(), tolerance)
        };
        let place = match made.iter().position(serves) {
            Some(place) => place,
            None => {
                let nowhere = Points::same(&[[0.0; 3]]);
                let sum = StokesSum::new(nowhere, singularities, output, tolerance)?;
                made.push(Made {
                    singularities,
                    output,
                    sum,
                });
                made.len() - 1
            }
        };
        made[place].sum.moved(points)
    }
}

/// Whether so few sources and targets are summed pair by pair: the one place where that is decided.
///
/// Pair by pair, what belongs to one body can be left out or done exactly. A fast sum counts all,
/// and what is wrong of it is taken away: that costs digits where points are near each other.
pub(crate) fn are_few(sources: usize, targets: usize) -> bool {
    sources as f64 * targets as f64 <= FEW
}

fn are_alike(a: f64, b: f64) -> bool {
    (a / b - 1.0).abs() < 0.1
}

/// Sums over the same points, again and again.
pub(crate) struct Sums {
    operators: Operators,
    singularities: Singularities,
    output: Output,
    best: f64,
    /// The sum that was used last.
    planned: Option<StokesSum>,
}

impl Sums {
    /// Sums to the tolerance `best` and looser ones.
    pub fn new(
        operators: Operators,
        singularities: Singularities,
        output: Output,
        best: f64,
    ) -> Self {
        Self {
            operators,
            singularities,
            output,
            best,
            planned: None,
        }
    }

    /// Frees the plan.
    pub fn forget_plan(&mut self) {
        self.planned = None;
    }

    /// The flow of `strengths` at the targets to a tolerance, or somewhat better. The points must
    /// be the same each time.
    pub fn apply(
        &mut self,
        points: Points<'_>,
        strengths: &Strengths<'_>,
        tolerance: f64,
    ) -> Result<Flow, FmmError> {
        let [least, largest] = TOLERANCES;
        let steps = (tolerance / self.best).log(STEP).floor().max(0.0);
        let tolerance = (self.best * STEP.powf(steps)).clamp(least, largest);
        let serves = |sum: &&StokesSum| are_alike(sum.tolerance(), tolerance);
        if let Some(sum) = self.planned.as_ref().filter(serves) {
            return sum.apply(strengths);
        }
        // Let go of the one before first: two would take twice the memory.
        self.planned = None;
        let sum = self
            .operators
            .plan(self.singularities, self.output, tolerance, points)?;
        self.planned.insert(sum).apply(strengths)
    }
}
