//! The canvas of a plot: its diagrams, and text on it.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Why there is no plot.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cannot draw the plot: {0}")]
pub struct PlotError(String);

/// What is drawn on.
pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Width and height of one diagram with its labels, in pixels.
pub(super) const DIAGRAM: (i32, i32) = (640, 440);

/// Draws diagrams in rows and columns on a white ground; `draw` gets the canvas and the corner of
/// each.
pub(super) fn diagrams(
    columns: usize,
    rows: usize,
    draw: impl Fn(&Canvas<'_>, usize, usize, (i32, i32)) -> Result<(), PlotError>,
) -> Result<String, PlotError> {
    let size = (
        DIAGRAM.0 as u32 * columns as u32,
        DIAGRAM.1 as u32 * rows as u32,
    );
    let mut svg = String::new();
    {
        let canvas = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        canvas.fill(&WHITE).map_err(failed)?;
        for column in 0..columns {
            for row in 0..rows {
                let corner = (DIAGRAM.0 * column as i32, DIAGRAM.1 * row as i32);
                draw(&canvas, column, row, corner)?;
            }
        }
        canvas.present().map_err(failed)?;
    }
    Ok(svg)
}

pub(super) fn failed(error: impl std::error::Error) -> PlotError {
    PlotError(error.to_string())
}

/// Writes `text` at a place, `size` pixels high.
pub(super) fn write(
    canvas: &Canvas<'_>,
    text: &str,
    at: (i32, i32),
    size: f64,
    colour: RGBColor,
    (h, v): (HPos, VPos),
) -> Result<(), PlotError> {
    // The backend divides by 1.24.
    let style = ("sans-serif", 1.24 * size).into_font().color(&colour);
    let style = style.pos(Pos::new(h, v));
    canvas.draw_text(text, &style, at).map_err(failed)
}

/// The same, from bottom to top.
pub(super) fn write_upwards(
    canvas: &Canvas<'_>,
    text: &str,
    at: (i32, i32),
    size: f64,
) -> Result<(), PlotError> {
    let font = ("sans-serif", 1.24 * size).into_font();
    let style = font.transform(FontTransform::Rotate270).color(&BLACK);
    let style = style.pos(Pos::new(HPos::Center, VPos::Bottom));
    canvas.draw_text(text, &style, at).map_err(failed)
}

/// A power of ten with its exponent raised.
pub(super) fn power_of_ten(exponent: i32) -> String {
    let digits = exponent.to_string();
    let raised = digits.chars().map(|c| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32(0x2070 + digit.to_digit(10).unwrap_or(0)).unwrap_or(digit),
    });
    format!("10{}", raised.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_ten() {
        assert_eq!(power_of_ten(-14), "10⁻¹⁴");
        assert_eq!(power_of_ten(230), "10²³⁰");
    }
}
