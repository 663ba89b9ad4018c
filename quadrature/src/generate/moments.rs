//! The functions `P_k` and `P_k log sqrt(u^2 + e^2)`, and their integrals over the interval.

use crate::double_double::Dd;
use crate::gauss_legendre::node_and_weight;

/// An interval of offsets from the singular point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Interval {
    pub(super) from: Dd,
    pub(super) to: Dd,
    centre: Dd,
    pub(super) half: Dd,
}

impl Interval {
    pub(super) fn new(from: Dd, to: Dd) -> Self {
        let half = Dd::from(0.5);
        Self {
            from,
            to,
            centre: half * (from + to),
            half: half * (to - from),
        }
    }
}

/// A quadrature point: offset from the singular point, and weight.
#[derive(Debug, Clone, Copy)]
pub(super) struct Point {
    pub(super) offset: Dd,
    pub(super) weight: Dd,
}

/// The `2n` functions on an interval, with an accurate rule for their moments.
pub(super) struct System {
    pub(super) interval: Interval,
    pub(super) nodes: usize,
    /// Gauss-Legendre panels, halved towards the singular point (or its neighbourhood) down to
    /// 2^-110.
    fine: Vec<Point>,
}

/// Values of the functions and their derivatives by `u` at one point.
pub(super) struct Values {
    pub(super) value: Vec<Dd>,
    pub(super) slope: Vec<Dd>,
}

/// Halvings of the panels: 2^-110 is below what double-double resolves.
const LEVELS: i32 = 110;
/// Nodes per panel of the fine rule. On a panel as long as its distance from the singularity the
/// error falls like 5.8^(degree - 2 order).
const FINE_ORDER: usize = 48;

impl System {
    pub(super) fn new(interval: &Interval, nodes: usize) -> Self {
        let reference: Vec<_> = (0..FINE_ORDER)
            .map(|i| node_and_weight(FINE_ORDER, i))
            .collect();
        let mut fine = Vec::new();
        let mut panel = |from: Dd, to: Dd| {
            let piece = Interval::new(from, to);
            fine.extend(reference.iter().map(|&(x, w)| Point {
                offset: piece.centre + piece.half * x,
                weight: piece.half.abs() * w,
            }));
        };
        let (zero, from, to) = (Dd::ZERO, interval.from, interval.to);
        if from < zero && to > zero {
            graded(zero, from, LEVELS, &mut panel);
            graded(zero, to, LEVELS, &mut panel);
        } else {
            // Panels get smaller towards the nearer end, until they are as small as its distance
            // from the singularity.
            let (near, far) = if from >= zero { (from, to) } else { (to, from) };
            let ratio = (near / interval.half).abs().to_f64();
            let levels = (2.0 - ratio.log2()).clamp(1.0, LEVELS.into()) as i32;
            graded(near, far, levels, &mut panel);
        }
        Self {
            interval: *interval,
            nodes,
            fine,
        }
    }

    /// The integrals of all functions over the interval.
    pub(super) fn moments(&self, epsilon: Dd) -> Vec<Dd> {
        self.sums(&self.fine, epsilon)
    }

    /// What a rule makes of all functions.
    pub(super) fn sums(&self, rule: &[Point], epsilon: Dd) -> Vec<Dd> {
        let n = self.nodes;
        let mut sums = vec![Dd::ZERO; 2 * n];
        let mut p = vec![Dd::ZERO; n];
        for point in rule {
            self.legendre(point.offset, &mut p);
            let log = logarithm(point.offset, epsilon);
            for (k, p) in p.iter().enumerate() {
                let term = point.weight * *p;
                sums[k] = sums[k] + term;
                sums[n + k] = sums[n + k] + term * log;
            }
        }
        sums
    }

    /// All functions and their derivatives at one point.
    pub(super) fn values(&self, u: Dd, epsilon: Dd) -> Values {
        let n = self.nodes;
        let mut value = vec![Dd::ZERO; n];
        self.legendre(u, &mut value);
        let mut slope = vec![Dd::ZERO; n];
        for k in 1..n {
            let below = if k >= 2 { slope[k - 2] } else { Dd::ZERO };
            slope[k] = below + Dd::from(2.0 * k as f64 - 1.0) * value[k - 1] / self.interval.half;
        }
        let log = logarithm(u, epsilon);
        let log_slope = u / (u * u + epsilon * epsilon);
        for k in 0..n {
            slope.push(slope[k] * log + value[k] * log_slope);
            value.push(value[k] * log);
        }
        Values { value, slope }
    }

    fn legendre(&self, u: Dd, p: &mut [Dd]) {
        let t = (u - self.interval.centre) / self.interval.half;
        p[0] = Dd::ONE;
        if p.len() > 1 {
            p[1] = t;
        }
        for k in 2..p.len() {
            let order = k as f64;
            let a = Dd::from(2.0 * order - 1.0) * t * p[k - 1] - Dd::from(order - 1.0) * p[k - 2];
            p[k] = a / Dd::from(order);
        }
    }
}

/// `log sqrt(u^2 + e^2)`.
fn logarithm(u: Dd, epsilon: Dd) -> Dd {
    if epsilon == Dd::ZERO {
        u.abs().ln()
    } else {
        Dd::from(0.5) * (u * u + epsilon * epsilon).ln()
    }
}

/// Cuts `[near, far]` into panels halved `levels` times towards `near`.
fn graded(near: Dd, far: Dd, levels: i32, panel: &mut impl FnMut(Dd, Dd)) {
    let length = far - near;
    let cut = |level: i32| near + length * Dd::from(2f64.powi(-level));
    for level in 0..levels {
        panel(cut(level + 1), cut(level));
    }
    panel(near, cut(levels));
}
