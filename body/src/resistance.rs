//! Resistance and mobility matrices of one body, with their scalar functions.
//!
//! A body of revolution with axis $d = e_z$, in a fluid of viscosity $\mu$ at rest, moves with $U$ (of the point that everything is about,
//! on the axis) and $\Omega$ when it exerts force $F$ and torque $T$ on the fluid, where
//!
//! $$ \begin{pmatrix} F \\\\ T \end{pmatrix} = \mu \begin{pmatrix} A & \tilde B \\\\ B & C \end{pmatrix} \begin{pmatrix} U \\\\ \Omega \end{pmatrix} , \qquad
//! \begin{pmatrix} U \\\\ \Omega \end{pmatrix} = \frac{1}{\mu} \begin{pmatrix} a & \tilde b \\\\ b & c \end{pmatrix} \begin{pmatrix} F \\\\ T \end{pmatrix} . $$
//!
//! Both matrices are symmetric, and by symmetry about the axis (Kim & Karrila 1991, sections 5.2 and 5.3; their force is that of the fluid
//! on the body and their velocity that of the fluid past it, which is the same equation)
//!
//! $$ A = X^A dd + Y^A (1 - dd), \quad B_{ij} = Y^B \epsilon_{ijk} d_k, \quad \tilde B = B^\mathsf{T}, \quad C = X^C dd + Y^C (1 - dd) , $$
//!
//! so that $T = \mu Y^B\\, U \times d$ in a translation across the axis; likewise $a$, $b$, $c$ with $x^a$, $y^a$, $y^b$, $x^c$, $y^c$. The functions are not
//! made dimensionless: a sphere of radius $R$ has $X^A = 6\pi R$ and $X^C = 8\pi R^3$.

use std::sync::Arc;

use nalgebra::{Matrix3, Matrix6, Vector3};
use panel_quadrature::QuadratureError;

use super::dirichlet::{DirichletSolver, Formulation};
use super::discretization::Discretization;
use super::error::BodyError;
use super::mobility::MobilitySolver;
use super::refinement::{
    EXTRA_ORDER, ORDER, Round, error_estimate, first_panels, refine, unresolved_panels,
};
use super::resolution::Resolution;
use super::surface::SurfaceModes;
use crate::progress::Progress;
use bodies_of_revolution::{GeneratingCurve, Panels};
use bodies_of_revolution::{RigidMotion, Wrench};

/// The five scalar functions of a matrix: $X^A, Y^A, Y^B, X^C, Y^C$ of a resistance (length, length, length², length³, length³), or
/// $x^a, y^a, y^b, x^c, y^c$ of a mobility (their inverses).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScalarFunctions {
    /// Translation along the axis.
    pub xa: f64,
    /// Translation across the axis.
    pub ya: f64,
    /// Coupling of translation and rotation across the axis.
    pub yb: f64,
    /// Rotation about the axis.
    pub xc: f64,
    /// Rotation about a line across the axis.
    pub yc: f64,
}

/// The resistance matrix for viscosity 1: velocity and angular velocity to force and torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResistanceMatrix(pub Matrix6<f64>);

/// The mobility matrix for viscosity 1: force and torque to velocity and angular velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MobilityMatrix(pub Matrix6<f64>);

/// Both matrices about the origin of the body's frame, by different integral equations: that they are inverse to each other is a
/// check of both.
#[derive(Clone, Debug)]
pub struct RigidBodyMatrices {
    /// Resistance, by the combined field.
    pub resistance: ResistanceMatrix,
    /// Mobility, by the completed double layer.
    pub mobility: MobilityMatrix,
    /// Estimated error of every entry $(i, j)$ relative to the root of the product of the entries $(i, i)$ and $(j, j)$: of each scalar
    /// function relative to itself, of $Y^B$ to $\sqrt{Y^A Y^C}$.
    pub error_estimate: f64,
    /// The resolution they were computed with.
    pub resolution: Resolution,
}

/// Modes of rigid motions end with this one.
const LAST_MODE: usize = 1;
/// Most panels that are tried: 3 GB of matrices.
const MOST_PANELS: usize = 160;

/// The matrix $[v]$ with $[v]\\, w = v \times w$.
fn cross(v: Vector3<f64>) -> Matrix3<f64> {
    v.cross_matrix()
}

/// A matrix of four blocks of three by three.
fn blocks(upper: [Matrix3<f64>; 2], lower: [Matrix3<f64>; 2]) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| {
        let row = if i < 3 { &upper } else { &lower };
        row[j / 3][(i % 3, j % 3)]
    })
}

impl ScalarFunctions {
    /// Of a matrix about a point of the axis: the mean of the entries that symmetry makes equal.
    fn of(matrix: &Matrix6<f64>) -> Self {
        let entry = |i: usize, j: usize| matrix[(i, j)];
        Self {
            xa: entry(2, 2),
            ya: 0.5 * (entry(0, 0) + entry(1, 1)),
            yb: 0.25 * (entry(3, 1) - entry(4, 0) + entry(1, 3) - entry(0, 4)),
            xc: entry(5, 5),
            yc: 0.5 * (entry(3, 3) + entry(4, 4)),
        }
    }
}

