use std::f64::consts::PI;

use super::*;
use crate::far::Far;
use crate::kernel::{Laplace, Stokes};
use crate::tree::{Leaf, Near};

const ALPHA: f64 = 8.0;

/// $b_n(t)$ of a Gaussian $\psi = e^{-\alpha\rho^2}$:
/// $(-2\alpha)^{n-1} \int_0^1 v^{2n-2} e^{-\alpha t v^2} dv / 8 \pi C_0$, $C_0 = \int_0^1 \psi$.
fn gaussian(n: usize, t: f64) -> f64 {
    let simpson = |f: &dyn Fn(f64) -> f64| {
        let weight = |i: usize| {
            if i.is_multiple_of(1000) {
                1.0
            } else {
                2.0 + 2.0 * (i % 2) as f64
            }
        };
        (0..=1000)
            .map(|i| weight(i) * f(i as f64 / 1000.0))
            .sum::<f64>()
            / 3000.0
    };
    let moment = simpson(&|v| v.powi(2 * n as i32 - 2) * (-ALPHA * t * v * v).exp());
    let c0 = simpson(&|v| (-ALPHA * v * v).exp());
    (-2.0 * ALPHA).powi(n as i32 - 1) * moment / (8.0 * PI * c0)
}

/// Coefficients, highest first, of the interpolant at Chebyshev points of $s = 2t - 1$.
fn polynomial(n: usize, terms: usize) -> Vec<f64> {
    let angle = |i: usize| PI * (i as f64 + 0.5) / terms as f64;
    let mut power = vec![0.0; terms];
    let (mut before, mut now) = (vec![0.0; terms], vec![0.0; terms]);
    now[0] = 1.0;
    for k in 0..terms {
        let value =
            |i: usize| gaussian(n, 0.5 * (1.0 + angle(i).cos())) * (k as f64 * angle(i)).cos();
        let c = (0..terms).map(value).sum::<f64>() * if k == 0 { 1.0 } else { 2.0 } / terms as f64;
        (0..terms).for_each(|i| power[i] += c * now[i]);
        let factor = if k == 0 { 1.0 } else { 2.0 };
        let next = (0..terms).map(|i| if i > 0 { factor * now[i - 1] } else { 0.0 } - before[i]);
        let next: Vec<f64> = next.collect();
        before = std::mem::replace(&mut now, next);
    }
    power.reverse();
    power
}

fn polynomials(terms: usize) -> [Vec<f64>; 4] {
    [1, 2, 3, 4].map(|n| polynomial(n, terms))
}

/// The unit cube divided into `cells` leaves along each side, with the points in each leaf. If
/// `mixed`, the reach of a leaf depends on its parity.
fn tree(
    random: &mut fastrand::Rng,
    cells: usize,
    sources: usize,
    targets: Option<usize>,
    mixed: bool,
) -> Tree {
    let cell = |x: [f64; 3]| {
        let place = x.map(|x| (x * cells as f64) as usize);
        (place[0] * cells + place[1]) * cells + place[2]
    };
    let mut sorted = |count: usize| {
        let mut points: Vec<[f64; 3]> = (0..count).map(|_| [0; 3].map(|_| random.f64())).collect();
        points.sort_by_key(|&x| cell(x));
        let starts: Vec<u32> = (0..=cells.pow(3))
            .map(|i| points.partition_point(|&x| cell(x) < i) as u32)
            .collect();
        let positions = [0, 1, 2].map(|axis| points.iter().map(|x| x[axis]).collect());
        let order = (0..count as u32).collect();
        (SortedPoints { order, positions }, starts)
    };
    let (source_points, source_starts) = sorted(sources);
    let targets = targets.map(&mut sorted);
    let side = 1.0 / cells as f64;
    let range = |starts: &[u32], i: usize| starts[i]..starts[i + 1];
    let near = |i: usize| {
        let place = [i / cells / cells, i / cells % cells, i % cells];
        (0..cells.pow(3)).filter(move |&j| {
            let other = [j / cells / cells, j / cells % cells, j % cells];
            (0..3).all(|k| place[k].abs_diff(other[k]) <= 1)
        })
    };
    let leaves = (0..cells.pow(3)).map(|i| Leaf {
        sources: range(&source_starts, i),
        targets: targets
            .as_ref()
            .map_or(0..0, |(_, starts)| range(starts, i)),
        near: near(i)
            .map(|j| Near {
                sources: range(&source_starts, j),
                reach: if mixed && (i + j) % 2 == 0 {
                    0.7 * side
                } else {
                    side
                },
            })
            .collect(),
    });
    Tree {
        leaves: leaves.collect(),
        sources: source_points,
        targets: targets.map(|(points, _)| points),
        levels: Vec::new(),
    }
}

