use std::convert::Infallible;

use faer::linalg::solvers::Solve;
use faer::{Mat, Par};

use super::*;

/// A matrix whose products are wrong by exactly what is allowed, in a direction of chance.
struct Dense {
    matrix: Mat<f64>,
    inexact: bool,
    tolerances: Vec<f64>,
    chance: fastrand::Rng,
}

impl Dense {
    fn new(n: usize, entry: impl Fn(usize, usize) -> f64) -> Self {
        Self {
            matrix: Mat::from_fn(n, n, entry),
            inexact: false,
            tolerances: Vec::new(),
            chance: fastrand::Rng::with_seed(7),
        }
    }

    /// The identity and a nonsymmetric rest that is not small, with some eigenvalues far out.
    fn second_kind(n: usize, seed: u64) -> Self {
        let mut chance = fastrand::Rng::with_seed(seed);
        let rest = Mat::from_fn(n, n, |_, _| 1.2 * (chance.f64() - 0.5) / (n as f64).sqrt());
        Self::new(n, |i, j| {
            rest[(i, j)]
                + if i == j {
                    1.0 + 4.0 / (1.0 + i as f64)
                } else {
                    0.0
                }
        })
    }

    fn inexact(mut self) -> Self {
        self.inexact = true;
        self
    }

    fn exact_solution(&self, b: &[f64]) -> Vec<f64> {
        let b = Mat::from_fn(b.len(), 1, |i, _| b[i]);
        let x = self.matrix.partial_piv_lu().solve(&b);
        (0..x.nrows()).map(|i| x[(i, 0)]).collect()
    }

    fn times(&self, x: &[f64], y: &mut [f64]) {
        for (i, y) in y.iter_mut().enumerate() {
            *y = x
                .iter()
                .enumerate()
                .map(|(j, x)| self.matrix[(i, j)] * x)
                .sum();
        }
    }

    /// Norm of the residual over that of `b`.
    fn residual(&self, x: &[f64], b: &[f64]) -> f64 {
        let mut y = vec![0.0; b.len()];
        self.times(x, &mut y);
        norm(&b.iter().zip(&y).map(|(b, y)| b - y).collect::<Vec<_>>()) / norm(b)
    }
}

impl Operator for Dense {
    type Error = Infallible;

