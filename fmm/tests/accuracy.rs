//! Fast sums against direct sums: the relative error is at most the tolerance.

mod common;

use std::sync::{Arc, Mutex, PoisonError};

use common::{Amounts, Cloud, errors, every, in_cube, relative_error, thinned};
use fastrand::Rng;
use stokes_fmm::{LaplaceSum, Output, Points, Singularities, StokesSum, Strengths, direct};

/// So many that the fast way is taken.
const MANY: usize = 20_000;
/// Targets compared.
const COMPARED: usize = 200;

const TOLERANCES: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];
const OUTPUTS: [Output; 3] = [Output::Velocity, Output::Pressure, Output::Gradient];

/// What a sum missed.
struct Misses(Vec<String>);

impl Misses {
    fn none() -> Self {
        Self(Vec::new())
    }

    /// Errors of one case, each of which must be within the tolerance.
    fn check(&mut self, case: &str, tolerance: f64, errors: &[f64]) {
        let listed: Vec<String> = errors.iter().map(|error| format!("{error:.1e}")).collect();
        println!("{case} at {tolerance:.0e}: {}", listed.join(" "));
        if errors
            .iter()
            .any(|&error| error.is_nan() || error > tolerance)
        {
            let factors: Vec<f64> = errors.iter().map(|error| error / tolerance).collect();
            self.0.push(format!(
                "{case} at {tolerance:.0e}: {factors:.2?} times the tolerance"
            ));
        }
    }

    fn report(self) {
        assert!(self.0.is_empty(), "\n{}", self.0.join("\n"));
    }
}

/// Sums that were planned before: their operators take longer to make than many a sum.
static PLANNED: Mutex<Vec<Planned>> = Mutex::new(Vec::new());

struct Planned {
    what: (Singularities, Output, f64),
    sum: Arc<StokesSum>,
}

/// A plan for points, with operators that all tests share.
fn planned(points: Points<'_>, kinds: Singularities, output: Output, tolerance: f64) -> StokesSum {
    let what = (kinds, output, tolerance);
    let any = {
        let mut planned = PLANNED.lock().unwrap_or_else(PoisonError::into_inner);
        let known = planned.iter().find(|planned| planned.what == what);
        known.map(|known| known.sum.clone()).unwrap_or_else(|| {
            let nowhere = Points::same(&[]);
            let sum = StokesSum::new(nowhere, kinds, output, tolerance).expect("valid points");
            let sum = Arc::new(sum);
            planned.push(Planned {
                what,
                sum: sum.clone(),
            });
            sum
        })
    };
    any.moved(points).expect("valid points")
}

/// Errors of velocity, pressure and gradient at some of the targets. Without targets, these are the
/// sources.
fn stokes(
    cloud: &Cloud,
    targets: Option<&[[f64; 3]]>,
    kinds: Singularities,
    output: Output,
    tolerance: f64,
) -> [f64; 3] {
    let amounts = Amounts::random(&cloud.normals, &mut Rng::with_seed(5));
    let strengths = amounts.strengths(kinds);
    let points = Points {
        sources: &cloud.points,
        targets,
    };
    let sum = planned(points, kinds, output, tolerance);
    let flow = sum.apply(&strengths).expect("valid strengths");
    let targets = targets.unwrap_or(&cloud.points);
    let stride = targets.len().div_ceil(COMPARED);
    let few = thinned(targets, stride);
    let expected =
        direct::sum(&cloud.points, &strengths, &few, output, None).expect("valid points");
    errors(&every(&flow, stride), &expected)
}

/// A distribution at every tolerance, with all outputs of all kinds.
fn distribution(name: &str, cloud: &Cloud) {
    distribution_at(name, cloud, &TOLERANCES);
}

