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

/// ColorBrewer's RdBu turned around: blue, white in the middle, red.
const BLUE_RED: [[f64; 3]; 11] = [
    [5.0, 48.0, 97.0],
    [33.0, 102.0, 172.0],
    [67.0, 147.0, 195.0],
    [146.0, 197.0, 222.0],
    [209.0, 229.0, 240.0],
    [247.0, 247.0, 247.0],
    [253.0, 219.0, 199.0],
    [244.0, 165.0, 130.0],
    [214.0, 96.0, 77.0],
    [178.0, 24.0, 43.0],
    [103.0, 0.0, 31.0],
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
    between(&VIRIDIS, t)
}

/// For values of either sign, `t` from 0 (blue) over 0.5 (white) to 1 (red).
pub fn blue_red(t: f64) -> RGBColor {
    between(&BLUE_RED, t)
}

/// The colour at `t` from 0 to 1 on a scale given at equal steps.
fn between(scale: &[[f64; 3]], t: f64) -> RGBColor {
    let steps = scale.len() - 1;
    let t = t.clamp(0.0, 1.0) * steps as f64;
    let k = (t as usize).min(steps - 1);
    let [r, g, b] = std::array::from_fn(|c| {
        let (from, to) = (scale[k][c], scale[k + 1][c]);
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
