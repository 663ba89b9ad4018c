//! Parts of the format that are read but cannot be solved yet.

use super::{Case, CaseError, Motion};

/// Refuses a case that needs what is not built, naming all of it at the line of the first.
pub(super) fn check(case: &Case) -> Result<(), CaseError> {
    let mut missing: Vec<(usize, String)> = Vec::new();
    let sections = [
        ("[time]", case.time.as_ref().map(|s| s.line)),
        ("[background]", case.background.as_ref().map(|s| s.line)),
        ("[output]", case.output.as_ref().map(|s| s.line)),
    ];
    for (name, line) in sections {
        missing.extend(line.map(|line| (line, name.to_owned())));
    }
    if let [_, second, ..] = &case.bodies[..] {
        let given = case.bodies.len();
        missing.push((second.line, format!("more than one body ({given} given)")));
    }
    // with [test] the known flow replaces what bodies impose
    if case.test.is_none() {
        missing.extend(first_free(case));
        let slip = case.bodies.iter().find_map(|body| body.slip.as_ref());
        missing.extend(slip.map(|slip| (slip.line, "slip".to_owned())));
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
    let name = "force and torque imposed on a free body";
    Some((body.motion.line, name.to_owned()))
}
