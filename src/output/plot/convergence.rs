//! Figure 3.2: a heat map of the relative error over panels and modes, and curves of the absolute
//! error.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::canvas::{Canvas, PlotError, diagrams, failed, power_of_ten, write};
use super::colour::{MISSING, ink, viridis};
use super::frame::{Axis, Frame, Style, inner, names, outline};
use crate::study::errors::ErrorTable;

/// The decades of error that the colours and the vertical axis cover.
const DECADES: [i32; 2] = [-16, 0];

/// A column for each order: the heat map above, the curves below.
///
/// # Errors
/// If the plotting library fails.
pub fn convergence(tables: &[ErrorTable]) -> Result<String, PlotError> {
    diagrams(tables.len(), 2, |canvas, column, row, corner| {
        let table = &tables[column];
        if row == 0 {
            heat_map(canvas, corner, table)
        } else {
            curves(canvas, corner, table)
        }
    })
}

/// Where an error lies in the range of colours.
fn shade(error: f64) -> f64 {
    let [from, to] = DECADES.map(f64::from);
    (error.log10() - from) / (to - from)
}

fn heat_map(canvas: &Canvas<'_>, corner: (i32, i32), table: &ErrorTable) -> Result<(), PlotError> {
    let (corner, size) = inner(corner);
    let (columns, rows) = (table.panels.len() as i32, table.modes.len() as i32);
    let left = |i: i32| corner.0 + size.0 * i / columns;
    let bottom = |j: i32| corner.1 + size.1 - size.1 * j / rows;
    let centre = (HPos::Center, VPos::Center);
    let height = (f64::from(size.0) / f64::from(columns) * 0.24).clamp(7.0, 11.0);
    for (k, (_, _, errors)) in table.entries().enumerate() {
        let (i, j) = (k as i32 / rows, k as i32 % rows);
        let cell = [(left(i), bottom(j + 1)), (left(i + 1), bottom(j))];
        let t = errors.map(|e| shade(e.relative));
        let colour = t.map_or(MISSING, viridis);
        canvas
            .draw(&Rectangle::new(cell, colour.filled()))
            .map_err(failed)?;
        let middle = ((cell[0].0 + cell[1].0) / 2, (cell[0].1 + cell[1].1) / 2);
        let text = errors.map_or("–".into(), |e| {
            format!("{:.0e}", e.relative).replace('-', "−")
        });
        write(canvas, &text, middle, height, t.map_or(BLACK, ink), centre)?;
    }
    for (i, panels) in (0..).zip(&table.panels) {
        let at = ((left(i) + left(i + 1)) / 2, corner.1 + size.1 + 8);
        write(
            canvas,
            &panels.to_string(),
            at,
            12.0,
            BLACK,
            (HPos::Center, VPos::Top),
        )?;
    }
    for (j, modes) in (0..).zip(&table.modes) {
        let at = (corner.0 - 8, (bottom(j) + bottom(j + 1)) / 2);
        write(
            canvas,
            &modes.to_string(),
            at,
            12.0,
            BLACK,
            (HPos::Right, VPos::Center),
        )?;
    }
    outline(canvas, corner, size)?;
    let title = format!("Relative error, {} nodes per panel", table.order);
    names(
        canvas,
        corner,
        size,
        &title,
        "panels",
        "highest Fourier mode",
    )?;
    colour_bar(canvas, (corner.0 + size.0 + 26, corner.1), (18, size.1))
}

fn colour_bar(canvas: &Canvas<'_>, corner: (i32, i32), size: (i32, i32)) -> Result<(), PlotError> {
    let bottom = corner.1 + size.1;
    for y in 0..size.1 {
        let t = f64::from(y) / f64::from(size.1 - 1);
        let line = [(corner.0, bottom - y - 1), (corner.0 + size.0, bottom - y)];
        canvas
            .draw(&Rectangle::new(line, viridis(t).filled()))
            .map_err(failed)?;
    }
    outline(canvas, corner, size)?;
    let [from, to] = DECADES;
    for decade in (from..=to).step_by(4) {
        let y = bottom - size.1 * (decade - from) / (to - from);
        let at = (corner.0 + size.0 + 6, y);
        write(
            canvas,
            &power_of_ten(decade),
            at,
            12.0,
            BLACK,
            (HPos::Left, VPos::Center),
        )?;
    }
    Ok(())
}

fn curves(canvas: &Canvas<'_>, corner: (i32, i32), table: &ErrorTable) -> Result<(), PlotError> {
    let log = |p: Option<&usize>| (p.copied().unwrap_or(1) as f64).log10();
    let ends = [
        log(table.panels.first()) - 0.05,
        log(table.panels.last()) + 0.05,
    ];
    let ticks = table.panels.iter();
    let x = Axis {
        range: ends,
        ticks: ticks
            .map(|&p| ((p as f64).log10(), p.to_string()))
            .collect(),
        name: "panels",
    };
    let decades = (DECADES[0]..=DECADES[1]).step_by(2);
    let y = Axis {
        range: DECADES.map(f64::from),
        ticks: decades.map(|d| (f64::from(d), power_of_ten(d))).collect(),
        name: "absolute error",
    };
    let title = format!("Absolute error, {} nodes per panel", table.order);
    let frame = Frame::new(canvas, corner, &title, x, y)?;
    frame.legend(0, None, "highest mode")?;
    let last = table.modes.len().saturating_sub(1).max(1);
    for (k, modes) in table.modes.iter().enumerate() {
        let style = Style {
            colour: viridis(0.9 * k as f64 / last as f64),
            mark: k % 4,
            joined: true,
        };
        frame.curve(&table.column(k), &style)?;
        frame.legend(k + 1, Some(&style), &modes.to_string())?;
    }
    Ok(())
}
