//! Numbers of waves, grid points and digits for a tolerance.

use std::f64::consts::PI;

use f64_lanes::{PADDING, Precision, padded};

use crate::gridding::WIDEST;
use crate::prolate::Prolate;
use crate::splitting::Splitting;

/// What a fast sum with a given tolerance is made of.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Parameters {
    /// $J$: the difference kernels have the waves $2\pi j/3L$, $|j| < J$, per axis.
    pub waves: usize,
    /// $w$, grid points across the window.
    pub width: usize,
    /// $g$, grid points per axis of a box (even).
    pub points: usize,
    /// Relative error of the polynomials of the mollified chain.
    pub accuracy: f64,
    /// Of the reciprocal square roots of the near field.
    pub precision: Precision,
}

impl Parameters {
    /// Parameters for a relative error of `tolerance` (1e-12 to 1e-1) in flows that are derivatives
    /// of order up to `derivatives` of the flow of Stokeslets: one for stresslets, rotlets and
    /// sources, one more for pressures and gradients.
    ///
    /// Truncation, window and polynomials are each given a part of the tolerance.
    pub fn for_tolerance(tolerance: f64, derivatives: usize) -> Self {
        let waves = fewest_waves(tolerance, derivatives);
        let (width, points) = cheapest_window(waves, WINDOW_PART * tolerance, derivatives);
        Self {
            waves,
            width,
            points,
            accuracy: POLYNOMIAL_PART * tolerance,
            precision: root_precision(ROOT_PART * tolerance),
        }
    }
}

/// Truncation makes an error of about $3\,\psi(1)/\psi(0)$ in the velocity of Stokeslets. For every
/// derivative it is [`TRUNCATION_PER_DERIVATIVE`] times larger. Most of it is at the end of the
/// band and at the end of the residual.
const TRUNCATION: f64 = 3.0;
const TRUNCATION_PER_DERIVATIVE: f64 = 10.0;

/// Grid points for each point that the shortest wave needs at least. With fewer, the grids of
/// children cannot be transferred to those of their parents. The value was measured in whole sums.
const OVERSAMPLING: f64 = 1.42;

/// Parts of the tolerance.
const WINDOW_PART: f64 = 0.25;
const POLYNOMIAL_PART: f64 = 0.3;
const ROOT_PART: f64 = 0.1;

/// $J$ that keeps the truncation within the tolerance.
fn fewest_waves(tolerance: f64, derivatives: usize) -> usize {
    /// Truncation below the last digit of the numbers.
    const MOST: usize = 36;
    let factor = TRUNCATION * TRUNCATION_PER_DERIVATIVE.powi(derivatives as i32);
    (3..MOST)
        .find(|&waves| factor * Prolate::new(waves as f64 * PI / 3.0).value(1.0) <= tolerance)
        .unwrap_or(MOST)
}

/// The roots' precision for an error.
fn root_precision(error: f64) -> Precision {
    match error {
        e if e >= 1e-4 => Precision::Seed,
        e if e >= 1e-8 => Precision::Single,
        e if e >= 1e-12 => Precision::Close,
        _ => Precision::Full,
    }
}

/// Width and grid points of the cheapest window whose error is at most `error`; the most accurate
/// window if there is none.
fn cheapest_window(waves: usize, error: f64, derivatives: usize) -> (usize, usize) {
    let slopes = derivatives > 0;
    let spectrum = spectrum(waves, derivatives);
    let mut cheapest = (f64::INFINITY, WIDEST, 2 * waves);
    let mut most_accurate = (f64::INFINITY, WIDEST, 2 * waves);
    for width in 3..=WIDEST {
        let narrowest = (OVERSAMPLING * 2.0 * waves as f64 / 3.0) as usize + width;
        let narrowest = narrowest.next_multiple_of(2);
        for points in (narrowest..=2 * waves + width).step_by(2) {
            let cost = cost(width, points, waves);
            if cost >= cheapest.0 {
                continue;
            }
            let found = window_error(width, points, &spectrum, slopes);
            if found < most_accurate.0 {
                most_accurate = (found, width, points);
            }
            if found <= error {
                cheapest = (cost, width, points);
            }
        }
    }
    let best = if cheapest.0.is_finite() {
        cheapest
    } else {
        most_accurate
    };
    (best.1, best.2)
}

/// Cost of a box per density, in products of registers: of its points one by one, and of the
/// transform of its grid to waves axis by axis.
fn cost(width: usize, points: usize, waves: usize) -> f64 {
    const BOX_POINTS: f64 = 400.0;
    let (w, g, j) = (width as f64, points as f64, waves as f64);
    // A window of w points begins anywhere in a register.
    let registers = (w + 0.5 * (PADDING - 1) as f64) / PADDING as f64;
    let spreading = BOX_POINTS * w * w * registers.max(1.0) * 2.0;
    let transform = g * g * padded(points) as f64 * j + 2.0 * g * g * j * j + 4.0 * g * j * j * j;
    spreading + transform / PADDING as f64
}

