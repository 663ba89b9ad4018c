//! The window that spreads points over a grid, and the one-axis matrices from grids to waves and to
//! the grids of parents.

use std::f64::consts::PI;

use f64_lanes::padded;
use faer::Mat;

use crate::polynomial::{self, Sample};
use crate::prolate::Prolate;

/// The window of a grid: $\varphi(z) = \psi_0^{c_w}(2z/w)$ at a distance of $z$ grid spacings, 0
/// beyond $w/2$.
///
/// All lengths are in sides of the box, and positions are measured from its centre. The grid has
/// its $g$ points per axis at $(i - \frac{g-1}2)h$, $h = 1/(g - w + 1)$, so that the $w$ points
/// nearest to any place in the box exist.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    psi: Prolate,
    width: usize,
    points: usize,
    /// No waves beyond: $K = 2\pi J/3$.
    cutoff: f64,
    values: PiecewisePolynomial,
}

/// The $w$ values of the window on the grid as polynomials in $s \in [-1, 1]$. Here $s = 2f - 1$
/// with $f$ the distance, in grid spacings, from the lower end of the window to the first grid
/// point in it. As the point moves up by a grid spacing, $s$ falls by 2.
#[derive(Clone, Debug)]
pub(crate) struct PiecewisePolynomial {
    /// $w$ padded to whole registers.
    pub stride: usize,
    /// The coefficients of all grid points, power by power, the highest first. Each power is padded
    /// with zeros to `stride`.
    pub coefficients: Vec<f64>,
}

impl Window {
    /// The window over `width` $= w$ grid points, for grids of `points` $= g$ per axis (even,
    /// $g > w$) and $J$ = `waves`.
    pub fn new(width: usize, points: usize, waves: usize) -> Self {
        let cutoff = 2.0 * PI * waves as f64 / 3.0;
        let intervals = (points - width + 1) as f64;
        let oversampling = intervals * PI / cutoff;
        let psi = Prolate::new(0.5 * PI * width as f64 * (2.0 - 1.0 / oversampling));
        let values = PiecewisePolynomial::new(&psi, width);
        Self {
            psi,
            width,
            points,
            cutoff,
            values,
        }
    }

    /// $w$.
    pub fn width(&self) -> usize {
        self.width
    }

    /// $g$, grid points per axis.
    pub fn points(&self) -> usize {
        self.points
    }

    /// $h$, in sides of the box.
    pub fn spacing(&self) -> f64 {
        1.0 / (self.points - self.width + 1) as f64
    }

    /// The values on the grid, ready for evaluation.
    pub fn values(&self) -> &PiecewisePolynomial {
        &self.values
    }

    /// Transform $\hat\varphi(k) = \int \varphi(z)\,e^{-ikhz}\,dz$ for $|k| \le K$ in box units. It
    /// is $w C_0\,\psi(khw/2c_w)$, since $\psi$ is its own transform.
    pub fn fourier(&self, k: f64) -> f64 {
        let width = self.width as f64;
        let x = 0.5 * k * self.spacing() * width / self.psi.bandwidth();
        width * self.psi.half_integral() * self.psi.value(x)
    }

    /// From the grid to these waves.
    pub fn waves_matrix(&self, waves: &[f64]) -> WavesMatrix {
        let half = self.points / 2;
        let matrix = |trigonometric: fn(f64) -> f64| {
            waves
                .iter()
                .flat_map(|&k| {
                    let inverse = 1.0 / self.fourier(k);
                    (0..half).map(move |i| {
                        trigonometric(k * (i as f64 + 0.5) * self.spacing()) * inverse
                    })
                })
                .collect()
        };
        WavesMatrix {
            even: matrix(f64::cos),
            odd: matrix(f64::sin),
        }
    }

    /// Number of points of the parent's grid that a child reaches along each axis: those over which
    /// its own points, in half of the parent, would be spread.
    pub fn reach(&self) -> usize {
        (self.points + self.width).div_ceil(2)
    }

