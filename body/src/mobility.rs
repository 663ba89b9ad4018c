//! Bodies that are free to move: force and torque are given, the rigid motion is wanted.
//!
//! The velocity on the surface is $U + \Omega \times x + u_s$ with unknown $U$, $\Omega$ and given
//! slip $u_s$, in an undisturbed flow $u_\infty$. A single layer $\varrho$ that is itself a rigid
//! motion carries force and torque (see [`shell`](super::shell)), and with the projection $P$ onto
//! the rigid motions the density of the completed double layer solves (Power & Miranda 1987; Kim &
//! Karrila 1991, chapter 17)
//!
//! $$ (\tfrac12 + D + P)\\, \sigma = u_s - u_\infty - S[\varrho], \qquad
//!    u = u_\infty + D[\sigma] + S[\varrho], \qquad U + \Omega \times x = -P\sigma . $$
//!
//! $\frac12 + D$ vanishes on the rigid motions; $P$ makes it invertible, and gives the motion.

use panel_quadrature::QuadratureError;

use super::discretization::Discretization;
use super::factors::{ModalFactors, Seconds};
use super::layers::Layers;
use super::matrix::{LayerPotential, ModalMatrices};
use super::shell::Shell;
use super::surface::SurfaceModes;
use crate::kernel::DoubleLayer;
use crate::progress::Progress;
use bodies_of_revolution::{RigidMotion, Wrench};

/// The factored equation of one shape: solves for any number of loads, slips and undisturbed flows.
#[derive(Debug)]
pub struct MobilitySolver {
    discretization: Discretization,
    shell: Shell,
    factors: ModalFactors,
    /// The single layer's matrices of modes 0 and 1, all that a rigid motion has.
    single: ModalMatrices,
    seconds: Seconds,
}

impl MobilitySolver {
    /// Assembles and factors the equation for modes up to `n_max`, at least 1.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn new(
        discretization: Discretization,
        n_max: usize,
        progress: &dyn Progress,
    ) -> Result<Self, QuadratureError> {
        let shell = Shell::new(&discretization);
        let single = ModalMatrices::of(LayerPotential::Single, &discretization, 1)?;
        let (factors, seconds) = ModalFactors::assembled(&discretization, progress, |done| {
            let n_max = n_max.max(1);
            let mut matrices =
                ModalMatrices::assemble(&discretization, &DoubleLayer, 0.5, n_max, done)?;
            add_rigid_projection(&mut matrices, &discretization, &shell);
            Ok(matrices)
        })?;
        Ok(Self {
            discretization,
            shell,
            factors,
            single,
            seconds,
        })
    }

    /// The nodes.
    pub fn discretization(&self) -> &Discretization {
        &self.discretization
    }

    /// The factors.
    pub fn factors(&self) -> &ModalFactors {
        &self.factors
    }

    /// The surface as a shell.
    pub fn shell(&self) -> &Shell {
        &self.shell
    }

    /// The velocity on the surface of a single layer of modes 0 and 1, all that a rigid motion has.
    pub fn single_layer(&self, density: &SurfaceModes) -> SurfaceModes {
        self.single.apply(&self.discretization, density)
    }

    /// Unknowns of all modes: three components at each node for two families, one for mode 0.
    pub fn unknowns(&self) -> usize {
        self.factors.unknowns()
    }

    /// How long the stages took.
    pub fn seconds(&self) -> Seconds {
        self.seconds
    }

    /// The rigid motion about the origin and the layers of the disturbance, for viscosity 1: of a
    /// body that exerts `wrench` on the fluid (about the origin; the same is exerted on the body
    /// from outside) and whose slip less the undisturbed flow on the surface is `data`,
    /// $u_s - u_\infty$.
    pub fn solve(&self, wrench: Wrench, data: SurfaceModes) -> (RigidMotion, Layers) {
        let discretization = &self.discretization;
        let single = SurfaceModes::of_motion(discretization, &self.shell.motion(wrench));
        let data = data.plus(-1.0, &self.single_layer(&single));
        let double = self.factors.solve(&data);
        let motion = -self.shell.projection(discretization, &double);
        (motion, Layers { double, single })
    }

    /// The rigid motion (about the origin) of a body under force and torque (about the origin), in
    /// a fluid of viscosity 1 at rest.
    pub fn mobility(&self, wrench: Wrench) -> RigidMotion {
        let at_rest = SurfaceModes::zero(0, self.discretization.nodes().len());
        self.solve(wrench, at_rest).0
    }
}

/// Adds $P$: about the centroid the six rigid motions are orthogonal to each other, two in mode 0
/// and, in each of its families, two in mode 1.
fn add_rigid_projection(
    matrices: &mut ModalMatrices,
    discretization: &Discretization,
    shell: &Shell,
) {
    let c = shell.centroid().z;
    matrices.add_projection(discretization, 0, 1.0, |_| [0.0, 0.0, 1.0]);
    matrices.add_projection(discretization, 0, 1.0, |node| [0.0, node.r, 0.0]);
    matrices.add_projection(discretization, 1, 1.0, |_| [1.0, -1.0, 0.0]);
    matrices.add_projection(discretization, 1, 1.0, |node| {
        [node.z - c, c - node.z, -node.r]
    });
}
