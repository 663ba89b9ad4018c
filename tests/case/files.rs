//! The project's cases are read whole, and those of later issues refused by name; mutations never
//! panic.

use axistokes::case::{
    Accuracy, Background, Body, BodyOrientation, Case, Component, Motion, ShapeSpec, Slip, Steps,
};
use proptest::prelude::*;
use std::path::{Path, PathBuf};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/data/cases")
        .join(name)
}

fn read(name: &str) -> Case {
    Case::read(path(name)).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn every_case_is_read() {
    let mut cases = 0;
    for entry in std::fs::read_dir(path("")).unwrap() {
        let path = entry.unwrap().path();
        if let Err(error) = Case::read(&path) {
            panic!("{error}");
        }
        cases += 1;
    }
    assert_eq!(cases, 11);
}

#[test]
fn cases_of_one_body_and_of_many_are_supported() {
    for name in [
        "sphere-drag",
        "oblique-spheroid",
        "thesis-single-body",
        "torus-spin",
        "capsule",
        "jeffery",
        "squirmer",
        "two-spheres",
        "eight-sinking",
        "held-and-free",
    ] {
        let case = read(&format!("{name}.toml"));
        assert_eq!(case.check_supported(), Ok(()), "{name}");
    }
}

#[test]
fn cases_of_later_issues_are_refused_by_name() {
    let error = read("sinking-pair.toml").check_supported().unwrap_err();
    assert_eq!(error.message(), "not supported yet: [time]");
    assert!(error.line().is_some());
}

#[test]
fn values_are_those_of_the_file() {
    let case = read("oblique-spheroid.toml");
    assert_eq!(case.viscosity, 2.5);
    assert_eq!(case.tolerance(), Some(1e-9));
    let body = &case.bodies[0];
    let rod = ShapeSpec::Spheroid {
        polar: 1.0,
        equatorial: 0.5,
    };
    assert_eq!(case.shape_of(body).value, rod);
    assert!(
        body.axis
            .iter()
            .all(|x| (x - 1.0 / 3.0_f64.sqrt()).abs() < 1e-15)
    );
    let motion = Motion::Rigid {
        velocity: [0.0, 0.0, 1.0],
        angular_velocity: [0.3, 0.0, -0.2],
    };
    assert_eq!((body.motion.value, body.motion.line), (motion, 14));
    assert_eq!(
        (case.probes[1].value, case.probes[1].line),
        ([1.0, -2.0, 2.5], 21)
    );

    let case = read("thesis-single-body.toml");
    let by_hand = Accuracy::ByHand {
        panels: 8,
        order: 16,
        modes: 60,
    };
    assert_eq!(case.accuracy, by_hand);
    let test = case.test.unwrap();
    assert_eq!(test.stokeslets.len(), 5);
    assert_eq!(test.stokeslets[4].force[2], -2.015177655919);
    assert_eq!(test.stokeslets[4].line, 23);
}

#[test]
fn sections_of_later_issues_are_typed() {
    let jeffery = read("jeffery.toml").background.unwrap().value;
    assert!(matches!(jeffery, Background::Shear { rate: 1.0, .. }));
    let pair = read("sinking-pair.toml");
    assert_eq!(pair.time.unwrap().steps, Steps::Adaptive(1e-6));
    assert!(pair.output.unwrap().vtk);
    let squirmer = read("squirmer.toml").bodies.remove(0).slip.unwrap().value;
    assert_eq!(squirmer, Slip::Squirmer { b: vec![1.5, 3.0] });
}

#[test]
fn defaults_are_documented_ones() {
    let text = "shapes.a = { kind = 'sphere', radius = 1 }\nshapes.b = { kind = 'biconcave', radius = 2 }\nbodies = [{ shape = 'a' }]";
    let case = Case::parse(text, "default.toml").unwrap();
    assert_eq!(case.accuracy, Accuracy::Tolerance(1e-8));
    assert_eq!(case.viscosity, 1.0);
    assert_eq!(case.bodies[0].axis, [0.0, 0.0, 1.0]);
    assert_eq!(case.shapes["b"].line, 2);
    let held = Motion::Rigid {
        velocity: [0.0; 3],
        angular_velocity: [0.0; 3],
    };
    assert_eq!(case.bodies[0].motion.value, held);
    assert_eq!(case.check_supported(), Ok(()));
}

/// The one body of a case, which has these lines.
fn body(lines: &str) -> Body {
    let text =
        format!("shapes.a = {{ kind = 'sphere', radius = 1 }}\n[[bodies]]\nshape = 'a'\n{lines}");
    let mut case = Case::parse(&text, "body.toml").unwrap();
    case.bodies.remove(0)
}

#[test]
fn an_orientation_is_a_quaternion_of_any_length() {
    let turned = body("orientation = [1e3, 0, 1e3, 0]");
    let half = 0.5_f64.sqrt();
    let BodyOrientation::Quaternion(quaternion) = turned.orientation else {
        panic!("{:?}", turned.orientation);
    };
    for (found, exact) in quaternion.iter().zip([half, 0.0, half, 0.0]) {
        assert!((found - exact).abs() < 1e-15);
    }
    for (found, exact) in turned.axis.iter().zip([1.0, 0.0, 0.0]) {
        assert!((found - exact).abs() < 1e-15);
    }
    let along = body("axis = [2, 0, 0]");
    let axis = [1.0, 0.0, 0.0];
    assert_eq!(
        (along.orientation, along.axis),
        (BodyOrientation::Axis(axis), axis)
    );
}

#[test]
fn components_are_imposed_or_free() {
    use Component::{Free, Imposed};
    let rest = Imposed(0.0);
    let unloaded = Free(0.0);
    let cases = [
        ("", [rest; 6]),
        (
            "velocity = [1, 2, 3]",
            [Imposed(1.0), Imposed(2.0), Imposed(3.0), rest, rest, rest],
        ),
        (
            "torque = [1, 2, 3]",
            [
                unloaded,
                unloaded,
                unloaded,
                Free(1.0),
                Free(2.0),
                Free(3.0),
            ],
        ),
        (
            "velocity = [0, 5, 'free']\nforce = [0, 0, -1]",
            [rest, Imposed(5.0), Free(-1.0), rest, rest, rest],
        ),
        (
            "velocity = [0, 0, 0]\ntorque = [0, 0, 0]",
            [rest, rest, rest, unloaded, unloaded, unloaded],
        ),
        (
            "force = [1, 0, 0]\nangular_velocity = [0, 0, 0]",
            [Free(1.0), unloaded, unloaded, rest, rest, rest],
        ),
        (
            "angular_velocity = ['free', 0, 0]",
            [rest, rest, rest, unloaded, rest, rest],
        ),
    ];
    for (lines, components) in cases {
        let body = body(lines);
        assert_eq!(body.components, components, "{lines}");
        let free = components.iter().filter(|c| matches!(c, Free(_))).count();
        assert_eq!(body.is_mixed(), free != 0 && free != 6, "{lines}");
    }
    let all_free =
        body("velocity = ['free', 'free', 'free']\nforce = [1, 0, 0]\ntorque = [0, 2, 0]");
    let motion = Motion::Free {
        force: [1.0, 0.0, 0.0],
        torque: [0.0, 2.0, 0.0],
    };
    assert_eq!(all_free.motion.value, motion);
}

#[test]
fn a_tolerance_by_hand_is_not_promised() {
    let case = |accuracy: &str| {
        let text = format!(
            "shapes.a = {{ kind = 'sphere', radius = 1 }}\nbodies = [{{ shape = 'a' }}]\n[accuracy]\n{accuracy}"
        );
        Case::parse(&text, "accuracy.toml").unwrap()
    };
    let tolerances = |case: &Case| (case.tolerance(), case.promised_tolerance());
    let by_hand = "panels = 8\norder = 16\nmodes = 4\n";
    assert_eq!(
        tolerances(&case("tolerance = 1e-6")),
        (Some(1e-6), Some(1e-6))
    );
    assert_eq!(tolerances(&case(by_hand)), (None, None));
    let both = case(&format!("{by_hand}tolerance = 1e-5"));
    assert_eq!(tolerances(&both), (Some(1e-5), None));
    assert_eq!(both.tolerance_by_hand, Some(1e-5));
}

#[test]
fn panels_by_hand_may_take_the_memory_that_the_solver_may() {
    let read = |panels: usize, memory: f64| {
        let text = format!(
            "shapes.a = {{ kind = 'sphere', radius = 1 }}\nbodies = [{{ shape = 'a' }}]\n\
             [accuracy]\npanels = {panels}\norder = 16\nmodes = 4\n[solver]\nmemory = {memory}"
        );
        Case::parse(&text, "memory.toml").map_err(|error| error.to_string())
    };
    // The solution that checks it has 8 * 20 * 3 unknowns in 13 modes: 0.022 GiB.
    assert!(read(8, 0.03).is_ok());
    let error = read(8, 0.01).expect_err("too little memory");
    assert!(error.starts_with("memory.toml:4:"), "{error}");
    // 31.4 GiB: more than most machines have, but it is the user who says so.
    assert!(read(300, 40.0).is_ok());
}

#[test]
fn what_is_seldom_meant_is_warned_of() {
    let warnings = |lines: &str| {
        let text = format!(
            "shapes.a = {{ kind = 'sphere', radius = 1 }}\n[[bodies]]\nshape = 'a'\n{lines}"
        );
        Case::parse(&text, "warned.toml").unwrap().warnings()
    };
    let none: [&str; 0] = [];
    let slip = "slip = { kind = 'squirmer', b = [1] }";
    let held = "body 1 (line 2) has a slip but neither force nor velocity, and is held: \
                it pumps fluid; give force = [0, 0, 0] to let it swim";
    assert_eq!(warnings(slip), [held]);
    assert_eq!(warnings(&format!("{slip}\nforce = [0, 0, 0]")), none);
    assert_eq!(warnings(&format!("{slip}\nvelocity = [0, 0, 0]")), none);
    assert_eq!(
        warnings(&format!(
            "force = [0, 0, 1]\n[[bodies]]\nshape = 'a'\n{slip}"
        ))
        .len(),
        1
    );

    let still = ["nothing moves: no velocity, force, slip or background"];
    assert_eq!(warnings(""), still);
    assert_eq!(warnings("velocity = [0, 0, 'free']"), still);
    assert_eq!(warnings("torque = [0, 0, 1]"), none);
    assert_eq!(warnings("[background]\nkind = 'shear'\nrate = 1"), none);
    let test = "[test]\nstokeslets = [{ at = [0, 0, 0], force = [0, 0, 1] }]\n[probes]\npoints = [[0, 0, 2]]";
    assert_eq!(warnings(test), none);
}

#[test]
fn line_ends_of_other_systems_are_read() {
    let text =
        "\u{feff}[shapes.a]\r\nkind = 'sphere'\r\nradius = 1\r\n[[bodies]]\r\nshape = 'a'\r\n";
    let case = Case::parse(text, "windows.toml").unwrap();
    assert_eq!(case.bodies[0].line, 4);
}

#[test]
fn a_profile_lies_beside_its_case() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("profile-beside-case");
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("curve.csv"), "0,1\n1,0\n0,-1\n").unwrap();
    let text = "[shapes.a]\nkind = 'profile'\nfile = 'curve.csv'\n[[bodies]]\nshape = 'a'";
    let case = Case::parse(text, folder.join("case.toml")).unwrap();
    let file = folder.join("curve.csv");
    assert_eq!(case.shapes["a"].value, ShapeSpec::Profile { file });
}