    /// The one-axis matrix that takes the grid of the lower child to the lowest
    /// [`reach`](Self::reach) points of its parent's grid: row-major, parent by child.
    ///
    /// The parent's grid is the one whose waves come closest, over $|k| \le K$ and in the sense of
    /// least squares, to those of the child:
    /// $$ \sum_G R_{Gg}\,\frac{e^{-ikX_G}}{\hat\varphi(k)}
    ///    = \frac{e^{-ikx_g}}{\hat\varphi(k/2)}, $$
    /// with $X_G$ the parent's grid and $x_g$ the child's, both in sides of the parent. Grids that
    /// hardly make waves are left out. The upper child's matrix is the mirror image,
    /// $R_{g-1-G,\,g-1-g'}$.
    pub fn transfer(&self) -> Vec<f64> {
        const SAMPLES: usize = 200;
        const NEGLIGIBLE: f64 = 1e-11;
        let waves: Vec<f64> = (0..SAMPLES)
            .map(|i| self.cutoff * (i as f64 + 0.5) / SAMPLES as f64)
            .collect();
        let parent = self.phases(&waves, 1.0, 0.0, self.reach());
        let child = self.phases(&waves, 0.5, -0.25, self.points);
        let svd = parent.thin_svd().expect("finite numbers");
        let singular = svd.S().column_vector();
        let mut modes = svd.U().transpose() * child;
        for (i, mut row) in modes.row_iter_mut().enumerate() {
            let kept = singular[i] > NEGLIGIBLE * singular[0];
            let inverse = if kept { 1.0 / singular[i] } else { 0.0 };
            row *= faer::Scale(inverse);
        }
        let transfer = svd.V() * modes;
        transfer
            .row_iter()
            .flat_map(|row| row.iter().copied().collect::<Vec<_>>())
            .collect()
    }

    /// Values of $e^{-ikx}/\hat\varphi$ on the lowest `points` of the grid of a box of some side
    /// about some centre: cosines above, sines below.
    fn phases(&self, waves: &[f64], side: f64, center: f64, points: usize) -> Mat<f64> {
        let count = waves.len();
        let transforms: Vec<f64> = waves.iter().map(|k| self.fourier(k * side)).collect();
        Mat::from_fn(2 * count, points, |row, i| {
            let k = waves[row % count];
            let x = center + side * self.position(i);
            let wave = if row < count {
                (k * x).cos()
            } else {
                (k * x).sin()
            };
            wave / transforms[row % count]
        })
    }

    /// Grid point `i`.
    fn position(&self, i: usize) -> f64 {
        (i as f64 - 0.5 * (self.points - 1) as f64) * self.spacing()
    }
}

/// The one-axis matrices of $\hat q(k) = \frac1{\hat\varphi(k)}\sum_i G_i\,e^{-ikx_i}$, folded
/// about the centre. With the upper half $x_i = (i + \frac12)h$, $0 \le i < g/2$, `even` takes the
/// even part of the grid, $G(x_i) + G(-x_i)$, to the real part, and $-$`odd` takes the odd part,
/// $G(x_i) - G(-x_i)$, to the imaginary part. The transposes take waves back to grids.
#[derive(Clone, Debug)]
pub(crate) struct WavesMatrix {
    /// $\cos(k_jx_i)/\hat\varphi(k_j)$, waves by half the grid, row-major.
    pub even: Vec<f64>,
    /// $\sin(k_jx_i)/\hat\varphi(k_j)$, the same.
    pub odd: Vec<f64>,
}

impl PiecewisePolynomial {
    /// Right to a hundredth of where the window is cut off.
    fn new(psi: &Prolate, width: usize) -> Self {
        const LONGEST: usize = 40;
        let accuracy = (0.01 * psi.value(1.0)).max(2e-15);
        let samples: Vec<Vec<Sample>> =
            (0..width).map(|m| piece(psi, width, m, accuracy)).collect();
        let mut pieces = Vec::new();
        for degree in 1..=LONGEST {
            let fits: Vec<_> = samples.iter().map(|s| polynomial::fit(s, degree)).collect();
            let good = fits.iter().all(|(_, error)| *error <= 1.0);
            pieces = fits.into_iter().map(|(piece, _)| piece).collect();
            if good {
                break;
            }
        }
        let stride = padded(width);
        Self {
            stride,
            coefficients: interleave(&pieces, stride),
        }
    }
}

/// The window at its grid point number `m` as a function of $s$.
fn piece(psi: &Prolate, width: usize, m: usize, allowed: f64) -> Vec<Sample> {
    const SAMPLES: usize = 80;
    (0..SAMPLES)
        .map(|i| {
            let s = polynomial::node(i, SAMPLES);
            let from_end = m as f64 + 0.5 * (s + 1.0);
            let value = psi.value(2.0 * from_end / width as f64 - 1.0);
            Sample { s, value, allowed }
        })
        .collect()
}

/// Coefficients of all polynomials power by power, each power padded to `stride`.
fn interleave(polynomials: &[Vec<f64>], stride: usize) -> Vec<f64> {
    let terms = polynomials[0].len();
    let mut interleaved = vec![0.0; terms * stride];
    for (m, polynomial) in polynomials.iter().enumerate() {
        for (power, coefficient) in polynomial.iter().enumerate() {
            interleaved[power * stride + m] = *coefficient;
        }
    }
    interleaved
}

