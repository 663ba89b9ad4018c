use super::*;
use crate::kernel::Laplace;
use crate::parameters::Parameters;
use crate::splitting::Splitting;
use crate::tree::Costs;

/// The chain of the residual: the radial functions $\beta_1$ to $\beta_4$.
fn residual(splitting: &Splitting, r2: f64, reach: f64) -> [f64; 4] {
    let t = r2 / (reach * reach);
    let mut chain = [0.0; 4];
    if t >= 1.0 {
        return chain;
    }
    let mut full = 1.0 / (8.0 * std::f64::consts::PI * r2.sqrt());
    for order in 1..=4 {
        let mollified = splitting.mollified(order, t) * reach.powi(1 - 2 * order as i32);
        chain[order - 1] = if r2 > 0.0 { full } else { 0.0 } - mollified;
        full *= -(2.0 * order as f64 - 1.0) / r2;
    }
    chain
}

fn cube(count: usize) -> Vec<[f64; 3]> {
    let mut random = fastrand::Rng::with_seed(7);
    (0..count).map(|_| [0; 3].map(|_| random.f64())).collect()
}

/// Potentials of the far field plus the residual, by brute force, against the full kernel.
#[test]
fn charges() {
    for (parameters, bound) in sets() {
        let operators = Operators::with_parameters::<Laplace<4>>(parameters);
        let splitting = Splitting::new(operators.parameters.waves);
        let sources = cube(600);
        for costs in [1e9, 20_000.0, 50.0] {
            let tree = Tree::new(
                &sources,
                None,
                &Costs {
                    pair: 10.0,
                    grid: costs,
                    point: 10.0,
                },
            );
            let boxes: Vec<usize> = tree.levels.iter().map(|l| l.boxes.len()).collect();
            let far = FarField::new(&tree);
            let mut grids = Grids::default();
            let x = |i: usize| [0, 1, 2].map(|axis| tree.sources.positions[axis][i]);
            let charges = vec![(0..600).map(|i| (i as f64).sin()).collect::<Vec<f64>>()];
            far.fill(
                &operators,
                Fields::of::<Laplace<4>>(),
                &tree,
                &charges,
                &mut grids,
            );
            let mut worst = [0.0f64; 4];
            let mut size = [0.0f64; 4];
            let mut out = vec![vec![0.0; 600]; 4];
            far.read(
                &operators,
                Fields::of::<Laplace<4>>(),
                &tree,
                &grids,
                &mut out,
            );
            for leaf in &tree.leaves {
                for target in leaf.targets.clone() {
                    let mut exact = [0.0; 4];
                    let mut found = [0, 1, 2, 3].map(|k| out[k][target as usize]);
                    for source in 0..600 {
                        let d: Vec<f64> = (0..3)
                            .map(|a| x(target as usize)[a] - x(source)[a])
                            .collect();
                        let r2: f64 = d.iter().map(|d| d * d).sum();
                        if r2 > 0.0 {
                            let r = r2.sqrt();
                            let q = charges[0][source] / (4.0 * std::f64::consts::PI);
                            exact[0] += q / r;
                            (0..3).for_each(|a| exact[a + 1] -= q * d[a] / (r * r2));
                        }
                    }
                    for near in &leaf.near {
                        for source in near.sources.clone() {
                            let d: Vec<f64> = (0..3)
                                .map(|a| x(target as usize)[a] - x(source as usize)[a])
                                .collect();
                            let r2: f64 = d.iter().map(|d| d * d).sum();
                            let [b1, b2, b3, _] = residual(&splitting, r2, near.reach);
                            let q = charges[0][source as usize];
                            if r2 > 0.0 || b1 != 0.0 {
                                let (b2, b3) = if r2 > 0.0 { (b2, b3) } else { (b2, b3) };
                                found[0] += q * (3.0 * b1 + r2 * b2);
                                (0..3)
                                    .for_each(|a| found[a + 1] += q * d[a] * (5.0 * b2 + r2 * b3));
                            }
                        }
                    }
                    for k in 0..4 {
                        worst[k] += (found[k] - exact[k]).powi(2);
                        size[k] += exact[k].powi(2);
                    }
                }
            }
            let errors = [0, 1, 2, 3].map(|k| (worst[k] / size[k]).sqrt());
            println!(
                "waves {} boxes {boxes:?}: {:?}",
                operators.parameters.waves,
                errors.map(|e| format!("{e:.1e}"))
            );
            assert!(errors[0] < bound);
        }
    }
}

fn sets() -> Vec<(Parameters, f64)> {
    [(6, 16, 10, 1e-3), (9, 26, 18, 1e-6)]
        .map(|(width, points, waves, accuracy)| {
            (
                Parameters {
                    width,
                    points,
                    waves,
                    accuracy,
                    precision: f64_lanes::Precision::Full,
                },
                accuracy,
            )
        })
        .to_vec()
}
