//! What a report says: the question again in JSON, digits that are known in tables, and where a
//! long run is on stderr.

use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Output, Stdio};

use serde_json::{Value, json};

/// Runs the program on a case that comes from standard input.
fn run(arguments: &[&str], text: &str) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut stdin = child.stdin.take().expect("a pipe");
    stdin.write_all(text.as_bytes()).expect("it reads");
    drop(stdin);
    child.wait_with_output().expect("it ends")
}

fn answer(arguments: &[&str], text: &str) -> String {
    let output = run(arguments, text);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    String::from_utf8(output.stdout).expect("text")
}

const SWIMMER: &str = "\
viscosity = 2.0
[shapes.cell]
kind = 'sphere'
radius = 0.5
[[bodies]]
shape = 'cell'
center = [1, 0, 0]
axis = [0, 2, 0]
scale = 2
velocity = [0, 0, 'free']
force = [0, 0, 3]
slip = { kind = 'squirmer', b = [1.5, 3.0] }
[background]
kind = 'shear'
rate = 0.5
[accuracy]
tolerance = 1e-3
";

#[test]
fn json_repeats_the_question() {
    let report: Value =
        serde_json::from_str(&answer(&["solve", "--json", "-"], SWIMMER)).expect("JSON");
    assert_eq!(report["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(report["case"], "stdin");
    assert_eq!(
        (&report["viscosity"], &report["tolerance"]),
        (&json!(2.0), &json!(1e-3))
    );
    let shear = json!({
        "kind": "shear", "rate": 0.5, "flow": [1.0, 0.0, 0.0], "gradient": [0.0, 1.0, 0.0],
    });
    assert_eq!(report["background"], shear);
    let sphere = json!({ "kind": "sphere", "radius": 0.5 });
    assert_eq!(report["shapes"], json!({ "cell": sphere }));
    let body = &report["bodies"][0];
    assert_eq!(body["shape"], "cell");
    assert_eq!(body["center"], json!([1.0, 0.0, 0.0]));
    assert_eq!(body["axis"], json!([0.0, 1.0, 0.0]));
    assert_eq!((&body["scale"], &body["size"]), (&json!(2.0), &json!(1.0)));
    let rotation = body["orientation"].as_array().expect("a quaternion");
    let half = 0.5f64.sqrt();
    for (found, exact) in rotation.iter().zip([half, -half, 0.0, 0.0]) {
        assert!(
            (found.as_f64().expect("a number") - exact).abs() < 1e-15,
            "{rotation:?}"
        );
    }
    let imposed = &body["imposed"];
    assert_eq!(imposed["velocity"], json!([0.0, 0.0, null]));
    assert_eq!(imposed["angular_velocity"], json!([0.0, 0.0, 0.0]));
    assert_eq!(imposed["force"], json!([null, null, 3.0]));
    assert_eq!(imposed["torque"], json!([null, null, null]));
    let slip = json!({ "kind": "squirmer", "b": [1.5, 3.0] });
    assert_eq!(imposed["slip"], slip);

    let text = answer(&["resistance", "--json", "-"], SWIMMER);
    let report: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(
        (&report["version"], &report["viscosity"]),
        (&json!("0.1.0"), &json!(2.0))
    );
    assert_eq!(report["shapes"][0]["definition"], sphere);
}

/// The keys of the reports are those of the documentation.
#[test]
fn every_key_is_documented() {
    let documented = include_str!("../../docs/json.md");
    let text = format!("{SWIMMER}[probes]\npoints = [[0, 3, 0]]\n");
    for command in ["solve", "resistance", "grand"] {
        let report = answer(&[command, "--json", "-"], &text);
        let report: Value = serde_json::from_str(&report).expect("JSON");
        let mut tables = vec![&report];
        for list in ["bodies", "discretization", "probes", "shapes"] {
            tables.extend(report[list].as_array().into_iter().flatten());
        }
        tables.extend(report.get("timings"));
        for key in tables
            .iter()
            .filter_map(|table| table.as_object())
            .flat_map(|t| t.keys())
        {
            assert!(documented.contains(&format!("`{key}`")), "{command}: {key}");
        }
    }
}

/// Words of the first line of a table that begins so.
fn words(table: &str, start: &str) -> Vec<String> {
    let line = table
        .lines()
        .find(|line| line.trim_start().starts_with(start));
    let line = line.unwrap_or_else(|| panic!("no {start} in {table}"));
    line.split_whitespace().map(str::to_owned).collect()
}

#[test]
fn tables_show_digits_that_are_known() {
    let pair = |tolerance: &str| {
        format!(
            "[shapes.ball]\nkind = 'sphere'\nradius = 1\n\
             [[bodies]]\nshape = 'ball'\nforce = [0, 0, -1]\n\
             [[bodies]]\nshape = 'ball'\ncenter = [0, 0, 6]\n\
             [accuracy]\ntolerance = {tolerance}\n"
        )
    };
    let loose = answer(&["solve", "-"], &pair("1e-3"));
    // The first body's velocity is found, and its force as it was given.
    let [.., x, y, z] = &words(&loose, "1  ball   velocity")[..] else {
        panic!("{loose}");
    };
    assert_eq!((x.as_str(), y.as_str()), ("0", "0"), "{loose}");
    assert!((9..=16).contains(&z.len()), "{loose}");
    assert_eq!(words(&loose, "angular")[2..], ["0", "0", "0"], "{loose}");
    assert_eq!(words(&loose, "force"), ["force", "0", "0", "-1.000e+00"]);
    let tight = answer(&["solve", "-"], &pair("1e-9"));
    let [.., longer] = &words(&tight, "1  ball   velocity")[..] else {
        panic!("{tight}");
    };
    assert!(longer.len() > z.len(), "{tight}");
}

#[cfg(unix)]
#[test]
fn a_long_run_tells_where_it_is_without_a_terminal() {
    let case = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/tests/data/cases/eight-sinking.toml"
    );
    let text = std::fs::read_to_string(case).expect("the case");
    let mut child = Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(["solve", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut stdin = child.stdin.take().expect("a pipe");
    let strict = text.replace("tolerance = 1e-6", "tolerance = 1e-10");
    stdin.write_all(strict.as_bytes()).expect("it reads");
    drop(stdin);
    let mut line = String::new();
    let mut stderr = BufReader::new(child.stderr.take().expect("a pipe"));
    stderr.read_line(&mut line).expect("a line");
    child.kill().expect("it runs");
    child.wait().expect("it ends");
    let stages = [
        "assembling",
        "factoring",
        "near points",
        "iterating",
        "checking",
        "round 1: ",
    ];
    assert!(stages.iter().any(|stage| line.starts_with(stage)), "{line}");
}
