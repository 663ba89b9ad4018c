//! A body in a straining flow: stresslet, force and torque of a held body; stresslet and motion of
//! a free one.
//!
//! The body of revolution has the axis $d = e_z$. It is in the undisturbed flow
//! $u_\infty(x) = U_\infty + \Omega_\infty \times x + E x$ of viscosity $\mu$, with the rate of
//! strain $E$ (symmetric, without trace, in units of 1/time), and moves with $U + \Omega \times x$.
//! The origin of $x$ is the point on the axis that everything is about, and all components are in
//! the body's frame.
//!
//! # Held body: resistance functions
//!
//! Force $F$ and torque $T$ **of the fluid on the body** and its [`stresslet`] $S$ are
//! (Kim & Karrila 1991, section 5.1)
//!
//! $$ F_i = \mu \bigl( A (U_\infty - U) + \tilde B (\Omega_\infty - \Omega) \bigr)_i +
//!    \mu\\, G_{jki} E_{jk} , $$
//! $$ T_i = \mu \bigl( B (U_\infty - U) + C (\Omega_\infty - \Omega) \bigr)_i +
//!    \mu\\, H_{jki} E_{jk} , $$
//! $$ S_{ij} = \mu\\, G_{ijk} (U_\infty - U)_k + \mu\\, H_{ijk} (\Omega_\infty - \Omega)_k +
//!    \mu\\, M_{ijkl} E_{kl} . $$
//!
//! That the same $G$ and $H$ are in all of them is the reciprocal theorem. By symmetry about the
//! axis (Kim & Karrila 1991, section 5.3)
//!
//! $$ G_{ijk} = X^G (d_i d_j - \tfrac13 \delta_{ij}) d_k +
//!    Y^G (d_i \delta_{jk} + d_j \delta_{ik} - 2 d_i d_j d_k) , $$
//! $$ H_{ijk} = Y^H (\epsilon_{ikl} d_l d_j + \epsilon_{jkl} d_l d_i) , \qquad
//!    M = X^M d^{(0)} + Y^M d^{(1)} + Z^M d^{(2)} . $$
//!
//! The $d^{(m)}$ are the projections of a symmetric tensor without trace onto its parts that vary
//! around the axis like $\cos m\theta$ and $\sin m\theta$:
//!
//! $$ d^{(0)} E = \tfrac32 (d \cdot E d) (dd - \tfrac13 1) , \quad d^{(1)} E = d e + e d
//!    \text{ with } e = E d - (d \cdot E d)\\, d , \quad d^{(2)} = 1 - d^{(0)} - d^{(1)} . $$
//!
//! In vectors, a body held in strain feels $F = \mu (X^G (d \cdot E d)\\, d + 2 Y^G e)$ and
//! $T = 2 \mu Y^H\\, d \times E d$.
//!
//! The functions are not made dimensionless: $G$ is in units of length², $H$ and $M$ of length³.
//! A sphere of radius $R$ about its centre has $X^M = Y^M = Z^M = \frac{20}{3} \pi R^3$ and no
//! others. Kim & Karrila's table 3.4 of spheroids with the longer semi-axis $a$ has
//! $X^M / \frac{20}{3} \pi a^3$ (and so for $Y^M$, $Z^M$) and $Y^H / 4 \pi a^3$; Jeffrey (1992,
//! Phys. Fluids A 4, 16) divides $G$ by $4 \pi a^2$ and $H$ by $8 \pi a^3$.
//!
//! # Free body: mobility functions
//!
//! When $F$ and $T$ are given, the same equations read
//!
//! $$ (U - U_\infty)_i = -\frac{1}{\mu} (a F + \tilde b T)_i + g_{jki} E_{jk} , \quad
//!    (\Omega - \Omega_\infty)_i = -\frac{1}{\mu} (b F + c T)_i + h_{jki} E_{jk} , $$
//! $$ S_{ij} = g_{ijk} F_k + h_{ijk} T_k + \mu\\, m_{ijkl} E_{kl} , $$
//!
//! where $g$, $h$, $m$ are made of $x^g, y^g$ (length), $y^h$ (a number) and $x^m, y^m, z^m$
//! (length³) as $G$, $H$, $M$ are of the resistance functions. A body without force and torque
//! moves with
//!
//! $$ U = U_\infty + x^g (d \cdot E d)\\, d + 2 y^g e , \qquad
//!    \Omega = \Omega_\infty + 2 y^h\\, d \times E d , $$
//!
//! so that $2 y^h$ is the constant of Bretherton (1962, J. Fluid Mech. 14, 284) in Jeffery's
//! equation $\dot d = \Omega_\infty \times d + 2 y^h e$. [`StrainFunctions::freed`] has the
//! relations between both sets of functions.

