//! The flow in a plane as a picture: colours, streamlines, and the bodies' sections.
//!
//! One SVG file without anything outside it: the colours are an embedded PNG of the grid,
//! everything else is drawn as lines. With the feature `png`, the `png` function makes an image of
//! it.

mod axis;
mod canvas;
mod error;
mod lines;
#[cfg(feature = "png")]
mod pixels;
mod quantity;
mod raster;
mod scale;
mod smooth;

use svg::Document;
use svg::node::element::path::Data;
use svg::node::element::{ClipPath, Definitions, Group, Image, Path};

use super::View;
use crate::plane::PlaneFlow;
use canvas::{Canvas, arrow, outlined, rectangle, tenths};
pub use error::PictureError;
use lines::{Inside, arrows_path, lines_path, streamlines};
#[cfg(feature = "png")]
pub use pixels::png;
pub use quantity::Quantity;
use scale::Scale;
use stokes_body::kernel::FlowAt;

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

/// Arrows to the heads of swimmers, in those that the plane cuts.
fn heads_path(canvas: &Canvas, view: &View) -> Path {
    let inside = Inside::of(&view.sections);
    let seen = view.heads.iter();
    let seen = seen.filter(|ends| ends.iter().all(|&end| inside.contains(end)));
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
