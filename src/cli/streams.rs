//! Writing to stdout and stderr without panics.

use super::failure::Failure;
use std::io::{ErrorKind, Write, stderr, stdout};

/// Writes to stdout; a reader that has gone away (`| head`) is not an error.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Other(format!("cannot write to stdout: {error}")))
        }
        _ => Ok(()),
    }
}

/// Writes one line to stderr.
pub fn complain(line: &str) {
    // nobody is left to hear about a stderr that is closed
    let _ = writeln!(stderr().lock(), "{line}");
}
