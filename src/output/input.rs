//! The question of a case, repeated with its answer.

use serde::{Deserialize, Serialize};

use crate::case::{Body, Case, Component, Slip};

/// What every report begins with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// The version of the program.
    pub version: String,
    /// The file of the case, as it was named; `stdin` if it was read from there.
    pub case: String,
    /// Viscosity of the fluid.
    pub viscosity: f64,
    /// The largest estimated error that is accepted; none if panels, order and modes were chosen by
    /// hand.
    pub tolerance: Option<f64>,
}

impl Input {
    /// That of a case.
    pub fn of(case: &Case) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            case: case.path.display().to_string(),
            viscosity: case.viscosity,
            tolerance: case.promised_tolerance(),
        }
    }
}

/// Where a body is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// The name of its shape.
    pub shape: String,
    /// Its centre.
    pub center: [f64; 3],
    /// Direction of its symmetry axis, of length one.
    pub axis: [f64; 3],
    /// The rotation from the laboratory's axes, a quaternion of length one with its scalar first.
    pub orientation: [f64; 4],
    /// How many times larger than its shape it is.
    pub scale: f64,
    /// The largest distance of its surface from its centre, or nearly.
    pub size: f64,
}

impl Place {
    /// That of a body of a case, in the library's terms too.
    pub fn of(body: &Body, placed: &stokes_suspension::Body) -> Self {
        let rotation = placed.frame.orientation();
        Self {
            shape: body.shape.clone(),
            center: body.center,
            axis: body.axis,
            orientation: [rotation.w, rotation.i, rotation.j, rotation.k],
            scale: body.scale,
            size: placed.shape.extent() * body.scale,
        }
    }
}

/// What was imposed on a body: of each of its six components a velocity or a force.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Imposed {
    /// Velocity of the centre; none where the body is free.
    pub velocity: [Option<f64>; 3],
    /// Angular velocity; none where the body is free.
    pub angular_velocity: [Option<f64>; 3],
    /// Force from outside; none where the body is held.
    pub force: [Option<f64>; 3],
    /// Torque from outside, about the centre; none where the body is held.
    pub torque: [Option<f64>; 3],
    /// The velocity of the surface, in the words of the case.
    pub slip: Option<Slip>,
}

impl Imposed {
    /// On a body of a case.
    pub fn on(body: &Body) -> Self {
        let held = |k: usize| match body.components[k] {
            Component::Imposed(velocity) => Some(velocity),
            Component::Free(_) => None,
        };
        let free = |k: usize| match body.components[k] {
            Component::Imposed(_) => None,
            Component::Free(force) => Some(force),
        };
        Self {
            velocity: [0, 1, 2].map(held),
            angular_velocity: [3, 4, 5].map(held),
            force: [0, 1, 2].map(free),
            torque: [3, 4, 5].map(free),
            slip: body.slip.as_ref().map(|slip| slip.value.clone()),
        }
    }
}
