//! A folder that results are written to, each file only when it is complete.

use super::failure::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// A folder that exists and can be written to.
#[derive(Debug)]
pub struct Folder(PathBuf);

impl Folder {
    /// Opens the folder `path`, made if it does not exist; fails if nothing can be written there.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        let refuse = |why: String| Failure::Input(format!("--output {}: {why}", path.display()));
        if path.as_os_str().is_empty() {
            return Err(Failure::Input(
                "--output: expected the name of a folder".into(),
            ));
        }
        if path.exists() && !path.is_dir() {
            return Err(refuse("this is not a folder".into()));
        }
        fs::create_dir_all(path)
            .map_err(|error| refuse(format!("cannot make the folder: {error}")))?;
        let folder = Self(path.to_owned());
        let attempt = folder.temporary("access");
        fs::write(&attempt, "")
            .and_then(|()| fs::remove_file(&attempt))
            .map_err(|error| refuse(format!("cannot write there: {error}")))?;
        Ok(folder)
    }

    /// Writes a file beside its place, then moves it there.
    pub fn write(&self, name: &str, text: &str) -> Result<(), Failure> {
        let (temporary, path) = (self.temporary(name), self.0.join(name));
        fs::write(&temporary, text)
            .and_then(|()| fs::rename(&temporary, &path))
            .map_err(|error| {
                // what failed may have left nothing to remove
                let _ = fs::remove_file(&temporary);
                Failure::Other(format!("{}: cannot write: {error}", path.display()))
            })
    }

    /// The folder's path.
    pub fn path(&self) -> &Path {
        &self.0
    }

    fn temporary(&self, name: &str) -> PathBuf {
        self.0.join(format!(".{name}.{}.part", std::process::id()))
    }
}
