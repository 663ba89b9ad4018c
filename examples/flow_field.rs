//! The flow past a tilted spheroid that is held in a uniform stream, as a picture.
//!
//!     cargo run --release --example flow_field -- flow.svg
//!
//! Colour is the speed relative to the stream's, in the plane of the stream and the spheroid's axis; the lines are
//! streamlines, which stay in that plane by symmetry.

use std::error::Error;
use std::ops::Range;
use std::sync::Arc;

use axistokes::nalgebra::{Point3, Unit, Vector3};
use axistokes::{
    DirichletSolver, Discretization, Formulation, Frame, GeneratingCurve, Meridian, Outline,
    Panels, RigidMotion, Silent, Spheroid,
};
use plotters::prelude::*;

/// The part of the plane that is drawn.
const X: Range<f64> = -3.0..3.0;
const Z: Range<f64> = -2.0..2.0;
/// Cells of the picture, across and up, and pixels of each.
const CELLS: [usize; 2] = [144, 96];
const PIXELS: usize = 8;
/// Width of the colour bar with its numbers.
const BAR: usize = 150;
/// Nearer to the body than this the velocity is taken to be the body's own, which is zero.
const GAP: f64 = 0.02;
/// Accuracy of the velocities.
const TOLERANCE: f64 = 1e-4;
const COLOURS: usize = 24;
const STREAMLINES: usize = 34;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).unwrap_or("flow.svg".into());
    let body = Body {
        curve: Arc::new(Spheroid::new(1.0, 0.4)?),
        frame: Frame::new(
            Point3::origin(),
            Unit::new_normalize(Vector3::new(1.0, 0.0, 0.8)),
        ),
    };
    let field = velocities(&body)?;
    draw(&path, &body, &field)?;
    println!("written to {path}");
    Ok(())
}

struct Body {
    curve: Arc<Spheroid>,
    frame: Frame,
}

/// The velocity, in the plane, at the centres of the cells, row by row from below; the stream is (1, 0).
fn velocities(body: &Body) -> Result<Vec<[f64; 2]>, Box<dyn Error>> {
    // A body at rest in the stream U: the stream itself and the flow of a body that moves with -U.
    let stream = Vector3::x();
    let panels = Panels::equal_arcs(&*body.curve, 16)?;
    let nodes = Discretization::new(body.curve.clone(), panels, 16)?;
    let solver = DirichletSolver::new(nodes, Formulation::CombinedField, 16, &Silent)?;
    let motion = RigidMotion {
        velocity: body.frame.vector_to_body(-stream),
        angular_velocity: Vector3::zeros(),
    };
    let density = solver.solve(&motion.on(solver.discretization()));

    let outline = Outline::new(&*body.curve)?;
    let mut targets = Vec::new();
    let mut cells = Vec::new();
    for cell in 0..CELLS[0] * CELLS[1] {
        let point = body.frame.point_to_body(centre(cell));
        let meridian = Meridian {
            r: point.x.hypot(point.y),
            z: point.z,
        };
        if !outline.contains(meridian) && outline.distance(meridian) > GAP {
            targets.push(point);
            cells.push(cell);
        }
    }
    let flow = solver.flow(&density).at(&targets, TOLERANCE)?;
    let mut field = vec![[0.0; 2]; CELLS[0] * CELLS[1]];
    for (cell, flow) in cells.into_iter().zip(flow) {
        let velocity = stream + body.frame.vector_to_lab(flow.velocity);
        field[cell] = [velocity.x, velocity.z];
    }
    Ok(field)
}

fn centre(cell: usize) -> Point3<f64> {
    let (i, k) = (cell % CELLS[0], cell / CELLS[0]);
    let at = |range: Range<f64>, i: usize, n: usize| {
        range.start + (range.end - range.start) * (i as f64 + 0.5) / n as f64
    };
    Point3::new(at(X, i, CELLS[0]), 0.0, at(Z, k, CELLS[1]))
}

/// Position in units of cells, the first cell's centre being (0, 0).
fn in_cells([x, z]: [f64; 2]) -> [f64; 2] {
    let n = CELLS.map(|n| n as f64);
    [
        (x - X.start) / (X.end - X.start) * n[0] - 0.5,
        (z - Z.start) / (Z.end - Z.start) * n[1] - 0.5,
    ]
}

/// The velocity anywhere in the picture, by bilinear interpolation.
fn interpolate(field: &[[f64; 2]], point: [f64; 2]) -> [f64; 2] {
    let at = in_cells(point);
    let corner = [0, 1].map(|j| at[j].floor().clamp(0.0, (CELLS[j] - 2) as f64));
    let [a, b] = [0, 1].map(|j| (at[j] - corner[j]).clamp(0.0, 1.0));
    let first = corner[0] as usize + CELLS[0] * corner[1] as usize;
    [0, 1].map(|j| {
        (1.0 - b) * ((1.0 - a) * field[first][j] + a * field[first + 1][j])
            + b * ((1.0 - a) * field[first + CELLS[0]][j] + a * field[first + CELLS[0] + 1][j])
    })
}