/// A case with every section of the format.
const WHOLE: &str = "\
viscosity = 1.5
shapes.a = { kind = \"polar\", coefficients = [1.0, 0.0, 0.5] }
shapes.c = { kind = \"capsule\", radius = 1, length = 2 }
shapes.t = { kind = \"torus\", major = 1, minor = 0.25 }
[[bodies]]
shape = \"a\"
center = [0.0, 1e3, -0.5]
axis = [0.0, 0.0, 1.0]
force = [0.0, 0.0, 1.0]
[background]
kind = \"linear\"
gradient = [[1, 0, 0], [0, -1, 0], [0, 0, 0]]
[accuracy]
panels = 8
order = 16
modes = 40
[solver]
formulation = \"single-layer\"
method = \"bicgstab\"
tolerance = 1e-10
max_iterations = 200
[probes]
points = [[0.0, 0.0, 3.0]]
[test]
stokeslets = [ { at = [0.0, 0.1, 0.2], force = [1.0, 0.0, 0.0] } ]
[time]
end = 10.0
step = 0.01
[output]
directory = \"out\"
vtk = true
[plane]
center = [0.0, 0.0, 1.0]
across = [0.0, 1.0, 0.0]
up = [0.0, 0.0, 2.0]
size = [4.0, 3.0]
points = 101
frame = \"body\"
";

#[test]
fn the_whole_format_is_read() {
    Case::parse(WHOLE, "whole.toml").unwrap();
}

/// Whatever the text, the outcome is a case or one line.
fn check_outcome(text: &str) -> Result<(), TestCaseError> {
    match Case::parse(text, "mutated.toml") {
        Ok(case) => {
            let _ = case.check_supported();
        }
        Err(error) => {
            let line = error.to_string();
            prop_assert!(line.starts_with("mutated.toml:"), "{}", line);
            prop_assert!(!line.contains('\n'), "{}", line);
            prop_assert!(
                error
                    .line()
                    .is_none_or(|n| n <= text.lines().count().max(1) + 1)
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn mutated_characters_never_panic(
        edits in prop::collection::vec((0..WHOLE.len(), 0..3_usize, any::<char>()), 1..6),
    ) {
        let mut text: Vec<char> = WHOLE.chars().collect();
        for (at, action, c) in edits {
            let at = at.min(text.len() - 1);
            match action {
                0 => text[at] = c,
                1 => text.insert(at, c),
                _ => { text.remove(at); }
            }
        }
        check_outcome(&text.into_iter().collect::<String>())?;
    }

    #[test]
    fn shuffled_pieces_never_panic(
        edits in prop::collection::vec((0..30_usize, 0..30_usize, 0..4_usize), 1..6),
        word in "[-+]?(nan|inf|[0-9]{1,3}(e[0-9]{1,4})?|true|\"\"|\\[\\[?|\\{|\\}|\\]|=|\\.|#|'''|a)",
    ) {
        let mut lines: Vec<String> = WHOLE.lines().map(str::to_owned).collect();
        for (a, b, action) in edits {
            let (a, b) = (a % lines.len(), b % lines.len());
            match action {
                0 => lines.swap(a, b),
                1 => { let line = lines[b].clone(); lines.insert(a, line); }
                2 => { lines[a] = match lines[a].split_once('=') {
                    Some((key, _)) => format!("{key} = {word}"),
                    None => word.clone(),
                }; }
                _ => { lines.remove(a); }
            }
            if lines.is_empty() {
                lines.push(String::new());
            }
        }
        check_outcome(&lines.join("\n"))?;
    }

    #[test]
    fn any_text_never_panics(text in "\\PC{0,200}") {
        check_outcome(&text)?;
    }
}
