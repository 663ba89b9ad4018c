//! The table of the README, as Markdown:
//!
//! ```text
//! cargo run --release -p stokes-fmm --example table > table.md
//! ```
//!
//! The figures of other codes were measured on the same machine as ours, an AMD EPYC of family 26
//! with AVX-512, on one thread. Their spheroids are the same as ours for DMK, and of 1000 points
//! each for the others.

mod common;

use clap::Parser;
use common::{
    Case,
    Distribution::{self, Cube, Spheroids},
    Kernel::{self, Combined, Stokeslet, Stresslet},
    Measured, Method, Outputs,
};

/// Prints our speed beside that of other codes, in thousands of points per second, as a table in
/// Markdown.
#[derive(Parser)]
struct Arguments {
    /// Leaves out cases of more points.
    #[arg(long, default_value_t = usize::MAX)]
    largest: usize,
    #[arg(long, default_value_t = 1)]
    threads: usize,
}

/// A case, and thousands of points per second of other codes on one thread: of DMK (b325994), of
/// PVFMM (07a67a6, or STKFMM 56bfce3 on top of it where both kernels are summed) and of FMM3D
/// (38c0655 with its fast kernels).
type Row = (Kernel, Distribution, usize, f64, [Option<f64>; 3]);

const ROWS: [Row; 18] = [
    (
        Stokeslet,
        Cube,
        100_000,
        1e-3,
        [Some(340.0), Some(337.0), Some(46.0)],
    ),
    (
        Stokeslet,
        Cube,
        100_000,
        1e-6,
        [Some(74.3), Some(93.0), Some(19.0)],
    ),
    (
        Stokeslet,
        Cube,
        100_000,
        1e-9,
        [Some(40.5), Some(53.0), Some(9.5)],
    ),
    (
        Stokeslet,
        Cube,
        1_000_000,
        1e-3,
        [Some(310.0), Some(259.0), Some(37.0)],
    ),
    (
        Stokeslet,
        Cube,
        1_000_000,
        1e-6,
        [Some(57.5), Some(83.0), Some(20.0)],
    ),
    (
        Stokeslet,
        Cube,
        1_000_000,
        1e-9,
        [Some(31.0), Some(50.0), Some(9.7)],
    ),
    (
        Stokeslet,
        Spheroids,
        100_000,
        1e-3,
        [Some(250.0), Some(331.0), Some(48.0)],
    ),
    (
        Stokeslet,
        Spheroids,
        100_000,
        1e-6,
        [Some(61.9), Some(74.0), Some(19.0)],
    ),
    (
        Stokeslet,
        Spheroids,
        100_000,
        1e-9,
        [Some(33.2), Some(41.0), Some(9.8)],
    ),
    (
        Stokeslet,
        Spheroids,
        1_000_000,
        1e-3,
        [Some(244.0), Some(292.0), None],
    ),
    (
        Stokeslet,
        Spheroids,
        1_000_000,
        1e-6,
        [Some(51.8), Some(61.0), Some(20.0)],
    ),
    (
        Stokeslet,
        Spheroids,
        1_000_000,
        1e-9,
        [Some(29.3), Some(34.0), None],
    ),
    (Stresslet, Cube, 100_000, 1e-6, [Some(40.9), None, None]),
    (Stresslet, Cube, 1_000_000, 1e-6, [Some(31.2), None, None]),
    (
        Stresslet,
        Spheroids,
        1_000_000,
        1e-6,
        [Some(28.3), None, None],
    ),
    (
        Combined,
        Cube,
        100_000,
        1e-6,
        [None, Some(75.0), Some(16.0)],
    ),
    (Combined, Cube, 1_000_000, 1e-6, [None, None, None]),
    (Combined, Spheroids, 1_000_000, 1e-6, [None, None, None]),
];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Arguments { largest, threads } = Arguments::parse();
    println!(
        "| kernel | points | n | tolerance | error | plan (s) | memory (MB) | kpoints/s | direct | DMK | PVFMM | FMM3D | times the best |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for (kernel, distribution, n, tolerance, peers) in ROWS {
        if n > largest {
            continue;
        }
        let case = Case {
            kernel,
            output: Outputs::Velocity,
            distribution,
            n,
            tolerance,
            threads,
            method: Method::Fmm,
        };
        eprintln!("{kernel:?}, {distribution:?}, {n}, {tolerance:e}");
        print_row(&case, &case.measure()?, peers);
    }
    Ok(())
}

fn print_row(case: &Case, measured: &Measured, peers: [Option<f64>; 3]) {
    let thousands = |rate: f64| 1e-3 * rate;
    let speed = thousands(measured.points_per_second);
    let direct =
        thousands(measured.direct_pairs_per_second * case.threads as f64 / measured.n as f64);
    let best = peers.into_iter().flatten().reduce(f64::max);
    let peers = peers.map(|peer| peer.map_or(String::new(), |rate| format!("{rate:.0}")));
    println!(
        "| {:?} | {:?} | {} | {:.0e} | {:.1e} | {:.2} | {:.0} | **{speed:.0}** | {direct:.1} | {} | {} |",
        case.kernel,
        case.distribution,
        measured.n,
        measured.tolerance,
        measured.error,
        measured.plan_seconds,
        1e-6 * measured.peak_bytes as f64,
        peers.join(" | "),
        best.map_or(String::new(), |best| format!("{:.1}", speed / best)),
    );
}
