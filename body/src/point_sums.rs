//! Matrices of the sum over a body's own points, at these points.
//!
//! A fast summation over the points of all bodies includes the points of the target's own body,
//! where the rule is not accurate. This part has to be subtracted. On equidistant azimuths it is
//! rotationally invariant like the integral that it approximates: for each mode a small matrix,
//! which depends on the shape alone and subtracts the part to rounding.

use std::f64::consts::PI;

use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use pulp::Scalar;
use rayon::prelude::*;

use super::discretization::{Discretization, Node};
use super::layers::LayerWeights;
use super::matrix::{ModalMatrices, SIGN, TargetRows};
use crate::kernel::{DoubleLayer, Kernel, Pair, Parity, SingleLayer};
use f64_lanes::Lanes;

/// Azimuths, and the transforms from half of them to modes.
struct Transforms {
    azimuths: usize,
    /// Half the azimuths and azimuth zero.
    half: usize,
    modes: usize,
    /// Mode after mode, the weights of the azimuths in even and in odd entries.
    even: Vec<f64>,
    odd: Vec<f64>,
}

impl Transforms {
    fn new(n_max: usize, azimuths: usize) -> Self {
        let half = azimuths / 2 + 1;
        let table = |weight: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..=n_max)
                .flat_map(|n| (0..half).map(move |l| (n, l)))
                .map(|(n, l)| {
                    // Azimuth l and its mirror image, which coincide at 0 and, for even numbers,
                    // opposite to it.
                    let pair = if 2 * l % azimuths == 0 { 1.0 } else { 2.0 };
                    let angle = 2.0 * PI * (n * l % azimuths) as f64 / azimuths as f64;
                    pair * 2.0 * PI / azimuths as f64 * weight(angle)
                })
                .collect()
        };
        Self {
            azimuths,
            half,
            modes: n_max + 1,
            even: table(&f64::cos),
            odd: table(&f64::sin),
        }
    }
}

impl ModalMatrices {
    /// The matrices of $w_D D + w_S S$ summed over points at so many azimuths of every node, each
    /// with its share of the surface; a point's own term is left out. For modes up to `n_max`, at
    /// most half the azimuths.
    pub fn of_point_sum(
        discretization: &Discretization,
        weights: LayerWeights,
        n_max: usize,
        azimuths: usize,
    ) -> Self {
        let mut matrices = Self::zeros(discretization, n_max);
        let transforms = Transforms::new(n_max, azimuths);
        let nodes = discretization.nodes();
        let targets = matrices.rows_by_target();
        targets.into_par_iter().enumerate().for_each_init(
            || (Vec::new(), Vec::new()),
            |(samples, spectrum), (target, mut rows)| {
                sample(nodes, target, weights, &transforms, samples);
                fill(nodes, target, &transforms, samples, spectrum, &mut rows);
            },
        );
        matrices
    }
}

/// The kernel's entries between a target at azimuth zero and all sources: entry after entry, source
/// after source, azimuth after azimuth.
fn sample(
    nodes: &[Node],
    target: usize,
    weights: LayerWeights,
    transforms: &Transforms,
    samples: &mut Vec<f64>,
) {
    let half = transforms.half;
    samples.clear();
    samples.resize(9 * nodes.len() * half, 0.0);
    let one = |x: f64| Lanes(Scalar, x);
    let at = &nodes[target];
    for (j, node) in nodes.iter().enumerate() {
        let (a, b) = (at.r - node.r, at.z - node.z);
        let [nu_r, nu_z] = node.normal;
        let pair = Pair::new(
            one(at.r),
            one(node.r),
            one(a),
            one(b),
            one(nu_r),
            one(nu_z),
            one(0.0),
            one(0.0),
        );
        let first = usize::from(j == target);
        for l in first..half {
            let t = 2.0 * PI * l as f64 / transforms.azimuths as f64;
            let c = 2.0 * (0.5 * t).sin().powi(2);
            let separation = pair.separation(one(c), one(t.sin()));
            let (double, single) = (
                DoubleLayer.sample(&separation),
                SingleLayer.sample(&separation),
            );
            for k in 0..9 {
                samples[(k * nodes.len() + j) * half + l] =
                    weights.double * double[k].1 + weights.single * single[k].1;
            }
        }
    }
}

/// The target's rows of every mode.
fn fill(
    nodes: &[Node],
    target: usize,
    transforms: &Transforms,
    samples: &[f64],
    spectrum: &mut Vec<f64>,
    rows: &mut TargetRows<'_>,
) {
    let (count, half, modes) = (nodes.len(), transforms.half, transforms.modes);
    spectrum.resize(count * modes, 0.0);
    let root = nodes[target].weight.sqrt();
    for (k, sign) in SIGN.into_iter().enumerate() {
        let table = match <SingleLayer as Kernel<9>>::PARITY[k] {
            Parity::Even => &transforms.even,
            Parity::Odd => &transforms.odd,
        };
        matmul(
            MatMut::from_column_major_slice_mut(spectrum, count, modes),
            Accum::Replace,
            MatRef::from_column_major_slice(
                &samples[k * count * half..][..count * half],
                half,
                count,
            )
            .transpose(),
            MatRef::from_column_major_slice(table, half, modes),
            sign * root,
            Par::Seq,
        );
        for (n, spectrum) in spectrum.chunks(count).enumerate() {
            let row = &mut rows[3 * n + k / 3][k % 3 * count..][..count];
            for ((to, from), node) in row.iter_mut().zip(spectrum).zip(nodes) {
                *to = from * node.weight.sqrt();
            }
        }
    }
}
