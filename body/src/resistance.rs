//! Everything that a rigid body does in a linear flow, to a tolerance: its resistance and mobility
//! matrices and its functions of strain.

use std::sync::Arc;

use bodies_of_revolution::{GeneratingCurve, Panels, curve::volume};
use nalgebra::{DMatrix, Matrix6};
use panel_quadrature::QuadratureError;

use super::dirichlet::{DirichletSolver, Formulation};
use super::discretization::Discretization;
use super::error::BodyError;
use super::linear_flow::LAST_MODE;
use super::mobility::MobilitySolver;
use super::refinement::{
    EXTRA_ORDER, Round, error_estimate, first_panels, refine, unresolved_panels,
};
use super::resolution::Resolution;
use super::rigid::inverse_of_resistance;
use super::strain::{FreeBodyFunctions, StrainFunctions};
use super::surface::SurfaceModes;
use crate::progress::Progress;

pub use super::rigid_matrices::{MobilityMatrix, ResistanceMatrix, ScalarFunctions};

/// Resistance and mobility about the origin of the body's frame, for rigid motions and for strain,
/// by different integral equations: that they are inverse to each other is a check of both.
#[derive(Clone, Debug)]
pub struct RigidBodyMatrices {
    /// Resistance, by the combined field.
    pub resistance: ResistanceMatrix,
    /// Mobility, by the completed double layer.
    pub mobility: MobilityMatrix,
    /// Force, torque and stresslet of the body held in strain, by the combined field.
    pub strain: StrainFunctions,
    /// Motion and stresslet of the free body in strain, by the completed double layer.
    pub free: FreeBodyFunctions,
    /// The volume of the body.
    pub volume: f64,
    /// Estimated error of every entry $(i, j)$ of a matrix relative to the root of the product of
    /// the entries $(i, i)$ and $(j, j)$: of each scalar function relative to itself, of $Y^B$ to
    /// $\sqrt{Y^A Y^C}$. Of the functions of strain: of the $M$ and $m$ relative to themselves, of
    /// the others to $\sqrt{X^A X^M}$, $\sqrt{Y^A Y^M}$, $\sqrt{Y^C Y^M}$ and, for the free body,
    /// $\sqrt{x^a X^M}$, $\sqrt{y^a Y^M}$, $\sqrt{y^c Y^M}$.
    pub error_estimate: f64,
    /// The resolution they were computed with.
    pub resolution: Resolution,
}

/// Most panels that are tried: 3 GB of matrices.
const MOST_PANELS: usize = 140;

impl RigidBodyMatrices {
    /// The matrices at a given resolution, which does not need more modes than 2.
    ///
    /// # Errors
    /// If there is no quadrature of that order.
    pub fn at_resolution(
        curve: Arc<dyn GeneratingCurve>,
        panels: Panels,
        order: usize,
        progress: &dyn Progress,
    ) -> Result<Self, BodyError> {
        Ok(checked(&curve, panels, order, progress)?.answer)
    }

    /// The matrices to a tolerance: at the first resolution found whose error estimate is below it,
    /// or the best there is; compare [`error_estimate`](Self::error_estimate) with the tolerance.
    ///
    /// # Errors
    /// If the curve is not smooth enough.
    pub fn to_tolerance(
        curve: Arc<dyn GeneratingCurve>,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Self, BodyError> {
        let (first, order) = first_panels(&*curve, tolerance)?;
        let affordable = |panels: usize| panels <= MOST_PANELS;
        let round = |panels| checked(&curve, panels, order, progress);
        Ok(refine(&*curve, first, tolerance, affordable, round)?.answer)
    }
}

/// What both equations give on one discretization.
struct Solved {
    resistance: ResistanceMatrix,
    mobility: MobilityMatrix,
    strain: StrainFunctions,
    free: FreeBodyFunctions,
    /// The densities of all that was solved for.
    densities: [SurfaceModes; 4],
}

impl Solved {
    fn on(
        discretization: Discretization,
        progress: &dyn Progress,
    ) -> Result<Self, QuadratureError> {
        let solver = DirichletSolver::new(
            discretization.clone(),
            Formulation::CombinedField,
            LAST_MODE,
            progress,
        )?;
        let (resistance, of_resistance) = ResistanceMatrix::solve(&solver);
        let (strain, of_strain) = StrainFunctions::solve(&solver);
        drop(solver);
        let solver = MobilitySolver::new(discretization, LAST_MODE, progress)?;
        let (mobility, of_mobility) = MobilityMatrix::solve(&solver);
        let (free, of_free) = FreeBodyFunctions::solve(&solver);
        Ok(Self {
            resistance,
            mobility,
            strain,
            free,
            densities: [of_resistance, of_strain, of_mobility, of_free],
        })
    }

