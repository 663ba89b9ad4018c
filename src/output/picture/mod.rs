//! The flow in a plane as a picture: colours, streamlines, and the bodies' sections.
//!
//! One SVG file without anything outside it: the colours are an embedded PNG of the grid,
//! everything else is drawn as lines. With the feature `png`, the `png` function makes an image of
//! it.

mod axis;
mod error;
mod lines;
#[cfg(feature = "png")]
mod pixels;
mod raster;
mod scale;
mod smooth;

use plotters::style::RGBColor;
use svg::node::element::path::Data;
use svg::node::element::{ClipPath, Definitions, Group, Image, Line, Path, Rectangle, Text};
use svg::{Document, Node};

use super::View;
use crate::plane::{Plane, PlaneFlow};
use axis::Axis;
pub use error::PictureError;
use lines::{arrows_path, lines_path, streamlines};
#[cfg(feature = "png")]
pub use pixels::png;
use scale::Scale;
use stokes_body::kernel::FlowAt;

/// What the colours show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quantity {
    /// The magnitude of the velocity, its component across the plane included: from zero to the
    /// largest.
    #[default]
    Speed,
    /// The pressure: the same up and down from zero, and so far that only one point in a thousand
    /// lies beyond; where any do, the bar of the colours ends in a point.
    Pressure,
    /// The same as the speed, of the flow without the undisturbed one.
    Disturbance,
}

/// The longer side of the plane, in pixels.
const LENGTH: f64 = 520.0;
/// Left, top, right, bottom of it, in pixels.
const MARGIN: [f64; 4] = [66.0, 20.0, 124.0, 56.0];
/// What a title takes above it, in pixels.
const TITLE: f64 = 22.0;
/// Width of a letter there, in pixels.
const LETTER: f64 = 9.0;
/// Length of the pointed end of the bar of colours, in pixels.
const POINT: f64 = 14.0;
/// Length and half width of the arrowheads of swimmers, in pixels.
const HEAD: [f64; 2] = [13.0, 5.0];

impl View {
    /// The picture as SVG.
    ///
    /// # Errors
    /// If there is nothing to draw.
    pub fn picture(&self, quantity: Quantity) -> Result<String, PictureError> {
        match quantity {
            Quantity::Speed | Quantity::Pressure => self.draw(&self.flow, quantity),
            Quantity::Disturbance => {
                let flow = self.flow.clone().without(&self.background);
                self.draw(&flow, quantity)
            }
        }
    }

    /// The picture of a flow in the same plane.
    fn draw(&self, flow: &PlaneFlow, quantity: Quantity) -> Result<String, PictureError> {
        let canvas = Canvas::new(&flow.plane, !self.title.is_empty());
        let speed = |at: &FlowAt| at.velocity.norm();
        let shown = |at: &FlowAt| match quantity {
            Quantity::Speed | Quantity::Disturbance => speed(at),
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
        let lines = streamlines(flow, &self.sections, fastest);
        let inside = Group::new()
            .set("clip-path", "url(#frame)")
            .add(image)
            .add(lines_path(&canvas, &lines, quantity))
            .add(arrows_path(&canvas, &lines, quantity))
            .add(sections_path(&canvas, &self.sections))
            .add(heads_path(&canvas, self));
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
        canvas.title(&mut document, &self.title);
        canvas.axes(&mut document, &flow.plane);
        canvas.colour_bar(&mut document, &scale);
        Ok(document.to_string() + "\n")
    }
}

/// Where the plane is on the picture.
struct Canvas {
    /// Pixels per unit of length.
    scale: f64,
    /// Size of the plane, in pixels.
    size: [f64; 2],
    /// Above the plane, in pixels.
    top: f64,
    /// Size of the picture, in pixels.
    whole: [f64; 2],
}

impl Canvas {
    fn new(plane: &Plane, titled: bool) -> Self {
        let scale = LENGTH / plane.size[0].max(plane.size[1]);
        let size = plane.size.map(|length| length * scale);
        let [left, top, right, bottom] = MARGIN;
        let top = if titled { top + TITLE } else { top };
        Self {
            scale,
            size,
            top,
            whole: [size[0] + left + right, size[1].max(160.0) + top + bottom],
        }
    }

    /// Left, top, width and height of the plane.
    fn frame(&self) -> [f64; 4] {
        [MARGIN[0], self.top, self.size[0], self.size[1]]
    }

    /// The title above the plane, as much of it as there is room for.
    fn title(&self, document: &mut Document, title: &str) {
        if title.is_empty() {
            return;
        }
        let [left, top, width, _] = self.frame();
        let room = (width.max(MARGIN[2]) / LETTER) as usize;
        let mut short: String = title.chars().take(room).collect();
        if short.len() < title.len() {
            short.pop();
            short.push('…');
        }
        let title = text(&short, [left + 0.5 * width, top - 12.0], "middle");
        document.append(title.set("id", "title").set("font-size", 16));
    }