/// The streamline from a point, by the midpoint rule in steps of equal length; none if it comes too near to the body.
fn streamline(field: &[[f64; 2]], start: [f64; 2]) -> Option<Vec<[f64; 2]>> {
    const STEP: f64 = 0.03;
    let direction = |point| {
        let [u, w] = interpolate(field, point);
        let speed = u.hypot(w);
        (speed > 1e-3).then(|| [u / speed, w / speed])
    };
    let advance = |[x, z]: [f64; 2], step: f64, [u, w]: [f64; 2]| [x + step * u, z + step * w];
    let mut line = vec![start];
    let mut point = start;
    let beyond = 3.0 * STEP;
    while point[0] < X.end + beyond {
        let middle = advance(point, 0.5 * STEP, direction(point)?);
        point = advance(point, STEP, direction(middle)?);
        line.push(point);
    }
    Some(line)
}

fn draw(path: &str, body: &Body, field: &[[f64; 2]]) -> Result<(), Box<dyn Error>> {
    let [width, height] = CELLS.map(|n| (PIXELS * n) as i32);
    let size = (width as u32 + BAR as u32, height as u32);
    let canvas = SVGBackend::new(path, size).into_drawing_area();
    canvas.fill(&WHITE)?;

    let colour = |cell: usize| {
        let speed = field[cell][0].hypot(field[cell][1]);
        ((speed * COLOURS as f64) as usize).min(COLOURS - 1)
    };
    for row in 0..CELLS[1] {
        // Neighbours of the same colour make one rectangle.
        let top = height - (PIXELS * (row + 1)) as i32;
        let mut start = 0;
        while start < CELLS[0] {
            let this = colour(row * CELLS[0] + start);
            let same = (start..CELLS[0]).take_while(|i| colour(row * CELLS[0] + i) == this);
            let end = start + same.count();
            let [left, right] = [start, end].map(|i| (PIXELS * i) as i32);
            let corners = [(left, top), (right, top + PIXELS as i32)];
            canvas.draw(&Rectangle::new(corners, viridis(this).filled()))?;
            start = end;
        }
    }

    let pixel = |point: [f64; 2]| {
        let [i, k] = in_cells(point).map(|x| PIXELS as f64 * (x + 0.5));
        (i.round() as i32, height - k.round() as i32)
    };
    for k in 0..STREAMLINES {
        let z = Z.start + (Z.end - Z.start) * (k as f64 + 0.5) / STREAMLINES as f64;
        let Some(line) = streamline(field, [X.start, z]) else {
            continue;
        };
        let line = line.into_iter().step_by(3).map(pixel);
        canvas.draw(&PathElement::new(
            line.collect::<Vec<_>>(),
            WHITE.stroke_width(2),
        ))?;
    }

    // The meridian and its mirror image.
    let outline = (0..200).map(|k| {
        let s = f64::from(k) * std::f64::consts::PI / 100.0;
        let Meridian { r, z } = body.curve.point(s);
        let point = body.frame.vector_to_lab(Vector3::new(r, 0.0, z));
        pixel([point.x, point.z])
    });
    canvas.draw(&Polygon::new(
        outline.collect::<Vec<_>>(),
        RGBColor(225, 225, 225).filled(),
    ))?;

    canvas.draw(&Rectangle::new(
        [(width, 0), (width + BAR as i32, height)],
        WHITE.filled(),
    ))?;
    let (left, top, bottom) = (width + 30, 90, height - 40);
    let level = |k: usize| bottom - (bottom - top) * k as i32 / COLOURS as i32;
    for k in 0..COLOURS {
        let corners = [(left, level(k + 1)), (left + 30, level(k))];
        canvas.draw(&Rectangle::new(corners, viridis(k).filled()))?;
    }
    let font = ("sans-serif", 32).into_font();
    for (text, k) in [("0", 0), ("0.5", COLOURS / 2), ("1", COLOURS)] {
        canvas.draw_text(text, &font.clone().into(), (left + 42, level(k) - 14))?;
    }
    canvas.draw_text("speed", &font.into(), (left, top - 60))?;
    canvas.present()?;
    Ok(())
}

/// Colour number `k` of a scale that everybody can tell apart, dark to light.
fn viridis(k: usize) -> RGBColor {
    const SCALE: [[f64; 3]; 5] = [
        [68.0, 1.0, 84.0],
        [59.0, 81.0, 139.0],
        [33.0, 144.0, 141.0],
        [92.0, 200.0, 99.0],
        [253.0, 231.0, 37.0],
    ];
    let at = 4.0 * k as f64 / (COLOURS - 1) as f64;
    let below = (at as usize).min(3);
    let t = at - below as f64;
    let [r, g, b] =
        [0, 1, 2].map(|j| ((1.0 - t) * SCALE[below][j] + t * SCALE[below + 1][j]).round() as u8);
    RGBColor(r, g, b)
}
