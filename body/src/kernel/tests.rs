//! Modal kernels against high-precision values, and the recurrences against the FFT.

use std::f64::consts::PI;

use super::invariant::Parity;
use super::pair::Pair;
use super::*;
use f64_lanes::Lanes;

/// A row of a table of tests/data: geometry, mode, and the entries of every kernel in the order of
/// its header.
struct Row {
    label: String,
    target: TargetRing,
    rp: f64,
    ab: [f64; 2],
    normal: [f64; 2],
    n: usize,
    entries: Vec<f64>,
}

fn rows(table: &str) -> Vec<Row> {
    table
        .lines()
        .filter(|l| !l.starts_with('#'))
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let x = |k: usize| fields[k].parse::<f64>().expect("a number");
            Row {
                label: fields[0].to_string(),
                target: TargetRing {
                    r: x(1),
                    normal: [x(7), x(8)],
                },
                rp: x(2),
                ab: [x(3), x(4)],
                normal: [x(5), x(6)],
                n: x(11) as usize,
                entries: (12..fields.len()).map(x).collect(),
            }
        })
        .collect()
}

/// The entries of `kernel` in mode `row.n`, evaluated with modes up to `n_max`.
fn entries<const K: usize>(kernel: &impl Kernel<K>, row: &Row, n_max: usize) -> Vec<f64> {
    let modes = Modes::new(n_max);
    let mut sources = SourceRings::default();
    sources.push(row.rp, row.ab, row.normal);
    let mut workspace = Workspace::default();
    modes.evaluate(kernel, row.target, &sources, &mut workspace);
    (0..K)
        .map(|k| workspace.block[(row.n * K + k) * workspace.stride])
        .collect()
}

/// Largest error of each kernel, in units of its natural size next to the singularity: $1/r$ for
/// the single layer, $1/\rho r$ for double layer, traction and single-layer pressure, $1/\rho^2 r$
/// for the double layer's pressure.
fn worst(table: &str, n_max: usize) -> [(f64, String); 5] {
    let mut worst: [(f64, String); 5] = Default::default();
    for row in rows(table).iter().filter(|row| row.n <= n_max) {
        let computed = [
            entries(&SingleLayer, row, n_max),
            entries(&DoubleLayer, row, n_max),
            entries(&SingleLayerTraction, row, n_max),
            entries(&SingleLayerPressure, row, n_max),
            entries(&DoubleLayerPressure, row, n_max),
        ];
        let rho = row.ab[0].hypot(row.ab[1]);
        let r = row.target.r.max(row.rp);
        let scales = [r, rho * r, rho * r, rho * r, rho * rho * r];
        let mut exact = row.entries.iter();
        for ((values, scale), worst) in computed.iter().zip(scales).zip(&mut worst) {
            for (k, (value, exact)) in values.iter().zip(&mut exact).enumerate() {
                let error = (value - exact).abs() * scale;
                if error.is_nan() || error > worst.0 {
                    *worst = (
                        error,
                        format!(
                            "{} n {} entry {k}: {value:e}, not {exact:e}",
                            row.label, row.n
                        ),
                    );
                }
            }
        }
    }
    println!("n_max {n_max}: {worst:#?}");
    worst
}

#[test]
fn near_modes_match_high_precision() {
    let table = include_str!("../../../tests/data/modal_kernels.csv");
    for n_max in [2, 60] {
        for (error, place) in worst(table, n_max) {
            assert!(error <= 5e-15, "{error:e} at {place}");
        }
    }
}

#[test]
fn far_modes_match_high_precision() {
    let table = include_str!("../../../tests/data/modal_kernels_far.csv");
    for n_max in [0, 1, 5, 60, 200] {
        for (error, place) in worst(table, n_max) {
            assert!(error <= 1e-15, "{error:e} at {place}");
        }
    }
}

/// A pair of rings.
#[derive(Clone, Copy, Debug)]
struct Rings {
    r: f64,
    rp: f64,
    ab: [f64; 2],
    normal: [f64; 2],
}

impl Rings {
    /// Rings at a distance (relative to the target's radius) from each other, in many directions.
    fn around(r: f64, distance: f64) -> impl Iterator<Item = Self> {
        let rho = r * distance;
        let pairs = (0..7).map(move |k| {
            let angle = 2.0 * PI * (k as f64 + 0.3) / 7.0;
            let ab = [rho * angle.cos(), rho * angle.sin()];
            let normal = [(2.0 * angle).cos(), (2.0 * angle).sin()];
            let rp = r - ab[0];
            Self { r, rp, ab, normal }
        });
        pairs.filter(move |rings| rings.rp > 0.05 * r)
    }