    /// The largest difference from a finer solution, or of the two equations of this one.
    fn difference(&self, finer: &Self) -> f64 {
        let resistance = self.resistance.scalar_functions();
        let mobility = self.mobility.scalar_functions();
        let held = self.strain;
        let relative =
            |pairs: [[f64; 3]; 6]| largest(pairs.map(|[a, b, scale]| ((a - b) / scale).abs()));
        let of_free = |other: &FreeBodyFunctions, [xm, ym]: [f64; 2]| {
            let free = &self.free;
            relative([
                [free.xg, other.xg, (mobility.xa * held.xm).sqrt()],
                [free.yg, other.yg, (mobility.ya * held.ym).sqrt()],
                [free.yh, other.yh, (mobility.yc * held.ym).sqrt()],
                [free.xm, other.xm, xm],
                [free.ym, other.ym, ym],
                [free.zm, other.zm, free.zm],
            ])
        };
        let of_strain = |other: &StrainFunctions| {
            relative([
                [held.xg, other.xg, (resistance.xa * held.xm).sqrt()],
                [held.yg, other.yg, (resistance.ya * held.ym).sqrt()],
                [held.yh, other.yh, (resistance.yc * held.ym).sqrt()],
                [held.xm, other.xm, held.xm],
                [held.ym, other.ym, held.ym],
                [held.zm, other.zm, held.zm],
            ])
        };
        let held_in_place = DMatrix::from_fn(6, 6, |i, j| self.resistance.0[(i, j)]);
        let inverse = inverse_of_resistance(&held_in_place);
        largest([
            distance(&self.resistance.0, &finer.resistance.0),
            distance(&self.mobility.0, &finer.mobility.0),
            of_strain(&finer.strain),
            of_free(&finer.free, [self.free.xm, self.free.ym]),
            // The held body's functions are differences of larger ones when it is freed.
            of_free(&held.freed(&resistance), [held.xm, held.ym]),
            inverse.map_or(f64::INFINITY, |inverse| {
                distance(&Matrix6::from_fn(|i, j| inverse[(i, j)]), &self.mobility.0)
            }),
        ])
    }
}

/// The largest of numbers that are not negative; infinite if one is not a number.
fn largest<const N: usize>(values: [f64; N]) -> f64 {
    let or_infinite = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
    values.into_iter().map(or_infinite).fold(0.0, f64::max)
}

fn checked(
    curve: &Arc<dyn GeneratingCurve>,
    panels: Panels,
    order: usize,
    progress: &dyn Progress,
) -> Result<Round<RigidBodyMatrices>, BodyError> {
    let discretization = Discretization::new(curve.clone(), panels.clone(), order)?;
    let finer = discretization.with_order(order + EXTRA_ORDER)?;
    let solved = Solved::on(discretization.clone(), progress)?;
    let difference = solved.difference(&Solved::on(finer, progress)?);
    let error_estimate = error_estimate(&discretization, difference);
    Ok(Round {
        error_estimate,
        unresolved: unresolved_panels(&discretization, &solved.densities.each_ref())?,
        answer: RigidBodyMatrices {
            resistance: solved.resistance,
            mobility: solved.mobility,
            strain: solved.strain,
            free: solved.free,
            volume: volume(&**curve, &panels),
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
/// $\sqrt{b_{ii} b_{jj}}$, the largest that it could be in the second: every scalar function counts
/// by its own size.
fn distance(a: &Matrix6<f64>, b: &Matrix6<f64>) -> f64 {
    let scale = |i: usize, j: usize| (b[(i, i)] * b[(j, j)]).abs().sqrt();
    Matrix6::from_fn(|i, j| (a[(i, j)] - b[(i, j)]) / scale(i, j)).amax()
}
