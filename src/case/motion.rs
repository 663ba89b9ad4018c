//! What is imposed on a body: its motion, the forces on it, or some components of each.

use super::node::Node;
use super::section::Section;
use super::{CaseError, Located};

/// What is imposed on a body; vectors in the laboratory frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The rigid motion is given (zero where the case gives nothing: the body is held).
    Rigid {
        /// Velocity of the centre.
        velocity: [f64; 3],
        /// Angular velocity.
        angular_velocity: [f64; 3],
    },
    /// Force and torque are given, the motion is wanted.
    Free {
        /// Force exerted on the body from outside.
        force: [f64; 3],
        /// Torque about the centre, exerted on the body from outside.
        torque: [f64; 3],
    },
}

/// One of the six components of a rigid motion, in the laboratory frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Component {
    /// The component of velocity or angular velocity is given; that of force or torque is wanted.
    Imposed(f64),
    /// The component of force or torque exerted from outside is given; the motion is wanted.
    Free(f64),
}

/// What a body's table says of its motion.
pub(super) struct Given {
    /// See [`super::Body::components`].
    pub(super) components: [Component; 6],
    /// See [`super::Body::motion`].
    pub(super) motion: Located<Motion>,
    /// Whether the table says anything of it.
    pub(super) by_case: bool,
}

/// The three components of translation or of rotation, by their keys.
struct Triple<'a> {
    velocity: Option<Node<'a>>,
    force: Option<Node<'a>>,
}

impl<'a> Triple<'a> {
    fn new(section: &Section<'a>, [velocity, force]: [&str; 2]) -> Self {
        Self {
            velocity: section.optional(velocity),
            force: section.optional(force),
        }
    }

    fn is_empty(&self) -> bool {
        self.velocity.is_none() && self.force.is_none()
    }

    /// Whether all three are free for lack of a velocity.
    fn is_free(&self) -> bool {
        self.velocity.is_none() && self.force.is_some()
    }

    fn line(&self) -> Option<usize> {
        let node = self.velocity.as_ref().or(self.force.as_ref())?;
        Some(node.line)
    }

    /// The components; if nothing is given, they are free or imposed, and zero.
    fn read(&self, free_if_empty: bool) -> Result<[Component; 3], CaseError> {
        let Some(velocity_node) = &self.velocity else {
            let free = |force: [f64; 3]| force.map(Component::Free);
            return match &self.force {
                Some(force) => force.vector().map(free),
                None if free_if_empty => Ok(free([0.0; 3])),
                None => Ok([Component::Imposed(0.0); 3]),
            };
        };
        let velocity = velocity_node.vector_or_free()?;
        let force = match &self.force {
            Some(node) => node.vector()?,
            None => [0.0; 3],
        };
        if let Some(force_node) = &self.force {
            if velocity.iter().all(Option::is_some) {
                return Err(Node::later(velocity_node, force_node).error(format!(
                    "both {} and {} are given: expected one of them, or \"free\" for the components \
                     of {} in which the body is free to move",
                    velocity_node.key, force_node.key, velocity_node.key
                )));
            }
            let names = ["x", "y", "z"].iter().zip(velocity).zip(force);
            for ((name, velocity), force) in names {
                if velocity.is_some() && force != 0.0 {
                    return Err(force_node.expected(format_args!(
                        "zero as its {name} component, because {} imposes that component",
                        velocity_node.key
                    )));
                }
            }
        }
        let component = |i: usize| match velocity[i] {
            Some(velocity) => Component::Imposed(velocity),
            None => Component::Free(force[i]),
        };
        Ok([0, 1, 2].map(component))
    }
}

/// Reads what is given of `velocity`, `angular_velocity`, `force` and `torque`.
pub(super) fn read_motion(section: &Section<'_>) -> Result<Given, CaseError> {
    let translation = Triple::new(section, ["velocity", "force"]);
    let rotation = Triple::new(section, ["angular_velocity", "torque"]);
    let [a, b, c] = translation.read(rotation.is_free())?;
    let [d, e, f] = rotation.read(translation.is_free())?;
    let components = [a, b, c, d, e, f];
    let line = translation.line().or(rotation.line());
    Ok(Given {
        components,
        motion: Located {
            line: line.unwrap_or(section.node.line),
            value: motion(components),
        },
        by_case: !(translation.is_empty() && rotation.is_empty()),
    })
}

/// Force and torque if all components are free, otherwise the motion with zero where it is free.
fn motion(components: [Component; 6]) -> Motion {
    let free = |component: &Component| matches!(component, Component::Free(_));
    let all_free = components.iter().all(free);
    let [a, b, c, d, e, f] = components.map(|component| match component {
        Component::Free(_) if !all_free => 0.0,
        Component::Free(value) | Component::Imposed(value) => value,
    });
    let (translation, rotation) = ([a, b, c], [d, e, f]);
    if all_free {
        Motion::Free {
            force: translation,
            torque: rotation,
        }
    } else {
        Motion::Rigid {
            velocity: translation,
            angular_velocity: rotation,
        }
    }
}
