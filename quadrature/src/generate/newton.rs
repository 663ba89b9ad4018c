//! Damped Newton iterations, and the continuation that leads them to the rule.

use super::moments::{Point, System};
use super::solve::solve;
use crate::double_double::Dd;
use crate::gauss_legendre::node_and_weight;

/// The moment error a finished rule may have.
pub(super) const TOLERANCE: f64 = 1e-15;
/// Below this the smoothed logarithm is replaced by the logarithm.
const LAST_EPSILON: f64 = 1e-9;

/// How far and how hard to iterate.
#[derive(Clone, Copy)]
struct Effort {
    /// The moment error that is good enough to stop at once.
    enough: f64,
    /// The moment error that is accepted when iterations stall or end.
    accept: f64,
    /// Pivots relative to the largest below which a direction is left alone.
    rank: f64,
    /// Iterations without progress after which to stop.
    patience: usize,
    /// Most iterations.
    iterations: usize,
}

/// Ranks tried before the last step. There a rough rule is enough, and directions that hardly
/// matter are better left unchanged; but sometimes only a finer solution leads further.
const RANKS_ON_THE_WAY: [f64; 3] = [1e-15, 1e-19, 1e-24];
/// Ranks of the last iterations, one after the other.
const LAST_RANKS: [f64; 10] = [
    1e-15, 1e-16, 1e-17, 1e-18, 1e-19, 1e-20, 1e-22, 1e-24, 1e-26, 1e-28,
];
/// The moment error at which no other way is tried.
const SATISFIED: f64 = 1e-20;

/// Follows the continuation from the Gauss-Legendre rule to the rule for the logarithm. Returns the
/// best rule found and its largest moment error, which is infinite if all ways failed.
pub(super) fn continuation(system: &System) -> (Vec<Point>, f64) {
    let mut best = (Vec::new(), f64::INFINITY);
    for rank in RANKS_ON_THE_WAY {
        let Some(rough) = descend(system, rank) else {
            continue;
        };
        let found = finish(system, rough);
        if found.1 < best.1 {
            best = found;
        }
        if best.1 <= SATISFIED {
            break;
        }
    }
    best
}

/// Lowers the smoothing of the logarithm to zero, leaving a rough rule.
fn descend(system: &System, rank: f64) -> Option<Vec<Point>> {
    let effort = Effort {
        enough: 1e-11,
        accept: 1e-9,
        rank,
        patience: 3,
        iterations: 15,
    };
    let mut rule = gauss_legendre(system);
    let mut epsilon = system.interval.half.to_f64();
    let mut factor: f64 = 0.8;
    loop {
        let next = epsilon * factor;
        let target = if next < LAST_EPSILON { 0.0 } else { next };
        if let Some((found, _)) = newton(system, &rule, target, effort) {
            rule = found;
            if target == 0.0 {
                return Some(rule);
            }
            epsilon = next;
            factor = (factor * factor).max(0.1);
        } else {
            factor = factor.sqrt();
            if factor > 0.999 {
                return None;
            }
        }
    }
}

/// Takes in, one after the other, the directions that were left alone on the way.
fn finish(system: &System, rough: Vec<Point>) -> (Vec<Point>, f64) {
    let mut best = (rough, f64::INFINITY);
    for rank in LAST_RANKS {
        let effort = Effort {
            enough: 1e-29,
            accept: 1e-9,
            rank,
            patience: 15,
            iterations: 40,
        };
        if let Some(found) = newton(system, &best.0, 0.0, effort)
            && found.1 < best.1
        {
            best = found;
        }
    }
    best
}

/// The Gauss-Legendre rule on the interval.
fn gauss_legendre(system: &System) -> Vec<Point> {
    let interval = &system.interval;
    (0..system.nodes)
        .map(|i| {
            let (x, w) = node_and_weight(system.nodes, i);
            Point {
                offset: interval.from + interval.half * (x + Dd::ONE),
                weight: interval.half * w,
            }
        })
        .collect()
}

/// Newton's method with steps limited to half the distance of each node from the singularity and
/// the ends, and to half of each weight. Returns `None` if it does not converge to nodes inside
/// with positive weights.
fn newton(
    system: &System,
    start: &[Point],
    epsilon: f64,
    effort: Effort,
) -> Option<(Vec<Point>, f64)> {
    let moments = system.moments(Dd::from(epsilon));
    let mut rule = start.to_vec();
    let mut best = (rule.clone(), f64::INFINITY);
    let mut stalled = 0;
    for _ in 0..effort.iterations {
        let sums = system.sums(&rule, Dd::from(epsilon));
        let defect: Vec<Dd> = std::iter::zip(&moments, sums)
            .map(|(m, s)| *m - s)
            .collect();
        let residual = defect.iter().fold(0.0, |m: f64, d| m.max(d.to_f64().abs()));
        if !residual.is_finite() || defect.iter().any(|d| d.to_f64().is_nan()) {
            return None;
        }
        stalled = if residual < 0.5 * best.1 {
            0
        } else {
            stalled + 1
        };
        if residual < best.1 && inside(system, &rule) {
            best = (rule.clone(), residual);
        }
        if best.1 <= effort.enough || (best.1 <= effort.accept && stalled >= effort.patience) {
            break;
        }
        step(system, &mut rule, defect, epsilon, effort.rank);
    }
    (best.1 <= effort.accept).then_some(best)
}

/// One damped Newton step.
fn step(system: &System, rule: &mut [Point], defect: Vec<Dd>, epsilon: f64, rank: f64) {
    let n = rule.len();
    let room: Vec<f64> = rule
        .iter()
        .map(|p| {
            let u = p.offset;
            let to_end = (u - system.interval.from).abs().to_f64();
            let to_end = to_end.min((system.interval.to - u).abs().to_f64());
            to_end.min(u.to_f64().abs() + epsilon)
        })
        .collect();
    // Unknowns are scaled by the room they have.
    let scale: Vec<Dd> = room
        .iter()
        .copied()
        .chain(rule.iter().map(|p| p.weight.to_f64().abs()))
        .map(Dd::from)
        .collect();
    let mut matrix = vec![vec![Dd::ZERO; 2 * n]; 2 * n];
    for (j, point) in rule.iter().enumerate() {
        let values = system.values(point.offset, Dd::from(epsilon));
        for (k, row) in matrix.iter_mut().enumerate() {
            row[j] = values.slope[k] * point.weight * scale[j];
            row[n + j] = values.value[k] * scale[n + j];
        }
    }
    let change = solve(matrix, defect, rank);
    let largest = change.iter().fold(0.0, |m: f64, c| m.max(c.to_f64().abs()));
    let damping = Dd::from(if largest > 0.5 { 0.5 / largest } else { 1.0 });
    for (j, point) in rule.iter_mut().enumerate() {
        point.offset = point.offset + damping * change[j] * scale[j];
        point.weight = point.weight + damping * change[n + j] * scale[n + j];
    }
}

/// Whether all nodes lie inside the interval and all weights are positive.
fn inside(system: &System, rule: &[Point]) -> bool {
    rule.iter().all(|p| {
        p.weight > Dd::ZERO && p.offset > system.interval.from && p.offset < system.interval.to
    })
}
