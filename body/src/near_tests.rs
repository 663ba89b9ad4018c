//! The near rules against brute force, mode by mode: panels halved forty times towards the target
//! and towards their ends.

use std::sync::Arc;

use panel_quadrature::GaussLegendre;

use super::discretization::{Discretization, Node};
use super::near::{NearNodes, NearRules};
use crate::kernel::{CombinedField, Modes, SourceRings, TargetRing, Workspace};
use bodies_of_revolution::{GeneratingCurve, Panels, Spheroid, Torus};

const N_MAX: usize = 40;

/// Entry after entry, mode after mode, the integrals against the panel's interpolating polynomials.
fn integrals(
    target: &Node,
    order: usize,
    nodes: &[Node],
    separation: &[[f64; 2]],
    interpolation: &[f64],
) -> Vec<f64> {
    let mut sources = SourceRings::default();
    for (node, &separation) in nodes.iter().zip(separation) {
        sources.push(node.r, separation, node.normal);
    }
    let mut workspace = Workspace::default();
    let at = TargetRing {
        r: target.r,
        normal: target.normal,
    };
    Modes::new(N_MAX).evaluate(&CombinedField { eta: 1.0 }, at, &sources, &mut workspace);
    let mut sums = vec![0.0; (N_MAX + 1) * 9 * order];
    for (entry, sums) in sums.chunks_mut(order).enumerate() {
        for (column, &source) in workspace.order.iter().enumerate() {
            let value = workspace.block[entry * workspace.stride + column] * nodes[source].weight;
            for (sum, l) in sums.iter_mut().zip(&interpolation[source * order..]) {
                *sum += value * l;
            }
        }
    }
    sums
}

/// The same by brute force for a target on the panel.
fn brute_force(discretization: &Discretization, panel: usize, target: usize) -> Vec<f64> {
    let order = discretization.order();
    let basis = discretization.basis();
    let at = &discretization.nodes_of(panel)[target];
    let curve = discretization.curve();
    let half = 0.5 * discretization.panel(panel).length();
    let gauss = GaussLegendre::new(20).expect("a rule");
    let (mut nodes, mut separation, mut interpolation) = (Vec::new(), Vec::new(), Vec::new());
    let mut row = vec![0.0; order];
    for end in [-1.0 - basis.nodes()[target], 1.0 - basis.nodes()[target]] {
        // Offsets from the target, halved towards it and towards the panel's end.
        let mut cuts: Vec<f64> = (1..=40).map(|k| end * 0.5f64.powi(k)).collect();
        cuts.extend((2..=40).map(|k| end * (1.0 - 0.5f64.powi(k))));
        cuts.extend([0.0, end]);
        cuts.sort_by(f64::total_cmp);
        for cut in cuts.windows(2) {
            for (x, w) in gauss.iter() {
                let offset = 0.5 * (cut[0] + cut[1]) + 0.5 * (cut[1] - cut[0]) * x;
                let ds = half * offset;
                let chord = curve.chord(at.s, ds);
                let weight = 0.5 * (cut[1] - cut[0]) * w * half;
                nodes.push(Node::new(&**curve, at.s + ds, weight));
                separation.push([-chord.r, -chord.z]);
                basis
                    .interpolation_row_near(target, offset, &mut row)
                    .expect("a row");
                interpolation.extend_from_slice(&row);
            }
        }
    }
    integrals(at, order, &nodes, &separation, &interpolation)
}

/// The largest error of each mode over a panel's targets, relative to the mode's largest entry of
/// that target.
fn errors(curve: Arc<dyn GeneratingCurve>, panels: usize, order: usize, panel: usize) -> Vec<f64> {
    let panels = Panels::equal_arcs(&*curve, panels).expect("panels");
    let discretization = Discretization::new(curve, panels, order).expect("nodes");
    let rules = NearRules::new(order, N_MAX).expect("rules");
    let mut near = NearNodes::default();
    let mut worst = vec![0.0f64; N_MAX + 1];
    for target in 0..order {
        rules
            .fill(&discretization, panel, target, panel, &mut near)
            .expect("nodes");
        let at = &discretization.nodes_of(panel)[target];
        let some = integrals(
            at,
            order,
            &near.nodes,
            &near.separation,
            &near.interpolation,
        );
        let exact = brute_force(&discretization, panel, target);
        let modes = some.chunks(9 * order).zip(exact.chunks(9 * order));
        for ((some, exact), worst) in modes.zip(&mut worst) {
            let size = exact.iter().fold(0.0f64, |most, x| most.max(x.abs()));
            let error = some.iter().zip(exact).map(|(a, b)| (a - b).abs());
            *worst = worst.max(error.fold(0.0, f64::max) / size);
        }
    }
    worst
}

fn list(errors: &[f64]) -> String {
    errors.iter().map(|e| format!("{e:.0e} ")).collect()
}

/// With so many nodes a panel, modes up to this one have decay lengths that the rules resolve to
/// the bar; the density's own interpolation gives out earlier.
const RESOLVED: [(usize, usize); 2] = [(10, 6), (16, 20)];

#[test]
fn panels_at_a_pole_are_resolved_mode_by_mode() {
    for (polar, equatorial) in [(1.0, 0.5), (1.0, 1.0), (0.3, 1.0)] {
        for order in [10, 16] {
            for panel in [0, 7] {
                let curve = Arc::new(Spheroid::new(polar, equatorial).expect("a spheroid"));
                let errors = errors(curve, 8, order, panel);
                println!(
                    "{polar} x {equatorial}, {order} nodes, panel {panel}: {}",
                    list(&errors)
                );
                assert!(errors.iter().all(|&e| e <= 1e-10), "{errors:?}");
            }
        }
    }
}

#[test]
fn panels_off_the_axis_are_resolved_mode_by_mode() {
    let spheroid: Arc<dyn GeneratingCurve> = Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid"));
    let torus: Arc<dyn GeneratingCurve> = Arc::new(Torus::new(1.0, 0.5).expect("a torus"));
    for curve in [spheroid, torus] {
        for (order, resolved) in RESOLVED {
            let errors = errors(curve.clone(), 8, order, 3);
            println!("{curve:?}, {order} nodes: {}", list(&errors));
            assert!(
                errors[..=resolved].iter().all(|&e| e <= 1e-12),
                "{errors:?}"
            );
            assert!(errors.iter().all(|&e| e <= 1e-4), "{errors:?}");
        }
    }
}
