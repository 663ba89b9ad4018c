//! The symbol of a kernel: its action on plane waves.
//!
//! All kernels come from one scalar: the biharmonic function $B = r/8\pi$ split at a length, with
//! transform $-\Gamma(k)/k^4$. Every kernel here is a differential operator on $B$. So every
//! potential is a sum of densities, each multiplied by a table over the waves, with cosines and
//! sines exchanged for every odd derivative.

use std::f64::consts::PI;

use f64_lanes::Lanes;
use pulp::Simd;

use crate::splitting::{ROOT_CHARGE, ROOT_STOKESLET};
use crate::transform::{BATCH, Ball, CLASSES};

/// A product of the symbol: potential = $\pm$ derivative along `axes` of (table times density).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term {
    pub potential: usize,
    pub density: usize,
    /// Bit `axis` is set where one derivative is taken along it.
    pub axes: usize,
    /// The sign of the derivative.
    pub sign: f64,
    /// What multiplies $\Gamma/k^4$, the derivatives without their $\pm$ included.
    pub polynomial: fn([f64; 3]) -> f64,
    /// Degree of the polynomial.
    pub degree: i32,
    /// What is added to the root, of side 1, per unit sum of the density, to correct for the
    /// cut-off of $B$ in free space.
    pub constant: f64,
}

fn square(k: [f64; 3]) -> f64 {
    k.iter().map(|k| k * k).sum()
}

/// The symbol of Stokes flow. Densities are the force (3) and, if `flux`, sources; potentials are
/// the velocity (3) and, if `pressure`, the pressure.
pub(crate) fn stokes(flux: bool, pressure: bool) -> Vec<Term> {
    let across: [fn([f64; 3]) -> f64; 3] = [
        |[_, y, z]| y * y + z * z,
        |[x, _, z]| x * x + z * z,
        |[x, y, _]| x * x + y * y,
    ];
    let between: [fn([f64; 3]) -> f64; 3] =
        [|[_, y, z]| y * z, |[x, _, z]| x * z, |[x, y, _]| x * y];
    let along: [fn([f64; 3]) -> f64; 3] = [
        |k| k[0] * square(k),
        |k| k[1] * square(k),
        |k| k[2] * square(k),
    ];
    let mut terms = Vec::new();
    for i in 0..3 {
        for j in 0..3 {
            // u = (I lap - grad grad) B * F.
            terms.push(if i == j {
                Term {
                    potential: i,
                    density: j,
                    axes: 0,
                    sign: 1.0,
                    polynomial: across[i],
                    degree: 2,
                    constant: -ROOT_STOKESLET,
                }
            } else {
                Term {
                    potential: i,
                    density: j,
                    axes: 1 << i | 1 << j,
                    sign: 1.0,
                    polynomial: between[3 - i - j],
                    degree: 2,
                    constant: 0.0,
                }
            });
        }
        let gradient = |potential, density| Term {
            potential,
            density,
            axes: 1 << i,
            sign: -1.0,
            polynomial: along[i],
            degree: 3,
            constant: 0.0,
        };
        if flux {
            terms.push(gradient(i, 3));
        }
        if pressure {
            terms.push(gradient(3, i));
        }
    }
    terms
}

/// The symbol of the potential of charges.
pub(crate) fn laplace() -> Vec<Term> {
    vec![Term {
        potential: 0,
        density: 0,
        axes: 0,
        sign: 1.0,
        polynomial: square,
        degree: 2,
        constant: -ROOT_CHARGE,
    }]
}

/// A symbol on the waves of a box of side 1.
#[derive(Clone, Debug)]
pub(crate) struct Symbol {
    waves: usize,
    potentials: usize,
    terms: Vec<Weighted>,
}

#[derive(Clone, Debug)]
struct Weighted {
    term: Term,
    /// For each wave.
    table: Vec<f64>,
}

