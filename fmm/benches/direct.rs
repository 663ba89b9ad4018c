//! Pairs per second of the direct sums, on one thread: `cargo bench -p stokes-fmm --bench direct`.

use divan::{Bencher, counter::ItemsCount};
use stokes_fmm::{Output, Strengths, Stresslets, direct};

const POINTS: usize = 8000;

fn main() {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()
        .expect("first to build the pool");
    divan::main();
}

fn vectors(seed: u64) -> Vec<[f64; 3]> {
    let mut random = fastrand::Rng::with_seed(seed);
    (0..POINTS).map(|_| [0; 3].map(|_| random.f64())).collect()
}

fn bench(bencher: Bencher, strengths: Strengths, output: Output, tolerance: Option<f64>) {
    let points = vectors(1);
    bencher.counter(ItemsCount::new(POINTS * POINTS)).bench(|| {
        direct::sum(&points, &strengths, &points, output, tolerance).expect("valid input")
    });
}

const OUTPUTS: [Output; 3] = [Output::Velocity, Output::Pressure, Output::Gradient];
const TOLERANCES: [Option<f64>; 4] = [None, Some(1e-9), Some(1e-6), Some(1e-3)];

#[divan::bench(args = TOLERANCES)]
fn stokeslets_to_velocity(bencher: Bencher, tolerance: Option<f64>) {
    let forces = vectors(2);
    let strengths = Strengths {
        stokeslets: Some(&forces),
        ..Strengths::default()
    };
    bench(bencher, strengths, Output::Velocity, tolerance);
}

#[divan::bench(args = TOLERANCES)]
fn stresslets_to_velocity(bencher: Bencher, tolerance: Option<f64>) {
    let (densities, normals) = (vectors(2), vectors(3));
    let stresslets = Some(Stresslets {
        densities: &densities,
        normals: &normals,
    });
    let strengths = Strengths {
        stresslets,
        ..Strengths::default()
    };
    bench(bencher, strengths, Output::Velocity, tolerance);
}

#[divan::bench(args = OUTPUTS)]
fn stokeslets(bencher: Bencher, output: Output) {
    let forces = vectors(2);
    let strengths = Strengths {
        stokeslets: Some(&forces),
        ..Strengths::default()
    };
    bench(bencher, strengths, output, None);
}

#[divan::bench(args = OUTPUTS)]
fn stresslets(bencher: Bencher, output: Output) {
    let (densities, normals) = (vectors(2), vectors(3));
    let stresslets = Some(Stresslets {
        densities: &densities,
        normals: &normals,
    });
    let strengths = Strengths {
        stresslets,
        ..Strengths::default()
    };
    bench(bencher, strengths, output, None);
}

#[divan::bench(args = OUTPUTS)]
fn all(bencher: Bencher, output: Output) {
    let (forces, densities, normals) = (vectors(2), vectors(3), vectors(4));
    let fluxes: Vec<f64> = vectors(5).iter().map(|x| x[0]).collect();
    let strengths = Strengths {
        stokeslets: Some(&forces),
        stresslets: Some(Stresslets {
            densities: &densities,
            normals: &normals,
        }),
        rotlets: Some(&forces),
        fluxes: Some(&fluxes),
    };
    bench(bencher, strengths, output, None);
}
