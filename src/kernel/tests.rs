//! Modal kernels against high-precision values, and the recurrences against the FFT.

use super::*;

/// A row of a table of tests/data: geometry, mode, and the entries of every kernel in the order of its header.
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

/// Largest error of each kernel, in units of its natural size next to the singularity: $1/r$ for the single layer,
/// $1/\rho r$ for double layer, traction and single-layer pressure, $1/\rho^2 r$ for the double layer's pressure.
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
    let table = include_str!("../../tests/data/modal_kernels.csv");
    for n_max in [2, 60] {
        for (error, place) in worst(table, n_max) {
            assert!(error <= 5e-15, "{error:e} at {place}");
        }
    }
}

#[test]
fn far_modes_match_high_precision() {
    let table = include_str!("../../tests/data/modal_kernels_far.csv");
    for n_max in [0, 1, 5, 60, 200] {
        for (error, place) in worst(table, n_max) {
            assert!(error <= 1e-15, "{error:e} at {place}");
        }
    }
}
