//! Speed of the parts of a modal solver: `cargo bench --bench modal`.
//!
//! Modules mirror those of the library; items per second are pairs times modes, or pairs of points.

use axistokes::body::dirichlet::{DirichletSolver, Formulation};
use axistokes::body::discretization::Discretization;
use axistokes::geometry::curve::{Panels, Spheroid};
use axistokes::progress::Silent;
use std::sync::Arc;

fn main() {
    divan::main();
    if std::env::args().any(|argument| argument == "--bench") {
        print_ratio();
    }
}

mod kernel {
    use axistokes::body::kernel::bench::{DirectSum, Method, ModalPairs};
    use divan::counter::ItemsCount;
    use divan::{Bencher, black_box};
    use nalgebra::Point3;

    const PAIRS: usize = 256;
    const MODES: [usize; 3] = [20, 60, 150];

    fn evaluate(bencher: Bencher, n_max: usize, distance: f64, method: Method) {
        let mut pairs = ModalPairs::new(n_max, PAIRS, distance, method);
        bencher
            .counter(ItemsCount::new(PAIRS * (n_max + 1)))
            .bench_local(|| black_box(pairs.evaluate().len()));
    }

    /// Pairs at a tenth of their radius: always the recurrence.
    #[divan::bench(args = MODES)]
    fn near_by_recurrence(bencher: Bencher, n_max: usize) {
        evaluate(bencher, n_max, 0.1, Method::Recurrence);
    }

    /// Pairs at one and a half times their radius: the FFT is what the library takes.
    #[divan::bench(args = MODES)]
    fn far_by_fft(bencher: Bencher, n_max: usize) {
        evaluate(bencher, n_max, 1.5, Method::Fourier);
    }

    /// The same pairs by the recurrence.
    #[divan::bench(args = MODES)]
    fn far_by_recurrence(bencher: Bencher, n_max: usize) {
        evaluate(bencher, n_max, 1.5, Method::Recurrence);
    }

    /// Velocity and pressure of both layers, on all threads.
    #[divan::bench]
    fn direct_sum(bencher: Bencher) {
        let (points, targets) = (20_000, 200);
        let sum = DirectSum::new(points);
        let targets: Vec<_> = (0..targets)
            .map(|k| Point3::new(0.3, f64::from(k), 2.0))
            .collect();
        bencher
            .counter(ItemsCount::new(points * targets.len()))
            .bench(|| sum.flow(black_box(&targets)));
    }
}

mod body {
    use divan::Bencher;

    /// Assembly and factors together, 8 panels of 16 nodes, 60 modes.
    #[divan::bench(sample_count = 10)]
    fn dirichlet_solver(bencher: Bencher) {
        bencher.bench(super::solver);
    }
}

/// The thesis's spheroid with 8 panels of 16 nodes, 60 modes.
fn solver() -> DirichletSolver {
    let curve = Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid"));
    let panels = Panels::uniform(&*curve, 8).expect("panels");
    let nodes = Discretization::new(curve, panels, 16).expect("nodes");
    DirichletSolver::new(nodes, Formulation::CombinedField, 60, &Silent).expect("a solver")
}

/// Assembly against LU, medians of eleven runs.
fn print_ratio() {
    let seconds: Vec<_> = (0..11).map(|_| solver().seconds()).collect();
    let median = |mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    };
    let assemble = median(seconds.iter().map(|s| s.assemble).collect());
    let factor = median(seconds.iter().map(|s| s.factor).collect());
    println!(
        "8 panels x 16 nodes, 60 modes, {} threads: assemble {:.1} ms, LU {:.1} ms, ratio {:.2}",
        rayon::current_num_threads(),
        1e3 * assemble,
        1e3 * factor,
        assemble / factor
    );
}