    fn apply(&mut self, x: &[f64], y: &mut [f64], tolerance: f64) -> Result<(), Infallible> {
        self.tolerances.push(tolerance);
        self.times(x, y);
        if self.inexact {
            let error: Vec<f64> = x.iter().map(|_| self.chance.f64() - 0.5).collect();
            let size = tolerance * norm(x) / norm(&error);
            y.iter_mut().zip(&error).for_each(|(y, e)| *y += size * e);
        }
        Ok(())
    }
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn some_vector(n: usize, seed: u64) -> Vec<f64> {
    let mut chance = fastrand::Rng::with_seed(seed);
    (0..n).map(|_| chance.f64() - 0.5).collect()
}

fn run(
    operator: &mut Dense,
    b: &[f64],
    start: Option<&[f64]>,
    method: Method,
    control: &Control,
) -> Outcome {
    solve(operator, b, start, method, control, &mut |_, _| Ok(())).unwrap()
}

const FULL: Method = Method::Gmres { restart: 1000 };
const SHORT: Method = Method::Gmres { restart: 7 };
const METHODS: [Method; 3] = [FULL, SHORT, Method::BiCgStab];

#[test]
fn solutions_are_those_of_a_direct_solver() {
    faer::set_global_parallelism(Par::Seq);
    for seed in 0..5 {
        let mut operator = Dense::second_kind(80, seed);
        let b = some_vector(80, seed + 100);
        let exact = operator.exact_solution(&b);
        for method in METHODS {
            let outcome = run(&mut operator, &b, None, method, &Control::new(1e-12));
            assert_eq!(outcome.stop, Stop::Converged, "{method:?}");
            let error: Vec<f64> = exact
                .iter()
                .zip(&outcome.solution)
                .map(|(x, y)| x - y)
                .collect();
            assert!(
                norm(&error) < 1e-11 * norm(&exact),
                "{method:?} {}",
                norm(&error)
            );
            let residual = operator.residual(&outcome.solution, &b);
            assert!(residual <= 1.1e-12, "{method:?} {residual}");
            assert!((residual - outcome.residual).abs() < 1e-14);
            assert_eq!(outcome.history.len(), outcome.iterations + 1);
            assert_eq!(outcome.history[0], 1.0);
            assert_eq!(outcome.products, operator.tolerances.len());
            operator.tolerances.clear();
        }
    }
}

/// Cut short: the residual is then far from rounding.
#[test]
fn the_residual_that_is_left_is_that_of_the_solution() {
    for method in METHODS {
        let mut operator = Dense::second_kind(60, 1);
        let b: Vec<f64> = some_vector(60, 2).iter().map(|x| 1e-30 * x).collect();
        let start = some_vector(60, 3)
            .iter()
            .map(|x| 1e-30 * x)
            .collect::<Vec<_>>();
        for iterations in [0, 3, 9] {
            let control = Control {
                max_iterations: iterations,
                ..Control::new(1e-12)
            };
            let outcome = run(&mut operator, &b, Some(&start), method, &control);
            assert_eq!(outcome.stop, Stop::MaxIterations);
            let mut left = vec![0.0; b.len()];
            operator.times(&outcome.solution, &mut left);
            left.iter_mut().zip(&b).for_each(|(y, b)| *y = b - *y);
            let apart = left
                .iter()
                .zip(&outcome.residual_vector)
                .map(|(a, b)| a - b);
            assert!(norm(&apart.collect::<Vec<_>>()) < 1e-13 * norm(&b));
            assert!(norm(&left) > 1e-8 * norm(&b));
        }
    }
}

#[test]
fn gmres_has_the_least_residual_of_the_krylov_space() {
    let mut operator = Dense::second_kind(40, 3);
    let b = some_vector(40, 4);
    let outcome = run(&mut operator, &b, None, FULL, &Control::new(1e-10));
    let mut krylov = vec![b.clone()];
    for steps in 1..6 {
        let mut next = vec![0.0; 40];
        operator.times(&krylov[steps - 1], &mut next);
        krylov.push(next);
        // Residual of b on A b .. A^steps b.
        let columns = Mat::from_fn(40, steps, |i, j| krylov[j + 1][i]);
        let rhs = Mat::from_fn(40, 1, |i, _| b[i]);
        let q = columns.qr().compute_thin_Q();
        let rest = &rhs - &q * (q.transpose() * &rhs);
        let least = rest.norm_l2() / norm(&b);
        assert!((outcome.history[steps] - least).abs() < 1e-12, "{steps}");
    }
}

#[test]
fn exact_in_as_many_steps_as_there_are_eigenvalues() {
    let mut operator = Dense::new(60, |i, j| if i == j { (1 + i % 3) as f64 } else { 0.0 });
    let b = some_vector(60, 1);
    let outcome = run(&mut operator, &b, None, FULL, &Control::new(1e-13));
    assert_eq!((outcome.stop, outcome.iterations), (Stop::Converged, 3));
    // One eigenvalue, and nothing left after the first step.
    let mut operator = Dense::new(5, |i, j| if i == j { 2.0 } else { 0.0 });
    for method in METHODS {
        let outcome = run(&mut operator, &b[..5], None, method, &Control::new(1e-13));
        assert_eq!((outcome.stop, outcome.iterations), (Stop::Converged, 1));
    }
}

#[test]
fn inexact_products_meet_the_tolerance_and_get_looser() {
    for method in METHODS {
        for tolerance in [1e-4, 1e-8, 1e-11] {
            for seed in 0..5 {
                let mut operator = Dense::second_kind(80, seed).inexact();
                let b = some_vector(80, seed + 50);
                let control = Control {
                    loosest: 0.1,
                    ..Control::new(tolerance)
                };
                let outcome = run(&mut operator, &b, None, method, &control);
                let residual = operator.residual(&outcome.solution, &b);
                assert_eq!(outcome.stop, Stop::Converged, "{method:?} {tolerance}");
                assert!(
                    residual <= 1.1 * tolerance,
                    "{method:?} {tolerance} {residual}"
                );
                let asked = &operator.tolerances;
                assert!((asked[0] / (0.1 * tolerance) - 1.0).abs() < 1e-14);
                let loosest = asked.iter().copied().fold(0.0, f64::max);
                assert!(loosest > 1e-3 && loosest <= 0.1, "{loosest}");
                let mut exact = Dense::second_kind(80, seed);
                let reference = run(&mut exact, &b, None, method, &Control::new(tolerance));
                assert!(exact.tolerances.iter().all(|&t| t <= 0.1 * tolerance));
                assert!(
                    10 * outcome.iterations <= 16 * reference.iterations + 20,
                    "{method:?} {tolerance} {} {}",
                    outcome.iterations,
                    reference.iterations
                );
            }
        }
    }
}

/// The bound of the theory has the least singular value, which is not known: here it is small.
#[test]
fn inexact_products_that_are_too_loose_are_found_out() {
    let singular = |i: usize| if i < 4 { 1e-4 } else { 1.0 };
    for method in METHODS {
        let mut operator = Dense::new(30, |i, j| if i == j { singular(i) } else { 0.0 }).inexact();
        let b = some_vector(30, 9);
        let control = Control {
            loosest: 0.1,
            ..Control::new(1e-9)
        };
        let outcome = run(&mut operator, &b, None, method, &control);
        let residual = operator.residual(&outcome.solution, &b);
        assert_eq!(outcome.stop, Stop::Converged, "{method:?}");
        assert!(residual <= 1.1e-9, "{method:?} {residual}");
        // The believed residual was below the tolerance before the end.
        let early = outcome.history[..outcome.iterations]
            .iter()
            .any(|&r| r <= 1e-9);
        assert!(early || method != FULL, "{method:?}");
    }
}

#[test]
fn a_singular_system_stagnates_and_says_so() {
    // No right-hand side with a last entry is in the range.
    let mut operator = Dense::new(20, |i, j| {
        if i == j && i < 19 {
            1.0 + i as f64
        } else {
            0.0
        }
    });
    let b = vec![1.0; 20];
    let least = (1.0f64 / 20.0).sqrt();
    for method in [FULL, Method::Gmres { restart: 10 }] {
        let outcome = run(&mut operator, &b, None, method, &Control::new(1e-8));
        assert_eq!(outcome.stop, Stop::Stagnated, "{method:?}");
        assert!(
            (outcome.residual - least).abs() < 1e-3,
            "{}",
            outcome.residual
        );
    }
    let outcome = run(
        &mut operator,
        &b,
        None,
        Method::BiCgStab,
        &Control::new(1e-8),
    );
    assert!(matches!(outcome.stop, Stop::Stagnated | Stop::Breakdown));
    assert!(outcome.residual >= least - 1e-12 && outcome.residual <= 1.0);
    let true_residual = operator.residual(&outcome.solution, &b);
    assert!((true_residual - outcome.residual).abs() < 1e-12);

    // A rotation of the plane: each residual is at right angles to its product.
    let mut rotation = Dense::new(2, |i, j| j as f64 - i as f64);
    let once = Method::Gmres { restart: 1 };
    let outcome = run(&mut rotation, &[1.0, 0.0], None, once, &Control::new(1e-8));
    assert_eq!((outcome.stop, outcome.residual), (Stop::Stagnated, 1.0));
    let outcome = run(
        &mut rotation,
        &[1.0, 0.0],
        None,
        Method::BiCgStab,
        &Control::new(1e-8),
    );
    assert_eq!((outcome.stop, outcome.residual), (Stop::Breakdown, 1.0));
    let outcome = run(&mut rotation, &[1.0, 0.0], None, FULL, &Control::new(1e-8));
    assert_eq!(outcome.stop, Stop::Converged);

    // A tolerance below rounding.
    let mut operator = Dense::second_kind(80, 1);
    let b = some_vector(80, 2);
    for method in METHODS {
        let outcome = run(&mut operator, &b, None, method, &Control::new(1e-18));
        assert_eq!(outcome.stop, Stop::Stagnated, "{method:?}");
        assert!(outcome.residual < 1e-14, "{method:?} {}", outcome.residual);
    }
}

#[test]
fn few_iterations_are_told_as_such() {
    let mut operator = Dense::second_kind(80, 1);
    let b = some_vector(80, 2);
    for method in METHODS {
        let control = Control {
            max_iterations: 3,
            ..Control::new(1e-12)
        };
        let outcome = run(&mut operator, &b, None, method, &control);
        assert_eq!((outcome.stop, outcome.iterations), (Stop::MaxIterations, 3));
        assert!((outcome.residual - operator.residual(&outcome.solution, &b)).abs() < 1e-14);
        assert!(outcome.residual < 0.5);
    }
}

#[test]
fn a_good_start_saves_iterations_and_does_not_move_the_goal() {
    let mut operator = Dense::second_kind(80, 1);
    let b = some_vector(80, 2);
    let exact = operator.exact_solution(&b);
    for method in METHODS {
        let control = Control::new(1e-10);
        let cold = run(&mut operator, &b, None, method, &control);
        let near: Vec<f64> = exact
            .iter()
            .zip(&some_vector(80, 5))
            .map(|(x, e)| x + 1e-6 * e)
            .collect();
        let warm = run(&mut operator, &b, Some(&near), method, &control);
        assert_eq!(warm.stop, Stop::Converged);
        assert!(
            warm.iterations * 3 < cold.iterations * 2,
            "{} {}",
            warm.iterations,
            cold.iterations
        );
        assert!(operator.residual(&warm.solution, &b) <= 1.1e-10);
        assert!((warm.history[0] - operator.residual(&near, &b)).abs() < 1e-14);
        let there = run(&mut operator, &b, Some(&cold.solution), method, &control);
        assert_eq!(
            (there.stop, there.iterations, there.products),
            (Stop::Converged, 0, 1)
        );
        assert_eq!(there.solution, cold.solution);
        let far = vec![1e6; 80];
        let from_far = run(&mut operator, &b, Some(&far), method, &control);
        assert_eq!(from_far.stop, Stop::Converged);
        assert!(operator.residual(&from_far.solution, &b) <= 1.1e-10);
    }
}

/// A tridiagonal operator on vectors of several blocks.
struct Chain;

impl Operator for Chain {
    type Error = Infallible;

