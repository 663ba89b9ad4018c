#![expect(clippy::needless_range_loop, reason = "indices as in the formulas")]

use f64_lanes::Lanes;
use pulp::Scalar;

use super::*;

/// Derivative $\partial_x^a \partial_y^b \partial_z^c$ of $e^{-r^2/2}$ along the axes listed: a
/// product of Hermite polynomials.
fn derivative(x: [f64; 3], axes: &[usize]) -> f64 {
    let product: f64 = (0..3)
        .map(|axis| {
            let order = axes.iter().filter(|&&other| other == axis).count();
            let (mut now, mut before) = (1.0, 0.0);
            for n in 0..order {
                (now, before) = (-x[axis] * now - n as f64 * before, now);
            }
            now
        })
        .product();
    product * (-0.5 * (x[0] * x[0] + x[1] * x[1] + x[2] * x[2])).exp()
}

/// Derivatives of the Laplacian.
fn laplacian(x: [f64; 3], axes: &[usize]) -> f64 {
    let of = |k| derivative(x, &[axes, &[k, k]].concat());
    (0..3).map(of).sum()
}

fn delta(i: usize, j: usize) -> f64 {
    f64::from(u8::from(i == j))
}

/// $\epsilon_{ijk}$.
fn permutation(i: usize, j: usize, k: usize) -> f64 {
    (j as f64 - i as f64) * (k as f64 - j as f64) * (k as f64 - i as f64) / 2.0
}

/// Velocity component `i` of all singularities of the kernel made of $B = e^{-r^2/2}$,
/// differentiated along `axes`.
fn velocity(x: [f64; 3], strength: &[f64; 13], i: usize, axes: &[usize]) -> f64 {
    let d = |own: &[usize]| derivative(x, &[own, axes].concat());
    let l = |own: &[usize]| laplacian(x, &[own, axes].concat());
    let (mut u, [force, q, n, torque]) = (
        -strength[12] * l(&[i]),
        [0, 3, 6, 9].map(|k| &strength[k..k + 3]),
    );
    for j in 0..3 {
        u += (delta(i, j) * l(&[]) - d(&[i, j])) * force[j];
        for k in 0..3 {
            let traces = delta(j, k) * l(&[i]) + delta(i, j) * l(&[k]) + delta(i, k) * l(&[j]);
            u += (traces - 2.0 * d(&[i, j, k])) * q[j] * n[k];
            u -= 0.5 * permutation(i, j, k) * torque[j] * l(&[k]);
        }
    }
    u
}

fn pressure(x: [f64; 3], strength: &[f64; 13]) -> f64 {
    let mut p = 0.0;
    for j in 0..3 {
        p -= laplacian(x, &[j]) * strength[j];
        for k in 0..3 {
            p -= 2.0 * laplacian(x, &[j, k]) * strength[3 + j] * strength[6 + k];
        }
    }
    p
}

/// What a pair adds if the chain is that of $B = e^{-r^2/2}$: $\beta_n = (-1)^n B$.
fn added<P: Pair>(x: [f64; 3], strength: &[f64]) -> Vec<f64> {
    let lane = |x: f64| Lanes::splat(Scalar::new(), x);
    let r2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
    let signs = [-1.0, 1.0, -1.0, 1.0];
    let [first, last] = P::ORDERS;
    let chain = Chain::<Scalar, false> {
        r2: lane(r2),
        b: [0, 1, 2, 3].map(|n| {
            let needed = (first..=last).contains(&(n + 1));
            lane(if needed {
                signs[n] * (-0.5 * r2).exp() / UNITS[n]
            } else {
                f64::NAN
            })
        }),
    };
    let weighed: Vec<f64> = strength
        .iter()
        .zip(P::FACTORS)
        .map(|(s, factor)| s * factor)
        .collect();
    let mut out = [lane(0.0); MOST];
    P::add(&x.map(lane), &chain, &weighed, &mut out);
    out[..P::OUTPUTS].iter().map(|out| out.sum()).collect()
}

fn check<const STRENGTHS: usize, const OUTPUTS: usize>() {
    let random = &mut fastrand::Rng::with_seed(5);
    for _ in 0..20 {
        let x = [0; 3].map(|_| 3.0 * random.f64() - 1.5);
        let own: Vec<f64> = (0..STRENGTHS).map(|_| random.f64() - 0.5).collect();
        let first = if STRENGTHS == 6 { 3 } else { 0 };
        let mut strength = [0.0; 13];
        strength[first..first + STRENGTHS].copy_from_slice(&own);
        let out = added::<Stokes<STRENGTHS, OUTPUTS>>(x, &own);
        let mut expected: Vec<f64> = (0..3).map(|i| velocity(x, &strength, i, &[])).collect();
        expected.push(pressure(x, &strength));
        expected.extend((0..9).map(|k| velocity(x, &strength, k / 3, &[k % 3])));
        for (k, out) in out.iter().enumerate() {
            assert!(
                (out - expected[k]).abs() < 1e-13,
                "{STRENGTHS} {OUTPUTS}: {k}: {out} {}",
                expected[k]
            );
        }
    }
}

#[test]
fn kernels_are_derivatives_of_any_b() {
    check::<3, 3>();
    check::<3, 4>();
    check::<3, 13>();
    check::<6, 3>();
    check::<6, 4>();
    check::<6, 13>();
    check::<9, 3>();
    check::<9, 4>();
    check::<9, 13>();
    check::<13, 3>();
    check::<13, 4>();
    check::<13, 13>();
}

#[test]
fn charge_is_the_laplacian_of_any_b() {
    let x = [0.3, -0.8, 0.5];
    let out = added::<Laplace<4>>(x, &[0.7]);
    let expected = [
        laplacian(x, &[]),
        laplacian(x, &[0]),
        laplacian(x, &[1]),
        laplacian(x, &[2]),
    ];
    for (out, expected) in out.iter().zip(expected) {
        assert!((out - 0.7 * expected).abs() < 1e-14);
    }
    assert!((added::<Laplace<1>>(x, &[0.7])[0] - 0.7 * expected[0]).abs() < 1e-14);
}