impl ResistanceMatrix {
    /// Solves for the four different rigid motions at once.
    ///
    /// Translations and rotations along the axis are in the two families of mode 0; one across the axis in one family of mode 1, a
    /// rotation about the same line in the other. So their answers do not mix.
    fn solve(solver: &DirichletSolver) -> (Self, SurfaceModes) {
        let size = solver.discretization().size();
        let unit = Vector3::new(1.0, 0.0, 1.0);
        let motion = RigidMotion {
            velocity: unit,
            angular_velocity: unit / size,
        };
        let density = solver.solve(&SurfaceModes::of_motion(solver.discretization(), &motion));
        let Wrench { force, torque } = solver.wrench(&density);
        (Self(assembled([force, torque], size)), density)
    }

    /// The scalar functions, if the matrix is about a point of the axis.
    pub fn scalar_functions(&self) -> ScalarFunctions {
        ScalarFunctions::of(&self.0)
    }

    /// The centre of hydrodynamic reaction on the axis, $-Y^B/Y^A$ above the origin: about it rotations exert no force (Happel & Brenner
    /// 1965, section 5.4). A body of revolution's centre of mobility is the same point.
    pub fn center_of_reaction(&self) -> Vector3<f64> {
        let functions = self.scalar_functions();
        Vector3::new(0.0, 0.0, -functions.yb / functions.ya)
    }

    /// The matrix about another point, `point` from the present one: torque about it, velocity of the body there.
    pub fn about(&self, point: Vector3<f64>) -> Self {
        let shift = blocks(
            [Matrix3::identity(), cross(point)],
            [Matrix3::zeros(), Matrix3::identity()],
        );
        Self(shift.transpose() * self.0 * shift)
    }
}

impl MobilityMatrix {
    /// Solves for the four different loads at once, as [`ResistanceMatrix::solve`] for the motions.
    fn solve(solver: &MobilitySolver) -> (Self, SurfaceModes) {
        let discretization = solver.discretization();
        let size = discretization.size();
        let unit = Vector3::new(1.0, 0.0, 1.0);
        let wrench = Wrench {
            force: unit,
            torque: size * unit,
        };
        let at_rest = SurfaceModes::zero(0, discretization.nodes().len());
        let (motion, layers) = solver.solve(wrench, at_rest);
        let answer = [motion.velocity, motion.angular_velocity];
        (Self(assembled(answer, 1.0 / size)), layers.double)
    }

    /// The scalar functions, if the matrix is about a point of the axis.
    pub fn scalar_functions(&self) -> ScalarFunctions {
        ScalarFunctions::of(&self.0)
    }

    /// The matrix about another point, `point` from the present one: torque about it, velocity of the body there.
    pub fn about(&self, point: Vector3<f64>) -> Self {
        let shift = blocks(
            [Matrix3::identity(), -cross(point)],
            [Matrix3::zeros(), Matrix3::identity()],
        );
        Self(shift * self.0 * shift.transpose())
    }
}

/// The matrix of a body of revolution that maps $e_x + e_z$ and $(e_x + e_z)/s$ with `scale` $s$ to `first` and `second`.
fn assembled([first, second]: [Vector3<f64>; 2], scale: f64) -> Matrix6<f64> {
    let turned =
        |across: f64, along: f64| Matrix3::from_diagonal(&Vector3::new(across, across, along));
    // The first vector along x answers along y in the second, and the second along x along y in the first.
    let axis = cross(Vector3::z());
    blocks(
        [turned(first.x, first.z), scale * first.y * axis],
        [second.y * axis, scale * turned(second.x, second.z)],
    )
}

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
    ) -> Result<Self, BodyError> {
        Ok(checked(&curve, panels, order, progress)?.answer)
    }

    /// The matrices to a tolerance: at the first resolution found whose error estimate is below it, or the best there is; compare
    /// [`error_estimate`](Self::error_estimate) with the tolerance.
    ///
    /// # Errors
    /// If the curve is not smooth enough.
    pub fn to_tolerance(
        curve: Arc<dyn GeneratingCurve>,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Self, BodyError> {
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
) -> Result<Round<RigidBodyMatrices>, BodyError> {
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

/// The largest difference of an entry of two positive definite matrices relative to $\sqrt{b_{ii} b_{jj}}$, the largest that it could be in
/// the second: every scalar function counts by its own size.
fn distance(a: &Matrix6<f64>, b: &Matrix6<f64>) -> f64 {
    let scale = |i: usize, j: usize| (b[(i, i)] * b[(j, j)]).abs().sqrt();
    Matrix6::from_fn(|i, j| (a[(i, j)] - b[(i, j)]) / scale(i, j)).amax()
}
