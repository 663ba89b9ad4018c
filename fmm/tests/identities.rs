//! Identities that flows satisfy whatever the method, and tests that sums are the same bits however
//! they are made.

mod common;

use std::f64::consts::PI;

use common::{Amounts, Cloud, cross, dot, frame, relative_error, turned};
use fastrand::Rng;
use panel_quadrature::GaussLegendre;
use stokes_fmm::{Flow, LaplaceSum, Output, Points, Singularities, StokesSum, Strengths};

/// So many that the fast way is taken.
const MANY: usize = 20_000;
const TOLERANCE: f64 = 1e-6;

/// Sources in the cube from -1/2 to 1/2, with strengths.
fn centred(seed: u64) -> (Cloud, Amounts) {
    let mut random = Rng::with_seed(seed);
    let mut cloud = Cloud::cube(MANY, &mut random);
    for x in cloud.points.as_flattened_mut() {
        *x -= 0.5;
    }
    let amounts = Amounts::random(&cloud.normals, &mut random);
    (cloud, amounts)
}

/// The flow of all kinds, with all outputs.
fn flow(points: Points<'_>, amounts: &Amounts, tolerance: f64) -> Flow {
    let kinds = Singularities::All;
    let sum = StokesSum::new(points, kinds, Output::Gradient, tolerance).expect("valid points");
    sum.apply(&amounts.strengths(kinds))
        .expect("valid strengths")
}

/// The worst of velocity, pressure and gradient.
fn difference(found: &Flow, expected: &Flow) -> f64 {
    common::errors(found, expected)
        .into_iter()
        .fold(0.0, f64::max)
}

fn difference_of_vectors(a: [f64; 3], b: [f64; 3]) -> f64 {
    relative_error(&a, &b)
}

/// $\sum_i f_i \cdot u_i$.
fn power(forces: &[[f64; 3]], velocities: &[[f64; 3]]) -> f64 {
    forces
        .iter()
        .zip(velocities)
        .map(|(f, u)| dot(*f, *u))
        .sum()
}

/// Points and weights on the sphere of radius 2 around the origin, which resolve there the flow of
/// sources within the unit cube.
fn sphere() -> (Vec<[f64; 3]>, Vec<f64>) {
    const RADIUS: f64 = 2.0;
    let rings = GaussLegendre::new(100).expect("an order it has");
    let around = 200;
    let (mut points, mut weights) = (Vec::new(), Vec::new());
    for (z, weight) in rings.iter() {
        for step in 0..around {
            let (sine, cosine) = (2.0 * PI * step as f64 / around as f64).sin_cos();
            let across = (1.0 - z * z).sqrt();
            points.push([across * cosine, across * sine, z].map(|x| RADIUS * x));
            weights.push(RADIUS * RADIUS * weight * 2.0 * PI / around as f64);
        }
    }
    (points, weights)
}

/// $\int \sigma n\,dS = -\sum f$, $\int x \times \sigma n\,dS = -\sum (x \times f + t)$,
/// $\int u \cdot n\,dS = \sum (s - q \cdot n)$.
#[test]
fn what_flows_through_a_sphere_is_what_is_inside() {
    let (cloud, amounts) = centred(1);
    let (points, weights) = sphere();
    let flow = flow(Points::apart(&cloud.points, &points), &amounts, TOLERANCE);
    let stresses = flow.stress();
    let (mut force, mut torque, mut flux) = ([0.0; 3], [0.0; 3], 0.0);
    for (index, &x) in points.iter().enumerate() {
        let area = common::normalized(x).map(|n| n * weights[index]);
        let traction = stresses[index].map(|row| dot(row, area));
        let moment = cross(x, traction);
        for k in 0..3 {
            force[k] -= traction[k];
            torque[k] -= moment[k];
        }
        flux += dot(flow.velocity[index], area);
    }
    let (mut forces, mut torques, mut fluxes) = ([0.0; 3], [0.0; 3], 0.0);
    for (i, &x) in cloud.points.iter().enumerate() {
        let moment = cross(x, amounts.forces[i]);
        for k in 0..3 {
            forces[k] += amounts.forces[i][k];
            torques[k] += moment[k] + amounts.torques[i][k];
        }
        fluxes += amounts.fluxes[i] - dot(amounts.densities[i], amounts.normals[i]);
    }
    assert!(difference_of_vectors(force, forces) < 10.0 * TOLERANCE);
    assert!(difference_of_vectors(torque, torques) < 10.0 * TOLERANCE);
    assert!((flux / fluxes - 1.0).abs() < 10.0 * TOLERANCE);
}

