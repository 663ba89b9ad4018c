//! What is imposed on a body: the right-hand side of its equation but for what the other bodies do.

use bodies_of_revolution::RigidMotion;
use nalgebra::Vector3;
use stokes_body::discretization::Discretization;
use stokes_body::linear_flow::LinearFlow;
use stokes_body::shell::Shell;
use stokes_body::surface::SurfaceModes;

use super::motion::Motion;
use super::suspension::Body;

/// What is imposed on a body, in its frame.
pub(crate) struct Imposed {
    /// $u_s - u_\infty$ and, of a held body, its motion.
    pub velocity: SurfaceModes,
    /// The slip $u_s$ alone, if there is one.
    pub slip: Option<SurfaceModes>,
    /// The density of a free body's single layer.
    pub single: Option<SurfaceModes>,
    /// The largest speed of motion and slip together, or of the background; infinite if one is not
    /// finite.
    pub largest: f64,
}

impl Imposed {
    /// Modes up to `n_max`, slips sampled for `oversampling` times as many; `free` is the shell of
    /// a free body.
    pub fn new(
        body: &Body,
        background: &LinearFlow,
        discretization: &Discretization,
        n_max: usize,
        oversampling: f64,
        free: Option<&Shell>,
    ) -> Self {
        let frame = &body.frame;
        let undisturbed = background.in_frame(frame).on(discretization);
        let motion: RigidMotion = frame.motion_to_body(body.motion.given());
        let of_motion = SurfaceModes::of_motion(discretization, &motion);
        let (velocity, slip, largest) = match &body.slip {
            Some(slip) => {
                let most = (oversampling * n_max as f64) as usize;
                let whole = |x: Vector3<f64>| motion.at(x) + slip.at(x);
                let sampled = SurfaceModes::sample(discretization, most.max(1), whole);
                let velocity = sampled.modes.truncated(n_max.max(1));
                let slip = velocity.clone().plus(-1.0, &of_motion);
                (velocity, Some(slip), sampled.largest)
            }
            None => {
                let sampled = SurfaceModes::sample(discretization, 1, |x| motion.at(x));
                (of_motion, None, sampled.largest)
            }
        };
        let single = match (body.motion, free) {
            (Motion::Free(wrench), Some(shell)) => {
                let motion = shell.motion(frame.wrench_to_body(wrench));
                Some(SurfaceModes::of_motion(discretization, &motion))
            }
            _ => None,
        };
        Self {
            largest: largest.max(undisturbed.largest),
            velocity: velocity.plus(-1.0, &undisturbed.modes),
            slip,
            single,
        }
    }
}
