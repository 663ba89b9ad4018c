//! Sums and updates of long vectors, the same bits on any number of threads.

use rayon::prelude::*;

use super::KrylovError;

/// Entries per block: three of them fit the second level cache.
const BLOCK: usize = 8192;
/// Sums side by side in a block, so that they are made in SIMD registers.
const LANES: usize = 16;

/// Room for one sum per block.
pub(super) struct Sums(Vec<f64>);

impl Sums {
    pub(super) fn new(length: usize) -> Self {
        Self(vec![0.0; length.div_ceil(BLOCK)])
    }

    fn total(&self) -> f64 {
        self.0.iter().sum()
    }

    pub(super) fn dot(&mut self, x: &[f64], y: &[f64]) -> f64 {
        let blocks = x.par_chunks(BLOCK).zip(y.par_chunks(BLOCK));
        let sums = self.0.par_iter_mut().zip(blocks);
        sums.for_each(|(sum, (x, y))| *sum = block_dot(x, y));
        self.total()
    }

    pub(super) fn norm(&mut self, x: &[f64]) -> f64 {
        self.dot(x, x).sqrt()
    }

    /// Adds `factor * x` to `y`, and gives the product of the new `y` with `next`, or with itself.
    pub(super) fn add_and_dot(
        &mut self,
        y: &mut [f64],
        factor: f64,
        x: &[f64],
        next: Option<&[f64]>,
    ) -> f64 {
        let blocks = y.par_chunks_mut(BLOCK).zip(x.par_chunks(BLOCK));
        let sums = self.0.par_iter_mut().zip(blocks).enumerate();
        sums.for_each(|(block, (sum, (y, x)))| {
            for (y, &x) in y.iter_mut().zip(x) {
                *y += factor * x;
            }
            let from = block * BLOCK;
            *sum = match next {
                Some(next) => block_dot(y, &next[from..from + y.len()]),
                None => block_dot(y, y),
            };
        });
        self.total()
    }

    /// Writes `scale * b - r` to `r`, and gives its norm.
    pub(super) fn residual(&mut self, r: &mut [f64], scale: f64, b: &[f64]) -> f64 {
        let blocks = r.par_chunks_mut(BLOCK).zip(b.par_chunks(BLOCK));
        let sums = self.0.par_iter_mut().zip(blocks);
        sums.for_each(|(sum, (r, b))| {
            for (r, &b) in r.iter_mut().zip(b) {
                *r = scale * b - *r;
            }
            *sum = block_dot(r, r);
        });
        self.total().sqrt()
    }
}

fn block_dot(x: &[f64], y: &[f64]) -> f64 {
    let ((x, x_rest), (y, y_rest)) = (x.as_chunks::<LANES>(), y.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (x, y) in x.iter().zip(y) {
        for lane in 0..LANES {
            sums[lane] += x[lane] * y[lane];
        }
    }
    let rest: f64 = x_rest.iter().zip(y_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

pub(super) fn scale(x: &mut [f64], factor: f64) {
    x.par_chunks_mut(BLOCK)
        .for_each(|x| x.iter_mut().for_each(|x| *x *= factor));
}

/// Writes `start` plus the sum of `factors[i] * basis[i]` to `y`.
pub(super) fn combine(y: &mut [f64], start: &[f64], factors: &[f64], basis: &[Vec<f64>]) {
    let blocks = y.par_chunks_mut(BLOCK).enumerate();
    blocks.for_each(|(block, y)| {
        let range = block * BLOCK..block * BLOCK + y.len();
        y.copy_from_slice(&start[range.clone()]);
        for (&factor, vector) in factors.iter().zip(basis) {
            for (y, &v) in y.iter_mut().zip(&vector[range.clone()]) {
                *y += factor * v;
            }
        }
    });
}

/// Adds `a * p + b * s` to `x`.
pub(super) fn add_two(x: &mut [f64], a: f64, p: &[f64], b: f64, s: &[f64]) {
    let blocks = x.par_chunks_mut(BLOCK).zip(p.par_chunks(BLOCK));
    let blocks = blocks.zip(s.par_chunks(BLOCK));
    blocks.for_each(|((x, p), s)| {
        for ((x, &p), &s) in x.iter_mut().zip(p).zip(s) {
            *x += a * p + b * s;
        }
    });
}

/// Writes `r + beta * (p - omega * v)` to `p`.
pub(super) fn new_direction(p: &mut [f64], r: &[f64], beta: f64, omega: f64, v: &[f64]) {
    let blocks = p.par_chunks_mut(BLOCK).zip(r.par_chunks(BLOCK));
    let blocks = blocks.zip(v.par_chunks(BLOCK));
    blocks.for_each(|((p, r), v)| {
        for ((p, &r), &v) in p.iter_mut().zip(r).zip(v) {
            *p = r + beta * (*p - omega * v);
        }
    });
}

/// Refuses a vector with an entry that is not finite.
pub(super) fn check<E>(quantity: &'static str, x: &[f64]) -> Result<(), KrylovError<E>> {
    match x.iter().position(|x| !x.is_finite()) {
        Some(index) => Err(KrylovError::NotFinite {
            quantity,
            index,
            value: x[index],
        }),
        None => Ok(()),
    }
}

/// The error for a vector of which a sum is not finite.
pub(super) fn not_finite<E>(quantity: &'static str, x: &[f64]) -> KrylovError<E> {
    let index = x.iter().position(|x| !x.is_finite()).unwrap_or_else(|| {
        // The squares overflow: the largest entry is the one to name.
        let larger = |best: usize, i: usize| if x[i].abs() > x[best].abs() { i } else { best };
        (0..x.len()).fold(0, larger)
    });
    KrylovError::NotFinite {
        quantity,
        index,
        value: x[index],
    }
}
