//! `axistokes resistance` at the command line.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use axistokes::output::ResistanceReport;

const CASE: &str = "\
viscosity = 2.0
[shapes.ball]
kind = 'sphere'
radius = 0.5
[shapes.pear]
kind = 'polar'
coefficients = [1.0, 0.3, 0.1, 0.15]
[[bodies]]
shape = 'ball'
";

fn run(name: &str, text: &str, arguments: &[&str]) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("resistance");
    fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, text).expect("written");
    Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .arg("resistance")
        .arg(&path)
        .args(arguments)
        .output()
        .expect("the program runs")
}

#[test]
fn json_has_matrices_functions_and_centre_of_every_shape() {
    let output = run("two-shapes", CASE, &["--json"]);
    assert_eq!(output.status.code(), Some(0));
    let report: ResistanceReport = serde_json::from_slice(&output.stdout).expect("a report");
    let [ball, pear] = &report.shapes[..] else {
        panic!("two shapes");
    };
    assert_eq!(
        (report.input.viscosity, &*ball.discretization.shape),
        (2.0, "ball")
    );
    let near = |a: f64, b: f64| (a - b).abs() < 1e-12 * b.abs();
    assert!(near(ball.functions["XA"], 3.0 * PI) && near(ball.functions["xc"], 1.0 / PI));
    assert!(near(ball.resistance[0][0], 6.0 * PI) && near(ball.mobility[5][5], 0.5 / PI));
    assert!(ball.center_of_reaction[2].abs() < 1e-14);
    let f = &pear.functions;
    assert!(near(pear.center_of_reaction[2], -f["YB"] / f["YA"]));
    // T = YB U x d: along -y for U along x.
    assert!(near(pear.resistance[4][0], -2.0 * f["YB"]));
    assert!(near(pear.mobility[4][0], -0.5 * f["yb"]));
    assert!(ball.error_estimate < 1e-8 && pear.error_estimate < 1e-8);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(value["shapes"][1]["shape"], "pear");
    assert_eq!(value["shapes"][1]["order"], 12);
}

#[test]
fn the_table_shows_the_same() {
    let by_hand = format!("{CASE}[accuracy]\npanels = 6\norder = 16\nmodes = 4\n");
    let output = run("table", &by_hand, &[]);
    assert_eq!(output.status.code(), Some(0));
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(text.contains("pear: 6 panels of 16 nodes") && text.contains("chosen by hand"));
    assert!(
        text.contains("XA") && text.contains("9.424777960769e+00"),
        "{text}"
    );
}

#[test]
fn bad_input_is_one_line_and_a_missed_tolerance_is_told() {
    let crossing = CASE.replace("[1.0, 0.3, 0.1, 0.15]", "[0.1, 1.0]");
    let output = run("crossing", &crossing, &[]);
    let line = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{line}");
    assert!(
        line.contains(":5: shapes.pear:") && line.lines().count() == 1,
        "{line}"
    );
    assert!(output.stdout.is_empty());

    let output = run(
        "strict",
        &format!("{CASE}[accuracy]\ntolerance = 1e-14\n"),
        &[],
    );
    let status = output.status.code();
    assert!(matches!(status, Some(0 | 3)), "{status:?}");
}
