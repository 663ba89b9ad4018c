//! Every tabulated rule against closed-form moments; a part of the tables made anew; convergence.

use super::*;
use crate::{legendre, log_moments::log_moments};

/// All rules of an order, with the singular point and a name.
fn all(order: usize) -> Vec<(String, f64, KolmRokhlin)> {
    let panel = GaussLegendre::new(order).unwrap();
    let mut rules = Vec::new();
    for (target, x) in panel.nodes().iter().enumerate() {
        let rule = KolmRokhlin::own(order, target).unwrap();
        rules.push((format!("own {order} {target}"), *x, rule));
        for (side, y) in [(Side::Left, x - 2.0), (Side::Right, x + 2.0)] {
            let rule = KolmRokhlin::neighbour(order, target, side).unwrap();
            rules.push((format!("{side:?} neighbour {order} {target}"), y, rule));
        }
    }
    rules
}

/// Largest error in the moments of `P_k` and `P_k log|x - y|`, `k < 2p`. The integrals of the
/// absolute values are of order one, so absolute errors are relative to the integrand's natural
/// scale.
fn moment_error(y: f64, rule: &KolmRokhlin) -> f64 {
    let n = rule.order();
    let mut exact = vec![0.0; n];
    log_moments(y, &mut exact).unwrap();
    let mut p = vec![0.0; n];
    let mut errors = vec![0.0; n];
    errors[0] = -2.0;
    errors.extend(exact.iter().map(|m| -m));
    for Node {
        node,
        offset,
        weight,
    } in rule.iter()
    {
        legendre::values(node, &mut p);
        for k in 0..n {
            errors[k] += weight * p[k];
            errors[n + k] += weight * p[k] * offset.abs().ln();
        }
    }
    errors.iter().fold(0.0, |worst: f64, e| worst.max(e.abs()))
}

#[test]
fn moments_are_exact() {
    for &order in ORDERS {
        for family in ["own", "neighbour"] {
            let (mut worst, mut nearest, mut lightest) = (0.0_f64, f64::INFINITY, f64::INFINITY);
            for (name, y, rule) in all(order).iter().filter(|(name, ..)| name.contains(family)) {
                let error = moment_error(*y, rule);
                assert!(error < 1e-14, "{name}: {error:e}");
                worst = worst.max(error);
                nearest = rule.offsets.iter().fold(nearest, |m, u| m.min(u.abs()));
                lightest = rule.weights.iter().fold(lightest, |m, w| m.min(*w));
            }
            println!(
                "{family} {order}: error {worst:.1e}, nearest node {nearest:.1e}, smallest weight {lightest:.1e}"
            );
        }
    }
}

#[test]
fn weights_are_positive_and_nodes_inside() {
    for &order in ORDERS {
        for (name, y, rule) in all(order) {
            assert_eq!(rule.order(), 2 * order, "{name}");
            assert!(rule.nodes.is_sorted() && rule.offsets.is_sorted(), "{name}");
            for n in rule.iter() {
                assert!(n.weight > 0.0, "{name}");
                assert!(n.node.abs() < 1.0, "{name}");
                assert!((n.node - y - n.offset).abs() < 1e-15, "{name}");
            }
        }
    }
}

#[test]
fn mirrored_targets_have_mirrored_rules() {
    for &order in ORDERS {
        for target in 0..order {
            let mirror = order - 1 - target;
            let pairs = [
                (
                    KolmRokhlin::own(order, target).unwrap(),
                    KolmRokhlin::own(order, mirror).unwrap(),
                ),
                (
                    KolmRokhlin::neighbour(order, target, Side::Left).unwrap(),
                    KolmRokhlin::neighbour(order, mirror, Side::Right).unwrap(),
                ),
            ];
            for (a, b) in pairs {
                for (n, m) in std::iter::zip(a.iter(), b.iter().collect::<Vec<_>>().iter().rev()) {
                    let mirrored = (-m.node, -m.offset, m.weight);
                    assert_eq!((n.node, n.offset, n.weight), mirrored);
                }
            }
        }
    }
}

/// Functions that are nearly dependent leave a rule for a neighbour a little freedom: another
/// machine, whose `ln` differs in the last place, moves some nodes by 1e-13 and changes no moment.
#[test]
fn generator_repeats_the_tables() {
    let compare = |made: generate::Generated, rule: KolmRokhlin, tolerance: f64| {
        assert!(made.residual < 1e-20);
        for (j, n) in rule.iter().enumerate() {
            assert!((made.offsets[j] / n.offset - 1.0).abs() < tolerance);
            assert!((made.weights[j] / n.weight - 1.0).abs() < tolerance);
        }
    };
    compare(
        generate::own(10, 5).unwrap(),
        KolmRokhlin::own(10, 5).unwrap(),
        1e-13,
    );
    compare(
        generate::neighbour(10, 7).unwrap(),
        KolmRokhlin::neighbour(10, 7, Side::Right).unwrap(),
        1e-10,
    );
}

/// `cos(3x) log|x - y| + exp(x)`, compared with the Legendre series of the cosine and the
/// closed-form moments.
#[test]
fn converges_for_analytic_factors() {
    for &order in ORDERS {
        let panel = crate::PanelBasis::new(40).unwrap();
        let cosine: Vec<f64> = panel.nodes().iter().map(|x| (3.0 * x).cos()).collect();
        let coefficients = panel.coefficients(&cosine).unwrap();
        let mut moments = [0.0; 40];
        let mut worst = 0.0_f64;
        for (name, y, rule) in all(order) {
            log_moments(y, &mut moments).unwrap();
            let log_part: f64 = std::iter::zip(&coefficients, moments)
                .map(|(c, m)| c * m)
                .sum();
            let exact = log_part + 2.0 * 1f64.sinh();
            let sum: f64 = rule
                .iter()
                .map(|n| n.weight * ((3.0 * n.node).cos() * n.offset.abs().ln() + n.node.exp()))
                .sum();
            assert!((sum - exact).abs() < 1e-14, "{name}: {:e}", sum - exact);
            worst = worst.max((sum - exact).abs());
        }
        println!("order {order}: {worst:.1e}");
    }
}

#[test]
fn misuse_is_an_error() {
    assert!(
        KolmRokhlin::own(12, 0)
            .unwrap_err()
            .to_string()
            .contains("12")
    );
    assert!(KolmRokhlin::own(10, 10).is_err());
    assert!(KolmRokhlin::neighbour(16, 99, Side::Left).is_err());
    assert!(generate::own(10, 10).is_err() && generate::own(0, 0).is_err());
    assert!(generate::neighbour(usize::MAX, 0).is_err() && generate::log_endpoint(0).is_err());
}
