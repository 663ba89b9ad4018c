//! The files that `solve` writes: a picture, VTK files.

use super::args::Solve;
use super::failure::Failure;
use super::folder::Folder;
use axistokes::SuspensionError;
use axistokes::case::Case;
use axistokes::output::picture::{PictureError, Quantity};
use axistokes::output::vtk::{Mesh, VtkError, plane_file};
use axistokes::output::{View, ViewError};
use axistokes::progress::Progress;
use axistokes::solve::Solved;
use std::ffi::OsStr;
use std::path::Path;

/// The files that are asked for, in folders that can be written to.
pub struct Files {
    picture: Option<(Folder, String, Quantity)>,
    vtk: Option<Folder>,
}

impl Files {
    /// What the arguments and `[output]` ask for.
    pub fn asked(arguments: &Solve, case: &Case) -> Result<Self, Failure> {
        let quantity = arguments.picture_of.into();
        let picture = match &arguments.picture {
            Some(path) => Some(picture_file(path, quantity)?),
            None => None,
        };
        let wanted = arguments.vtk || case.output.as_ref().is_some_and(|output| output.vtk);
        let vtk = wanted.then(|| vtk_folder(case)).transpose()?;
        Ok(Self { picture, vtk })
    }

    /// Writes them all; returns a line that says so.
    pub fn write(
        &self,
        case: &Case,
        solved: &Solved,
        progress: &dyn Progress,
    ) -> Result<String, Failure> {
        if self.picture.is_none() && self.vtk.is_none() {
            return Ok(String::new());
        }
        let flow = &solved.answer.flow;
        let view = View::in_plane(flow, solved.plane, progress)?
            .relative_to(solved.observer)
            .titled(stem(case));
        let mut written = Vec::new();
        // Everything is made before anything is written.
        if let Some((folder, name, quantity)) = &self.picture {
            let drawn = encoded(view.picture(*quantity)?, name)?;
            written.push((folder, vec![(name.clone(), drawn)]));
        }
        if let Some(folder) = &self.vtk {
            progress.begin("files for VTK", 0);
            written.push((folder, vtk_files(case, solved, &view, progress)?));
        }
        if progress.is_cancelled() {
            return Err(Failure::Interrupted);
        }
        let mut names = Vec::new();
        for (folder, files) in &written {
            folder.write(files)?;
            let paths = files.iter().map(|(name, _)| folder.path().join(name));
            names.extend(paths.map(|path| path.display().to_string()));
        }
        Ok(format!("written: {}\n", names.join(", ")))
    }
}

/// Folder and name of the picture.
fn picture_file(path: &Path, quantity: Quantity) -> Result<(Folder, String, Quantity), Failure> {
    let refuse = |why: &str| Failure::Input(format!("--picture {}: {why}", path.display()));
    let kind = path.extension().and_then(OsStr::to_str);
    let name = path.file_name().and_then(OsStr::to_str);
    let name = match (name, kind) {
        (Some(name), Some("svg")) => name,
        (Some(name), Some("png")) if cfg!(feature = "png") => name,
        (_, Some("png")) => {
            return Err(refuse(
                "this program was built without PNG (cargo build --features png): \
                 expected the name of a file that ends in .svg",
            ));
        }
        _ if cfg!(feature = "png") => {
            return Err(refuse(
                "expected the name of a file that ends in .svg or .png",
            ));
        }
        _ => return Err(refuse("expected the name of a file that ends in .svg")),
    };
    if path.is_dir() {
        return Err(refuse("this is a folder"));
    }
    let folder = match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    };
    let folder = Folder::open(folder).map_err(|why| refuse(&why))?;
    Ok((folder, name.to_owned(), quantity))
}

/// A picture as its file's name says: SVG, or PNG.
fn encoded(picture: String, name: &str) -> Result<Vec<u8>, PictureError> {
    #[cfg(feature = "png")]
    if name.ends_with(".png") {
        return axistokes::output::picture::png(&picture);
    }
    #[cfg(not(feature = "png"))]
    let _ = name;
    Ok(picture.into_bytes())
}

/// What a case is called.
fn stem(case: &Case) -> &str {
    let stem = case.path.file_stem().and_then(OsStr::to_str);
    stem.unwrap_or("case")
}

/// The folder of the VTK files: what `[output]` says, or that of the case.
fn vtk_folder(case: &Case) -> Result<Folder, Failure> {
    let beside = case.path.parent().unwrap_or(Path::new(""));
    let output = case.output.as_ref();
    let named = output.and_then(|output| output.directory.as_deref());
    let folder = beside.join(named.unwrap_or(Path::new(".")));
    Folder::open(&folder).map_err(|why| {
        let why = format!("{}: {why}", folder.display());
        Failure::Input(match output {
            Some(output) => {
                let message = format!("output.directory: {why}");
                case.error(output.line, message).to_string()
            }
            None => format!("--vtk: {why}"),
        })
    })
}

fn vtk_files(
    case: &Case,
    solved: &Solved,
    view: &View,
    progress: &dyn Progress,
) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let stem = stem(case);
    let surfaces = Mesh::of(&solved.answer, Mesh::azimuths, progress)?.file()?;
    Ok(vec![
        (format!("{stem}-bodies.vtu"), surfaces),
        (format!("{stem}-plane.vts"), plane_file(&view.flow)?),
    ])
}

impl From<PictureError> for Failure {
    fn from(error: PictureError) -> Self {
        match error {
            PictureError::NoFluid => Self::Input(error.to_string()),
            _ => Self::Other(error.to_string()),
        }
    }
}

impl From<VtkError> for Failure {
    fn from(error: VtkError) -> Self {
        Self::Other(error.to_string())
    }
}

impl From<ViewError> for Failure {
    fn from(error: ViewError) -> Self {
        match error {
            ViewError::Flow(error) => error.into(),
            other => Self::Other(other.to_string()),
        }
    }
}

impl From<SuspensionError> for Failure {
    fn from(error: SuspensionError) -> Self {
        match error {
            SuspensionError::Interrupted => Self::Interrupted,
            other => Self::Other(other.to_string()),
        }
    }
}
