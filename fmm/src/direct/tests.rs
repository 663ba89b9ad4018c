use std::f64::consts::PI;
use std::marker::PhantomData;

use f64_lanes::{Isa, WithRoots, dispatch_roots};
use proptest::prelude::*;

use super::chunks::ChunkSum;
use super::*;
use crate::flow::Stresslets;
use crate::kernel::{Pair, Stokes};

/// Points and strengths of every kind.
#[derive(Clone)]
struct Case {
    sources: Vec<[f64; 3]>,
    targets: Vec<[f64; 3]>,
    /// Forces, densities, normals, torques.
    vectors: [Vec<[f64; 3]>; 4],
    fluxes: Vec<f64>,
}

fn vectors(random: &mut fastrand::Rng, count: usize) -> Vec<[f64; 3]> {
    let number = |_| 2.0 * random.f64() - 1.0;
    let flat: Vec<f64> = (0..3 * count).map(number).collect();
    flat.as_chunks().0.to_vec()
}

impl Case {
    fn random(sources: usize, targets: usize) -> Self {
        let random = &mut fastrand::Rng::with_seed(7);
        Self {
            sources: vectors(random, sources),
            targets: vectors(random, targets),
            vectors: [0; 4].map(|_| vectors(random, sources)),
            fluxes: (0..sources).map(|_| random.f64() - 0.5).collect(),
        }
    }

    /// Of the kinds: Stokeslets, stresslets, rotlets, sources.
    fn strengths(&self, kinds: [bool; 4]) -> Strengths<'_> {
        let [forces, densities, normals, torques] = &self.vectors;
        Strengths {
            stokeslets: kinds[0].then_some(forces),
            stresslets: kinds[1].then_some(Stresslets { densities, normals }),
            rotlets: kinds[2].then_some(torques),
            fluxes: kinds[3].then_some(&self.fluxes),
        }
    }

    fn flow(&self, kinds: [bool; 4], output: Output, tolerance: Option<f64>) -> Flow {
        let strengths = self.strengths(kinds);
        sum(&self.sources, &strengths, &self.targets, output, tolerance).unwrap()
    }
}

const KINDS: [[bool; 4]; 9] = [
    [false; 4],
    [true, false, false, false],
    [false, true, false, false],
    [true, true, false, false],
    [false, false, true, false],
    [false, false, false, true],
    [true, false, true, false],
    [false, true, false, true],
    [true; 4],
];