/// The waves of differences in box units, in a shell of wave vectors, each with the size of the
/// flow that Stokeslets and `derivatives` make at it.
fn spectrum(waves: usize, derivatives: usize) -> Vec<(f64, f64)> {
    let splitting = Splitting::new(waves);
    (1..waves)
        .map(|j| {
            let k = 2.0 * PI / 3.0 * j as f64;
            (
                k,
                k * splitting.difference(k).abs() * k.powi(2 + derivatives as i32),
            )
        })
        .collect()
}

/// Relative error that a window makes in a flow of this spectrum, root mean square over waves and
/// largest over places. It is the error of the window itself or, with `slopes`, of its derivative.
fn window_error(width: usize, points: usize, spectrum: &[(f64, f64)], slopes: bool) -> f64 {
    const PLACES: usize = 6;
    let spacing = 1.0 / (points - width + 1) as f64;
    let w = width as f64;
    let cutoff = spectrum.last().map_or(PI, |(k, _)| *k) + 2.0 * PI / 3.0;
    let psi = Prolate::new(0.5 * PI * w * (2.0 - cutoff * spacing / PI).max(0.1));
    let transforms: Vec<f64> = spectrum
        .iter()
        .map(|(k, _)| w * psi.half_integral() * psi.value(0.5 * k * spacing * w / psi.bandwidth()))
        .collect();
    let mut worst = 0.0_f64;
    for place in 0..PLACES {
        let fraction = (place as f64 + 0.5) / PLACES as f64;
        let window: Vec<(f64, f64)> = (0..width)
            .map(|m| {
                let z = m as f64 + fraction - 0.5 * w;
                let x = 2.0 * z / w;
                let value = if slopes {
                    psi.derivative(x) * 2.0 / (w * spacing)
                } else {
                    psi.value(x)
                };
                (z * spacing, value)
            })
            .collect();
        let (mut error, mut total) = (0.0, 0.0);
        for (&(k, size), transform) in spectrum.iter().zip(&transforms) {
            let (mut real, mut imaginary) = (0.0, 0.0);
            for &(x, value) in &window {
                real += value * (k * x).cos() / transform;
                imaginary += value * (k * x).sin() / transform;
            }
            // Exactly, the transform of the window is 1 here and that of its derivative -i k.
            let (lost_real, lost_imaginary) = if slopes {
                (real / k, 1.0 + imaginary / k)
            } else {
                (real - 1.0, imaginary)
            };
            error += size * size * (lost_real * lost_real + lost_imaginary * lost_imaginary);
            total += size * size;
        }
        worst = worst.max((error / total).sqrt());
    }
    worst
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_of_every_size() {
        for derivatives in 0..3 {
            let mut waves = 0;
            for step in 0..=22 {
                let tolerance = 10f64.powf(-1.0 - 0.5 * step as f64);
                let parameters = Parameters::for_tolerance(tolerance, derivatives);
                assert!(parameters.waves >= waves, "more accuracy by fewer waves");
                waves = parameters.waves;
                assert!(parameters.width <= WIDEST && parameters.points > parameters.width);
                assert_eq!(parameters.points % 2, 0);
                let error = window_error(
                    parameters.width,
                    parameters.points,
                    &spectrum(waves, derivatives),
                    derivatives > 0,
                );
                assert!(error <= WINDOW_PART * tolerance, "{tolerance:e}: {error:e}");
                println!("{derivatives} derivatives, {tolerance:.0e}: {parameters:?}");
            }
        }
    }

    #[test]
    fn waves_are_as_many_as_peers_take() {
        // af Klinteberg et al. 2025 take c = 10.47, 17.80, 25.13, 33.51 for Stokeslets; these are
        // pi J / 3.
        for (digits, waves) in [(3, 10), (6, 17), (9, 24), (12, 32)] {
            let found = fewest_waves(10f64.powi(-digits), 0);
            assert!(found.abs_diff(waves) <= 1, "{digits}: {found}");
        }
    }

    #[test]
    fn precision_of_roots() {
        assert_eq!(
            Parameters::for_tolerance(1e-2, 0).precision,
            Precision::Seed
        );
        assert_eq!(
            Parameters::for_tolerance(1e-6, 0).precision,
            Precision::Single
        );
        assert_eq!(
            Parameters::for_tolerance(1e-9, 0).precision,
            Precision::Close
        );
        assert_eq!(
            Parameters::for_tolerance(1e-12, 0).precision,
            Precision::Full
        );
    }
}
