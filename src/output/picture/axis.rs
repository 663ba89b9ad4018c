//! Round numbers along an axis.

use nalgebra::{Point3, Unit, Vector3};

/// Most ticks on an axis.
const MOST: f64 = 7.0;

/// One axis of the plane.
pub struct Axis {
    /// Places of the ticks, counted from the middle of the plane, with their numbers.
    pub ticks: Vec<(f64, String)>,
    /// The axis's name.
    pub name: String,
}

impl Axis {
    /// The axis along a direction: coordinates of the laboratory if it is one of theirs, else
    /// distances from the middle.
    pub fn along(direction: Unit<Vector3<f64>>, center: Point3<f64>, length: f64) -> Self {
        let j = direction.iamax();
        if direction[j].abs() < 1.0 - 1e-12 {
            let rounded = direction.map(|x| number(x, 0.01));
            let name = format!("along ({}, {}, {})", rounded[0], rounded[1], rounded[2]);
            let ticks = ticks([-0.5 * length, 0.5 * length]);
            return Self { ticks, name };
        }
        let (origin, sign) = (center[j], direction[j].signum());
        let range = [origin - 0.5 * length, origin + 0.5 * length];
        let ticks = ticks(range).into_iter();
        Self {
            ticks: ticks
                .map(|(value, label)| (sign * (value - origin), label))
                .collect(),
            name: ["x", "y", "z"][j].to_owned(),
        }
    }
}

/// Round numbers in a range, with their text.
pub fn ticks([from, to]: [f64; 2]) -> Vec<(f64, String)> {
    let step = round_step((to - from) / MOST);
    let slack = 1e-9 * (to - from);
    let (first, last) = (
        ((from - slack) / step).ceil(),
        ((to + slack) / step).floor(),
    );
    // Far away from zero a double may not hold a step.
    if !(first.is_finite() && last.is_finite() && last - first <= 2.0 * MOST) {
        return Vec::new();
    }
    (0..=(last - first) as usize)
        .map(|k| {
            let value = (first + k as f64) * step;
            (value, number(value, step))
        })
        .collect()
}

/// The least of 1, 2, 5 times a power of ten that is not below `least`.
fn round_step(least: f64) -> f64 {
    let decade = 10f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * decade);
    let enough = steps.into_iter().find(|step| *step >= 0.999 * least);
    enough.unwrap_or(10.0 * decade)
}

/// A number to as many digits as a step has.
fn number(value: f64, step: f64) -> String {
    let exponent = |x: f64| x.abs().log10().floor() as i32;
    let text = if value.abs() < 1e-6 * step {
        "0".to_owned()
    } else if exponent(value) > 4 || exponent(step) < -4 {
        let digits = (exponent(value) - exponent(step * 1.001)).clamp(0, 15) as usize;
        format!("{value:.digits$e}")
    } else {
        let digits = (-exponent(step * 1.001)).max(0) as usize;
        format!("{value:.digits$}")
    };
    text.replace('-', "−")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(range: [f64; 2]) -> Vec<String> {
        ticks(range).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels([-3.5, 3.5]), ["−3", "−2", "−1", "0", "1", "2", "3"]);
        assert_eq!(labels([0.0, 1.0]), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels([0.0, 2e-7]).last().unwrap(), "2.0e−7");
        assert_eq!(labels([0.0, 3e6]).len(), 7);
        assert!(ticks([1e30, 1e30 + 1.0]).is_empty());
        for (value, label) in ticks([-0.07, 0.19]) {
            assert_eq!(
                label.replace('−', "-").parse::<f64>().unwrap(),
                (value * 100.0).round() / 100.0
            );
        }
    }

    #[test]
    fn named_after_the_laboratory_where_they_can_be() {
        let center = Point3::new(10.0, 0.0, 0.0);
        let axis = Axis::along(Vector3::x_axis(), center, 2.0);
        assert_eq!((axis.name.as_str(), axis.ticks.len()), ("x", 5));
        assert_eq!(axis.ticks[2], (0.0, "10.0".to_owned()));
        let back = Axis::along(-Vector3::x_axis(), center, 2.0);
        assert_eq!(back.ticks[0], (1.0, "9.0".to_owned()));
        let tilted = Unit::new_normalize(Vector3::new(1.0, 1.0, 0.0));
        assert_eq!(
            Axis::along(tilted, center, 2.0).name,
            "along (0.71, 0.71, 0)"
        );
    }
}
