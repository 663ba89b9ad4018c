//! The flow in a plane as a picture: colours, streamlines, and the bodies' sections.
//!
//! One SVG file without anything outside it: the colours are an embedded PNG of the grid,
//! everything else is drawn as lines.

mod axis;
mod error;
mod raster;

use plotters::style::RGBColor;
use svg::node::element::path::Data;
use svg::node::element::{
    ClipPath, Definitions, Group, Image, Line, LinearGradient, Path, Rectangle, Stop, Text,
};
use svg::{Document, Node};

use super::View;
use super::plot::colour::{blue_red, viridis};
use crate::plane::streamlines::{Streamline, evenly_spaced};
use crate::plane::{Plane, PlaneFlow};
use axis::Axis;
pub use error::PictureError;
use stokes_body::kernel::FlowAt;

/// What the colours show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// The magnitude of the velocity, its component across the plane included: from zero to the
    /// largest.
    #[default]
    Speed,
    /// The pressure: the same up and down from zero, and so far that only one point in a thousand
    /// lies beyond.
    Pressure,
}

/// The longer side of the plane, in pixels.
const LENGTH: f64 = 520.0;
/// Left, top, right, bottom of it, in pixels.
const MARGIN: [f64; 4] = [66.0, 20.0, 124.0, 56.0];
/// Streamlines side by side along the longer side.
const STREAMLINES: f64 = 28.0;
/// Speeds in the plane below this part of the largest speed have no streamlines: they are rounding.
const STILL: f64 = 1e-6;
/// The part of the pressures that the colours cover.
const COVERED: f64 = 0.999;
/// Length and half width of arrowheads, and the way from one to the next, in pixels.
const ARROW: [f64; 3] = [8.5, 3.4, 170.0];

/// The picture as SVG; `sections` are closed curves in the plane's coordinates, with what an odd
/// number of them goes around filled grey.
///
/// # Errors
/// If there is nothing to draw.
fn picture(
    flow: &PlaneFlow,
    sections: &[Vec<[f64; 2]>],
    quantity: Quantity,
) -> Result<String, PictureError> {
    let canvas = Canvas::new(&flow.plane);
    let speed = |at: &FlowAt| at.velocity.norm();
    let shown = |at: &FlowAt| match quantity {
        Quantity::Speed => speed(at),
        Quantity::Pressure => at.pressure,
    };
    let values: Vec<f64> = flow.values.iter().flatten().map(shown).collect();
    let fastest = flow.values.iter().flatten().map(speed).fold(0.0, f64::max);
    if !(fastest.is_finite() && values.iter().all(|value| value.is_finite())) {
        return Err(PictureError::NotFinite);
    }
    let scale = Scale::new(quantity, values);
    let colours = flow
        .continued(|at| [shown(at)])
        .ok_or(PictureError::NoFluid)?;
    let shades = colours.values().iter().map(|&[value]| scale.shade(value));
    let image = raster::png(
        &shades.collect::<Vec<_>>(),
        flow.plane.points[0],
        scale.colour,
    )?;

    let frame = canvas.frame();
    let [dx, dy] = canvas.pixels(flow.plane.spacing());
    let [left, top, width, height] = frame;
    // A pixel's centre is a grid point: half a pixel hangs over on every side.
    let image = Image::new()
        .set("href", format!("data:image/png;base64,{image}"))
        .set("x", tenths(left - 0.5 * dx))
        .set("y", tenths(top - 0.5 * dy))
        .set("width", tenths(width + dx))
        .set("height", tenths(height + dy))
        .set("preserveAspectRatio", "none");
    let lines = streamlines(flow, sections, fastest);
    let inside = Group::new()
        .set("clip-path", "url(#frame)")
        .add(image)
        .add(lines_path(&canvas, &lines, quantity))
        .add(arrows_path(&canvas, &lines, quantity))
        .add(sections_path(&canvas, sections));
    let clip = ClipPath::new().set("id", "frame").add(rectangle(frame));
    let whole = [0.0, 0.0, canvas.whole[0], canvas.whole[1]];
    let mut document = Document::new()
        .set("width", tenths(whole[2]))
        .set("height", tenths(whole[3]))
        .set("viewBox", (0, 0, tenths(whole[2]), tenths(whole[3])))
        .set("font-family", "sans-serif")
        .set("font-size", 14)
        .add(Definitions::new().add(clip).add(scale.gradient()))
        .add(rectangle(whole).set("fill", "white"))
        .add(inside)
        .add(outlined(frame));
    canvas.axes(&mut document, &flow.plane);
    canvas.colour_bar(&mut document, &scale);
    Ok(document.to_string() + "\n")
}