impl Symbol {
    /// Symbol at the waves `spacing` times $j$. `biharmonic(k)` is the transform $-\Gamma/k^4$ of
    /// the part of $B$ in question. In the `free_space` case $B$ is cut off, and the effect of that
    /// is corrected.
    pub fn new(
        terms: &[Term],
        ball: &Ball,
        spacing: f64,
        free_space: bool,
        biharmonic: impl Fn(f64) -> f64,
    ) -> Self {
        let cell = (spacing / (2.0 * PI)).powi(3);
        // Waves of one length share its value, and the square of the length counts in whole steps.
        let squared = |j: [usize; 3]| j.iter().map(|j| j * j).sum::<usize>();
        let longest = ball.indices().map(squared).max().unwrap_or(0);
        let biharmonic: Vec<f64> = (1..=longest)
            .map(|square| biharmonic(spacing * (square as f64).sqrt()))
            .collect();
        let table = |term: &Term| {
            ball.indices()
                .map(|j| {
                    let k = j.map(|j| spacing * j as f64);
                    let Some(shorter) = squared(j).checked_sub(1) else {
                        return if free_space { term.constant } else { 0.0 };
                    };
                    // Each wave stands for its mirror images too.
                    let images: f64 = j.map(|j| if j == 0 { 1.0 } else { 2.0 }).iter().product();
                    -images * cell * biharmonic[shorter] * (term.polynomial)(k)
                })
                .collect()
        };
        let terms: Vec<_> = terms
            .iter()
            .map(|&term| Weighted {
                term,
                table: table(&term),
            })
            .collect();
        let potentials = 1 + terms.iter().map(|t| t.term.potential).max().unwrap_or(0);
        Self {
            waves: ball.len,
            potentials,
            terms,
        }
    }

    /// Potentials of densities, both `[field][class of x][class of y][wave][class of z][8]`, in
    /// boxes of side `side`.
    #[inline(always)]
    pub fn apply<S: Simd>(&self, simd: S, side: f64, densities: &[f64], potentials: &mut [f64]) {
        let field = CLASSES * self.waves * BATCH;
        let row = 2 * BATCH;
        for potential in 0..self.potentials {
            let out = &mut potentials[potential * field..][..field];
            out.fill(0.0);
            for Weighted { term, table } in
                self.terms.iter().filter(|t| t.term.potential == potential)
            {
                let scale = term.sign * side.powi(1 - term.degree);
                let density = &densities[term.density * field..][..field];
                // Axis x is the highest digit of the class number, y the next; z stands after the
                // wave.
                let [x, y, z] = [0, 1, 2].map(|axis| term.axes >> axis & 1);
                for class in 0..4 {
                    let [class_x, class_y] = [class >> 1, class & 1];
                    let sign = if (class_x & x) ^ (class_y & y) == 1 {
                        -scale
                    } else {
                        scale
                    };
                    let from = (2 * (class_x ^ x) + (class_y ^ y)) * self.waves * row;
                    let from = &density[from..][..self.waves * row];
                    let to = &mut out[class * self.waves * row..][..self.waves * row];
                    for (wave, &factor) in table.iter().enumerate() {
                        let (even, odd) =
                            (sign * factor, if z == 1 { -sign } else { sign } * factor);
                        let from = &from[wave * row..][..row];
                        let to = &mut to[wave * row..][..row];
                        add(simd, even, &from[z * BATCH..][..BATCH], &mut to[..BATCH]);
                        add(
                            simd,
                            odd,
                            &from[(1 - z) * BATCH..][..BATCH],
                            &mut to[BATCH..],
                        );
                    }
                }
            }
        }
    }
}

/// `to += factor * from` for eight boxes.
#[inline(always)]
fn add<S: Simd>(simd: S, factor: f64, from: &[f64], to: &mut [f64]) {
    let factor = Lanes::splat(simd, factor);
    for register in 0..BATCH / Lanes::<S>::COUNT {
        factor
            .mul_add(
                Lanes::load(simd, from, register),
                Lanes::load(simd, to, register),
            )
            .store(to, register);
    }
}
