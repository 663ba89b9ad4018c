//! Parts of the format that are read but cannot be solved yet.

use super::{Body, Case, CaseError, Formulation, Motion};

impl Case {
    /// Refuses, by name, the parts of the format that cannot be solved yet. The error names all of
    /// them, at the line of the first.
    pub fn check_supported(&self) -> Result<(), CaseError> {
        let mut missing: Vec<(usize, String)> = Vec::new();
        let time = self.time.as_ref().map(|time| time.line);
        missing.extend(time.map(|line| (line, "[time]".to_owned())));
        if self.test.is_some() {
            let line = self.background.as_ref().map(|s| s.line);
            missing.extend(line.map(|line| (line, "[background] beside [test]".to_owned())));
        } else if self.solver.formulation == Formulation::SingleLayer {
            missing.extend(only_free(&self.bodies));
        }
        let Some(&(line, _)) = missing.first() else {
            return Ok(());
        };
        let names: Vec<String> = missing.into_iter().map(|(_, name)| name).collect();
        Err(self.error(line, format!("not supported yet: {}", names.join(", "))))
    }
}

/// The first body's motion, if all bodies are free: their equation has no single layer alone.
fn only_free(bodies: &[Body]) -> Option<(usize, String)> {
    let free = |body: &Body| !body.is_mixed() && matches!(body.motion.value, Motion::Free { .. });
    let name = "the single-layer formulation of a free body";
    let line = bodies.first()?.motion.line;
    bodies.iter().all(free).then(|| (line, name.to_owned()))
}