use bodies_of_revolution::Wrench;
use nalgebra::{Matrix3, Vector3};

use super::dirichlet::DirichletSolver;
use super::discretization::Discretization;
use super::layers::Layers;
use super::linear_flow::LinearFlow;
use super::mobility::MobilitySolver;
use super::rigid_matrices::ScalarFunctions;
use super::stresslet::stresslet;
use super::surface::SurfaceModes;

/// The resistance functions of strain, for viscosity 1: what a body held still in a straining flow
/// feels, see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrainFunctions {
    /// $X^G$, length²: force along the axis in the strain along it.
    pub xg: f64,
    /// $Y^G$, length²: force across the axis in the strain of a shear along it.
    pub yg: f64,
    /// $Y^H$, length³: torque across the axis in the same strain.
    pub yh: f64,
    /// $X^M$, length³: stresslet in the axisymmetric strain.
    pub xm: f64,
    /// $Y^M$, length³: stresslet in the strain of a shear along the axis.
    pub ym: f64,
    /// $Z^M$, length³: stresslet in the strain across the axis.
    pub zm: f64,
}

/// The mobility functions of strain, for viscosity 1: stresslet and motion of a body without force
/// and torque in a straining flow, see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBodyFunctions {
    /// $x^g$, a length: velocity along the axis in the strain along it.
    pub xg: f64,
    /// $y^g$, a length: half the velocity across the axis in the strain of a shear along it.
    pub yg: f64,
    /// $y^h$, a number: half the angular velocity in the same strain, less the fluid's.
    pub yh: f64,
    /// $x^m$, length³: stresslet in the axisymmetric strain.
    pub xm: f64,
    /// $y^m$, length³: stresslet in the strain of a shear along the axis.
    pub ym: f64,
    /// $z^m$, length³: stresslet in the strain across the axis.
    pub zm: f64,
}

/// A rate of strain with all three parts of size 1: axisymmetric with $d \cdot E d = 1$, of a shear
/// along the axis with $E_{xz} = 1$, and across the axis with $E_{xx} - E_{yy} = 2$.
///
/// The parts are in modes 0, 1, 2, so their answers do not mix and one solution gives all of them.
fn three_strains() -> Matrix3<f64> {
    Matrix3::new(0.5, 0.0, 1.0, 0.0, -1.5, 0.0, 1.0, 0.0, 1.0)
}

/// The three functions of $M$ or $m$ from the stresslet $S$ in those strains:
/// $S_{zz}$, $S_{xz}$ and $(S_{xx} - S_{yy})/2$.
fn of_stresslet(s: &Matrix3<f64>) -> [f64; 3] {
    [s[(2, 2)], s[(0, 2)], 0.5 * (s[(0, 0)] - s[(1, 1)])]
}

/// The velocity $-E x$ on the surface that makes up for those strains.
fn data(discretization: &Discretization) -> SurfaceModes {
    let strain = LinearFlow {
        velocity: Vector3::zeros(),
        gradient: three_strains(),
    };
    strain.on(discretization).modes.scaled(-1.0)
}

