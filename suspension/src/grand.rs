//! Grand resistance and mobility matrices: of all bodies together.
//!
//! For a cluster of $n$ bodies in a fluid at rest the forces and torques that the bodies exert on the fluid, and their velocities and angular velocities, all
//! about the bodies' centres and in the laboratory, are joined by matrices of $6n \times 6n$ (Kim & Karrila 1991, chapter 5),
//!
//! $$ (F_1, T_1, F_2, T_2, \dots) = R\\, (U_1, \Omega_1, U_2, \Omega_2, \dots), \qquad M = R^{-1}, $$
//!
//! for viscosity 1. Both are symmetric and positive definite. They come from different integral equations, one for held bodies and one for free
//! ones, column by column: symmetry, and that they are inverse to each other, are checks and not imposed.

use nalgebra::{DMatrix, Vector3};

use super::SuspensionError;
use super::assembly::Questions;
use super::suspension::{Motion, Suspension};
use bodies_of_revolution::{RigidMotion, Wrench};
use stokes_body::progress::Progress;

/// A matrix of all bodies, row and column $6i + k$ belonging to component $k$ (three linear, three angular) of body $i$.
#[derive(Clone, Debug)]
pub struct GrandMatrix {
    /// The matrix.
    pub matrix: DMatrix<f64>,
    /// The largest of the columns' estimated errors: of the column's forces relative to the largest of them (a force times its body's size, half its
    /// largest extent, counting as torque), or of its velocities likewise.
    pub error_estimate: f64,
}

impl Suspension<'_> {
    /// The grand resistance matrix of the bodies, whatever is asked of them otherwise.
    ///
    /// # Errors
    /// See [`SuspensionError`].
    pub fn grand_resistance(
        &self,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<GrandMatrix, SuspensionError> {
        let held = Motion::Given(RigidMotion::rest());
        let moving = |v: [Vector3<f64>; 2]| {
            Motion::Given(RigidMotion {
                velocity: v[0],
                angular_velocity: v[1],
            })
        };
        self.grand(held, moving, tolerance, progress)
    }

    /// The grand mobility matrix of the bodies, whatever is asked of them otherwise.
    ///
    /// # Errors
    /// See [`SuspensionError`].
    pub fn grand_mobility(
        &self,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<GrandMatrix, SuspensionError> {
        let free = Motion::Free(Wrench::zero());
        let pushed = |v: [Vector3<f64>; 2]| {
            Motion::Free(Wrench {
                force: v[0],
                torque: v[1],
            })
        };
        self.grand(free, pushed, tolerance, progress)
    }

    /// Column by column; each begins with the resolutions that the one before needed.
    fn grand(
        &self,
        still: Motion,
        elementary: impl Fn([Vector3<f64>; 2]) -> Motion,
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<GrandMatrix, SuspensionError> {
        let mut cluster = Suspension {
            targets: &[],
            background: stokes_body::linear_flow::LinearFlow::rest(),
            ..self.clone()
        };
        for body in &mut cluster.bodies {
            (body.motion, body.slip) = (still, None);
        }
        let count = cluster.bodies.len();
        let mut matrix = DMatrix::zeros(6 * count, 6 * count);
        let mut error_estimate = 0.0f64;
        cluster.check_question(tolerance)?;
        let (mut cluster, gaps) = cluster.arranged(progress)?;
        let mut start = cluster.start(&gaps, tolerance, Questions::Many)?;
        for column in 0..6 * count {
            let mut unit = [Vector3::zeros(); 2];
            unit[column % 6 / 3][column % 3] = 1.0;
            cluster.bodies[column / 6].motion = elementary(unit);
            let round = cluster.converge(start, tolerance, Questions::Many, progress)?;
            for body in 0..count {
                let frame = &cluster.bodies[body].frame;
                let [linear, angular] = match still {
                    Motion::Given(_) => {
                        let wrench = frame.wrench_to_lab(round.best.solution.wrenches[body]);
                        [wrench.force, wrench.torque]
                    }
                    Motion::Free(_) => {
                        let motion = frame.motion_to_lab(round.best.solution.motions[body]);
                        [motion.velocity, motion.angular_velocity]
                    }
                };
                for k in 0..3 {
                    matrix[(6 * body + k, column)] = linear[k];
                    matrix[(6 * body + 3 + k, column)] = angular[k];
                }
            }
            error_estimate = error_estimate.max(round.best.error_estimate);
            start = round.into_start();
            cluster.bodies[column / 6].motion = still;
        }
        Ok(GrandMatrix {
            matrix,
            error_estimate,
        })
    }
}
