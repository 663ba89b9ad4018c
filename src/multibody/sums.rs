//! Sums over points, fast where that pays, to the tolerance at hand.

use stokes_fmm::{Flow, FmmError, Output, Points, Singularities, StokesSum, Strengths, direct};

/// The least tolerance of a fast sum, and the largest that is worth having: beyond it sums become no cheaper.
const TOLERANCES: [f64; 2] = [1e-12, 1e-3];
/// Tolerances are taken in steps of this factor, so that plans last.
const STEP: f64 = 100.0;
/// Pairs up to which nothing is planned.
const FEW: f64 = 1e8;

/// Sums of one kind at various tolerances. What does not depend on the points is kept for each tolerance that was used.
pub(crate) struct Sums {
    singularities: Singularities,
    output: Output,
    best: f64,
    known: Vec<StokesSum>,
}

/// The sum over some points that was used last.
#[derive(Default)]
pub(crate) struct Planned(Option<StokesSum>);

impl Sums {
    /// Sums to the tolerance `best` and looser ones.
    pub fn new(singularities: Singularities, output: Output, best: f64) -> Self {
        Self {
            singularities,
            output,
            best,
            known: Vec::new(),
        }
    }

    /// The flow of `strengths` at the targets to a tolerance, or somewhat better.
    pub fn apply(
        &mut self,
        planned: &mut Planned,
        points: Points<'_>,
        strengths: &Strengths<'_>,
        tolerance: f64,
    ) -> Result<Flow, FmmError> {
        let [least, largest] = TOLERANCES;
        let steps = (tolerance / self.best).log(STEP).floor().max(0.0);
        let tolerance = (self.best * STEP.powf(steps)).clamp(least, largest);
        let targets = points.targets.unwrap_or(points.sources);
        if points.sources.len() as f64 * targets.len() as f64 <= FEW {
            let tolerance = Some(tolerance);
            return direct::sum(points.sources, strengths, targets, self.output, tolerance);
        }
        let serves = |sum: &StokesSum| (sum.tolerance() / tolerance - 1.0).abs() < 0.1;
        if let Some(sum) = planned.0.as_ref().filter(|sum| serves(sum)) {
            return sum.apply(strengths);
        }
        // Let go of the one before first: two would take twice the memory.
        planned.0 = None;
        if !self.known.iter().any(serves) {
            // Of one point: what is wanted of it are the operators.
            let nowhere = Points::same(&[[0.0; 3]]);
            let sum = StokesSum::new(nowhere, self.singularities, self.output, tolerance)?;
            self.known.push(sum);
        }
        let Some(operators) = self.known.iter().find(|sum| serves(sum)) else {
            return Ok(Flow::default());
        };
        planned.0.insert(operators.moved(points)?).apply(strengths)
    }
}
