//! Panels refined until an estimated error is small enough.
//!
//! Everything is computed twice: on the discretization asked for, and on one that has the same
//! panels with more nodes on each, more modes, and other quadrature for the near interactions. The
//! difference between the two is the error of the coarser, which is the one reported; where the
//! coarser is not good enough the panels that resolve the density worst are bisected.

use std::f64::consts::PI;

use panel_quadrature::QuadratureError;

use super::discretization::Discretization;
use super::surface::SurfaceModes;
use bodies_of_revolution::{GeneratingCurve, Panels};

/// Fewest and most nodes per panel where the solver chooses.
const ORDERS: [usize; 2] = [6, 16];
/// Panels of a shape that has nothing small.
const FEW_PANELS: usize = 4;
/// Nodes per panel that the checking discretization has beyond the checked one's.
pub const EXTRA_ORDER: usize = 4;
/// How far the estimate stays above the difference: the checking solution has an error too.
const SAFETY: f64 = 2.0;
/// What rounding leaves even where the difference happens to vanish.
const ROUNDING: f64 = 4e-15;
/// Panels are bisected that miss this fraction of what the worst does.
const MARKED: f64 = 0.02;
/// Rounds of refinement.
const ROUNDS: usize = 24;
/// Rounds in a row that may pass without halving the error.
const PATIENCE: usize = 2;

/// An answer on given panels.
#[derive(Clone, Debug)]
pub struct Round<A> {
    /// The answer.
    pub answer: A,
    /// Its estimated error.
    pub error_estimate: f64,
    /// The panels.
    pub panels: Panels,
    /// For each panel, whether it resolves the density worse than the others.
    pub unresolved: Vec<bool>,
}

/// The panels that resolve the curve itself well enough to start with, and the nodes on each.
///
/// Where four panels do, as for bodies without anything small, nodes are as few as the
/// tolerance allows: one for each digit and four more, an even number. So many resolve a density
/// about as well as the few modes that it then has. Elsewhere panels shrink towards what is small,
/// or towards joints where the curvature jumps, and more nodes on each take fewer in all.
pub fn first_panels(
    curve: &dyn GeneratingCurve,
    tolerance: f64,
) -> Result<(Panels, usize), bodies_of_revolution::CurveError> {
    let [fewest, most] = ORDERS;
    let digits = -tolerance.log10().round();
    let order = (digits as usize + 4)
        .next_multiple_of(2)
        .clamp(fewest, most);
    let resolution = tolerance.sqrt().clamp(1e-7, 1e-2);
    let is_smooth = Panels::pieces(curve)?.len() == 1;
    let few = Panels::resolving(curve, order, resolution)?.graded_across_joints(curve);
    if is_smooth && few.len() <= FEW_PANELS {
        return Ok((few, order));
    }
    let panels = Panels::resolving(curve, most, resolution)?;
    Ok((panels.graded_across_joints(curve), most))
}

/// Answers on finer and finer panels until one is estimated to be as good as the tolerance: that
/// one, or the best there is. `affordable` says whether so many panels may be tried.
pub fn refine<A: Clone, E: From<QuadratureError>>(
    curve: &dyn GeneratingCurve,
    first: Panels,
    tolerance: f64,
    affordable: impl Fn(usize) -> bool,
    mut answer_on: impl FnMut(Panels) -> Result<Round<A>, E>,
) -> Result<Round<A>, E> {
    let mut latest = answer_on(first)?;
    let mut best = latest.clone();
    let mut without_gain = 0;
    for _ in 1..ROUNDS {
        if best.error_estimate <= tolerance || without_gain > PATIENCE {
            break;
        }
        let marked = &latest.unresolved;
        let panels = latest.panels.bisected(|panel| marked[panel]);
        let panels = panels.graded_across_joints(curve);
        if !affordable(panels.len()) {
            break;
        }
        latest = answer_on(panels)?;
        let gain = latest.error_estimate < 0.5 * best.error_estimate;
        without_gain = if gain { 0 } else { without_gain + 1 };
        if latest.error_estimate < best.error_estimate {
            best = latest.clone();
        }
    }
    Ok(best)
}

/// The estimated error of a solution that differs from the one that checks it by so much.
pub fn error_estimate(discretization: &Discretization, difference: f64) -> f64 {
    SAFETY * difference + ROUNDING * thinness(discretization)
}

/// $A^2 / 12\pi a V$ for area, size and volume: 1 for a sphere and about that for a needle, but the
/// aspect ratio of a disc, whose two faces nearly cancel and lose as many digits.
fn thinness(discretization: &Discretization) -> f64 {
    // The volume is a third of the flux of the position, x . nu.
    let flux: f64 = (discretization.nodes().iter())
        .map(|n| n.weight * (n.r * n.normal[0] + n.z * n.normal[1]))
        .sum();
    let (area, size) = (discretization.area(), discretization.size());
    (area * area / (8.0 * PI * PI * size * flux)).max(1.0)
}

/// Panels on which densities are resolved worst, by the last two of their Legendre coefficients
/// there.
///
/// The difference of two densities would not do: what one panel misses spreads over all.
pub fn unresolved_panels(
    discretization: &Discretization,
    densities: &[&SurfaceModes],
) -> Result<Vec<bool>, QuadratureError> {
    let order = discretization.order();
    let mut missed = vec![0.0f64; discretization.panels().len()];
    // Densities of several problems need not be alike in size: each counts relative to its own
    // worst panel.
    for density in densities {
        let mut of_one = vec![0.0f64; missed.len()];
        for n in 0..density.modes() {
            for k in 0..6 {
                let values = density.component(n, k / 3, k % 3);
                for (values, missed) in values.chunks(order).zip(&mut of_one) {
                    let coefficients = discretization.basis().coefficients(values)?;
                    *missed += coefficients[order - 2..].iter().map(|c| c * c).sum::<f64>();
                }
            }
        }
        for (panel, missed) in of_one.iter_mut().enumerate() {
            let nodes = discretization.nodes_of(panel).iter();
            *missed *= nodes.map(|node| node.weight).sum::<f64>();
        }
        let most = of_one.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        for (missed, of_one) in missed.iter_mut().zip(of_one) {
            *missed = f64::max(*missed, of_one / most);
        }
    }
    Ok(missed
        .into_iter()
        .map(|missed| missed >= MARKED * MARKED)
        .collect())
}