impl StrainFunctions {
    /// The functions about the origin, with the density that they are of.
    ///
    /// The solver needs the modes up to [`LAST_MODE`](super::linear_flow::LAST_MODE).
    pub(crate) fn solve(solver: &DirichletSolver) -> (Self, SurfaceModes) {
        let discretization = solver.discretization();
        let density = solver.solve(&data(discretization));
        // The solver's are those on the fluid.
        let Wrench { force, torque } = solver.wrench(&density);
        let layers = Layers::weighted(&density, solver.weights());
        let [xm, ym, zm] = of_stresslet(&stresslet(discretization, &layers));
        let functions = Self {
            xg: -force.z,
            yg: -0.5 * force.x,
            yh: -0.5 * torque.y,
            xm,
            ym,
            zm,
        };
        (functions, density)
    }

    /// The functions about another point of the axis, `height` above the present one; `resistance`
    /// about the present one. With height $h$
    ///
    /// $$ X^G - h X^A, \quad Y^G - \tfrac12 h Y^A, \quad
    ///    Y^H - h Y^G + \tfrac12 h Y^B + \tfrac12 h^2 Y^A, $$
    /// $$ X^M - \tfrac43 h X^G + \tfrac23 h^2 X^A, \quad
    ///    Y^M - 2 h Y^G + \tfrac12 h^2 Y^A, \quad Z^M, $$
    ///
    /// since the flow $E (x - h d)$ is $E x$ and a translation $-h E d$, and the torque and the
    /// stresslet of a force $F$ change by the torque and the symmetric traceless part of $-h d F$.
    pub fn about(&self, height: f64, resistance: &ScalarFunctions) -> Self {
        let Self {
            xg,
            yg,
            yh,
            xm,
            ym,
            zm,
        } = *self;
        let ScalarFunctions { xa, ya, yb, .. } = *resistance;
        let h = height;
        Self {
            xg: xg - h * xa,
            yg: yg - 0.5 * h * ya,
            yh: yh - h * yg + 0.5 * h * (yb + h * ya),
            xm: xm - h * (4.0 * xg - 2.0 * h * xa) / 3.0,
            ym: ym - h * (2.0 * yg - 0.5 * h * ya),
            zm,
        }
    }

    /// The functions of the free body, about the same point as these and `resistance`:
    ///
    /// $$ X^A x^g = X^G , \qquad
    ///    \begin{pmatrix} Y^A & -Y^B \\\\ -Y^B & Y^C \end{pmatrix}
    ///    \begin{pmatrix} y^g \\\\ y^h \end{pmatrix}
    ///    = \begin{pmatrix} Y^G \\\\ Y^H \end{pmatrix} , $$
    /// $$ x^m = X^M - \tfrac23 X^G x^g , \quad
    ///    y^m = Y^M - 2 Y^G y^g - 2 Y^H y^h , \quad z^m = Z^M . $$
    ///
    /// For a slender body or a disc $y^m$ is much smaller than $Y^M$, and loses digits here.
    pub fn freed(&self, resistance: &ScalarFunctions) -> FreeBodyFunctions {
        let ScalarFunctions { xa, ya, yb, yc, .. } = *resistance;
        let determinant = ya * yc - yb * yb;
        let xg = self.xg / xa;
        let yg = (yc * self.yg + yb * self.yh) / determinant;
        let yh = (yb * self.yg + ya * self.yh) / determinant;
        FreeBodyFunctions {
            xg,
            yg,
            yh,
            xm: self.xm - self.xg * xg / 1.5,
            ym: self.ym - 2.0 * (self.yg * yg + self.yh * yh),
            zm: self.zm,
        }
    }
}

impl FreeBodyFunctions {
    /// The functions about the origin, with the density of the double layer that they are of.
    ///
    /// The solver needs the modes up to [`LAST_MODE`](super::linear_flow::LAST_MODE).
    pub(crate) fn solve(solver: &MobilitySolver) -> (Self, SurfaceModes) {
        let discretization = solver.discretization();
        let free = Wrench {
            force: Vector3::zeros(),
            torque: Vector3::zeros(),
        };
        let (motion, layers) = solver.solve(free, data(discretization));
        let [xm, ym, zm] = of_stresslet(&stresslet(discretization, &layers));
        let functions = Self {
            xg: motion.velocity.z,
            yg: 0.5 * motion.velocity.x,
            yh: 0.5 * motion.angular_velocity.y,
            xm,
            ym,
            zm,
        };
        (functions, layers.double)
    }