fn inner(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Velocity and pressure, as the textbooks have them.
fn textbook(case: &Case, kinds: [bool; 4], target: [f64; 3]) -> ([f64; 3], f64) {
    let [forces, densities, normals, torques] = &case.vectors;
    let (mut u, mut p) = ([0.0; 3], 0.0);
    for (j, source) in case.sources.iter().enumerate() {
        let x = [0, 1, 2].map(|k| target[k] - source[k]);
        let r = inner(x, x).sqrt();
        if r == 0.0 {
            continue;
        }
        let (f, q, n, t, s) = (
            forces[j],
            densities[j],
            normals[j],
            torques[j],
            case.fluxes[j],
        );
        let cross = [
            t[1] * x[2] - t[2] * x[1],
            t[2] * x[0] - t[0] * x[2],
            t[0] * x[1] - t[1] * x[0],
        ];
        for i in 0..3 {
            let parts = [
                (f[i] / r + x[i] * inner(x, f) / r.powi(3)) / (8.0 * PI),
                -3.0 * x[i] * inner(x, q) * inner(x, n) / r.powi(5) / (4.0 * PI),
                cross[i] / r.powi(3) / (8.0 * PI),
                s * x[i] / r.powi(3) / (4.0 * PI),
            ];
            u[i] += (0..4).filter(|&k| kinds[k]).map(|k| parts[k]).sum::<f64>();
        }
        if kinds[0] {
            p += inner(x, f) / r.powi(3) / (4.0 * PI);
        }
        if kinds[1] {
            let both = 3.0 * inner(x, q) * inner(x, n) / r.powi(5);
            p += (inner(q, n) / r.powi(3) - both) / (2.0 * PI);
        }
    }
    (u, p)
}

#[test]
fn textbook_formulas() {
    for count in [1, 7, 8, 300] {
        let case = Case::random(count, count + 5);
        for kinds in KINDS {
            for output in [Output::Velocity, Output::Pressure, Output::Gradient] {
                let flow = case.flow(kinds, output, None);
                assert_eq!(flow.velocity.len(), count + 5);
                for (i, &target) in case.targets.iter().enumerate() {
                    let (u, p) = textbook(&case, kinds, target);
                    // Terms of a sum cancel. So errors are relative to the terms, which are of
                    // order one at most near a source.
                    let bound = 1e-13 * (count as f64) * (1.0 + inner(u, u).sqrt() + p.abs());
                    for k in 0..3 {
                        assert!(
                            (flow.velocity[i][k] - u[k]).abs() < bound,
                            "{kinds:?} {output:?}"
                        );
                    }
                    if output != Output::Velocity {
                        assert!((flow.pressure[i] - p).abs() < bound, "{kinds:?} {output:?}");
                    }
                }
            }
        }
    }
}

/// Central differences of fourth order of the velocity, or of the pressure and the gradient, along
/// an axis.
fn difference<T>(
    value: impl Fn([f64; 3]) -> T,
    at: [f64; 3],
    axis: usize,
    of: impl Fn(&T) -> f64,
) -> f64 {
    let h = 1e-3;
    let shifted = |steps: f64| {
        let mut x = at;
        x[axis] += steps * h;
        of(&value(x))
    };
    (8.0 * (shifted(1.0) - shifted(-1.0)) - (shifted(2.0) - shifted(-2.0))) / (12.0 * h)
}

fn far_case() -> Case {
    let mut case = Case::random(20, 8);
    case.targets.iter_mut().for_each(|x| x[0] += 3.0);
    case
}

#[test]
fn gradient_is_that_of_the_velocity() {
    let case = far_case();
    for kinds in KINDS {
        let flow = case.flow(kinds, Output::Gradient, None);
        let strengths = case.strengths(kinds);
        let at = |x| sum(&case.sources, &strengths, &[x], Output::Velocity, None).unwrap();
        for (&target, gradient) in case.targets.iter().zip(&flow.gradient) {
            for i in 0..3 {
                for j in 0..3 {
                    let expected = difference(at, target, j, |flow| flow.velocity[0][i]);
                    assert!(
                        (gradient[i][j] - expected).abs() < 1e-10,
                        "{kinds:?} {i} {j}"
                    );
                }
            }
        }
    }
}

#[test]
fn incompressible_and_free_of_body_force() {
    let case = far_case();
    for kinds in KINDS {
        let strengths = case.strengths(kinds);
        let at = |x| sum(&case.sources, &strengths, &[x], Output::Gradient, None).unwrap();
        for &target in &case.targets {
            let gradient = at(target).gradient[0];
            let divergence: f64 = (0..3).map(|i| gradient[i][i]).sum();
            assert!(divergence.abs() < 1e-14);
            for i in 0..3 {
                let force: f64 = (0..3)
                    .map(|j| difference(at, target, j, |flow| flow.stress()[0][i][j]))
                    .sum();
                assert!(force.abs() < 1e-9, "{kinds:?}: {force:e}");
            }
        }
    }
}

fn close(a: &Flow, b: &Flow, bound: f64) {
    let pairs = a.velocity.iter().flatten().zip(b.velocity.iter().flatten());
    for (a, b) in pairs.chain(a.pressure.iter().zip(&b.pressure)) {
        assert!((a - b).abs() <= bound, "{a} {b}");
    }
    let gradients = a.gradient.as_flattened().iter().flatten();
    for (a, b) in gradients.zip(b.gradient.as_flattened().iter().flatten()) {
        assert!((a - b).abs() <= bound, "{a} {b}");
    }
}

proptest! {
    #[test]
    fn moves_with_its_frame(shift in prop::array::uniform3(-8.0f64..8.0), angle in 0.0f64..6.3) {
        let case = far_case();
        let (sin, cos) = angle.sin_cos();
        let turn = |x: &[f64; 3]| [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2]];
        let moved = |x: &[f64; 3]| {
            let x = turn(x);
            [x[0] + shift[0], x[1] + shift[1], x[2] + shift[2]]
        };
        let turned = Case {
            sources: case.sources.iter().map(moved).collect(),
            targets: case.targets.iter().map(moved).collect(),
            vectors: case.vectors.each_ref().map(|vectors| vectors.iter().map(turn).collect()),
            fluxes: case.fluxes.clone(),
        };
        let (flow, other) = (
            case.flow([true; 4], Output::Pressure, None),
            turned.flow([true; 4], Output::Pressure, None),
        );
        let expected = Flow {
            velocity: flow.velocity.iter().map(turn).collect(),
            ..flow
        };
        close(&other, &expected, 1e-13);
    }

    #[test]
    fn any_power_of_two_is_exact(exponent in -300i32..300) {
        let case = Case::random(30, 11);
        let length = f64::from(exponent).exp2();
        let bigger = |x: &[f64; 3]| x.map(|x| x * length);
        let other = Case {
            sources: case.sources.iter().map(bigger).collect(),
            targets: case.targets.iter().map(bigger).collect(),
            ..case.clone()
        };
        for (kinds, order) in [([true, false, false, false], 0), ([false, true, true, true], 1)] {
            let flow = case.flow(kinds, Output::Gradient, None);
            let other = other.flow(kinds, Output::Gradient, None);
            let back = |x: f64, order: i32| (0..order).fold(x, |x, _| x * length);
            let back = Flow {
                velocity: other.velocity.iter().map(|u| u.map(|u| back(u, order + 1))).collect(),
                pressure: other.pressure.iter().map(|&p| back(p, order + 2)).collect(),
                gradient: other.gradient.iter()
                    .map(|rows| rows.map(|row| row.map(|g| back(g, order + 2)))).collect(),
            };
            // The largest coordinate need not be 1: strengths keep their mantissas all the same.
            prop_assert_eq!(flow, back);
        }
    }
}

