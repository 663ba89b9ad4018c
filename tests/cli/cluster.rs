//! `axistokes gaps` and `axistokes grand` at the command line.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A case of two spheres whose surfaces are this far apart.
fn pair(name: &str, distance: f64, more: &str) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cluster");
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(format!("{name}.toml"));
    let case = format!(
        "[shapes.ball]\nkind = 'sphere'\nradius = 1\n[[bodies]]\nshape = 'ball'\n\
         [[bodies]]\nshape = 'ball'\ncenter = [0, 0, {}]\nvelocity = [0, 0, -1]\n\
         [accuracy]\ntolerance = 1e-3\n{more}",
        2.0 + distance
    );
    std::fs::write(&path, case).expect("written");
    path.to_str().expect("a path in UTF-8").to_owned()
}

#[test]
fn gaps_are_listed_or_none_are_found() {
    let near = pair("near", 0.5, "");
    let output = run(&["gaps", &near]);
    let table = text(&output.stdout);
    assert!(table.contains("5.000000e-1  apart"), "{table}");
    let output = run(&["gaps", "--json", &near]);
    let report: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["gaps"][0]["bodies"], serde_json::json!([1, 2]));
    let output = run(&["gaps", "--within", "0.25", &near]);
    let line = text(&output.stdout);
    assert!(
        line.ends_with("no two bodies are within 0.25 of each other\n"),
        "{line}"
    );
    for length in ["-1", "nan", "inf", "much"] {
        let output = run(&["gaps", &near, "--within", length]);
        let line = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(
            line.contains("expected a length") && line.lines().count() == 1,
            "{line}"
        );
    }
}

#[test]
fn grand_matrices_have_zeros_and_name_bodies_that_overlap() {
    let near = pair("grand", 2.0, "");
    let table = text(&run(&["grand", &near]).stdout);
    assert!(table.contains("viscosity 1,"), "{table}");
    let rows: Vec<Vec<&str>> = (table.lines())
        .map(|line| line.split_whitespace().collect())
        .filter(|cells: &Vec<_>| cells.len() == 12)
        .collect();
    assert_eq!(rows.len(), 24, "{table}");
    // Forces across the line of centres do not come from motions along it.
    assert_eq!((rows[0][2], rows[2][0]), ("0", "0"), "{table}");
    assert!(rows[0][0].parse::<f64>().is_ok_and(|x| x > 18.0), "{table}");
    let report: Value = serde_json::from_slice(&run(&["grand", "--json", &near]).stdout).unwrap();
    assert_eq!(
        (&report["version"], &report["tolerance"]),
        (&"0.1.0".into(), &1e-3.into())
    );
    // A matrix tells what it belongs to.
    let name = report["bodies"][1]["shape"].as_str().unwrap();
    assert!(report["shapes"][name].is_object(), "{report}");
    assert_eq!(report["bodies"].as_array().unwrap().len(), 2);

    let output = run(&["grand", &pair("overlap", -0.5, "")]);
    let line = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{line}");
    assert!(
        line.contains("body 1 (`ball`) and body 2 (`ball`) overlap by 5.000e-1"),
        "{line}"
    );
}

#[test]
fn a_gap_that_is_too_narrow_is_named() {
    let case = pair("narrow", 1e-4, "[solver]\nmax_iterations = 2\n");
    let output = run(&["solve", &case]);
    let lines = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{lines}");
    let last = lines.lines().last().unwrap_or_default();
    assert!(
        last.contains("the gap of 1.0e-4 between body 1 (`ball`) and body 2 (`ball`) may be"),
        "{lines}"
    );
}