    /// The functions about another point of the axis, `height` above the present one. With height
    /// $h$ they are $x^g - h$ and $y^g - \frac12 h + h y^h$; the others do not change.
    pub fn about(&self, height: f64) -> Self {
        Self {
            xg: self.xg - height,
            yg: self.yg - height * (0.5 - self.yh),
            ..*self
        }
    }

    /// The constant $B = 2 y^h$ of Bretherton (1962): the body turns with
    /// $\Omega = \Omega_\infty + B\\, d \times E d$. A spheroid of aspect ratio $q$ (length along
    /// the axis over width) has $B = (q^2 - 1)/(q^2 + 1)$ (Jeffery 1922), a sphere 0, a thin disc
    /// nearly $-1$.
    pub fn bretherton_constant(&self) -> f64 {
        2.0 * self.yh
    }

    /// The intrinsic viscosity of a dilute suspension of such bodies whose axes point in all
    /// directions alike, when nothing but the flow turns them: with the body's `volume` $V$
    ///
    /// $$ [\eta] = \frac{x^m + 2 y^m + 2 z^m}{10\\, V} , $$
    ///
    /// $\frac52$ for a sphere (Einstein 1911).
    ///
    /// The stress of the suspension is $2 \mu (1 + [\eta] \phi) E$ and a pressure, with the volume
    /// fraction $\phi$. The bodies add to that of the fluid their number per volume $\phi / V$
    /// times the mean of their stresslets (Batchelor 1970, J. Fluid Mech. 41, 545). The isotropic
    /// mean of the tensor $m$ is a multiple of the identity on the symmetric tensors without trace.
    /// These have five dimensions, and the $d^{(m)}$ are projections onto one, two and two, so by
    /// the trace the mean stresslet is $\frac{\mu}{5} (x^m + 2 y^m + 2 z^m) E$; it is equal to
    /// $2 \mu V [\eta] E$.
    ///
    /// For spheroids it is Simha's (1940, J. Phys. Chem. 44, 25) sum over Jeffery's integrals
    /// without its last term, which is that of
    /// [`brownian_intrinsic_viscosity`](Self::brownian_intrinsic_viscosity). A steady flow does not
    /// leave the orientations isotropic, because bodies linger in some places of Jeffery's orbits.
    /// So the value is that of a flow that has just started, or of a small oscillation that is fast
    /// compared with rotational diffusion.
    pub fn intrinsic_viscosity(&self, volume: f64) -> f64 {
        (self.xm + 2.0 * (self.ym + self.zm)) / (10.0 * volume)
    }

    /// The intrinsic viscosity in a steady flow so weak that Brownian rotation keeps the
    /// orientations nearly isotropic: the zero-shear viscosity that is measured for macromolecules.
    /// With the Bretherton constant $B$ and the mobility function $y^c$ for viscosity 1
    ///
    /// $$ [\eta]_0 = [\eta] + \frac{B^2}{10\\, V y^c} . $$
    ///
    /// The flow makes the density of orientations
    /// $\frac{1}{4\pi} (1 + \frac{B}{2 D}\\, d \cdot E d)$ to first order, where
    /// $D = k_B T y^c / \mu$ is the coefficient of rotational diffusion; the Brownian torques add
    /// the mean stresslet $3 k_B T B\\, \langle dd - \frac13 1 \rangle$ (Hinch & Leal 1972, J.
    /// Fluid Mech. 52, 683), which is $\frac{B^2 k_B T}{5 D} E$. For spheroids the values are those
    /// of Simha (1940) and Scheraga (1955, J. Chem. Phys. 23, 1526).
    pub fn brownian_intrinsic_viscosity(&self, volume: f64, mobility: &ScalarFunctions) -> f64 {
        let b = self.bretherton_constant();
        self.intrinsic_viscosity(volume) + b * b / (10.0 * volume * mobility.yc)
    }
}