#[test]
fn own_points_and_coincident_points_are_left_out() {
    let mut case = Case::random(37, 0);
    case.sources[5] = case.sources[20];
    case.targets = case.sources.clone();
    let flow = case.flow([true; 4], Output::Gradient, None);
    for (i, &target) in case.targets.iter().enumerate() {
        let (u, _) = textbook(&case, [true; 4], target);
        for k in 0..3 {
            assert!((flow.velocity[i][k] - u[k]).abs() < 1e-11 * (1.0 + u[k].abs()));
        }
        assert!(
            flow.gradient[i]
                .as_flattened()
                .iter()
                .all(|g| g.is_finite())
        );
    }
}

#[test]
fn tiny_distances_near_large_ones() {
    let sources = [[1e100, 0.0, 0.0], [0.0, 0.0, 0.0]];
    let forces = [[1.0, 0.0, 0.0]; 2];
    let strengths = Strengths {
        stokeslets: Some(&forces),
        ..Strengths::default()
    };
    let at = [[1e70, 0.0, 0.0], [1e-100, 0.0, 0.0], [0.0; 3]];
    let flow = sum(&sources, &strengths, &at, Output::Gradient, None).unwrap();
    assert!((flow.velocity[0][0] * 4.0 * PI * 1e70 - 1.0).abs() < 1e-14);
    let numbers = flow
        .velocity
        .iter()
        .flatten()
        .chain(flow.gradient.as_flattened().iter().flatten());
    assert!(numbers.chain(&flow.pressure).all(|x| x.is_finite()));
    let flow = sum(
        &[[0.0; 3]],
        &Strengths {
            stokeslets: Some(&forces[..1]),
            ..strengths
        },
        &[[1e-100, 0.0, 0.0]],
        Output::Gradient,
        None,
    )
    .unwrap();
    assert!((flow.velocity[0][0] * 4.0 * PI * 1e-100 - 1.0).abs() < 1e-14);
    assert!((flow.pressure[0] * 4.0 * PI * 1e-200 - 1.0).abs() < 1e-14);
}

#[test]
fn tolerances_are_kept() {
    let case = far_case();
    let full = case.flow([true; 4], Output::Gradient, None);
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
        let flow = case.flow([true; 4], Output::Gradient, Some(tolerance));
        close(&full, &flow, tolerance);
    }
}

