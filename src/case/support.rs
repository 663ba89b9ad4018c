//! Parts of the format that are read but cannot be solved yet.

use super::{Case, CaseError, Formulation, Motion};

/// Refuses a case that needs what is not built, naming all of it at the line of the first.
pub(super) fn check(case: &Case) -> Result<(), CaseError> {
    let mut missing: Vec<(usize, String)> = Vec::new();
    let time = case.time.as_ref().map(|time| time.line);
    missing.extend(time.map(|line| (line, "[time]".to_owned())));
    if let [_, second, ..] = &case.bodies[..] {
        let given = case.bodies.len();
        missing.push((second.line, format!("more than one body ({given} given)")));
    }
    if case.test.is_some() {
        let line = case.background.as_ref().map(|s| s.line);
        missing.extend(line.map(|line| (line, "[background] beside [test]".to_owned())));
    } else if case.solver.formulation == Formulation::SingleLayer {
        missing.extend(first_free(case));
    }
    let Some(&(line, _)) = missing.first() else {
        return Ok(());
    };
    let names: Vec<String> = missing.into_iter().map(|(_, name)| name).collect();
    Err(case.error(line, format!("not supported yet: {}", names.join(", "))))
}

fn first_free(case: &Case) -> Option<(usize, String)> {
    let free = |motion: &Motion| matches!(motion, Motion::Free { .. });
    let body = case.bodies.iter().find(|body| free(&body.motion))?;
    let name = "the single-layer formulation of a free body";
    Some((body.motion.line, name.to_owned()))
}
