//! Densities and motions, and how an earlier solution starts the next one.

use std::ops::Add;
use std::sync::Arc;

use bodies_of_revolution::{Frame, RigidMotion, Shape, Wrench};
use panel_quadrature::QuadratureError;
use stokes_body::discretization::Discretization;
use stokes_body::layers::Layers;
use stokes_body::resolution::Resolution;
use stokes_body::surface::SurfaceModes;

use super::class::{Classes, Role};
use super::iteration::Iteration;
use super::layout::Layout;
use super::suspension::Body;

/// Densities and motions of all bodies, for viscosity 1.
#[derive(Clone, Debug)]
pub(crate) struct Solution {
    pub classes: Classes,
    /// What each body's layers make on its own surface: the unknown of the iteration.
    pub unknown: Vec<SurfaceModes>,
    pub layers: Vec<Layers>,
    /// The slips at the nodes, of the bodies that have one.
    pub slips: Vec<Option<SurfaceModes>>,
    /// Rigid motions, and what the bodies exert on the fluid, in their frames.
    pub motions: Vec<RigidMotion>,
    pub wrenches: Vec<Wrench>,
    /// The largest speed that the iteration left on each body.
    pub residual_speeds: Vec<f64>,
    /// The largest speed that was imposed.
    pub largest_imposed: f64,
    pub iteration: Iteration,
    pub seconds: Seconds,
    pub unknowns: usize,
    pub points: usize,
    /// Points near another body, and the bytes of their rows.
    pub near_points: usize,
    pub near_bytes: usize,
}

/// Wall-clock seconds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Seconds {
    /// Assembling the matrices of single bodies, and factoring them.
    pub assemble: f64,
    pub factor: f64,
    /// Finding the points near other bodies, and their rows.
    pub near: f64,
    pub iterate: f64,
    /// Of that, the sums over points.
    pub sum: f64,
}

impl Add for Seconds {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            assemble: self.assemble + other.assemble,
            factor: self.factor + other.factor,
            near: self.near + other.near,
            iterate: self.iterate + other.iterate,
            sum: self.sum + other.sum,
        }
    }
}

/// What the next solution starts from: the unknowns, in the frames of their bodies.
#[derive(Clone, Debug)]
pub(crate) struct Start {
    pub bodies: Vec<StartOfBody>,
}

#[derive(Clone, Debug)]
pub(crate) struct StartOfBody {
    pub shape: Shape,
    pub role: Role,
    pub resolution: Arc<Resolution>,
    discretization: Discretization,
    frame: Frame,
    unknown: SurfaceModes,
}

/// Angle up to which a sphere's unknown turns with the axis that it was given.
const TURNS_ALONG: f64 = 0.3;

impl Start {
    /// A start from a solution for these bodies.
    pub fn new(bodies: &[Body], solution: &Solution) -> Self {
        let starts = bodies.iter().enumerate().map(|(i, body)| {
            let class = solution.classes.of(i);
            StartOfBody {
                shape: class.kind.shape.clone(),
                role: class.kind.role,
                resolution: class.kind.resolution.clone(),
                discretization: class.tables.discretization.clone(),
                frame: body.frame,
                unknown: solution.unknown[i].clone(),
            }
        });
        Self {
            bodies: starts.collect(),
        }
    }

    /// The start of a body, if it is of the same shape and held or free as then.
    pub fn of(&self, body: usize, shape: &Shape, role: Role) -> Option<&StartOfBody> {
        let start = self.bodies.get(body)?;
        (Arc::ptr_eq(&start.shape, shape) && start.role == role).then_some(start)
    }

    /// The resolutions alone: another load's unknowns are no start.
    pub fn resolutions(&self) -> Self {
        let bodies = self.bodies.iter().map(|body| StartOfBody {
            unknown: SurfaceModes::zero(0, body.discretization.nodes().len()),
            ..body.clone()
        });
        Self {
            bodies: bodies.collect(),
        }
    }

    /// Whether there is anything to start from.
    fn is_empty(&self) -> bool {
        (self.bodies.iter())
            .all(|body| (0..body.unknown.modes()).all(|n| body.unknown.amplitude(n) == 0.0))
    }

    /// The unknowns for bodies in other places and at other resolutions; zero for those that have
    /// no start, none if there is nothing to start from.
    ///
    /// An unknown is kept in its body's frame: it moves and turns with the body. The axis of a
    /// sphere without slip is chosen anew for each configuration; where it is a very different one,
    /// the unknown is turned to it.
    pub fn unknowns(
        &self,
        bodies: &[Body],
        classes: &Classes,
        layout: &Layout,
    ) -> Result<Option<Vec<f64>>, QuadratureError> {
        if self.is_empty() {
            return Ok(None);
        }
        let mut unknowns = vec![0.0; layout.len()];
        for (i, body) in bodies.iter().enumerate() {
            let class = classes.of(i);
            let Some(start) = self.of(i, &class.kind.shape, class.kind.role) else {
                continue;
            };
            let (from, to) = (&start.discretization, &class.tables);
            let turned = body
                .frame
                .orientation()
                .angle_to(&start.frame.orientation());
            let unknown = if body.slip.is_none() && turned > TURNS_ALONG && is_turned_freely(body) {
                let rotation = start.frame.orientation().inverse() * body.frame.orientation();
                &start.unknown.on_turned_sphere(from, &rotation)?
            } else {
                &start.unknown
            };
            let resampled = unknown.resampled(from, &to.discretization, to.n_max)?;
            let scaled = resampled.scaled_by_roots(&to.discretization);
            copy_modes(&mut unknowns[layout.of(i)], &scaled);
        }
        Ok(Some(unknowns))
    }
}

/// Whether the solver chooses the axis of a body.
fn is_turned_freely(body: &Body) -> bool {
    super::arrangement::is_sphere(&*body.shape)
}

/// Copies the modes that both have.
pub(crate) fn copy_modes(to: &mut [f64], from: &[f64]) {
    let count = to.len().min(from.len());
    to[..count].copy_from_slice(&from[..count]);
}