/// A distribution at these tolerances, with all outputs of all kinds.
fn distribution_at(name: &str, cloud: &Cloud, tolerances: &[f64]) {
    let mut misses = Misses::none();
    for &tolerance in tolerances {
        for kinds in [Singularities::Stokeslets, Singularities::All] {
            let errors = stokes(cloud, None, kinds, Output::Gradient, tolerance);
            misses.check(&format!("{name}, {kinds:?}"), tolerance, &errors);
        }
    }
    misses.report();
}

/// Every output at every tolerance.
fn outputs(kinds: Singularities) {
    let cloud = Cloud::cube(MANY, &mut Rng::with_seed(1));
    let mut misses = Misses::none();
    for tolerance in TOLERANCES {
        for output in OUTPUTS {
            let errors = stokes(&cloud, None, kinds, output, tolerance);
            misses.check(&format!("{kinds:?}, {output:?}"), tolerance, &errors);
        }
    }
    misses.report();
}

#[test]
fn stokeslets() {
    outputs(Singularities::Stokeslets);
}

#[test]
fn stresslets() {
    outputs(Singularities::Stresslets);
}

#[test]
fn stokeslets_and_stresslets() {
    outputs(Singularities::Both);
}

#[test]
fn all_kinds() {
    outputs(Singularities::All);
}

#[test]
fn surfaces() {
    distribution("spheroids", &Cloud::spheroids(8, &mut Rng::with_seed(2)));
}

#[test]
fn points_on_a_line() {
    let mut random = Rng::with_seed(3);
    // With fewer points all pairs would be summed for twelve digits.
    for (count, tolerances) in [(MANY / 2, &TOLERANCES[..3]), (MANY, &TOLERANCES[3..])] {
        let points = (0..count)
            .map(|_| [0.3, -0.2, 0.9].map(|slope| slope * random.f64()))
            .collect();
        distribution_at("line", &Cloud::of(points, &mut random), tolerances);
    }
    let points = (0..MANY / 2).map(|_| [random.f64(), 0.0, 0.0]).collect();
    distribution_at("axis", &Cloud::of(points, &mut random), &TOLERANCES[..2]);
}

#[test]
fn points_in_a_plane() {
    let mut random = Rng::with_seed(4);
    let points = (0..MANY)
        .map(|_| [random.f64(), 0.5, random.f64()])
        .collect();
    distribution("plane", &Cloud::of(points, &mut random));
}

#[test]
fn two_clusters_far_apart() {
    let mut random = Rng::with_seed(6);
    let points = (0..MANY)
        .map(|i| in_cube(&mut random).map(|x| x + 1e6 * (i % 2) as f64))
        .collect();
    distribution("two clusters", &Cloud::of(points, &mut random));
}

#[test]
fn points_of_every_scale() {
    let mut random = Rng::with_seed(7);
    let points = (0..MANY)
        .map(|_| {
            let distance = 10f64.powf(-6.0 * random.f64());
            common::direction(&mut random).map(|x| x * distance)
        })
        .collect();
    // For more digits of so few points all pairs are summed.
    distribution_at(
        "every scale",
        &Cloud::of(points, &mut random),
        &TOLERANCES[..2],
    );
}

#[test]
fn coincident_points() {
    let mut random = Rng::with_seed(8);
    let singles: Vec<[f64; 3]> = (0..MANY / 2).map(|_| in_cube(&mut random)).collect();
    let pairs = [singles.clone(), singles].concat();
    distribution("pairs in one place", &Cloud::of(pairs, &mut random));

    let mut points = vec![[0.25, 0.5, 0.125]; MANY / 10];
    points.extend((0..10).map(|_| in_cube(&mut random)));
    distribution("most in one place", &Cloud::of(points, &mut random));

    let points = vec![[0.25, 0.5, 0.125]; MANY / 10];
    distribution("all in one place", &Cloud::of(points, &mut random));
}