#[test]
fn flows_are_incompressible() {
    let (cloud, amounts) = centred(2);
    let flow = flow(Points::same(&cloud.points), &amounts, TOLERANCE);
    let trace = |g: &[[f64; 3]; 3]| g[0][0] + g[1][1] + g[2][2];
    let traces: f64 = flow.gradient.iter().map(|g| trace(g).powi(2)).sum();
    let slopes = flow.gradient.as_flattened().as_flattened();
    let all: f64 = slopes.iter().map(|g| g * g).sum();
    assert!(traces.sqrt() < TOLERANCE * all.sqrt());
}

#[test]
fn flows_move_with_their_sources() {
    let (cloud, amounts) = centred(3);
    let here = flow(Points::same(&cloud.points), &amounts, TOLERANCE);
    let moved: Vec<[f64; 3]> = cloud
        .points
        .iter()
        .map(|[x, y, z]| [x + 0.3, y - 70.1, z + 8.7])
        .collect();
    let there = flow(Points::same(&moved), &amounts, TOLERANCE);
    assert!(difference(&there, &here) < 2.0 * TOLERANCE);
}

#[test]
fn flows_turn_with_their_sources() {
    let (mut cloud, mut amounts) = centred(4);
    let mut expected = flow(Points::same(&cloud.points), &amounts, TOLERANCE);
    let frame = frame(&mut Rng::with_seed(40));
    let turn = |vectors: &mut Vec<[f64; 3]>| {
        for vector in vectors {
            *vector = turned(&frame, vector);
        }
    };
    turn(&mut cloud.points);
    turn(&mut amounts.forces);
    turn(&mut amounts.densities);
    turn(&mut amounts.normals);
    turn(&mut amounts.torques);
    turn(&mut expected.velocity);
    for gradient in &mut expected.gradient {
        // Q G Q^T.
        let rows = gradient.map(|row| turned(&frame, &row));
        let columns = [0, 1, 2].map(|j| turned(&frame, &rows.map(|row| row[j])));
        *gradient = [0, 1, 2].map(|i| columns.map(|column| column[i]));
    }
    let found = flow(Points::same(&cloud.points), &amounts, TOLERANCE);
    assert!(difference(&found, &expected) < 2.0 * TOLERANCE);
}

/// Of Stokeslets $u \sim 1/r$, of all others $1/r^2$; and by a power of two not a bit changes.
#[test]
fn flows_scale_with_their_sources() {
    let (cloud, amounts) = centred(5);
    let expected = flow(Points::same(&cloud.points), &amounts, TOLERANCE);
    for (scale, allowed) in [(3.0, 2.0 * TOLERANCE), (2f64.powi(-40), 0.0)] {
        let points: Vec<[f64; 3]> = cloud.points.iter().map(|x| x.map(|x| x * scale)).collect();
        let mut stronger = amounts.clone();
        for f in stronger.forces.as_flattened_mut() {
            *f *= scale;
        }
        for strength in stronger.densities.as_flattened_mut() {
            *strength *= scale * scale;
        }
        for strength in stronger.torques.as_flattened_mut() {
            *strength *= scale * scale;
        }
        for strength in &mut stronger.fluxes {
            *strength *= scale * scale;
        }
        // Now velocities are the same, and slopes 1/scale times.
        let mut found = flow(Points::same(&points), &stronger, TOLERANCE);
        found.pressure.iter_mut().for_each(|p| *p *= scale);
        for slope in found.gradient.as_flattened_mut().as_flattened_mut() {
            *slope *= scale;
        }
        assert!(difference(&found, &expected) <= allowed, "by {scale}");
    }
}