    fn pixels(&self, lengths: [f64; 2]) -> [f64; 2] {
        lengths.map(|length| length * self.scale)
    }

    /// The pixel of a point of the plane; those that lie far outside are moved nearer, to be
    /// numbers that every viewer can hold.
    fn place(&self, point: [f64; 2]) -> (f32, f32) {
        self.exactly(point).map(tenths).into()
    }

    /// The same, not rounded.
    fn exactly(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, width, height] = self.frame();
        let pixels = |length: f64| (length * self.scale).clamp(-1e6, 1e6);
        [
            left + 0.5 * width + pixels(x),
            top + 0.5 * height - pixels(y),
        ]
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
        document.append(text(scale.name, [bar[0], top + 12.0], "start"));
        let points = scale.beyond.map(|beyond| if beyond { POINT } else { 0.0 });
        let [x, y, w, h] = bar;
        let bar = [x, y + points[1], w, h - points[0] - points[1]];
        document.append(outlined(bar).set("fill", "url(#colours)"));
        for (beyond, colour, base, tip) in [
            (scale.beyond[0], 0.0, bar[1] + bar[3], y + h),
            (scale.beyond[1], 1.0, bar[1], y),
        ] {
            if beyond {
                document.append(pointed_end([x, x + w], base, tip, (scale.colour)(colour)));
            }
        }
        let [from, to] = scale.range;
        for (value, label) in axis::ticks(scale.range) {
            let y = bar[1] + bar[3] * (to - value) / (to - from);
            let right = bar[0] + bar[2];
            document.append(tick([right, right + 5.0].map(tenths), [y, y].map(tenths)));
            document.append(text(&label, [right + 9.0, y + 5.0], "start"));
        }
    }
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

/// An arrowhead of a length and a half width, in the middle of its way and along it.
fn arrow(data: Data, [from, to]: [[f64; 2]; 2], [length, half]: [f64; 2]) -> Data {
    let [x, y] = [0, 1].map(|j| 0.5 * (from[j] + to[j]));
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let norm = dx.hypot(dy);
    if norm == 0.0 {
        return data;
    }
    let (dx, dy) = (dx / norm, dy / norm);
    let corner = |along: f64, aside: f64| {
        (
            tenths(x + along * dx - aside * dy),
            tenths(y + along * dy + aside * dx),
        )
    };
    data.move_to(corner(0.5 * length, 0.0))
        .line_to(corner(-0.5 * length, half))
        .line_to(corner(-0.3 * length, 0.0))
        .line_to(corner(-0.5 * length, -half))
        .close()
}

/// Arrows to the heads of swimmers, in those that the plane cuts.
fn heads_path(canvas: &Canvas, view: &View) -> Path {
    let seen = view.heads.iter();
    let seen = seen.filter(|ends| ends.iter().all(|&end| contains(&view.sections, end)));
    let data = seen.fold(Data::new(), |data, ends| {
        let [tail, tip] = ends.map(|end| canvas.exactly(end));
        let way = [tip[0] - tail[0], tip[1] - tail[1]];
        let length = way[0].hypot(way[1]);
        let [size, half] = HEAD.map(|size| size.min(0.5 * length));
        // The middle of the arrowhead, and where the shaft meets its notch.
        let back = |by: f64| [0, 1].map(|j| tip[j] - by / length * way[j]);
        let shaft = data
            .move_to(<(f32, f32)>::from(tail.map(tenths)))
            .line_to(<(f32, f32)>::from(back(0.8 * size).map(tenths)));
        arrow(shaft, [back(size), tip], [size, half])
    });
    Path::new()
        .set("id", "heads")
        .set("d", data)
        .set("fill", "#404040")
        .set("stroke", "#404040")
        .set("stroke-width", 1.2)
        .set("stroke-linejoin", "round")
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

/// The end of the bar of colours where values lie beyond it: a triangle from its edge to a tip.
fn pointed_end([left, right]: [f64; 2], base: f64, tip: f64, colour: RGBColor) -> Path {
    let corners = [[left, base], [0.5 * (left + right), tip], [right, base]];
    let [a, b, c] = corners.map(|corner| <(f32, f32)>::from(corner.map(tenths)));
    let RGBColor(red, green, blue) = colour;
    Path::new()
        .set("class", "beyond")
        .set("d", Data::new().move_to(a).line_to(b).line_to(c).close())
        .set("fill", format!("#{red:02x}{green:02x}{blue:02x}"))
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
