//! What is known of a body's motion.

use bodies_of_revolution::{RigidMotion, Wrench};
use nalgebra::{UnitQuaternion, Vector3};

/// What is known of a body's rigid motion; in the laboratory, about the body's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The motion itself: the body is *held*. Force and torque are wanted.
    Given(RigidMotion),
    /// Force and torque exerted on the body from outside, which it hands on to the fluid: the body
    /// is *free*. Its motion is wanted.
    Free(Wrench),
    /// Some components of the motion, and of force and torque the others.
    Mixed(Mixed),
}

/// One component of a body's motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Component {
    /// The velocity (or angular velocity) in this direction is given; what holds the body there is
    /// wanted.
    Imposed(f64),
    /// The body may move in this direction, under this force (or torque) from outside.
    Free(f64),
}

/// A body held in some directions and free in the others: pinned but free to turn, on a line, in a
/// plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixed {
    /// The three components of velocity or force, then those of angular velocity or torque.
    pub components: [Component; 6],
    /// What turns the laboratory's axes to those along which the components are taken.
    pub axes: UnitQuaternion<f64>,
}

impl Motion {
    /// These components along the laboratory's axes: three of velocity or force, three of angular
    /// velocity or torque.
    pub fn components(components: [Component; 6]) -> Self {
        Self::components_along(components, UnitQuaternion::identity())
    }

    /// The same along the laboratory's axes turned by `axes`.
    pub fn components_along(components: [Component; 6], axes: UnitQuaternion<f64>) -> Self {
        let mixed = Mixed { components, axes };
        let is_free = |component: &Component| matches!(component, Component::Free(_));
        match components.iter().filter(|c| is_free(c)).count() {
            0 => Self::Given(mixed.given()),
            6 => Self::Free(mixed.load()),
            _ => Self::Mixed(mixed),
        }
    }

    /// Kept in its place, but free to turn under a torque.
    pub fn pinned(torque: Vector3<f64>) -> Self {
        let turning = [0, 1, 2].map(|k| Component::Free(torque[k]));
        let held = Component::Imposed(0.0);
        let [x, y, z] = turning;
        Self::components([held, held, held, x, y, z])
    }

    /// The part of the motion that is given; at rest where the body is free.
    pub(crate) fn given(&self) -> RigidMotion {
        match self {
            Self::Given(motion) => *motion,
            Self::Free(_) => RigidMotion::rest(),
            Self::Mixed(mixed) => mixed.given(),
        }
    }

    /// The unit motions in the directions in which the body is free.
    pub(crate) fn free_directions(&self) -> Vec<RigidMotion> {
        match self {
            Self::Given(_) => Vec::new(),
            Self::Free(wrench) => Mixed {
                components: [0, 1, 2, 3, 4, 5].map(|k| {
                    Component::Free(if k < 3 {
                        wrench.force[k]
                    } else {
                        wrench.torque[k - 3]
                    })
                }),
                axes: UnitQuaternion::identity(),
            }
            .free_directions(),
            Self::Mixed(mixed) => mixed.free_directions(),
        }
    }

    /// Whether anything of force and torque is to be found.
    pub(crate) fn is_held(&self) -> bool {
        !matches!(self, Self::Free(_))
    }

    /// Whether anything of the motion is to be found.
    pub(crate) fn is_found(&self) -> bool {
        !matches!(self, Self::Given(_))
    }

    /// The numbers that it is given by.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Given(RigidMotion {
                velocity: a,
                angular_velocity: b,
            })
            | Self::Free(Wrench {
                force: a,
                torque: b,
            }) => a.iter().chain(b.iter()).copied().collect(),
            Self::Mixed(mixed) => {
                let components = mixed.components.iter().map(|component| match component {
                    Component::Imposed(value) | Component::Free(value) => *value,
                });
                components
                    .chain(mixed.axes.coords.iter().copied())
                    .collect()
            }
        }
    }
}

impl Mixed {
    fn vectors(&self, value: impl Fn(&Component) -> f64) -> [Vector3<f64>; 2] {
        [0, 3].map(|first| {
            let along = Vector3::from_fn(|k, _| value(&self.components[first + k]));
            self.axes * along
        })
    }

    /// The motion that is given, zero in the free directions.
    pub fn given(&self) -> RigidMotion {
        let [velocity, angular_velocity] = self.vectors(|component| match component {
            Component::Imposed(value) => *value,
            Component::Free(_) => 0.0,
        });
        RigidMotion {
            velocity,
            angular_velocity,
        }
    }

    /// Force and torque in the free directions.
    pub fn load(&self) -> Wrench {
        let [force, torque] = self.vectors(|component| match component {
            Component::Imposed(_) => 0.0,
            Component::Free(value) => *value,
        });
        Wrench { force, torque }
    }

    /// The unit motions in the free directions.
    pub(crate) fn free_directions(&self) -> Vec<RigidMotion> {
        let free = (0..6).filter(|&k| matches!(self.components[k], Component::Free(_)));
        let unit = |k: usize| {
            let direction = self.axes * Vector3::ith(k % 3, 1.0);
            if k < 3 {
                RigidMotion::translation(direction)
            } else {
                RigidMotion::rotation(direction)
            }
        };
        free.map(unit).collect()
    }
}
