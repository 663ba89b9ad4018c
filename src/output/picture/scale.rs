//! From values to colours.

use plotters::style::RGBColor;
use svg::node::element::{LinearGradient, Stop};

use super::quantity::Quantity;
use crate::output::plot::colour::{blue_red, viridis};

/// The part of the pressures that the colours cover.
const COVERED: f64 = 0.999;

/// From values to colours.
pub struct Scale {
    /// What the colours show.
    pub name: &'static str,
    /// The values of the first and the last colour.
    pub range: [f64; 2],
    /// Whether there are values below and above the range.
    pub beyond: [bool; 2],
    /// The colour from 0 to 1 along the range.
    pub colour: fn(f64) -> RGBColor,
}

impl Scale {
    /// The range that the values need; of length one if they all vanish.
    pub fn new(quantity: Quantity, mut values: Vec<f64>) -> Self {
        let positive = |most: f64| if most > 0.0 { most } else { 1.0 };
        let name = match quantity {
            Quantity::Speed => "speed",
            Quantity::Pressure => "pressure",
            Quantity::Disturbance => "disturbance",
        };
        match quantity {
            Quantity::Speed | Quantity::Disturbance => Self {
                name,
                range: [0.0, positive(values.into_iter().fold(0.0, f64::max))],
                beyond: [false; 2],
                colour: viridis,
            },
            Quantity::Pressure => {
                values.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
                let index = (COVERED * values.len() as f64) as usize;
                let most = positive(values.get(index).map_or(0.0, |value| value.abs()));
                Self {
                    name,
                    range: [-most, most],
                    beyond: [-1.0, 1.0].map(|side| values.iter().any(|value| side * value > most)),
                    colour: blue_red,
                }
            }
        }
    }

    /// Where a value is in the range, from 0 to 1.
    pub fn shade(&self, value: f64) -> f64 {
        let [from, to] = self.range;
        ((value - from) / (to - from)).clamp(0.0, 1.0)
    }

    /// The colours from below upwards.
    pub fn gradient(&self) -> LinearGradient {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_pressures_lie_beyond() {
        let mut values: Vec<f64> = (0..2000).map(|k| 1e-3 * f64::from(k % 1000)).collect();
        let all = Scale::new(Quantity::Pressure, values.clone());
        assert_eq!(all.beyond, [false, false]);
        values[7] = -50.0;
        let scale = Scale::new(Quantity::Pressure, values.clone());
        assert_eq!(scale.beyond, [true, false]);
        assert!(scale.range[1] < 1.0 && scale.shade(-50.0) == 0.0);
        let speeds = Scale::new(Quantity::Speed, values);
        assert_eq!(speeds.beyond, [false, false]);
        assert_eq!(
            Scale::new(Quantity::Disturbance, vec![0.0]).range,
            [0.0, 1.0]
        );
    }
}