#[test]
fn charges() {
    let case = far_case();
    let at = |x| laplace(&case.sources, &case.fluxes, &[x], true, None).unwrap();
    for &target in &case.targets {
        let (potential, gradient) = at(target);
        let terms = case.sources.iter().zip(&case.fluxes).map(|(y, q)| {
            let x = [0, 1, 2].map(|k| target[k] - y[k]);
            q / (4.0 * PI * inner(x, x).sqrt())
        });
        assert!((potential[0] - terms.sum::<f64>()).abs() < 1e-15);
        for axis in 0..3 {
            let expected = difference(at, target, axis, |(potential, _)| potential[0]);
            assert!((gradient[0][axis] - expected).abs() < 1e-11);
        }
    }
    let alone = laplace(&case.sources, &case.fluxes, &case.targets, false, None).unwrap();
    assert!(alone.1.is_empty() && alone.0[0] == at(case.targets[0]).0[0]);
}

#[test]
fn nothing_gives_nothing() {
    let flow = Case::random(0, 3).flow([true; 4], Output::Gradient, None);
    assert_eq!(flow.velocity, [[0.0; 3]; 3]);
    assert_eq!(
        Case::random(3, 0).flow([true; 4], Output::Gradient, None),
        Flow::default()
    );
}

#[test]
fn wrong_input_is_refused() {
    let case = Case::random(3, 2);
    let strengths = case.strengths([true; 4]);
    let go = |sources: &[[f64; 3]], targets: &[[f64; 3]], strengths: &Strengths, tolerance| {
        sum(sources, strengths, targets, Output::Velocity, tolerance).unwrap_err()
    };
    let (sources, targets) = (&case.sources, &case.targets);
    assert!(matches!(
        go(&sources[..2], targets, &strengths, None),
        FmmError::Length {
            found: 3,
            expected: 2,
            ..
        }
    ));
    assert!(matches!(
        go(sources, &[[0.0, f64::NAN, 0.0]], &strengths, None),
        FmmError::NotFinite {
            what: "target position",
            index: 0,
            ..
        }
    ));
    assert_eq!(
        go(sources, &[[0.0, 2e100, 0.0]], &strengths, None),
        FmmError::TooFar(2e100)
    );
    let fluxes = [0.0, f64::INFINITY, 0.0];
    let bad = Strengths {
        fluxes: Some(&fluxes),
        ..strengths
    };
    assert!(matches!(
        go(sources, targets, &bad, None),
        FmmError::NotFinite { index: 1, .. }
    ));
    for tolerance in [0.0, 1.0, f64::NAN] {
        assert!(matches!(
            go(sources, targets, &strengths, Some(tolerance)),
            FmmError::Tolerance(_)
        ));
    }
}

#[test]
fn threads_do_not_matter() {
    let case = Case::random(700, 900);
    let go = || case.flow([true; 4], Output::Gradient, None);
    let pool = |threads| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
    };
    assert_eq!(pool(1).install(go), pool(3).install(go));
}

/// One chunk of targets on an instruction set that need not be this machine's widest.
struct On<'a, P, S>(ChunkSum<'a, P>, S);

impl<P: Pair, S: Isa> pulp::WithSimd for On<'_, P, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: pulp::Simd>(self, _: T) {
        self.0.with_roots::<S, 3>(self.1);
    }
}

fn chunk<'a, P>(
    records: &'a [f64],
    targets: &'a [[f64; 3]],
    numbers: &'a mut [f64],
) -> ChunkSum<'a, P> {
    ChunkSum {
        records,
        targets,
        numbers,
        pair: PhantomData,
    }
}

#[test]
fn instruction_sets_agree() {
    type All = Stokes<13, 13>;
    let random = &mut fastrand::Rng::with_seed(1);
    let records = vectors(random, 100 * 16 / 3 + 1).as_flattened()[..1600].to_vec();
    let targets = vectors(random, 77);
    let mut widest = vec![0.0; 13 * CHUNK];
    dispatch_roots(
        Precision::Full,
        chunk::<All>(&records, &targets, &mut widest),
    );
    let mut scalar = vec![0.0; 13 * CHUNK];
    chunk::<All>(&records, &targets, &mut scalar).with_roots::<_, 3>(pulp::Scalar::new());
    let compare = |other: &[f64]| {
        for k in 0..13 {
            for i in k * CHUNK..k * CHUNK + 77 {
                assert!((widest[i] - other[i]).abs() < 1e-11 * (1.0 + widest[i].abs()));
            }
        }
    };
    compare(&scalar);
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        let mut numbers = vec![0.0; 13 * CHUNK];
        pulp::Simd::vectorize(
            simd,
            On(chunk::<All>(&records, &targets, &mut numbers), simd),
        );
        compare(&numbers);
    }
}
