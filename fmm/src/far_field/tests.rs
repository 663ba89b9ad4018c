use std::f64::consts::PI;

use f64_lanes::Precision;

use super::*;
use crate::dispatch::Kernel;
use crate::parameters::Parameters;
use crate::splitting::Splitting;
use crate::tree::Costs;

const COUNT: usize = 600;

/// Potential of a unit charge and its gradient at a distance `d` from it, minus the part mollified
/// over `reach` if `reach` is given.
fn charge(splitting: &Splitting, d: [f64; 3], reach: Option<f64>) -> [f64; 4] {
    let r2: f64 = d.iter().map(|d| d * d).sum();
    let mut chain = [0.0; 3];
    if r2 > 0.0 {
        let r = r2.sqrt();
        chain = [1.0 / r, -1.0 / (r * r2), 3.0 / (r * r2 * r2)].map(|b| b / (8.0 * PI));
    }
    if let Some(reach) = reach {
        let t = r2 / (reach * reach);
        if t >= 1.0 {
            return [0.0; 4];
        }
        for (order, chain) in (1..).zip(&mut chain) {
            *chain -= splitting.mollified(order, t) * reach.powi(1 - 2 * order as i32);
        }
    }
    let [b1, b2, b3] = chain;
    let slope = 5.0 * b2 + r2 * b3;
    [3.0 * b1 + r2 * b2, slope * d[0], slope * d[1], slope * d[2]]
}

/// Sizes of the far field, and what error of potentials they are good to.
fn sets() -> [(Parameters, f64); 2] {
    [(6, 16, 10, 1e-3), (9, 26, 18, 1e-6)].map(|(width, points, waves, accuracy)| {
        let precision = Precision::Full;
        (
            Parameters {
                width,
                points,
                waves,
                accuracy,
                precision,
            },
            accuracy,
        )
    })
}

/// Relative errors of the far field plus residuals, for the potential and the gradient of charges
/// in the boxes of a tree.
fn errors(operators: &Operators, tree: &Tree) -> [f64; 4] {
    let splitting = Splitting::new(operators.parameters.waves);
    let fields = Kernel::laplace(true).fields;
    let charges = vec![(0..COUNT).map(|i| (i as f64).sin()).collect::<Vec<f64>>()];
    let (far, mut grids) = (FarField::new(tree), Grids::default());
    far.fill(operators, fields, tree, &charges, &mut grids);
    let mut sums = vec![vec![0.0; COUNT]; 4];
    far.read(operators, fields, tree, &grids, &mut sums);
    let x = |i: usize| [0, 1, 2].map(|axis| tree.sources.positions[axis][i]);
    let distance = |i: usize, j: usize| [0, 1, 2].map(|axis| x(i)[axis] - x(j)[axis]);
    let (mut squares, mut sizes) = ([0.0; 4], [0.0; 4]);
    for leaf in &tree.leaves {
        for target in leaf.targets.clone().map(|target| target as usize) {
            let mut found = [0, 1, 2, 3].map(|k| sums[k][target]);
            for near in &leaf.near {
                for source in near.sources.clone().map(|source| source as usize) {
                    let one = charge(&splitting, distance(target, source), Some(near.reach));
                    (0..4).for_each(|k| found[k] += charges[0][source] * one[k]);
                }
            }
            let mut exact = [0.0; 4];
            for (source, q) in charges[0].iter().enumerate() {
                let one = charge(&splitting, distance(target, source), None);
                (0..4).for_each(|k| exact[k] += q * one[k]);
            }
            for k in 0..4 {
                squares[k] += (found[k] - exact[k]).powi(2);
                sizes[k] += exact[k].powi(2);
            }
        }
    }
    [0, 1, 2, 3].map(|k| (squares[k] / sizes[k]).sqrt())
}

#[test]
fn far_field_and_residuals_are_all() {
    let mut random = fastrand::Rng::with_seed(7);
    let sources: Vec<[f64; 3]> = (0..COUNT).map(|_| [0; 3].map(|_| random.f64())).collect();
    for (parameters, bound) in sets() {
        let operators = Operators::with_parameters(Kernel::laplace(true), parameters);
        // The root alone, eight boxes, and levels of more than one slab.
        for grid in [1e9, 20_000.0, 50.0] {
            let tree = Tree::new(
                &sources,
                None,
                &Costs {
                    pair: 10.0,
                    grid,
                    point: 10.0,
                },
            );
            let [potential, gradient @ ..] = errors(&operators, &tree);
            assert!(potential < bound, "{potential:e}");
            assert!(
                gradient.iter().all(|&error| error < 10.0 * bound),
                "{gradient:?}"
            );
        }
    }
}
