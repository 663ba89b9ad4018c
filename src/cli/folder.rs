//! A folder that results are written to, all files or none.

use super::failure::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// A folder that can be written to, or can be made.
#[derive(Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// The folder `path`, which need not exist yet; otherwise why nothing could be written there.
    pub fn open(path: &Path) -> Result<Self, String> {
        if path.as_os_str().is_empty() {
            return Err("expected the name of a folder".into());
        }
        if path.exists() && !path.is_dir() {
            return Err("this is not a folder".into());
        }
        // The deepest part of the path that exists: the rest is made only when there is something
        // to write.
        let absolute = std::path::absolute(path).map_err(|error| error.to_string())?;
        let existing = absolute.ancestors().find(|part| part.exists());
        let existing = existing.ok_or("cannot make the folder")?;
        if !existing.is_dir() {
            let part = existing.display();
            return Err(format!("cannot make the folder: {part} is not a folder"));
        }
        let attempt = temporary(existing, "access");
        fs::write(&attempt, "")
            .and_then(|()| fs::remove_file(&attempt))
            .map_err(|error| format!("cannot write there: {error}"))?;
        Ok(Self(path.to_owned()))
    }

    /// Writes files beside their places, and moves them there when all are complete.
    pub fn write(&self, files: &[(String, Vec<u8>)]) -> Result<(), Failure> {
        let place = |(name, _): &(String, Vec<u8>)| (temporary(&self.0, name), self.0.join(name));
        let attempt = || {
            fs::create_dir_all(&self.0)?;
            for file in files {
                fs::write(place(file).0, &file.1)?;
            }
            for (temporary, path) in files.iter().map(place) {
                fs::rename(temporary, path)?;
            }
            Ok(())
        };
        attempt().map_err(|error: std::io::Error| {
            for (temporary, _) in files.iter().map(place) {
                // what failed may have left nothing to remove
                let _ = fs::remove_file(temporary);
            }
            Failure::Other(format!("{}: cannot write: {error}", self.0.display()))
        })
    }

    /// The folder's path.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

fn temporary(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!(".{name}.{}.part", std::process::id()))
}
