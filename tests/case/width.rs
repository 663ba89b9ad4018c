//! Comments are at most 100 columns wide, everywhere.

use std::fs;
use std::path::Path;

const WIDEST: usize = 100;

/// The comments below a folder that are too wide, each with its file and line.
fn too_wide(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .unwrap_or_default();
        if path.is_dir() && name != "target" && !name.starts_with('.') {
            too_wide(&path, found);
        } else if name.ends_with(".rs") {
            let text = fs::read_to_string(&path).expect("a file");
            for (line, text) in (1..).zip(text.lines()) {
                if text.trim_start().starts_with("//") && text.chars().count() > WIDEST {
                    found.push(format!("{}:{line}", path.display()));
                }
            }
        }
    }
}

#[test]
fn comments_are_narrow_enough() {
    let mut found = Vec::new();
    too_wide(Path::new(env!("CARGO_MANIFEST_DIR")), &mut found);
    assert!(found.is_empty(), "wider than {WIDEST} columns: {found:#?}");
}
