//! Resistance and mobility matrices of one body, to a tolerance.

use std::sync::Arc;

use bodies_of_revolution::{GeneratingCurve, Panels};
use nalgebra::Matrix6;
use panel_quadrature::QuadratureError;

use super::dirichlet::{DirichletSolver, Formulation};
use super::discretization::Discretization;
use super::mobility::MobilitySolver;
use super::problem::{ProblemError, Resolution};
use super::refinement::{
    EXTRA_ORDER, ORDER, Round, error_estimate, first_panels, refine, unresolved_panels,
};
use super::surface::SurfaceModes;
use crate::progress::Progress;

pub use super::rigid_matrices::{MobilityMatrix, ResistanceMatrix, ScalarFunctions};

/// Both matrices about the origin of the body's frame, by different integral equations: that they are
/// inverse to each other is a check of both.
#[derive(Clone, Debug)]
pub struct RigidBodyMatrices {
    /// Resistance, by the combined field.
    pub resistance: ResistanceMatrix,
    /// Mobility, by the completed double layer.
    pub mobility: MobilityMatrix,
    /// Estimated error of every entry $(i, j)$ relative to the root of the product of the entries $(i, i)$
    /// and $(j, j)$: of each scalar function relative to itself, of $Y^B$ to $\sqrt{Y^A Y^C}$.
    pub error_estimate: f64,
    /// The resolution they were computed with.
    pub resolution: Resolution,
}

/// Modes of rigid motions end with this one.
const LAST_MODE: usize = 1;
/// Most panels that are tried: 3 GB of matrices.
const MOST_PANELS: usize = 160;

impl RigidBodyMatrices {
    /// The matrices at a given resolution, which does not need more modes than 1.
    ///
    /// # Errors
    /// If there is no quadrature of that order.
    pub fn at_resolution(
        curve: Arc<dyn GeneratingCurve>,
        panels: Panels,
        order: usize,
        progress: &dyn Progress,
    ) -> Result<Self, ProblemError> {
        Ok(checked(&curve, panels, order, progress)?.answer)
    }

    /// The matrices to a tolerance: at the first resolution found whose error estimate is below it, or the
    /// best there is; compare [`error_estimate`](Self::error_estimate) with the tolerance.
    ///
    /// # Errors
    /// If the curve is not smooth enough.
    pub fn to_tolerance(
        curve: Arc<dyn GeneratingCurve>,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Self, ProblemError> {
        let first = first_panels(&*curve, tolerance)?;
        let affordable = |panels: usize| panels <= MOST_PANELS;
        let round = |panels| checked(&curve, panels, ORDER, progress);
        Ok(refine(&*curve, first, tolerance, affordable, round)?.answer)
    }
}

/// Both matrices on one discretization, with the densities of their equations.
fn solve(
    discretization: Discretization,
    progress: &dyn Progress,
) -> Result<(ResistanceMatrix, MobilityMatrix, [SurfaceModes; 2]), QuadratureError> {
    let solver = DirichletSolver::new(
        discretization.clone(),
        Formulation::CombinedField,
        LAST_MODE,
        progress,
    )?;
    let (resistance, of_resistance) = ResistanceMatrix::solve(&solver);
    drop(solver);
    let solver = MobilitySolver::new(discretization, LAST_MODE, progress)?;
    let (mobility, of_mobility) = MobilityMatrix::solve(&solver);
    Ok((resistance, mobility, [of_resistance, of_mobility]))
}

fn checked(
    curve: &Arc<dyn GeneratingCurve>,
    panels: Panels,
    order: usize,
    progress: &dyn Progress,
) -> Result<Round<RigidBodyMatrices>, ProblemError> {
    let discretization = Discretization::new(curve.clone(), panels.clone(), order)?;
    let finer = discretization.with_order(order + EXTRA_ORDER)?;
    let (resistance, mobility, densities) = solve(discretization.clone(), progress)?;
    let (finer_resistance, finer_mobility, _) = solve(finer, progress)?;
    // Both the finer matrices and the other equation's inverse check what was found.
    let mut difference = f64::max(
        distance(&resistance.0, &finer_resistance.0),
        distance(&mobility.0, &finer_mobility.0),
    );
    if let Some(inverse) = resistance.0.try_inverse() {
        difference = difference.max(distance(&inverse, &mobility.0));
    }
    let error_estimate = error_estimate(&discretization, difference);
    Ok(Round {
        error_estimate,
        unresolved: unresolved_panels(&discretization, &densities.each_ref())?,
        answer: RigidBodyMatrices {
            resistance,
            mobility,
            error_estimate,
            resolution: Resolution {
                panels: panels.clone(),
                order,
                modes: LAST_MODE,
            },
        },
        panels,
    })
}

/// The largest difference of an entry of two positive definite matrices relative to
/// $\sqrt{b_{ii} b_{jj}}$, the largest that it could be in the second: every scalar function counts by its
/// own size.
fn distance(a: &Matrix6<f64>, b: &Matrix6<f64>) -> f64 {
    let scale = |i: usize, j: usize| (b[(i, i)] * b[(j, j)]).abs().sqrt();
    Matrix6::from_fn(|i, j| (a[(i, j)] - b[(i, j)]) / scale(i, j)).amax()
}
