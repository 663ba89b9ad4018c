//! Sums over points, fast where that pays, to the tolerance at hand.

use stokes_fmm::{Flow, FmmError, Output, Points, Singularities, StokesSum, Strengths, direct};

/// The least tolerance of a fast sum, and the largest that is worth having: beyond it sums become no cheaper.
const TOLERANCES: [f64; 2] = [1e-12, 1e-3];
/// Pairs up to which nothing is planned.
const FEW: f64 = 3e7;

/// Sums of one kind at various tolerances. What does not depend on the points is kept for each tolerance that was used.
pub(crate) struct Sums {
    singularities: Singularities,
    output: Output,
    known: Vec<StokesSum>,
}

/// The sum over some points that was used last.
#[derive(Default)]
pub(crate) struct Planned(Option<StokesSum>);

impl Sums {
    pub fn new(singularities: Singularities, output: Output) -> Self {
        Self {
            singularities,
            output,
            known: Vec::new(),
        }
    }

    /// The flow of `strengths` at the targets to a tolerance, rounded down to a whole digit so that plans last.
    pub fn apply(
        &mut self,
        planned: &mut Planned,
        points: Points<'_>,
        strengths: &Strengths<'_>,
        tolerance: f64,
    ) -> Result<Flow, FmmError> {
        let [least, largest] = TOLERANCES;
        let tolerance = 10f64.powf(tolerance.log10().floor()).clamp(least, largest);
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