impl View {
    /// The picture as SVG.
    ///
    /// # Errors
    /// If there is nothing to draw.
    pub fn picture(&self, quantity: Quantity) -> Result<String, PictureError> {
        picture(&self.flow, &self.sections, quantity)
    }
}

/// Where the plane is on the picture.
struct Canvas {
    /// Pixels per unit of length.
    scale: f64,
    /// Size of the plane, in pixels.
    size: [f64; 2],
    /// Size of the picture, in pixels.
    whole: [f64; 2],
}

impl Canvas {
    fn new(plane: &Plane) -> Self {
        let scale = LENGTH / plane.size[0].max(plane.size[1]);
        let size = plane.size.map(|length| length * scale);
        let [left, top, right, bottom] = MARGIN;
        Self {
            scale,
            size,
            whole: [size[0] + left + right, size[1].max(160.0) + top + bottom],
        }
    }

    /// Left, top, width and height of the plane.
    fn frame(&self) -> [f64; 4] {
        [MARGIN[0], MARGIN[1], self.size[0], self.size[1]]
    }

    fn pixels(&self, lengths: [f64; 2]) -> [f64; 2] {
        lengths.map(|length| length * self.scale)
    }

    /// The pixel of a point of the plane; those that lie far outside are moved nearer, to be
    /// numbers that every viewer can hold.
    fn place(&self, [x, y]: [f64; 2]) -> (f32, f32) {
        let [left, top, width, height] = self.frame();
        let pixels = |length: f64| (length * self.scale).clamp(-1e6, 1e6);
        (
            tenths(left + 0.5 * width + pixels(x)),
            tenths(top + 0.5 * height - pixels(y)),
        )
    }

    /// Ticks, numbers and names of both axes.
    fn axes(&self, document: &mut Document, plane: &Plane) {
        let [left, top, width, height] = self.frame();
        let bottom = top + height;
        let across = Axis::along(plane.across, plane.center, plane.size[0]);
        for (at, label) in &across.ticks {
            let (x, _) = self.place([*at, 0.0]);
            document.append(tick([x, x], [bottom, bottom + 5.0].map(tenths)));
            document.append(text(label, [f64::from(x), bottom + 20.0], "middle"));
        }
        let up = Axis::along(plane.up, plane.center, plane.size[1]);
        for (at, label) in &up.ticks {
            let (_, y) = self.place([0.0, *at]);
            document.append(tick([left - 5.0, left].map(tenths), [y, y]));
            document.append(text(label, [left - 9.0, f64::from(y) + 5.0], "end"));
        }
        document.append(text(
            &across.name,
            [left + 0.5 * width, bottom + 43.0],
            "middle",
        ));
        let [x, y] = [18.0, top + 0.5 * height].map(tenths);
        let name = text(&up.name, [18.0, top + 0.5 * height], "middle");
        document.append(name.set("transform", format!("rotate(-90 {x} {y})")));
    }

