//! What the README shows is what there is.

use std::fs;
use std::path::Path;
use std::process::Command;

const README: &str = include_str!("../../README.md");

/// The first block of a language in the README.
fn block(language: &str) -> &'static str {
    block_of(README, language)
}

fn block_of(text: &'static str, language: &str) -> &'static str {
    let start = format!("\n```{language}\n");
    let (_, rest) = text.split_once(&start).expect("a block");
    rest.split_once("```").expect("its end").0
}

fn solve(case: &Path) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(["solve".as_ref(), case.as_os_str()])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("the program runs");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{}: {stderr}", case.display());
    String::from_utf8(output.stdout).expect("text")
}

/// Equal words, or numbers that are equal to ten digits or both rounding errors.
fn same(a: &str, b: &str) -> bool {
    let number = |text: &str| text.trim_end_matches(',').parse::<f64>().ok();
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-10 * a.abs().max(b.abs()) + 1e-13;
    a == b || matches!((number(a), number(b)), (Some(a), Some(b)) if near(a, b))
}

#[test]
fn the_first_case_and_its_answer() {
    let case = Path::new("examples/cases/first.toml");
    assert_eq!(
        block("toml"),
        include_str!("../../examples/cases/first.toml"),
        "the README shows another case than {}",
        case.display()
    );
    let (shown, answer) = (block("text"), solve(case));
    assert_eq!(shown.lines().count(), answer.lines().count());
    for (shown, line) in shown.lines().zip(answer.lines()) {
        if shown.starts_with("seconds:") {
            continue;
        }
        let words = shown.split_whitespace().zip(line.split_whitespace());
        assert!(
            words.into_iter().all(|(a, b)| same(a, b)),
            "{shown}\n{line}"
        );
    }
}

#[test]
fn the_plane_and_output_are_read() {
    let sections = README.split("\n```toml\n[plane]").nth(1).expect("a block");
    let sections = sections.split_once("```").expect("its end").0;
    let text = format!("{}[plane]{sections}", block("toml"));
    let case = axistokes::case::Case::parse(&text, "first.toml").expect("a case");
    assert_eq!(case.check_supported(), Ok(()));
    assert!(case.output.is_some_and(|output| output.vtk));
}

#[test]
fn the_library_example_is_that_of_the_front_page() {
    let front = include_str!("../../src/lib.rs");
    let code: String = front
        .lines()
        .skip_while(|line| *line != "//! ```")
        .skip(1)
        .take_while(|line| *line != "//! ```")
        .map(|line| {
            line.trim_start_matches("//!")
                .trim_start_matches(' ')
                .to_owned()
                + "\n"
        })
        .collect();
    let unindented = |text: &str| -> Vec<String> {
        text.lines()
            .map(|line| line.trim_start().to_owned())
            .collect()
    };
    let (_, section) = README.split_once("## As a library").expect("a section");
    assert_eq!(unindented(&code), unindented(block_of(section, "rust")));
}

#[test]
fn every_example_case_is_solved() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/cases");
    for entry in fs::read_dir(folder).expect("the folder") {
        solve(&entry.expect("an entry").path());
    }
}