#[test]
fn sums_are_linear() {
    let (cloud, first) = centred(6);
    let second = Amounts::random(&cloud.normals, &mut Rng::with_seed(60));
    let kinds = Singularities::All;
    let points = Points::same(&cloud.points);
    let sum = StokesSum::new(points, kinds, Output::Gradient, TOLERANCE).expect("valid points");
    let apply = |amounts: &Amounts| {
        sum.apply(&amounts.strengths(kinds))
            .expect("valid strengths")
    };
    let mixed = |a: f64, b: f64| 2.0 * a - 0.7 * b;
    let vectors = |a: &[[f64; 3]], b: &[[f64; 3]]| -> Vec<[f64; 3]> {
        let pairs = a.iter().zip(b);
        pairs
            .map(|(a, b)| [0, 1, 2].map(|k| mixed(a[k], b[k])))
            .collect()
    };
    let numbers = |a: &[f64], b: &[f64]| -> Vec<f64> {
        a.iter().zip(b).map(|(&a, &b)| mixed(a, b)).collect()
    };
    let both = Amounts {
        forces: vectors(&first.forces, &second.forces),
        densities: vectors(&first.densities, &second.densities),
        normals: cloud.normals.clone(),
        torques: vectors(&first.torques, &second.torques),
        fluxes: numbers(&first.fluxes, &second.fluxes),
    };
    let (found, a, b) = (apply(&both), apply(&first), apply(&second));
    let slopes = |flow: &Flow| flow.gradient.as_flattened().as_flattened().to_vec();
    let pairs = [
        (
            found.velocity.as_flattened(),
            numbers(a.velocity.as_flattened(), b.velocity.as_flattened()),
        ),
        (&found.pressure, numbers(&a.pressure, &b.pressure)),
        (&slopes(&found), numbers(&slopes(&a), &slopes(&b))),
    ];
    for (found, expected) in pairs {
        assert!(relative_error(found, &expected) < 1e-13);
    }
}

/// $\sum f \cdot u[g] = \sum g \cdot u[f]$ for Stokeslets, by the reciprocal theorem. The sum is
/// symmetric to rounding.
#[test]
fn stokeslets_are_reciprocal() {
    let (cloud, first) = centred(7);
    let second = Amounts::random(&cloud.normals, &mut Rng::with_seed(70));
    let kinds = Singularities::Stokeslets;
    let points = Points::same(&cloud.points);
    let sum = StokesSum::new(points, kinds, Output::Velocity, 1e-3).expect("valid points");
    let apply = |amounts: &Amounts| {
        sum.apply(&amounts.strengths(kinds))
            .expect("valid strengths")
    };
    let (f, g) = (apply(&first).velocity, apply(&second).velocity);
    let there = power(&first.forces, &g);
    let back = power(&second.forces, &f);
    let size = power(&first.forces, &first.forces).sqrt() * power(&g, &g).sqrt();
    assert!((there - back).abs() < 1e-14 * size);
}

/// $\sigma = -p I + \nabla u + \nabla u^T$ is divergence-free, by differences of the stress, and
/// $\nabla u$ is the gradient of $u$.
#[test]
fn gradients_and_stresses_are_those_of_the_velocity() {
    const STEP: f64 = 0.01;
    let (cloud, amounts) = centred(8);
    let mut random = Rng::with_seed(80);
    // A stencil along each axis, far enough from the sources for the differences.
    let places: Vec<[f64; 3]> = (0..1000)
        .map(|_| {
            let out = 2.0 + random.f64();
            common::direction(&mut random).map(|x| x * out)
        })
        .collect();
    let mut targets = places.clone();
    for axis in 0..3 {
        for steps in [-2.0, -1.0, 1.0, 2.0] {
            targets.extend(places.iter().map(|x| {
                let mut x = *x;
                x[axis] += steps * STEP;
                x
            }));
        }
    }
    let flow = flow(Points::apart(&cloud.points, &targets), &amounts, 1e-11);
    let stresses = flow.stress();
    // Fourth-order central difference along an axis at a place.
    let slope = |place: usize, axis: usize, value: &dyn Fn(usize) -> f64| {
        let at = |step: usize| value((1 + 4 * axis + step) * places.len() + place);
        (at(0) - 8.0 * at(1) + 8.0 * at(2) - at(3)) / (12.0 * STEP)
    };
    let (mut found, mut expected) = (Vec::new(), Vec::new());
    let (mut divergences, mut slopes) = (0.0, 0.0);
    for place in 0..places.len() {
        let mut divergence = [0.0; 3];
        for (i, j) in (0..9).map(|entry| (entry / 3, entry % 3)) {
            expected.push(slope(place, j, &|target| flow.velocity[target][i]));
            found.push(flow.gradient[place][i][j]);
            let term = slope(place, j, &|target| stresses[target][i][j]);
            divergence[i] += term;
            slopes += term * term;
        }
        divergences += dot(divergence, divergence);
    }
    assert!(relative_error(&found, &expected) < 1e-6);
    assert!((divergences / slopes).sqrt() < 1e-6);
}