    fn colour_bar(&self, document: &mut Document, scale: &Scale) {
        let [left, top, width, height] = self.frame();
        let bar = [
            left + width + 24.0,
            top + 26.0,
            18.0,
            height.max(160.0) - 26.0,
        ];
        document.append(outlined(bar).set("fill", "url(#colours)"));
        document.append(text(scale.name, [bar[0], top + 12.0], "start"));
        let [from, to] = scale.range;
        for (value, label) in axis::ticks(scale.range) {
            let y = bar[1] + bar[3] * (to - value) / (to - from);
            let right = bar[0] + bar[2];
            document.append(tick([right, right + 5.0].map(tenths), [y, y].map(tenths)));
            document.append(text(&label, [right + 9.0, y + 5.0], "start"));
        }
    }
}

/// From values to colours.
struct Scale {
    name: &'static str,
    range: [f64; 2],
    colour: fn(f64) -> RGBColor,
}

impl Scale {
    /// The range that the values need; of length one if they all vanish.
    fn new(quantity: Quantity, mut values: Vec<f64>) -> Self {
        let positive = |most: f64| if most > 0.0 { most } else { 1.0 };
        match quantity {
            Quantity::Speed => Self {
                name: "speed",
                range: [0.0, positive(values.into_iter().fold(0.0, f64::max))],
                colour: viridis,
            },
            Quantity::Pressure => {
                values.iter_mut().for_each(|value| *value = value.abs());
                values.sort_by(f64::total_cmp);
                let index = (COVERED * values.len() as f64) as usize;
                let most = positive(values.get(index).copied().unwrap_or_default());
                Self {
                    name: "pressure",
                    range: [-most, most],
                    colour: blue_red,
                }
            }
        }
    }

    fn shade(&self, value: f64) -> f64 {
        let [from, to] = self.range;
        ((value - from) / (to - from)).clamp(0.0, 1.0)
    }

    /// The colours from below upwards.
    fn gradient(&self) -> LinearGradient {
        const STOPS: usize = 40;
        let gradient = LinearGradient::new()
            .set("id", "colours")
            .set("x1", 0)
            .set("y1", 1)
            .set("x2", 0)
            .set("y2", 0);
        (0..=STOPS).fold(gradient, |gradient, k| {
            let t = k as f64 / STOPS as f64;
            let RGBColor(r, g, b) = (self.colour)(t);
            let stop = Stop::new().set("offset", t);
            gradient.add(stop.set("stop-color", format!("#{r:02x}{g:02x}{b:02x}")))
        })
    }
}

fn streamlines(flow: &PlaneFlow, sections: &[Vec<[f64; 2]>], fastest: f64) -> Vec<Streamline> {
    let Some(velocity) = flow.continued(|at| flow.plane.components(at.velocity)) else {
        return Vec::new();
    };
    let direction = |point: [f64; 2]| {
        let [u, v] = velocity.at(point);
        let speed = u.hypot(v);
        let moves = speed > STILL * fastest && !contains(sections, point);
        moves.then(|| [u / speed, v / speed])
    };
    let size = flow.plane.size;
    evenly_spaced(direction, size, size[0].max(size[1]) / STREAMLINES)
}

/// Whether an odd number of closed curves goes around a point.
fn contains(curves: &[Vec<[f64; 2]>], [x, y]: [f64; 2]) -> bool {
    let crossings = curves.iter().flat_map(|curve| {
        let next = curve.iter().cycle().skip(1);
        curve.iter().zip(next).filter(|([ax, ay], [bx, by])| {
            (*ay > y) != (*by > y) && ax + (bx - ax) * ((y - ay) / (by - ay)) > x
        })
    });
    crossings.count() % 2 == 1
}

fn lines_path(canvas: &Canvas, lines: &[Streamline], quantity: Quantity) -> Path {
    let mut data = Data::new();
    for line in lines {
        let last = line.points.len() - 1;
        let drawn = line.points.iter().enumerate();
        let drawn = drawn.filter(|(k, _)| k % 2 == 0 || *k == last);
        for (k, &point) in drawn {
            let place = canvas.place(point);
            data = if k == 0 {
                data.move_to(place)
            } else {
                data.line_to(place)
            };
        }
    }
    Path::new()
        .set("id", "streamlines")
        .set("d", data)
        .set("fill", "none")
        .set("stroke", ink(quantity))
        .set("stroke-width", 1.1)
        .set("stroke-linejoin", "round")
        .set("stroke-opacity", 0.8)
}

