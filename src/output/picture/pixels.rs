//! Pictures as pixels.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::fontdb::{Database, Family, Query};
use resvg::usvg::{Options, Tree};

use super::error::PictureError;

/// Pixels of the image per pixel of the SVG: about 300 to an inch at the width of a column.
const SCALE: f32 = 3.0;
/// Fonts for the numbers and names, the first one that there is.
const FONTS: [&str; 6] = [
    "DejaVu Sans",
    "Helvetica",
    "Arial",
    "Liberation Sans",
    "Noto Sans",
    "Segoe UI",
];

/// A picture as PNG, from its SVG.
///
/// # Errors
/// If there is no font on this machine, or the image cannot be made.
pub fn png(svg: &str) -> Result<Vec<u8>, PictureError> {
    let mut fonts = Database::new();
    fonts.load_system_fonts();
    let font = font(&fonts).ok_or(PictureError::NoFont)?;
    fonts.set_sans_serif_family(font);
    let options = Options {
        fontdb: Arc::new(fonts),
        ..Options::default()
    };
    let failed = |error: &dyn std::fmt::Display| PictureError::Image(error.to_string());
    let tree = Tree::from_str(svg, &options).map_err(|error| failed(&error))?;
    let size = tree.size().to_int_size().scale_by(SCALE);
    let pixels = size.and_then(|size| Pixmap::new(size.width(), size.height()));
    let mut pixels = pixels.ok_or_else(|| failed(&"it has no size"))?;
    let scale = Transform::from_scale(SCALE, SCALE);
    resvg::render(&tree, scale, &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| failed(&error))
}

/// The name of a font that there is: a good one, or else any.
fn font(fonts: &Database) -> Option<String> {
    let is_there = |name: &&str| {
        let query = Query {
            families: &[Family::Name(name)],
            ..Query::default()
        };
        fonts.query(&query).is_some()
    };
    let any = || Some(fonts.faces().next()?.families.first()?.0.clone());
    FONTS
        .into_iter()
        .find(is_there)
        .map(str::to_owned)
        .or_else(any)
}