    fn apply(&mut self, x: &[f64], y: &mut [f64], _: f64) -> Result<(), Infallible> {
        for i in 0..x.len() {
            let (left, right) = (
                if i > 0 { x[i - 1] } else { 0.0 },
                x.get(i + 1).unwrap_or(&0.0),
            );
            y[i] = 2.0 * x[i] - 0.8 * left + 0.3 * right;
        }
        Ok(())
    }
}

#[test]
fn the_same_bits_on_any_number_of_threads() {
    let b = some_vector(100_003, 3);
    for method in [SHORT, Method::BiCgStab] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| {
                solve(
                    &mut Chain,
                    &b,
                    None,
                    method,
                    &Control::new(1e-11),
                    &mut |_, _| Ok(()),
                )
                .unwrap()
            })
        };
        let one = on(1);
        assert_eq!(one.stop, Stop::Converged);
        let mut y = vec![0.0; b.len()];
        Chain.apply(&one.solution, &mut y, 0.0).unwrap();
        let rest: Vec<f64> = b.iter().zip(&y).map(|(b, y)| b - y).collect();
        assert!(norm(&rest) <= 1.1e-11 * norm(&b));
        assert_eq!(one, on(2));
        assert_eq!(one, on(3));
    }
}

#[test]
fn numbers_of_any_size() {
    let mut operator = Dense::second_kind(30, 1);
    let b = some_vector(30, 2);
    for method in METHODS {
        let unit = run(&mut operator, &b, None, method, &Control::new(1e-10));
        for power in [-800, 800] {
            let size = f64::from(power).exp2();
            let scaled: Vec<f64> = b.iter().map(|x| x * size).collect();
            let outcome = run(&mut operator, &scaled, None, method, &Control::new(1e-10));
            assert_eq!(outcome.history, unit.history);
            assert!(
                outcome
                    .solution
                    .iter()
                    .zip(&unit.solution)
                    .all(|(x, y)| x / size == *y)
            );
        }
    }
}

