//! "Did you mean ...?"

/// The longest name that is compared or shown, in characters.
const LONGEST: usize = 40;

/// What other programs and books call a thing, and what it is called here.
const OTHER_WORDS: &[(&str, &str)] = &[
    ("accuracy", "tolerance"),
    ("ball", "sphere"),
    ("cylinder", "capsule"),
    ("diameter", "radius"),
    ("direction", "axis"),
    ("ellipsoid", "spheroid"),
    ("eps", "tolerance"),
    ("eta", "viscosity"),
    ("flow", "background"),
    ("location", "center"),
    ("mu", "viscosity"),
    ("omega", "angular_velocity"),
    ("origin", "center"),
    ("points", "probes"),
    ("pos", "center"),
    ("position", "center"),
    ("quaternion", "orientation"),
    ("ring", "torus"),
    ("rod", "capsule"),
    ("rotation", "orientation"),
    ("size", "scale"),
    ("spherocylinder", "capsule"),
    ("spin", "angular_velocity"),
    ("tol", "tolerance"),
    ("type", "kind"),
];

/// What is asked for now and then, and is not built.
const NOT_BUILT: &[(&[&str], &str)] = &[
    (
        &["wall", "walls", "plane_wall", "boundary", "boundaries"],
        "walls are not supported, the fluid has no boundary but the bodies",
    ),
    (
        &["box", "cell", "domain", "period", "periodic"],
        "boxes are not supported, the fluid extends to infinity",
    ),
];

/// Why there is no key of this name, if there is more to say than that it is unknown.
pub(super) fn not_built(given: &str) -> Option<&'static str> {
    let entry = NOT_BUILT.iter().find(|(names, _)| names.contains(&given));
    entry.map(|(_, why)| *why)
}

/// The known name that was meant by `given`: another word for it, or the nearest one, if it is near
/// enough to be a typing error or the plural of it.
pub(super) fn nearest<'a>(given: &str, known: &[&'a str]) -> Option<&'a str> {
    if given.len() > LONGEST {
        return None;
    }
    let given = given.to_lowercase();
    let other_words = OTHER_WORDS.iter().filter(|(word, _)| *word == given);
    let word_for = |name: &&&str| other_words.clone().any(|(_, meant)| meant == *name);
    if let Some(name) = known.iter().find(word_for) {
        return Some(name);
    }
    known
        .iter()
        .filter(|name| name.len() <= LONGEST)
        .map(|&name| (difference(&given, &name.to_lowercase()), name))
        .filter(|&(d, name)| d <= 1 + name.len().min(given.len()) / 3)
        .min()
        .map(|(_, name)| name)
}

/// `, did you mean ...?` when a known name is near, and the list of known names.
pub(super) fn hint(given: &str, known: &[&str]) -> String {
    const SHOWN: usize = 12;
    let mut text = match nearest(given, known) {
        Some(name) => format!(", did you mean `{name}`?"),
        None => String::new(),
    };
    if known.is_empty() {
        return text;
    }
    let more = if known.len() > SHOWN { ", ..." } else { "" };
    let shown = known.iter().take(SHOWN);
    let names: Vec<String> = shown
        .map(|name| name.chars().take(LONGEST).collect())
        .collect();
    let list = names.join(", ");
    text.push_str(&format!(" (known: {list}{more})"));
    text
}

/// How different two names are; singular and plural differ by one.
fn difference(a: &str, b: &str) -> usize {
    let as_typed = distance(a, b);
    let in_singular = distance(&singular(a), &singular(b)) + usize::from(a != b);
    as_typed.min(in_singular)
}

/// The name without the ending of a plural.
fn singular(name: &str) -> String {
    match name.strip_suffix("ies") {
        Some(stem) => format!("{stem}y"),
        None => name.strip_suffix('s').unwrap_or(name).to_owned(),
    }
}

/// Levenshtein's distance: insertions, deletions and substitutions that turn `a` into `b`.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &cb) in b.iter().enumerate() {
            let substituted = diagonal + usize::from(ca != cb);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_slip() {
        let known = ["polar", "equatorial", "kind"];
        assert_eq!(nearest("polr", &known), Some("polar"));
        assert_eq!(nearest("equitorial", &known), Some("equatorial"));
        assert_eq!(nearest("temperature", &known), None);
    }

    #[test]
    fn singular_and_plural_are_near() {
        let known = ["bodies", "probes", "axis", "velocity", "shapes"];
        assert_eq!(nearest("body", &known), Some("bodies"));
        assert_eq!(nearest("Bodys", &known), Some("bodies"));
        assert_eq!(nearest("probe", &known), Some("probes"));
        assert_eq!(nearest("velocities", &known), Some("velocity"));
        assert_eq!(nearest("axes", &known), Some("axis"));
    }

    #[test]
    fn other_words_are_known() {
        assert_eq!(nearest("diameter", &["kind", "radius"]), Some("radius"));
        assert_eq!(nearest("diameter", &["kind", "polar"]), None);
        assert_eq!(nearest("position", &["shape", "center"]), Some("center"));
        assert!(not_built("wall").is_some() && not_built("bodies").is_none());
    }

    #[test]
    fn distance_is_levenshtein() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
    }
}