    fn h(&self) -> f64 {
        self.ab[0].hypot(self.ab[1]).powi(2) / (2.0 * self.r * self.rp)
    }

    /// Every entry of every mode by `modes`.
    fn by<const K: usize>(&self, modes: &Modes, kernel: &impl Kernel<K>) -> Vec<[f64; K]> {
        let target = TargetRing {
            r: self.r,
            normal: [0.0; 2],
        };
        let mut sources = SourceRings::default();
        sources.push(self.rp, self.ab, self.normal);
        let mut workspace = Workspace::default();
        modes.evaluate(kernel, target, &sources, &mut workspace);
        let entry = |n: usize, k: usize| workspace.block[(n * K + k) * workspace.stride];
        (0..modes.count())
            .map(|n| std::array::from_fn(|k| entry(n, k)))
            .collect()
    }

    /// The same up to mode `n_max` by the trapezoidal rule, with as many points as it takes.
    fn summed<const K: usize, F: Kernel<K>>(&self, n_max: usize, kernel: &F) -> Vec<[f64; K]> {
        let decay = 2.0 * (0.5 * self.h()).sqrt().asinh();
        let count = 2 * n_max + 64 + (40.0 / decay) as usize;
        let scalar = |x: f64| Lanes(pulp::Scalar, x);
        let [r, rp, a, b, nu_r, nu_z] = [
            self.r,
            self.rp,
            self.ab[0],
            self.ab[1],
            self.normal[0],
            self.normal[1],
        ]
        .map(scalar);
        let pair = Pair::new(r, rp, a, b, nu_r, nu_z, scalar(0.0), scalar(0.0));
        // From -pi to pi: angles close to zero are exact to relative precision.
        let t = |k: usize| {
            let k = k % count;
            let signed = k as f64 - if 2 * k > count { count as f64 } else { 0.0 };
            2.0 * PI * signed / count as f64
        };
        let mut modes = vec![[0.0; K]; n_max + 1];
        for k in 0..count {
            let c = 2.0 * (0.5 * t(k)).sin().powi(2);
            let entries = kernel.sample(&pair.separation(scalar(c), scalar(t(k).sin())));
            for (n, mode) in modes.iter_mut().enumerate() {
                let (sin, cos) = t(n * k).sin_cos();
                for ((sum, entry), parity) in mode.iter_mut().zip(&entries).zip(F::PARITY) {
                    let wave = if parity == Parity::Odd { sin } else { cos };
                    *sum += 2.0 * PI / count as f64 * entry.1 * wave;
                }
            }
        }
        modes
    }
}

/// All entries of the gradient's kernel in the size of the double layer's, $1/\rho r$ (the single
/// layer's are smaller): near pairs by recurrence, well-separated ones by recurrence and by FFT,
/// against sums over points of the kernels in space.
#[test]
fn modes_of_the_gradient_are_those_of_its_samples() {
    const N_MAX: usize = 60;
    let (usual, by_recurrence) = (Modes::new(N_MAX), Modes::with_far(N_MAX, 5.0));
    let r: f64 = 0.3;
    for distance in [1e-3, 1e-2, 0.1, 0.3, 0.7, 1.2, 2.0, 2.5, 3.0] {
        let (mut worst, mut pairs) = ((0.0f64, 0, 0, 0.0), 0);
        for rings in Rings::around(r, distance).filter(|rings| rings.h() < 5.0) {
            let kernel = VelocityPressureGradient;
            let exact = rings.summed(N_MAX, &kernel);
            let scale = distance * r * r.max(rings.rp);
            for modes in [&usual, &by_recurrence] {
                for (n, (found, exact)) in rings.by(modes, &kernel).iter().zip(&exact).enumerate() {
                    for (k, (found, exact)) in found.iter().zip(exact).enumerate() {
                        let error = (found - exact).abs() * scale;
                        if error.is_nan() || error > worst.0 {
                            worst = (error, n, k, rings.h());
                        }
                    }
                }
            }
            pairs += 1;
        }
        println!("distance {distance}: {pairs} pairs, {worst:?}");
        assert!(worst.0 < 1e-13, "{worst:?}");
    }
}
