//! What is written besides the answer.

use super::CaseError;
use super::node::Node;
use super::section::Section;
use std::path::PathBuf;

/// What `[output]` asks for.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct OutputOptions {
    /// Folder of the files, as given: relative to the folder of the case, which it is if not given.
    pub directory: Option<PathBuf>,
    /// Whether VTK files of the bodies' surfaces and of the plane are written.
    pub vtk: bool,
}

/// Reads `[output]`.
pub(super) fn read_output(node: Node<'_>) -> Result<OutputOptions, CaseError> {
    let section = Section::new(node, &["directory", "vtk"])?;
    let directory = section.read("directory", |node| {
        let path = node.string("the path of a folder")?;
        if path.contains(char::is_control) {
            return Err(node.expected("the path of a folder, without control characters"));
        }
        Ok(PathBuf::from(path))
    })?;
    let vtk = section.read("vtk", Node::boolean)?.unwrap_or_default();
    Ok(OutputOptions { directory, vtk })
}
