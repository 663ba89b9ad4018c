//! The sheet that a picture is drawn on: where the plane is on it, and what stands around it.

use plotters::style::RGBColor;
use svg::node::element::path::Data;
use svg::node::element::{Line, Path, Rectangle, Text};
use svg::{Document, Node};

use super::axis::{self, Axis};
use super::scale::Scale;
use crate::plane::Plane;

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

/// Where the plane is on the picture.
pub struct Canvas {
    /// Pixels per unit of length.
    pub scale: f64,
    /// Size of the plane, in pixels.
    pub size: [f64; 2],
    /// Above the plane, in pixels.
    pub top: f64,
    /// Size of the picture, in pixels.
    pub whole: [f64; 2],
}

impl Canvas {
    pub fn new(plane: &Plane, titled: bool) -> Self {
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
    pub fn frame(&self) -> [f64; 4] {
        [MARGIN[0], self.top, self.size[0], self.size[1]]
    }

    /// The title above the plane, as much of it as there is room for.
    pub fn title(&self, document: &mut Document, title: &str) {
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

    pub fn pixels(&self, lengths: [f64; 2]) -> [f64; 2] {
        lengths.map(|length| length * self.scale)
    }

    /// The pixel of a point of the plane; those that lie far outside are moved nearer, to be
    /// numbers that every viewer can hold.
    pub fn place(&self, point: [f64; 2]) -> (f32, f32) {
        self.exactly(point).map(tenths).into()
    }

    /// The same, not rounded.
    pub fn exactly(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top, width, height] = self.frame();
        let pixels = |length: f64| (length * self.scale).clamp(-1e6, 1e6);
        [
            left + 0.5 * width + pixels(x),
            top + 0.5 * height - pixels(y),
        ]
    }

    /// Ticks, numbers and names of both axes.
    pub fn axes(&self, document: &mut Document, plane: &Plane) {
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

    pub fn colour_bar(&self, document: &mut Document, scale: &Scale) {
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

/// An arrowhead of a length and a half width, in the middle of its way and along it.
pub fn arrow(data: Data, [from, to]: [[f64; 2]; 2], [length, half]: [f64; 2]) -> Data {
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

pub fn rectangle([x, y, width, height]: [f64; 4]) -> Rectangle {
    Rectangle::new()
        .set("x", tenths(x))
        .set("y", tenths(y))
        .set("width", tenths(width))
        .set("height", tenths(height))
}

pub fn outlined(corners: [f64; 4]) -> Rectangle {
    rectangle(corners)
        .set("fill", "none")
        .set("stroke", "black")
}

/// The end of the bar of colours where values lie beyond it: a triangle from its edge to a tip.
pub fn pointed_end([left, right]: [f64; 2], base: f64, tip: f64, colour: RGBColor) -> Path {
    let corners = [[left, base], [0.5 * (left + right), tip], [right, base]];
    let [a, b, c] = corners.map(|corner| <(f32, f32)>::from(corner.map(tenths)));
    let RGBColor(red, green, blue) = colour;
    Path::new()
        .set("class", "beyond")
        .set("d", Data::new().move_to(a).line_to(b).line_to(c).close())
        .set("fill", format!("#{red:02x}{green:02x}{blue:02x}"))
        .set("stroke", "black")
}

pub fn tick([x1, x2]: [f32; 2], [y1, y2]: [f32; 2]) -> Line {
    Line::new()
        .set("x1", x1)
        .set("y1", y1)
        .set("x2", x2)
        .set("y2", y2)
        .set("stroke", "black")
}

pub fn text(content: &str, [x, y]: [f64; 2], anchor: &str) -> Text {
    Text::new(content)
        .set("x", tenths(x))
        .set("y", tenths(y))
        .set("text-anchor", anchor)
}

/// Pixels to a tenth, which keeps the file small.
pub fn tenths(x: f64) -> f32 {
    ((10.0 * x).round() / 10.0) as f32
}