#[test]
fn numbers_of_threads_change_no_bit() {
    let (cloud, amounts) = centred(9);
    let all = [1, 2, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("a pool");
        pool.install(|| flow(Points::same(&cloud.points), &amounts, TOLERANCE))
    });
    assert!(all[0] == all[1] && all[0] == all[2]);
}

#[test]
fn sums_can_be_repeated_and_moved() {
    let (cloud, amounts) = centred(10);
    let (other, weaker) = centred(11);
    let kinds = Singularities::All;
    let (output, strengths) = (Output::Gradient, amounts.strengths(kinds));
    let here = Points::same(&cloud.points);
    let sum = StokesSum::new(here, kinds, output, TOLERANCE).expect("valid points");
    let first = sum.apply(&strengths).expect("valid strengths");
    let between = sum.apply(&weaker.strengths(kinds));
    assert!(between.expect("valid strengths") != first);
    assert!(sum.apply(&strengths).expect("valid strengths") == first);

    let away = sum
        .moved(Points::same(&other.points))
        .expect("valid points");
    let back = away.moved(here).expect("valid points");
    assert!(back.apply(&strengths).expect("valid strengths") == first);
}

#[test]
fn potentials_can_be_repeated_and_moved() {
    let (cloud, amounts) = centred(12);
    let fewer: Vec<[f64; 3]> = cloud.points.iter().skip(1).copied().collect();
    let here = Points::same(&cloud.points);
    let sum = LaplaceSum::new(here, true, TOLERANCE).expect("valid points");
    let first = sum.apply(&amounts.fluxes).expect("valid charges");
    assert!(sum.apply(&amounts.fluxes).expect("valid charges") == first);
    let away = sum.moved(Points::same(&fewer)).expect("valid points");
    let back = away.moved(here).expect("valid points");
    assert!(back.apply(&amounts.fluxes).expect("valid charges") == first);
}

/// $u(x) = \sum s\,x/4\pi r^3$ is minus the slope of the potential of the same charges.
#[test]
fn sources_flow_along_the_slope_of_their_potential() {
    let (cloud, amounts) = centred(13);
    let points = Points::same(&cloud.points);
    let potential = LaplaceSum::new(points, true, TOLERANCE).expect("valid points");
    let (_, slopes) = potential.apply(&amounts.fluxes).expect("valid charges");
    let sources = Strengths {
        fluxes: Some(&amounts.fluxes),
        ..Default::default()
    };
    let kinds = Singularities::All;
    let sum = StokesSum::new(points, kinds, Output::Velocity, TOLERANCE).expect("valid points");
    let flow = sum.apply(&sources).expect("valid strengths");
    let downhill: Vec<[f64; 3]> = slopes.iter().map(|slope| slope.map(|x| -x)).collect();
    let error = relative_error(flow.velocity.as_flattened(), downhill.as_flattened());
    assert!(error < 2.0 * TOLERANCE);
}

#[test]
fn absent_kinds_are_zeros() {
    let (cloud, mut amounts) = centred(14);
    let points = Points::same(&cloud.points);
    let kinds = Singularities::All;
    let sum = StokesSum::new(points, kinds, Output::Pressure, TOLERANCE).expect("valid points");
    let alone = sum.apply(&amounts.strengths(Singularities::Stokeslets));
    amounts.densities.fill([0.0; 3]);
    amounts.torques.fill([0.0; 3]);
    amounts.fluxes.fill(0.0);
    let with_zeros = sum.apply(&amounts.strengths(kinds));
    assert!(alone.expect("valid strengths") == with_zeros.expect("valid strengths"));
    let none = sum.apply(&Strengths::default());
    let still = none.expect("valid strengths").velocity;
    assert!(still == vec![[0.0; 3]; MANY]);
}
