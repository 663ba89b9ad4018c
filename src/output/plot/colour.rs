//! Colours that do not depend on telling red from green.

use plotters::style::RGBColor;

/// Matplotlib's viridis at equal steps: perceptually uniform, dark to light.
const VIRIDIS: [[f64; 3]; 9] = [
    [68.0, 1.0, 84.0],
    [71.0, 44.0, 122.0],
    [59.0, 81.0, 139.0],
    [44.0, 113.0, 142.0],
    [33.0, 144.0, 141.0],
    [39.0, 173.0, 129.0],
    [92.0, 200.0, 99.0],
    [170.0, 220.0, 50.0],
    [253.0, 231.0, 37.0],
];

/// Colours of Okabe and Ito for things without an order: blue, vermilion, green, purple.
pub const DISTINCT: [RGBColor; 4] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
];

pub const GRID: RGBColor = RGBColor(222, 222, 222);
pub const MISSING: RGBColor = RGBColor(235, 235, 235);

/// Viridis at `t` from 0 (dark) to 1 (light).
pub fn viridis(t: f64) -> RGBColor {
    let steps = VIRIDIS.len() - 1;
    let t = t.clamp(0.0, 1.0) * steps as f64;
    let k = (t as usize).min(steps - 1);
    let [r, g, b] = std::array::from_fn(|c| {
        let (from, to) = (VIRIDIS[k][c], VIRIDIS[k + 1][c]);
        (from + (to - from) * (t - k as f64)).round() as u8
    });
    RGBColor(r, g, b)
}

/// Black or white, whichever can be read on viridis at `t`.
pub fn ink(t: f64) -> RGBColor {
    if t > 0.6 {
        RGBColor(0, 0, 0)
    } else {
        RGBColor(255, 255, 255)
    }
}