fn random_columns(random: &mut fastrand::Rng, columns: usize, count: usize) -> Vec<Vec<f64>> {
    (0..columns)
        .map(|_| (0..count).map(|_| random.f64() - 0.5).collect())
        .collect()
}

/// All pairs of each near list, one at a time.
fn brute<P: Pair>(tree: &Tree, mollified: &[Vec<f64>; 4], strengths: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let simd = pulp::Scalar::new();
    let lane = |x: f64| Lanes::splat(simd, x);
    let points = tree.targets.as_ref().unwrap_or(&tree.sources);
    let mut outputs = vec![vec![0.0; points.order.len()]; P::OUTPUTS];
    for leaf in &tree.leaves {
        let targets = if tree.targets.is_some() {
            &leaf.targets
        } else {
            &leaf.sources
        };
        for i in targets.clone().map(|i| i as usize) {
            for near in &leaf.near {
                for j in near.sources.clone().map(|j| j as usize) {
                    let x =
                        [0, 1, 2].map(|k| points.positions[k][i] - tree.sources.positions[k][j]);
                    let r2 = x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
                    let t = r2 / (near.reach * near.reach);
                    let values = [0, 1, 2, 3].map(|n| {
                        let s = 2.0 * t - 1.0;
                        let value = mollified[n].iter().fold(0.0, |value, c| value * s + c);
                        lane(value * near.reach.powi(-1 - 2 * n as i32) / UNITS[n])
                    });
                    let chain =
                        Chain::residual::<3>(lane(r2), lane(near.reach * near.reach), &values);
                    let weighed: Vec<f64> = (0..P::STRENGTHS)
                        .map(|k| strengths[k][j] * P::FACTORS[k])
                        .collect();
                    let mut out = [lane(0.0); MOST];
                    P::add(&x.map(lane), &chain, &weighed, &mut out);
                    (0..P::OUTPUTS).for_each(|k| outputs[k][i] += out[k].sum());
                }
            }
        }
    }
    outputs
}

fn compare<P: Far>(tree: &Tree, random: &mut fastrand::Rng) {
    let mollified = polynomials(13);
    let strengths = random_columns(random, P::STRENGTHS, tree.sources.order.len());
    let expected = brute::<P>(tree, &mollified, &strengths);
    let mut outputs: Vec<Vec<f64>> = expected
        .iter()
        .map(|column| vec![0.0; column.len()])
        .collect();
    NearField::new(tree, &mollified, Precision::Full).add(
        &Numbers::of::<P>(),
        add_tile::<P>,
        &strengths,
        &mut outputs,
    );
    for (column, expected) in outputs.iter().zip(&expected) {
        let scale = expected.iter().fold(0.0f64, |scale, x| scale.max(x.abs()));
        for (x, expected) in column.iter().zip(expected) {
            assert!(
                (x - expected).abs() <= 1e-12 * scale,
                "{x} {expected} of {scale}"
            );
        }
    }
}

#[test]
fn all_pairs_in_reach() {
    let random = &mut fastrand::Rng::with_seed(3);
    for (sources, targets, mixed) in [
        (700, None, false),
        (700, None, true),
        (900, Some(500), true),
        (40, Some(70), false),
    ] {
        let tree = tree(random, 3, sources, targets, mixed);
        compare::<Stokes<3, 3>>(&tree, random);
        compare::<Stokes<6, 3>>(&tree, random);
        compare::<Stokes<9, 4>>(&tree, random);
        compare::<Stokes<13, 13>>(&tree, random);
        compare::<Laplace<4>>(&tree, random);
    }
}

#[test]
fn nothing_gives_nothing() {
    let random = &mut fastrand::Rng::with_seed(3);
    for (sources, targets) in [(0, None), (0, Some(5)), (5, Some(0))] {
        compare::<Stokes<3, 3>>(&tree(random, 2, sources, targets, false), random);
    }
}

#[test]
fn coincident_points_lose_the_mollified_part_only() {
    let random = &mut fastrand::Rng::with_seed(3);
    let mut tree = tree(random, 1, 2, None, false);
    for axis in 0..3 {
        tree.sources.positions[axis][1] = tree.sources.positions[axis][0];
    }
    let mollified = polynomials(20);
    let field = NearField::new(&tree, &mollified, Precision::Full);
    let mut outputs = vec![vec![0.0; 2]; 3];
    field.add(
        &Numbers::of::<Stokes<3, 3>>(),
        add_tile::<Stokes<3, 3>>,
        &[vec![1.0, 0.0], vec![0.0; 2], vec![0.0; 2]],
        &mut outputs,
    );
    let expected = -2.0 * gaussian(1, 0.0);
    for own in &outputs[0] {
        assert!((own / expected - 1.0).abs() < 1e-9, "{own} {expected}");
    }
}
