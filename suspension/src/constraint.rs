//! Bodies that are held in some directions and free in the others.
//!
//! Such a body has the equation of a held one, $A_{ii}\sigma_i = y_i$, with unknown velocities $a$
//! in its free directions $N$ and given forces $\varphi$ there. Let $E$ take rigid motions to
//! boundary velocities, $L$ boundary velocities $g$ to force and torque of $A_{ii}^{-1} g$, and $R
//! = LE$ be the resistance. From
//!
//! $$ y_i = d_i - \sum_{j \ne i} u_j + E N a, \qquad N^\mathsf{T} L\\, y_i = \varphi $$
//!
//! follows $a = (N^\mathsf{T} R N)^{-1} (\varphi - N^\mathsf{T} L (d_i - \sum u_j))$: what others
//! do to the body, and what is imposed on it, acts through the projection $\Pi = 1 - E H L$ with $H
//! = N (N^\mathsf{T} R N)^{-1} N^\mathsf{T}$, which takes away the forces in the free directions.

use std::f64::consts::PI;
use std::sync::Arc;

use bodies_of_revolution::{Frame, RigidMotion, Wrench};
use faer::MatMut;
use nalgebra::{DMatrix, DVector, Matrix6, Vector6};
use stokes_body::dirichlet::DirichletSolver;
use stokes_body::rigid::inverse_of_resistance;
use stokes_body::surface::SurfaceModes;

use super::motion::Mixed;

/// The rigid motions of a shape as boundary velocities, and what they take; in its frame. Fields
/// are scaled modes 0 and 1.
#[derive(Debug)]
pub(crate) struct RigidResponse {
    /// $E$, motion by motion.
    motions: Vec<Vec<f64>>,
    /// $L$, component by component.
    functionals: Vec<Vec<f64>>,
    /// $R$.
    resistance: Matrix6<f64>,
}

pub(crate) fn elementary(k: usize) -> RigidMotion {
    let mut motion = RigidMotion::rest();
    if k < 3 {
        motion.velocity[k] = 1.0;
    } else {
        motion.angular_velocity[k - 3] = 1.0;
    }
    motion
}

pub(crate) fn six_of_motion(motion: RigidMotion) -> Vector6<f64> {
    let (u, o) = (motion.velocity, motion.angular_velocity);
    Vector6::new(u.x, u.y, u.z, o.x, o.y, o.z)
}

pub(crate) fn six_of_wrench(wrench: Wrench) -> Vector6<f64> {
    let (f, t) = (wrench.force, wrench.torque);
    Vector6::new(f.x, f.y, f.z, t.x, t.y, t.z)
}

fn motion_of(six: &Vector6<f64>) -> RigidMotion {
    RigidMotion {
        velocity: six.fixed_rows::<3>(0).into_owned(),
        angular_velocity: six.fixed_rows::<3>(3).into_owned(),
    }
}

impl RigidResponse {
    /// The response of a shape that is held.
    pub fn new(solver: &DirichletSolver) -> Self {
        let discretization = solver.discretization();
        let unknowns = 3 * discretization.nodes().len();
        let on = |k: usize| SurfaceModes::of_motion(discretization, &elementary(k));
        let motions: Vec<Vec<f64>> = (0..6)
            .map(|k| on(k).scaled_by_roots(discretization))
            .collect();
        let functional = |motion: &Vec<f64>| {
            let mut functional = motion.clone();
            for (n, columns) in functional.chunks_mut(2 * unknowns).enumerate() {
                // The integral of the square of the sine or cosine that a component comes with.
                let around = if n == 0 { 2.0 * PI } else { PI };
                for x in columns.iter_mut() {
                    *x *= around * solver.weights().single;
                }
                let columns = MatMut::from_column_major_slice_mut(columns, unknowns, 2);
                solver.factors().solve_transposed_scaled(n, columns);
            }
            functional
        };
        let functionals: Vec<Vec<f64>> = motions.iter().map(functional).collect();
        let resistance = Matrix6::from_fn(|k, l| dot(&functionals[k], &motions[l]));
        Self {
            motions,
            functionals,
            resistance,
        }
    }

    /// $L g$.
    fn wrench(&self, field: &[f64]) -> Vector6<f64> {
        Vector6::from_fn(|k, _| dot(&self.functionals[k], field))
    }

    /// Adds $E m$.
    fn add(&self, motion: &Vector6<f64>, field: &mut [f64]) {
        for (on, by) in self.motions.iter().zip(motion) {
            for (to, from) in field.iter_mut().zip(on) {
                *to += by * from;
            }
        }
    }

    /// Numbers of modes 0 and 1.
    fn len(&self) -> usize {
        self.motions[0].len()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// What holds one body in some directions.
#[derive(Clone, Debug)]
pub(crate) struct Constraint {
    response: Arc<RigidResponse>,
    /// $H$.
    yielding: Matrix6<f64>,
    /// $N (N^\mathsf{T} R N)^{-1} \varphi$.
    pushed: Vector6<f64>,
    given: RigidMotion,
}

impl Constraint {
    /// The constraint of a body in its place.
    pub fn new(response: Arc<RigidResponse>, mixed: &Mixed, frame: &Frame) -> Self {
        let directions: Vec<RigidMotion> = mixed.free_directions();
        let load = six_of_wrench(mixed.load());
        let columns: Vec<Vector6<f64>> = (directions.iter())
            .map(|&motion| six_of_motion(frame.motion_to_body(motion)))
            .collect();
        let free = DMatrix::from_fn(6, columns.len(), |i, j| columns[j][i]);
        // A rate of work in the laboratory is the scale times that of the numbers in the body's
        // frame.
        let loads = directions.iter().map(|&motion| {
            let direction = six_of_motion(motion);
            load.dot(&direction) / frame.scale()
        });
        let loads = DVector::from_iterator(columns.len(), loads);
        let square = free.transpose() * response.resistance * &free;
        let inverse = inverse_of_resistance(&square).unwrap_or_else(|| {
            // A resistance has an inverse; without one nothing yields.
            DMatrix::zeros(columns.len(), columns.len())
        });
        let yielding = &free * &inverse * free.transpose();
        let pushed = &free * &inverse * loads;
        Self {
            yielding: Matrix6::from_fn(|i, j| yielding[(i, j)]),
            pushed: Vector6::from_fn(|i, _| pushed[i]),
            given: frame.motion_to_body(mixed.given()),
            response,
        }
    }

    /// Numbers of a field that it looks at, the first ones.
    pub fn len(&self) -> usize {
        self.response.len()
    }

    /// $\Pi$, in place.
    pub fn project(&self, field: &mut [f64]) {
        let yields = -self.yielding * self.response.wrench(field);
        self.response.add(&yields, field);
    }

    /// $\Pi$ on rigid motions, $1 - HR$: what the second level of the preconditioner sees of it.
    pub fn on_motions(&self) -> Matrix6<f64> {
        Matrix6::identity() - self.yielding * self.response.resistance
    }

    /// Adds the boundary velocity that the load makes.
    pub fn add_pushed(&self, field: &mut [f64]) {
        self.response.add(&self.pushed, field);
    }

    /// The whole motion, in the body's frame, of a body on which this is imposed, less what others
    /// do.
    pub fn motion(&self, imposed: &[f64]) -> RigidMotion {
        let found = self.pushed - self.yielding * self.response.wrench(imposed);
        self.given + motion_of(&found)
    }
}
