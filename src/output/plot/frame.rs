//! A diagram with logarithmic axes: frame, grid, ticks, curves, legend.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{Canvas, DIAGRAM, PlotError, failed, write, write_upwards};
use super::colour::GRID;

/// Margins of the frame in its diagram: left, top, right, bottom.
const MARGIN: [i32; 4] = [76, 44, 168, 58];

/// One axis: the range of its logarithm, its ticks with labels, its name.
pub struct Axis {
    pub range: [f64; 2],
    pub ticks: Vec<(f64, String)>,
    pub name: &'static str,
}

/// How a curve is drawn: its marks, joined or not.
pub struct Style {
    pub colour: RGBColor,
    /// 0 circle, 1 square, 2 triangle, 3 diamond.
    pub mark: usize,
    pub joined: bool,
}

/// A diagram under construction.
pub struct Frame<'a, 'b> {
    canvas: &'a Canvas<'b>,
    corner: (i32, i32),
    size: (i32, i32),
    x: Axis,
    y: Axis,
}

impl<'a, 'b> Frame<'a, 'b> {
    /// Draws frame, grid, ticks and names.
    pub fn new(
        canvas: &'a Canvas<'b>,
        corner: (i32, i32),
        title: &str,
        x: Axis,
        y: Axis,
    ) -> Result<Self, PlotError> {
        let (corner, size) = inner(corner);
        let frame = Self {
            canvas,
            corner,
            size,
            x,
            y,
        };
        let (left, top) = corner;
        let (right, bottom) = (left + size.0, top + size.1);
        for (value, label) in &frame.x.ticks {
            let (at, _) = frame.place(*value, 0.0);
            frame.line((at, top), (at, bottom), GRID, 1)?;
            let place = (at, bottom + 8);
            write(canvas, label, place, 12.0, BLACK, (HPos::Center, VPos::Top))?;
        }
        for (value, label) in &frame.y.ticks {
            let (_, at) = frame.place(0.0, *value);
            frame.line((left, at), (right, at), GRID, 1)?;
            let place = (left - 8, at);
            write(
                canvas,
                label,
                place,
                12.0,
                BLACK,
                (HPos::Right, VPos::Center),
            )?;
        }
        outline(canvas, corner, size)?;
        names(canvas, corner, size, title, frame.x.name, frame.y.name)?;
        Ok(frame)
    }

    /// Draws a curve through points, given by their values.
    pub fn curve(&self, points: &[(f64, f64)], style: &Style) -> Result<(), PlotError> {
        let logs = points.iter().filter(|(x, y)| *x > 0.0 && *y > 0.0);
        let places: Vec<_> = logs
            .map(|(x, y)| self.place(x.log10(), y.log10()))
            .collect();
        if style.joined {
            for pair in places.windows(2) {
                self.line(pair[0], pair[1], style.colour, 2)?;
            }
        }
        places.iter().try_for_each(|&at| self.mark(at, style))
    }

    /// Draws a dashed line between two points, given by their values.
    pub fn dashed(
        &self,
        from: (f64, f64),
        to: (f64, f64),
        colour: RGBColor,
    ) -> Result<(), PlotError> {
        let place = |(x, y): (f64, f64)| self.place(x.log10(), y.log10());
        let line = plotters::element::DashedPathElement::new(
            [place(from), place(to)],
            6,
            4,
            colour.stroke_width(2),
        );
        self.canvas.draw(&line).map_err(failed)
    }

    /// Writes the line `index` of the legend, beside the frame.
    pub fn legend(&self, index: usize, style: Option<&Style>, text: &str) -> Result<(), PlotError> {
        let (x, y) = (
            self.corner.0 + self.size.0 + 14,
            self.corner.1 + 8 + 20 * index as i32,
        );
        let text_at = match style {
            Some(style) => {
                if style.joined {
                    self.line((x, y), (x + 22, y), style.colour, 2)?;
                }
                self.mark((x + 11, y), style)?;
                x + 30
            }
            None => x,
        };
        write(
            self.canvas,
            text,
            (text_at, y),
            12.0,
            BLACK,
            (HPos::Left, VPos::Center),
        )
    }

    fn place(&self, x: f64, y: f64) -> (i32, i32) {
        let along = |v: f64, [from, to]: [f64; 2], size: i32| {
            (((v - from) / (to - from)).clamp(0.0, 1.0) * f64::from(size)).round() as i32
        };
        (
            self.corner.0 + along(x, self.x.range, self.size.0),
            self.corner.1 + self.size.1 - along(y, self.y.range, self.size.1),
        )
    }

    fn line(
        &self,
        from: (i32, i32),
        to: (i32, i32),
        colour: RGBColor,
        width: u32,
    ) -> Result<(), PlotError> {
        let line = PathElement::new([from, to], colour.stroke_width(width));
        self.canvas.draw(&line).map_err(failed)
    }

    fn mark(&self, (x, y): (i32, i32), style: &Style) -> Result<(), PlotError> {
        let fill = style.colour.filled();
        let canvas = self.canvas;
        let polygon = |corners: &[(i32, i32)]| {
            let corners: Vec<_> = corners.iter().map(|(a, b)| (x + a, y + b)).collect();
            canvas.draw(&Polygon::new(corners, fill)).map_err(failed)
        };
        match style.mark {
            0 => canvas.draw(&Circle::new((x, y), 4, fill)).map_err(failed),
            1 => polygon(&[(-4, -4), (4, -4), (4, 4), (-4, 4)]),
            2 => polygon(&[(-5, 4), (5, 4), (0, -5)]),
            _ => polygon(&[(-5, 0), (0, -5), (5, 0), (0, 5)]),
        }
    }
}

/// Corner and size of the frame in the diagram at `corner`.
pub fn inner(corner: (i32, i32)) -> ((i32, i32), (i32, i32)) {
    let [left, top, right, bottom] = MARGIN;
    let size = (DIAGRAM.0 - left - right, DIAGRAM.1 - top - bottom);
    ((corner.0 + left, corner.1 + top), size)
}

/// Draws the frame's outline.
pub fn outline(canvas: &Canvas<'_>, corner: (i32, i32), size: (i32, i32)) -> Result<(), PlotError> {
    let opposite = (corner.0 + size.0, corner.1 + size.1);
    canvas
        .draw(&Rectangle::new([corner, opposite], BLACK))
        .map_err(failed)
}

/// Writes the title and the names of the axes around a frame.
pub fn names(
    canvas: &Canvas<'_>,
    corner: (i32, i32),
    size: (i32, i32),
    title: &str,
    x: &str,
    y: &str,
) -> Result<(), PlotError> {
    let middle = corner.0 + size.0 / 2;
    let above = (middle, corner.1 - 14);
    write(
        canvas,
        title,
        above,
        15.0,
        BLACK,
        (HPos::Center, VPos::Bottom),
    )?;
    let below = (middle, corner.1 + size.1 + 34);
    write(canvas, x, below, 13.0, BLACK, (HPos::Center, VPos::Top))?;
    write_upwards(canvas, y, (corner.0 - 50, corner.1 + size.1 / 2), 13.0)
}
