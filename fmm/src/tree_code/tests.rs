use fastrand::Rng;

use super::*;

const COUNT: usize = 12_000;

fn vectors(random: &mut Rng) -> Vec<[f64; 3]> {
    (0..COUNT)
        .map(|_| [0; 3].map(|_| random.f64() - 0.5))
        .collect()
}

fn relative_error(found: &[f64], expected: &[f64]) -> f64 {
    let error: f64 = found
        .iter()
        .zip(expected)
        .map(|(a, b)| (a - b).powi(2))
        .sum();
    (error / expected.iter().map(|b| b * b).sum::<f64>()).sqrt()
}

/// Errors of velocity, pressure and gradient at some of the targets.
fn errors(code: &TreeCode, points: &[[f64; 3]], kinds: Singularities, output: Output) -> [f64; 3] {
    let mut random = Rng::with_seed(4);
    let (forces, densities) = (vectors(&mut random), vectors(&mut random));
    let (normals, torques) = (vectors(&mut random), vectors(&mut random));
    let fluxes: Vec<f64> = torques.iter().map(|t| t[0]).collect();
    let records = Records {
        positions: Vec::new(),
        forces,
        densities,
        normals,
        torques,
        fluxes,
    };
    let strengths = records.strengths(kinds);
    let found = code.apply(&strengths).unwrap();
    let expected = direct::sum(points, &strengths, &points[..200], output, None).unwrap();
    let error = |found: &[f64], expected: &[f64]| {
        if expected.is_empty() {
            0.0
        } else {
            relative_error(&found[..expected.len()], expected)
        }
    };
    [
        error(
            found.velocity.as_flattened(),
            expected.velocity.as_flattened(),
        ),
        error(&found.pressure, &expected.pressure),
        error(
            found.gradient.as_flattened().as_flattened(),
            expected.gradient.as_flattened().as_flattened(),
        ),
    ]
}

#[test]
fn errors_fall_with_proxies_and_angle() {
    let points = vectors(&mut Rng::with_seed(1));
    let (kinds, output) = (Singularities::Stokeslets, Output::Velocity);
    let error = |proxies: usize, angle: f64| {
        let opening = Opening { proxies, angle };
        let here = Points::same(&points);
        let code = TreeCode::with_opening(here, kinds, output, 1e-12, opening);
        assert!(code.views.iter().any(|view| !view.far.is_empty()));
        let [error, ..] = errors(&code, &points, kinds, output);
        println!("{proxies} proxies, angle {angle}: {error:.1e}");
        error
    };
    let by_proxies = [2, 3, 4, 5, 6].map(|proxies| error(proxies, 0.6));
    assert!(by_proxies.windows(2).all(|pair| pair[1] < 0.5 * pair[0]));
    let by_angle = [0.8, 0.6, 0.45].map(|angle| error(4, angle));
    assert!(by_angle.windows(2).all(|pair| pair[1] < 0.5 * pair[0]));
}

#[test]
fn every_kind_meets_its_tolerance() {
    let points = vectors(&mut Rng::with_seed(2));
    let output = Output::Gradient;
    for kinds in [
        Singularities::Stokeslets,
        Singularities::Stresslets,
        Singularities::Both,
        Singularities::All,
    ] {
        for tolerance in [1e-1, 1e-2, 1e-3] {
            let here = Points::same(&points);
            let code = TreeCode::new(here, kinds, output, tolerance).unwrap();
            let far = code.views.iter().map(|view| view.far.len()).sum::<usize>();
            let errors = errors(&code, &points, kinds, output);
            println!("{kinds:?} at {tolerance:.0e}, {far} far: {errors:?}");
            assert!(errors.iter().all(|&error| error <= tolerance));
        }
    }
}

#[test]
fn lagrange_polynomials_are_one_at_their_nodes() {
    let basis = Basis::new(7);
    let (mut powers, mut values) = ([0.0; 7], [0.0; 7]);
    for (k, &node) in basis.nodes.iter().enumerate() {
        basis.values(node, &mut powers, &mut values);
        for (j, value) in values.iter().enumerate() {
            assert!((value - f64::from(u8::from(j == k))).abs() < 1e-14);
        }
    }
    basis.values(0.3, &mut powers, &mut values);
    let quintic: f64 = basis
        .nodes
        .iter()
        .zip(values)
        .map(|(x, l)| x.powi(5) * l)
        .sum();
    assert!((quintic - 0.3f64.powi(5)).abs() < 1e-15);
}

#[test]
fn points_in_one_place_or_none_are_fine() {
    for count in [0, 1, 3000] {
        let points = vec![[0.5, 0.25, 0.75]; count];
        let kinds = Singularities::Stokeslets;
        let code = TreeCode::new(Points::same(&points), kinds, Output::Velocity, 1e-3).unwrap();
        let strengths = Strengths {
            stokeslets: Some(&vec![[1.0; 3]; count]),
            ..Default::default()
        };
        let flow = code.apply(&strengths).unwrap();
        assert_eq!(flow.velocity, vec![[0.0; 3]; count]);
    }
}
