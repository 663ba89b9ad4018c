//! The examples are run, not only compiled; they check their own results.

use std::path::Path;
use std::process::Command;

fn run(example: &str, arguments: &[&str]) -> String {
    let mut command = Command::new(env!("CARGO"));
    command.args(["run", "--quiet", "--example", example]);
    if !cfg!(debug_assertions) {
        command.arg("--release");
    }
    let output = command
        .arg("--")
        .args(arguments)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{example}: {stderr}");
    String::from_utf8(output.stdout).expect("text")
}

#[test]
fn drag() {
    assert_eq!(run("drag", &[]).lines().count(), 8);
}

#[test]
fn flow_field() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("flow.svg");
    run("flow_field", &[path.to_str().expect("a path in UTF-8")]);
    let svg = std::fs::read_to_string(path).expect("the picture");
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
}
