//! Streamlines as they are drawn.

use svg::node::element::Path;
use svg::node::element::path::Data;

use super::canvas::{Canvas, arrow};
use super::quantity::Quantity;
use super::smooth;
use crate::plane::PlaneFlow;
use crate::plane::streamlines::{Streamline, evenly_spaced};

/// Streamlines side by side along the longer side.
const STREAMLINES: f64 = 28.0;
/// Speeds in the plane below this part of the largest speed have no streamlines: they are rounding.
const STILL: f64 = 1e-6;
/// Length and half width of arrowheads, in pixels.
const ARROW: [f64; 2] = [8.5, 3.4];
/// The way from one arrowhead to the next, in pixels.
const APART: f64 = 170.0;
/// Where an arrowhead may be, as parts of that way from the middle; the middle is preferred.
const PLACES: [f64; 5] = [0.4, -0.4, 0.2, -0.2, 0.0];

/// The streamlines of a flow, outside of the bodies.
pub fn streamlines(flow: &PlaneFlow, sections: &[Vec<[f64; 2]>], fastest: f64) -> Vec<Streamline> {
    let Some(velocity) = flow.continued(|at| flow.plane.components(at.velocity)) else {
        return Vec::new();
    };
    let inside = Inside::of(sections);
    let direction = |point: [f64; 2]| {
        let [u, v] = velocity.at(point);
        let speed = u.hypot(v);
        let moves = speed > STILL * fastest && !inside.contains(point);
        moves.then(|| [u / speed, v / speed])
    };
    let size = flow.plane.size;
    evenly_spaced(direction, size, size[0].max(size[1]) / STREAMLINES)
}

/// All lines.
pub fn lines_path(canvas: &Canvas, lines: &[Streamline], quantity: Quantity) -> Path {
    let data = lines.iter().fold(Data::new(), |data, line| {
        let pixels = line.points.iter().map(|&point| canvas.exactly(point));
        smooth::curve(data, &pixels.collect::<Vec<_>>())
    });
    Path::new()
        .set("id", "streamlines")
        .set("d", data)
        .set("fill", "none")
        .set("stroke", ink(quantity))
        .set("stroke-width", 1.1)
        .set("stroke-linejoin", "round")
        .set("stroke-opacity", 0.8)
}

/// Arrowheads on all lines, where they are straight.
pub fn arrows_path(canvas: &Canvas, lines: &[Streamline], quantity: Quantity) -> Path {
    let mut data = Data::new();
    for line in lines {
        let lengths = line.lengths();
        let whole = lengths.last().copied().unwrap_or_default();
        let count = (whole * canvas.scale / APART).round().max(1.0);
        let half = 0.5 * ARROW[0] / canvas.scale;
        for k in 0..count as usize {
            let ends = PLACES.map(|place| {
                let middle = (k as f64 + 0.5 + place) / count * whole;
                [middle - half, middle + half].map(|length| at(line, &lengths, length))
            });
            // To a hundredth, as the eye sees it.
            let straight = |[[a, b], [c, d]]: &[[f64; 2]; 2]| {
                (100.0 * (c - a).hypot(d - b) / (2.0 * half)).round()
            };
            let best = ends
                .into_iter()
                .max_by(|a, b| straight(a).total_cmp(&straight(b)));
            if let Some(ends) = best {
                data = arrow(data, ends.map(|end| canvas.exactly(end)), ARROW);
            }
        }
    }
    Path::new()
        .set("id", "arrows")
        .set("d", data)
        .set("fill", ink(quantity))
}

/// The point of a line at a length from its beginning; one of its ends if there is none.
fn at(line: &Streamline, lengths: &[f64], length: f64) -> [f64; 2] {
    let after = lengths.partition_point(|&l| l < length);
    let after = after.clamp(1, lengths.len().max(2) - 1);
    let (Some(pair), Some(&[from, to])) = (
        line.points.get(after - 1..=after),
        lengths
            .get(after - 1..=after)
            .and_then(|pair| pair.first_chunk()),
    ) else {
        return line.points.first().copied().unwrap_or_default();
    };
    let t = ((length - from) / (to - from)).clamp(0.0, 1.0);
    [0, 1].map(|j| pair[0][j] + t * (pair[1][j] - pair[0][j]))
}

/// Lines that can be seen on the colours.
fn ink(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Speed | Quantity::Disturbance => "white",
        Quantity::Pressure => "#333333",
    }
}

/// What an odd number of closed curves goes around.
pub struct Inside<'a> {
    curves: Vec<Bounded<'a>>,
}

/// A closed curve with the least and the largest coordinates of its points.
struct Bounded<'a> {
    points: &'a [[f64; 2]],
    across: [f64; 2],
    up: [f64; 2],
}

impl<'a> Inside<'a> {
    /// The inside of some curves.
    pub fn of(curves: &'a [Vec<[f64; 2]>]) -> Self {
        let bounded = |points: &'a Vec<[f64; 2]>| {
            let [across, up] = [0, 1].map(|j| {
                let along = points.iter().map(|point| point[j]);
                along.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| {
                    [least.min(x), most.max(x)]
                })
            });
            Bounded { points, across, up }
        };
        Self {
            curves: curves.iter().map(bounded).collect(),
        }
    }

    /// Whether an odd number of the curves goes around a point.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let within = |[least, most]: [f64; 2], x: f64| least <= x && x <= most;
        let near = self.curves.iter();
        let near = near.filter(|curve| within(curve.across, x) && within(curve.up, y));
        let crossings = near.flat_map(|curve| {
            let next = curve.points.iter().cycle().skip(1);
            curve
                .points
                .iter()
                .zip(next)
                .filter(|([ax, ay], [bx, by])| {
                    (*ay > y) != (*by > y) && ax + (bx - ax) * ((y - ay) / (by - ay)) > x
                })
        });
        crossings.count() % 2 == 1
    }
}
