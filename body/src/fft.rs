//! Plans of discrete Fourier transforms.
//!
//! They are made here and nowhere else: the planner holds every algorithm of rustfft, and a generic
//! function that called it would have all of them compiled again in each crate that uses it.

use std::sync::Arc;

use rustfft::{Fft, FftPlanner};

/// $\hat{x}_n = \sum_l x_l e^{-2 \pi i n l / N}$ for $N$ samples.
#[inline(never)]
pub(crate) fn forward(count: usize) -> Arc<dyn Fft<f64>> {
    FftPlanner::new().plan_fft_forward(count)
}

/// $x_l = \sum_n \hat{x}_n e^{2 \pi i n l / N}$, without the factor $1/N$.
#[inline(never)]
pub(crate) fn inverse(count: usize) -> Arc<dyn Fft<f64>> {
    FftPlanner::new().plan_fft_inverse(count)
}