#[cfg(test)]
mod tests {
    use panel_quadrature::GaussLegendre;

    use super::*;

    /// Width, grid points, waves, and bounds a little above what a prototype in numpy measured.
    const SETS: [(usize, usize, usize, f64); 4] = [
        (6, 16, 10, 6e-5),
        (8, 24, 17, 4e-6),
        (12, 36, 24, 1.2e-9),
        (16, 48, 32, 1e-12),
    ];

    /// The grid of one axis for a unit charge at `x`.
    fn grid(window: &Window, x: f64) -> Vec<f64> {
        let from = x / window.spacing() + 0.5 * (window.points() - 1 - window.width()) as f64;
        let last = (window.points() - window.width()) as f64;
        let start = from.ceil().clamp(0.0, last);
        let s = 2.0 * (start - from) - 1.0;
        let values = window.values();
        let mut grid = vec![0.0; window.points()];
        for m in 0..window.width() {
            grid[start as usize + m] = values
                .coefficients
                .chunks(values.stride)
                .fold(0.0, |sum, power| sum * s + power[m]);
        }
        grid
    }

    /// Largest difference between the waves of a grid and $e^{-ikx}$, over the waves.
    fn error(window: &Window, matrix: &WavesMatrix, waves: &[f64], grid: &[f64], x: f64) -> f64 {
        let (g, half) = (window.points(), window.points() / 2);
        let mut worst = 0.0_f64;
        for (j, k) in waves.iter().enumerate() {
            let (mut real, mut imaginary) = (0.0, 0.0);
            for i in 0..half {
                let (above, below) = (grid[half + i], grid[g - 1 - half - i]);
                real += matrix.even[j * half + i] * (above + below);
                imaginary -= matrix.odd[j * half + i] * (above - below);
            }
            worst = worst.max((real - (k * x).cos()).hypot(imaginary + (k * x).sin()));
        }
        worst
    }

    #[test]
    fn spreads_waves() {
        for (width, points, waves, bound) in SETS {
            let window = Window::new(width, points, waves);
            let k: Vec<f64> = (0..waves).map(|j| 2.0 * PI / 3.0 * j as f64).collect();
            let matrix = window.waves_matrix(&k);
            let worst = (0..=400)
                .map(|i| i as f64 / 400.0 - 0.5)
                .map(|x| error(&window, &matrix, &k, &grid(&window, x), x))
                .fold(0.0, f64::max);
            let terms = window.values().coefficients.len() / window.values().stride;
            println!("w = {width}, g = {points}, J = {waves}: {worst:.1e}, {terms} terms");
            assert!(worst < bound);
        }
    }

    #[test]
    fn spreads_through_the_child() {
        for (width, points, waves, bound) in SETS {
            let window = Window::new(width, points, waves);
            let k: Vec<f64> = (0..100).map(|i| window.cutoff * i as f64 / 99.0).collect();
            let matrix = window.waves_matrix(&k);
            let transfer = window.transfer();
            let mut worst = 0.0_f64;
            for i in 0..=200 {
                let x = i as f64 / 400.0 - 0.5;
                let child = grid(&window, 2.0 * (x + 0.25));
                let beyond = points - window.reach();
                let parent: Vec<f64> = transfer
                    .chunks(points)
                    .map(|row| row.iter().zip(&child).map(|(r, g)| r * g).sum())
                    .chain(std::iter::repeat_n(0.0, beyond))
                    .collect();
                let mirrored: Vec<f64> = parent.iter().rev().copied().collect();
                worst = worst.max(error(&window, &matrix, &k, &parent, x));
                worst = worst.max(error(&window, &matrix, &k, &mirrored, -x));
            }
            println!("w = {width}, g = {points}, J = {waves}: {worst:.1e} through the child");
            assert!(worst < bound);
        }
    }

    #[test]
    fn transform_is_the_integral() {
        let window = Window::new(8, 24, 17);
        let rule = GaussLegendre::new(60).unwrap();
        for k in [0.0, 3.0, 20.0, window.cutoff] {
            let integral: f64 = rule
                .iter()
                .map(|(x, weight)| {
                    let z = 4.0 * x;
                    4.0 * weight * window.psi.value(x) * (k * z * window.spacing()).cos()
                })
                .sum();
            assert!((integral - window.fourier(k)).abs() < 1e-13);
        }
    }
}
