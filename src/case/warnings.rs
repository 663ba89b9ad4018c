//! What a valid case may not have meant.

use super::{Body, Case, Component};

/// One line for everything in the case that is valid but seldom meant.
pub(super) fn warnings(case: &Case) -> Vec<String> {
    // the known flow takes the place of all that is imposed
    if case.test.is_some() {
        return Vec::new();
    }
    let held = |(number, body): (usize, &Body)| {
        (body.slip.is_some() && !body.motion_given).then(|| {
            format!(
                "body {number} (line {}) has a slip but neither force nor velocity, and is held: \
                 it pumps fluid; give force = [0, 0, 0] to let it swim",
                body.line
            )
        })
    };
    let mut warnings: Vec<String> = (1..).zip(&case.bodies).filter_map(held).collect();
    if case.background.is_none() && case.bodies.iter().all(does_nothing) {
        warnings.push("nothing moves: no velocity, force, slip or background".to_owned());
    }
    warnings
}

/// Whether a body has no slip, and neither a velocity nor a load that is not zero.
fn does_nothing(body: &Body) -> bool {
    let zero = |component: &Component| match *component {
        Component::Imposed(value) | Component::Free(value) => value == 0.0,
    };
    body.slip.is_none() && body.components.iter().all(zero)
}