fn arrows_path(canvas: &Canvas, lines: &[Streamline], quantity: Quantity) -> Path {
    let [length, half, apart] = ARROW;
    let mut data = Data::new();
    for Streamline { points, .. } in lines {
        let pixels: Vec<(f32, f32)> = points.iter().map(|&point| canvas.place(point)).collect();
        let step = points.windows(2).next().map_or(1.0, |pair| {
            canvas.scale * (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1])
        });
        let count = ((points.len() as f64 * step / apart).round() as usize).max(1);
        for k in 0..count {
            let at = (2 * k + 1) * (points.len() - 1) / (2 * count);
            let (Some(&(ax, ay)), Some(&(bx, by))) =
                (pixels.get(at.saturating_sub(1)), pixels.get(at + 1))
            else {
                continue;
            };
            let (dx, dy) = (f64::from(bx - ax), f64::from(by - ay));
            let norm = dx.hypot(dy);
            if norm == 0.0 {
                continue;
            }
            let (dx, dy) = (dx / norm, dy / norm);
            let (x, y) = (f64::from(pixels[at].0), f64::from(pixels[at].1));
            let corner = |along: f64, aside: f64| {
                (
                    tenths(x + along * dx - aside * dy),
                    tenths(y + along * dy + aside * dx),
                )
            };
            data = data
                .move_to(corner(0.5 * length, 0.0))
                .line_to(corner(-0.5 * length, half))
                .line_to(corner(-0.3 * length, 0.0))
                .line_to(corner(-0.5 * length, -half))
                .close();
        }
    }
    Path::new()
        .set("id", "arrows")
        .set("d", data)
        .set("fill", ink(quantity))
}

/// Lines that can be seen on the colours.
fn ink(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Speed => "white",
        Quantity::Pressure => "#333333",
    }
}

fn sections_path(canvas: &Canvas, sections: &[Vec<[f64; 2]>]) -> Path {
    let mut data = Data::new();
    for curve in sections {
        let mut places: Vec<(f32, f32)> = curve.iter().map(|&point| canvas.place(point)).collect();
        places.dedup();
        for (k, place) in places.into_iter().enumerate() {
            data = if k == 0 {
                data.move_to(place)
            } else {
                data.line_to(place)
            };
        }
        data = data.close();
    }
    Path::new()
        .set("id", "bodies")
        .set("d", data)
        .set("fill", "#bdbdbd")
        .set("fill-rule", "evenodd")
        .set("stroke", "#404040")
        .set("stroke-width", 1.2)
}

fn rectangle([x, y, width, height]: [f64; 4]) -> Rectangle {
    Rectangle::new()
        .set("x", tenths(x))
        .set("y", tenths(y))
        .set("width", tenths(width))
        .set("height", tenths(height))
}

fn outlined(corners: [f64; 4]) -> Rectangle {
    rectangle(corners)
        .set("fill", "none")
        .set("stroke", "black")
}

fn tick([x1, x2]: [f32; 2], [y1, y2]: [f32; 2]) -> Line {
    Line::new()
        .set("x1", x1)
        .set("y1", y1)
        .set("x2", x2)
        .set("y2", y2)
        .set("stroke", "black")
}

fn text(content: &str, [x, y]: [f64; 2], anchor: &str) -> Text {
    Text::new(content)
        .set("x", tenths(x))
        .set("y", tenths(y))
        .set("text-anchor", anchor)
}

/// Pixels to a tenth, which keeps the file small.
fn tenths(x: f64) -> f32 {
    ((10.0 * x).round() / 10.0) as f32
}
