//! Grand resistance and mobility matrices: of all bodies together.
//!
//! For a cluster of $n$ bodies in a fluid at rest the forces and torques that the bodies exert on
//! the fluid, and their velocities and angular velocities, all about the bodies' centres and in the
//! laboratory, are joined by matrices of $6n \times 6n$ (Kim & Karrila 1991, chapter 5),
//!
//! $$ (F_1, T_1, F_2, T_2, \dots) = R\\, (U_1, \Omega_1, U_2, \Omega_2, \dots),
//! \qquad M = R^{-1} . $$
//!
//! Both are symmetric and positive definite. They come from different integral equations, one for
//! held bodies and one for free ones, column by column: symmetry, and that they are inverse to each
//! other, are checks and not imposed.

use bodies_of_revolution::{RigidMotion, Wrench};
use nalgebra::{DMatrix, Vector3};
use stokes_body::linear_flow::LinearFlow;
use stokes_body::progress::Progress;

use super::answer::{Answer, BodyAnswer};
use super::error::SuspensionError;
use super::motion::Motion;
use super::solver::Solver;
use super::suspension::Suspension;

/// A matrix of all bodies: row and column $6i + k$ belong to component $k$ (three linear, three
/// angular) of body $i$.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct GrandMatrix {
    /// The matrix, for the viscosity of the question.
    pub matrix: DMatrix<f64>,
    /// The largest of the columns' estimated errors: of the column's forces relative to the largest
    /// of them (a force times its body's size, half its largest extent, counting as torque), or of
    /// its velocities likewise. Compare it with the tolerance.
    pub error_estimate: f64,
}

impl Solver {
    /// The grand resistance matrix of the bodies, whatever is asked of them otherwise.
    ///
    /// # Errors
    /// See [`SuspensionError`].
    pub fn grand_resistance(
        &mut self,
        suspension: &Suspension,
        progress: &dyn Progress,
    ) -> Result<GrandMatrix, SuspensionError> {
        let moving = |[velocity, angular_velocity]: [Vector3<f64>; 2]| {
            Motion::Given(RigidMotion {
                velocity,
                angular_velocity,
            })
        };
        let forces = |body: &BodyAnswer| [body.wrench.force, body.wrench.torque];
        self.grand(suspension, "resistance, column", moving, forces, progress)
    }

    /// The grand mobility matrix of the bodies, whatever is asked of them otherwise.
    ///
    /// # Errors
    /// See [`SuspensionError`].
    pub fn grand_mobility(
        &mut self,
        suspension: &Suspension,
        progress: &dyn Progress,
    ) -> Result<GrandMatrix, SuspensionError> {
        let pushed = |[force, torque]: [Vector3<f64>; 2]| Motion::Free(Wrench { force, torque });
        let motions = |body: &BodyAnswer| [body.motion.velocity, body.motion.angular_velocity];
        self.grand(suspension, "mobility, column", pushed, motions, progress)
    }

    /// Column by column; each begins with the resolutions that the one before needed.
    fn grand(
        &mut self,
        suspension: &Suspension,
        what: &'static str,
        elementary: impl Fn([Vector3<f64>; 2]) -> Motion,
        found: impl Fn(&BodyAnswer) -> [Vector3<f64>; 2],
        progress: &dyn Progress,
    ) -> Result<GrandMatrix, SuspensionError> {
        suspension.check()?;
        let still = elementary([Vector3::zeros(); 2]);
        let mut cluster = Suspension {
            probes: Vec::new(),
            background: LinearFlow::rest(),
            ..suspension.clone()
        };
        for body in &mut cluster.bodies {
            (body.motion, body.slip) = (still, None);
        }
        let count = cluster.bodies.len();
        let mut matrix = DMatrix::zeros(6 * count, 6 * count);
        let mut error_estimate = 0.0f64;
        let mut before: Option<Answer> = None;
        for column in 0..6 * count {
            progress.begin_question(what, column + 1, 6 * count);
            let mut unit = [Vector3::zeros(); 2];
            unit[column % 6 / 3][column % 3] = 1.0;
            cluster.bodies[column / 6].motion = elementary(unit);
            let resolutions = before.as_ref().map(|answer| answer.start.resolutions());
            let answer = self.best(&cluster, resolutions.as_ref(), progress)?;
            cluster.bodies[column / 6].motion = still;
            for (body, of_body) in answer.bodies.iter().enumerate() {
                let [linear, angular] = found(of_body);
                for k in 0..3 {
                    matrix[(6 * body + k, column)] = linear[k];
                    matrix[(6 * body + 3 + k, column)] = angular[k];
                }
            }
            error_estimate = error_estimate.max(answer.error_estimate);
            before = Some(answer);
        }
        Ok(GrandMatrix {
            matrix,
            error_estimate,
        })
    }
}
