//! Reading a text file that may be anything: a directory, a device, a gigabyte of garbage.

use super::CaseError;
use std::fs::{File, metadata};
use std::io::{ErrorKind, Read};
use std::path::Path;

/// The largest file that is read, in bytes (4 MiB): whatever it holds, it is judged within a second
/// or so.
pub const LARGEST_FILE: u64 = 4 << 20;

/// The text of a regular file of at most [`LARGEST_FILE`] bytes; everything else is refused before
/// it is read.
pub fn read_text(path: &Path) -> Result<String, CaseError> {
    check_regular(path).map_err(|message| CaseError::new(path.display(), None, message))?;
    let fail = |message: String| CaseError::new(path.display(), None, message);
    let file = File::open(path).map_err(|e| fail(describe(&e)))?;
    text_of(file, path)
}

/// The text that `reader` yields, at most [`LARGEST_FILE`] bytes; `path` names it in errors.
pub(super) fn text_of(reader: impl Read, path: &Path) -> Result<String, CaseError> {
    let fail = |message: String| CaseError::new(path.display(), None, message);
    let mut bytes = Vec::new();
    reader
        .take(LARGEST_FILE + 1)
        .read_to_end(&mut bytes)
        .map_err(|e| fail(describe(&e)))?;
    check_size(bytes.len() as u64).map_err(fail)?;
    String::from_utf8(bytes).map_err(|error| {
        let good = error.utf8_error().valid_up_to();
        let line = 1 + error.as_bytes()[..good]
            .iter()
            .filter(|&&b| b == b'\n')
            .count();
        CaseError::new(path.display(), Some(line), "not UTF-8, expected text")
    })
}

/// Whether `path` is a regular file of acceptable size; otherwise what it is. Does not open the
/// file.
pub fn check_regular(path: &Path) -> Result<(), String> {
    let about = metadata(path).map_err(|e| describe(&e))?;
    if about.is_dir() {
        return Err("is a directory, expected a file".into());
    }
    if !about.is_file() {
        return Err("is not a regular file".into());
    }
    check_size(about.len())
}

fn check_size(bytes: u64) -> Result<(), String> {
    if bytes > LARGEST_FILE {
        let limit = LARGEST_FILE >> 20;
        return Err(format!("too large, expected at most {limit} MiB"));
    }
    Ok(())
}

fn describe(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => "no such file".into(),
        ErrorKind::PermissionDenied => "permission denied".into(),
        _ => format!("cannot be read: {error}"),
    }
}
