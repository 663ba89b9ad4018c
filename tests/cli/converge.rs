//! `axistokes converge`: its files, its numbers, and what it refuses.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// An empty folder for one test.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("converge-{name}"));
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).unwrap();
    path
}

fn converge(run: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .arg("converge")
        .args(arguments)
        .current_dir(run)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// The header's names and the numbers below them.
fn csv(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let content = fs::read_to_string(path).unwrap();
    let mut lines = content.lines();
    let head = lines
        .next()
        .unwrap()
        .split(',')
        .map(str::to_owned)
        .collect();
    let row = |line: &str| line.split(',').map(|x| x.parse().unwrap()).collect();
    (head, lines.map(row).collect())
}

#[test]
fn errors_fall_to_rounding_and_files_are_complete() {
    let run = folder("files");
    let output = converge(
        &run,
        &["--tiny", "--order", "16", "--output", "a/b", "--seed", "7"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let stdout = text(&output.stdout);
    for part in [
        "seed 7",
        "absolute error",
        "relative error",
        "alpha",
        "order in panels",
    ] {
        assert!(stdout.contains(part), "no {part} in\n{stdout}");
    }

    let results = run.join("a/b");
    let expected = [
        "convergence.csv",
        "convergence.svg",
        "timing.csv",
        "timing.svg",
    ];
    assert_eq!(names(&results), expected);
    for name in ["convergence.svg", "timing.svg"] {
        let svg = fs::read_to_string(results.join(name)).unwrap();
        assert!(
            svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"),
            "{name}"
        );
        assert!(svg.contains("<text") && !svg.contains("NaN"), "{name}");
    }

    let (head, rows) = csv(&results.join("convergence.csv"));
    let expected = "order,panels,modes,unknowns,absolute_error,relative_error";
    assert_eq!(head.join(","), expected);
    assert_eq!(rows.len(), 8);
    let most_modes: Vec<_> = rows.iter().filter(|row| row[2] == 80.0).collect();
    for pair in most_modes.windows(2) {
        assert!(
            pair[1][1] > pair[0][1] && pair[1][4] < 0.1 * pair[0][4],
            "{pair:?}"
        );
    }
    let last = most_modes.last().unwrap();
    assert!(last[4] <= 1e-12, "{last:?}");
    // With 20 modes only, no number of panels helps.
    assert!(rows.iter().all(|row| row[2] == 80.0 || row[4] > 1e-10));
    for row in &rows {
        assert_eq!(row[3], row[0] * row[1] * (2.0 * row[2] + 1.0));
        assert!(row[5] >= row[4], "velocities are below one: {row:?}");
    }

    let (head, rows) = csv(&results.join("timing.csv"));
    assert_eq!(head.len(), 9);
    assert_eq!(rows.len(), 3);
    assert!(
        rows.iter()
            .all(|row| row.len() == 9 && row.iter().all(|&x| x > 0.0))
    );
}

#[test]
fn refuses_with_one_line_and_writes_nothing() {
    let run = folder("refusals");
    fs::write(run.join("file"), "mine").unwrap();
    for (arguments, part) in [
        (vec!["--output", "file"], "not a folder"),
        (vec!["--output", "file/below"], "cannot make the folder"),
        (vec!["--output", ""], "--output"),
        (vec!["--output"], "--output"),
        (vec!["--order", "12"], "expected 10 or 16"),
        (vec!["--seed", "-1"], "-1"),
        (vec!["--seed", "many"], "many"),
        (vec!["--slow"], "--slow"),
    ] {
        let mut typed = vec!["--tiny"];
        typed.extend(&arguments);
        let output = converge(&run, &typed);
        let stderr = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert_eq!(stderr.lines().count(), 1, "{arguments:?}: {stderr}");
        assert!(stderr.contains(part), "{arguments:?}: {stderr}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
    assert_eq!(names(&run), ["file"]);
    assert_eq!(fs::read_to_string(run.join("file")).unwrap(), "mine");
}