#[test]
fn points_in_one_place_do_nothing() {
    for place in [[0.0; 3], [1e-200, 0.0, 1e-200], [3.0, 1e8, -5e-324]] {
        let points = vec![place; 5000];
        let forces = vec![[1.0, -2.0, 0.5]; 5000];
        let strengths = Strengths {
            stokeslets: Some(&forces),
            ..Default::default()
        };
        let kinds = Singularities::Stokeslets;
        let sum = StokesSum::new(Points::same(&points), kinds, Output::Gradient, 1e-6)
            .expect("valid points");
        let flow = sum.apply(&strengths).expect("valid strengths");
        assert_eq!(flow.velocity, vec![[0.0; 3]; 5000]);
        assert_eq!(flow.pressure, vec![0.0; 5000]);
        assert_eq!(flow.gradient, vec![[[0.0; 3]; 3]; 5000]);
    }
}

#[test]
fn few_points() {
    for count in [1, 2, 10] {
        let cloud = Cloud::cube(count, &mut Rng::with_seed(9));
        distribution(&format!("{count} points"), &cloud);
    }
}

#[test]
fn targets_apart() {
    let mut random = Rng::with_seed(10);
    let cloud = Cloud::cube(MANY, &mut random);
    let beside: Vec<[f64; 3]> = (0..MANY / 2)
        .map(|_| {
            let [x, y, z] = in_cube(&mut random);
            [x + 0.5, 2.0 * y, z]
        })
        .collect();
    let mut misses = Misses::none();
    for tolerance in TOLERANCES {
        for kinds in [Singularities::Stokeslets, Singularities::All] {
            let errors = stokes(&cloud, Some(&beside), kinds, Output::Gradient, tolerance);
            misses.check(&format!("apart, {kinds:?}"), tolerance, &errors);
        }
    }
    misses.report();
}

/// Targets that are far away are still seen to a relative error.
#[test]
fn targets_far_away() {
    let mut random = Rng::with_seed(11);
    let cloud = Cloud::cube(MANY, &mut random);
    let far: Vec<[f64; 3]> = (0..MANY)
        .map(|_| in_cube(&mut random).map(|x| x + 10.0))
        .collect();
    let mut misses = Misses::none();
    for tolerance in TOLERANCES {
        let kinds = Singularities::Stokeslets;
        let [velocity, pressure, gradient] =
            stokes(&cloud, Some(&far), kinds, Output::Gradient, tolerance);
        // Far from all sources pressures and gradients are small compared with velocities over the
        // shortest wave. As documented, accuracy is lost: up to a factor of 5 in pressures, up to
        // 20 in gradients.
        let errors = [velocity, pressure / 5.0, gradient / 20.0];
        misses.check("far targets", tolerance, &errors);
    }
    misses.report();
}

#[test]
fn laplace() {
    let mut random = Rng::with_seed(12);
    let points = Cloud::cube(MANY, &mut random).points;
    let charges: Vec<f64> = points.iter().map(|_| random.f64() - 0.5).collect();
    let beside: Vec<[f64; 3]> = thinned(&points, 2)
        .iter()
        .map(|x| x.map(|x| 1.5 * x))
        .collect();
    let mut misses = Misses::none();
    for tolerance in TOLERANCES {
        for (targets, gradient) in [(None, false), (None, true), (Some(&beside[..]), true)] {
            let places = Points {
                sources: &points,
                targets,
            };
            let sum = LaplaceSum::new(places, gradient, tolerance).expect("valid points");
            let (potential, slopes) = sum.apply(&charges).expect("valid charges");
            let targets = targets.unwrap_or(&points);
            let stride = targets.len().div_ceil(COMPARED);
            let few = thinned(targets, stride);
            let expected =
                direct::laplace(&points, &charges, &few, gradient, None).expect("valid points");
            let potential: Vec<f64> = potential.into_iter().step_by(stride).collect();
            let errors = [
                relative_error(&potential, &expected.0),
                relative_error(
                    thinned(&slopes, stride).as_flattened(),
                    expected.1.as_flattened(),
                ),
            ];
            misses.check("Laplace", tolerance, &errors);
        }
    }
    misses.report();
}