#[test]
fn nothing_to_solve() {
    let mut operator = Dense::second_kind(30, 1);
    for method in METHODS {
        let outcome = run(
            &mut operator,
            &[0.0; 30],
            Some(&[1.0; 30]),
            method,
            &Control::new(1e-10),
        );
        assert_eq!((outcome.stop, outcome.products), (Stop::Converged, 0));
        assert_eq!(outcome.solution, [0.0; 30]);
        let empty = run(&mut operator, &[], None, method, &Control::new(1e-10));
        assert!(empty.solution.is_empty());
    }
}

/// Products that go wrong after some.
#[derive(Debug)]
struct Failing(usize, Result<f64, String>);

impl Operator for Failing {
    type Error = String;

    fn apply(&mut self, x: &[f64], y: &mut [f64], tolerance: f64) -> Result<(), String> {
        Chain.apply(x, y, tolerance).unwrap();
        if self.0 == 0 {
            y[4] = self.1.clone()?;
        }
        self.0 = self.0.wrapping_sub(1);
        Ok(())
    }
}

#[test]
fn what_is_wrong_is_named() {
    let b = some_vector(20, 1);
    let control = Control::new(1e-10);
    for method in METHODS {
        for after in 0..4 {
            for value in [f64::NAN, f64::INFINITY, 1e200] {
                let mut failing = Failing(after, Ok(value));
                let error = solve(&mut failing, &b, None, method, &control, &mut |_, _| Ok(()));
                match error.unwrap_err() {
                    KrylovError::NotFinite {
                        quantity: "a product of the operator",
                        index,
                        ..
                    } => assert!(
                        index == 4 || method != Method::BiCgStab,
                        "{method:?} {after} {value} {index}"
                    ),
                    error => panic!("{error}"),
                }
            }
            let mut failing = Failing(after, Err("no".into()));
            let error = solve(&mut failing, &b, None, method, &control, &mut |_, _| Ok(()));
            assert_eq!(error, Err(KrylovError::Operator("no".into())));
        }
        let mut told = Vec::new();
        let mut report = |iteration, residual| {
            told.push((iteration, residual));
            if iteration == 3 {
                Err("enough".to_string())
            } else {
                Ok(())
            }
        };
        let error = solve(
            &mut Failing(99, Ok(0.0)),
            &b,
            None,
            method,
            &control,
            &mut report,
        );
        assert_eq!(error, Err(KrylovError::Operator("enough".into())));
        assert!(told.len() == 3 && told.iter().all(|t| t.1 > 0.0 && t.1 < 1.0));

        let run = |b: &[f64], start: Option<&[f64]>, control: &Control| {
            solve(&mut Chain, b, start, method, control, &mut |_, _| Ok(()))
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            run(&[1.0, f64::NAN], None, &control),
            "entry 1 of the right-hand side must be a finite number, got NaN"
        );
        assert_eq!(
            run(&[1.0, 2.0], Some(&[f64::INFINITY, 0.0]), &control),
            "entry 0 of the start must be a finite number, got inf"
        );
        assert_eq!(
            run(&[1.0, 2.0], Some(&[1.0]), &control),
            "the start must have as many entries as the right-hand side, 2, got 1"
        );
        assert_eq!(
            run(&[1.0], None, &Control::new(0.0)),
            "tolerance must be a number above 0 and below 1, got 0"
        );
        assert_eq!(
            run(
                &[1.0],
                None,
                &Control {
                    safety: f64::NAN,
                    ..control
                }
            ),
            "safety must be a number above 0 and below 1, got NaN"
        );
        assert_eq!(
            run(
                &[1.0],
                None,
                &Control {
                    loosest: 1.0,
                    ..control
                }
            ),
            "loosest must be a number from 0 to less than 1, got 1"
        );
    }
    let none = Method::Gmres { restart: 0 };
    let error = solve(&mut Chain, &[1.0], None, none, &control, &mut |_, _| Ok(())).unwrap_err();
    assert_eq!(error.to_string(), "restart must be at least 1, got 0");
}
