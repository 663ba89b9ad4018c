//! What a valid case may not have meant.

use super::{Body, Case, Component};

impl Case {
    /// What is valid in this case but seldom meant, one line each.
    pub fn warnings(&self) -> Vec<String> {
        // the known flow takes the place of all that is imposed
        if self.test.is_some() {
            return Vec::new();
        }
        let mut warnings: Vec<String> = (1..)
            .zip(&self.bodies)
            .filter(|(_, body)| body.slip.is_some() && !body.motion_given)
            .map(|(number, body)| held(number, body))
            .collect();
        if self.background.is_none() && self.bodies.iter().all(does_nothing) {
            warnings.push("nothing moves: no velocity, force, slip or background".to_owned());
        }
        warnings
    }
}

/// The warning for a body that is held for want of a word about its motion.
fn held(number: usize, body: &Body) -> String {
    format!(
        "body {number} (line {}) has a slip but neither force nor velocity, and is held: \
         it pumps fluid; give force = [0, 0, 0] to let it swim",
        body.line
    )
}

/// Whether a body has no slip, and neither a velocity nor a load that is not zero.
fn does_nothing(body: &Body) -> bool {
    let zero = |component: &Component| match *component {
        Component::Imposed(value) | Component::Free(value) => value == 0.0,
    };
    body.slip.is_none() && body.components.iter().all(zero)
}
