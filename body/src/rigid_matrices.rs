//! The six-by-six resistance and mobility matrices of one body and their scalar functions.
//!
//! A body of revolution with axis $d = e_z$, in a fluid of viscosity $\mu$ at rest, moves with $U$
//! (of the point that everything is about, on the axis) and $\Omega$ when it exerts force $F$ and
//! torque $T$ on the fluid, where
//!
//! $$ \begin{pmatrix} F \\\\ T \end{pmatrix}
//!    = \mu \begin{pmatrix} A & \tilde B \\\\ B & C \end{pmatrix}
//!      \begin{pmatrix} U \\\\ \Omega \end{pmatrix} , \qquad
//!    \begin{pmatrix} U \\\\ \Omega \end{pmatrix}
//!    = \frac{1}{\mu} \begin{pmatrix} a & \tilde b \\\\ b & c \end{pmatrix}
//!      \begin{pmatrix} F \\\\ T \end{pmatrix} . $$
//!
//! Both matrices are symmetric, and by symmetry about the axis (Kim & Karrila 1991, sections 5.2
//! and 5.3; their force is that of the fluid on the body and their velocity that of the fluid past
//! it, which is the same equation)
//!
//! $$ A = X^A dd + Y^A (1 - dd), \quad B_{ij} = Y^B \epsilon_{ijk} d_k, \quad
//!    \tilde B = B^\mathsf{T}, \quad C = X^C dd + Y^C (1 - dd) , $$
//!
//! so that $T = \mu Y^B\\, U \times d$ in a translation across the axis; likewise $a$, $b$, $c$
//! with $x^a$, $y^a$, $y^b$, $x^c$, $y^c$. The functions are not made dimensionless: a sphere of
//! radius $R$ has $X^A = 6\pi R$ and $X^C = 8\pi R^3$.

use bodies_of_revolution::{RigidMotion, Wrench};
use nalgebra::{Matrix3, Matrix6, Vector3};

use super::dirichlet::DirichletSolver;
use super::mobility::MobilitySolver;
use super::surface::SurfaceModes;

/// The five scalar functions of a matrix: $X^A, Y^A, Y^B, X^C, Y^C$ of a resistance (length,
/// length, length², length³, length³), or $x^a, y^a, y^b, x^c, y^c$ of a mobility (1/length,
/// 1/length, 1/length², 1/length³, 1/length³).
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
    /// Translations and rotations along the axis are in the two families of mode 0; one across the
    /// axis in one family of mode 1, a rotation about the same line in the other. So their answers
    /// do not mix.
    pub(crate) fn solve(solver: &DirichletSolver) -> (Self, SurfaceModes) {
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

    /// The centre of hydrodynamic reaction on the axis, $-Y^B/Y^A$ above the origin: about it
    /// rotations exert no force (Happel & Brenner 1965, section 5.4). A body of revolution's centre
    /// of mobility is the same point.
    pub fn center_of_reaction(&self) -> Vector3<f64> {
        let functions = self.scalar_functions();
        Vector3::new(0.0, 0.0, -functions.yb / functions.ya)
    }

    /// The matrix about another point, `point` from the present one: torque about it, velocity of
    /// the body there.
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
    pub(crate) fn solve(solver: &MobilitySolver) -> (Self, SurfaceModes) {
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

    /// The matrix about another point, `point` from the present one: torque about it, velocity of
    /// the body there.
    pub fn about(&self, point: Vector3<f64>) -> Self {
        let shift = blocks(
            [Matrix3::identity(), -cross(point)],
            [Matrix3::zeros(), Matrix3::identity()],
        );
        Self(shift * self.0 * shift.transpose())
    }
}

/// The matrix of a body of revolution that maps $e_x + e_z$ and $(e_x + e_z)/s$ with `scale` $s$ to
/// `first` and `second`.
fn assembled([first, second]: [Vector3<f64>; 2], scale: f64) -> Matrix6<f64> {
    let turned =
        |across: f64, along: f64| Matrix3::from_diagonal(&Vector3::new(across, across, along));
    // A first vector along x adds to the second answer along y, and a second along x to the first.
    let axis = cross(Vector3::z());
    blocks(
        [turned(first.x, first.z), scale * first.y * axis],
        [second.y * axis, scale * turned(second.x, second.z)],
    )
}
