//! Quintic splines through points: C^4, with mirror symmetry at poles or periodic.
//!
//! The unknowns are the first and second derivatives v_i, a_i at the knots; continuity of the third
//! and fourth derivatives gives a block tridiagonal system of 2 x 2 blocks (Späth, One Dimensional
//! Spline Interpolation Algorithms, 1995, chapter 7), solved in O(N).

use super::{Meridian, Topology};

type Matrix = [[f64; 2]; 2];
/// Right-hand sides: two rows, up to four columns.
type Columns = [[f64; 4]; 2];

/// One polynomial: coefficients of `t^k`, `t = s - knot`.
pub(super) type Segment = [Meridian; 6];

/// Blocks before, on and after the diagonal, and the right-hand sides.
#[derive(Clone, Copy, Default)]
struct Row {
    before: Matrix,
    on: Matrix,
    after: Matrix,
    right: Columns,
}

/// The segments of the spline through `points` at the ascending `knots`; in a loop the last point
/// repeats the first. Nothing is said about finiteness: collinear knots give infinities, not
/// panics.
pub(super) fn spline(knots: &[f64], points: &[Meridian], topology: Topology) -> Vec<Segment> {
    let steps: Vec<f64> = knots.windows(2).map(|k| k[1] - k[0]).collect();
    // In units of the mean step, so that the blocks are well scaled.
    let unit = steps.iter().sum::<f64>() / steps.len() as f64;
    let scaled: Vec<f64> = steps.iter().map(|h| h / unit).collect();
    let coordinates: [Vec<f64>; 2] = [
        points.iter().map(|p| p.r).collect(),
        points.iter().map(|p| p.z).collect(),
    ];
    let derivatives = match topology {
        Topology::PoleToPole => [
            pole_to_pole(&scaled, &coordinates[0], Parity::Odd),
            pole_to_pole(&scaled, &coordinates[1], Parity::Even),
        ],
        Topology::Loop => periodic(&scaled, &coordinates),
    };
    let segment = |i: usize| {
        let [r, z] = [0, 1].map(|k| {
            let (c, d) = (&coordinates[k], &derivatives[k]);
            hermite(c[i], c[i + 1] - c[i], scaled[i], d[i], d[i + 1])
        });
        let mut scale = 1.0;
        let mut segment = [Meridian { r: 0.0, z: 0.0 }; 6];
        for (k, coefficient) in segment.iter_mut().enumerate() {
            *coefficient = Meridian {
                r: r[k] * scale,
                z: z[k] * scale,
            };
            scale /= unit;
        }
        segment
    };
    (0..steps.len()).map(segment).collect()
}

/// The quintic with value, derivative and second derivative given at both ends.
fn hermite(start: f64, rise: f64, h: f64, from: [f64; 2], to: [f64; 2]) -> [f64; 6] {
    let ([v0, a0], [v1, a1]) = (from, to);
    let h2 = h * h;
    [
        start,
        v0,
        0.5 * a0,
        (10.0 * rise - (6.0 * v0 + 4.0 * v1) * h - (1.5 * a0 - 0.5 * a1) * h2) / (h2 * h),
        (-15.0 * rise + (8.0 * v0 + 7.0 * v1) * h + (1.5 * a0 - a1) * h2) / (h2 * h2),
        (6.0 * rise - 3.0 * (v0 + v1) * h - 0.5 * (a0 - a1) * h2) / (h2 * h2 * h),
    ]
}

/// Continuity of the third and fourth derivatives at a knot with steps `l` before and `h` after it.
fn interior(l: f64, h: f64) -> Row {
    let (l2, h2) = (l * l, h * h);
    let (l3, h3) = (l2 * l, h2 * h);
    Row {
        before: [[-24.0 / l2, -3.0 / l], [-168.0 / l3, -24.0 / l2]],
        on: [
            [-36.0 / l2 + 36.0 / h2, 9.0 / l + 9.0 / h],
            [-192.0 / l3 - 192.0 / h3, 36.0 / l2 - 36.0 / h2],
        ],
        after: [[24.0 / h2, -3.0 / h], [-168.0 / h3, 24.0 / h2]],
        right: Columns::default(),
    }
}

/// What belongs to the rises before and after a knot in [`interior`].
fn forces(l: f64, h: f64, rise_before: f64, rise_after: f64) -> [f64; 2] {
    [
        60.0 * rise_after / h.powi(3) - 60.0 * rise_before / l.powi(3),
        -360.0 * rise_after / h.powi(4) - 360.0 * rise_before / l.powi(4),
    ]
}

#[derive(Clone, Copy, PartialEq)]
enum Parity {
    /// Vanishes at the pole with its even derivatives.
    Odd,
    /// Its odd derivatives vanish at the pole.
    Even,
}

fn pole_to_pole(steps: &[f64], values: &[f64], parity: Parity) -> Vec<[f64; 2]> {
    let n = values.len();
    let rise = |i: usize| values[i + 1] - values[i];
    let mut rows = vec![Row::default(); n];
    for i in 1..n - 1 {
        let (l, h) = (steps[i - 1], steps[i]);
        rows[i] = interior(l, h);
        let force = forces(l, h, rise(i - 1), rise(i));
        rows[i].right[0][0] = force[0];
        rows[i].right[1][0] = force[1];
    }
    let (h, l) = (steps[0], steps[n - 2]);
    let (first, last) = match parity {
        // a = 0 and no fourth derivative.
        Parity::Odd => (
            Row {
                on: [[192.0 / h.powi(3), 36.0 / h.powi(2)], [0.0, 1.0]],
                after: [[168.0 / h.powi(3), -24.0 / h.powi(2)], [0.0; 2]],
                right: [[360.0 * rise(0) / h.powi(4), 0.0, 0.0, 0.0], [0.0; 4]],
                ..Row::default()
            },
            Row {
                before: [[-168.0 / l.powi(3), -24.0 / l.powi(2)], [0.0; 2]],
                on: [[-192.0 / l.powi(3), 36.0 / l.powi(2)], [0.0, 1.0]],
                right: [[-360.0 * rise(n - 2) / l.powi(4), 0.0, 0.0, 0.0], [0.0; 4]],
                ..Row::default()
            },
        ),
        // v = 0 and no third derivative.
        Parity::Even => (
            Row {
                on: [[1.0, 0.0], [-36.0 / h.powi(2), -9.0 / h]],
                after: [[0.0; 2], [-24.0 / h.powi(2), 3.0 / h]],
                right: [[0.0; 4], [-60.0 * rise(0) / h.powi(3), 0.0, 0.0, 0.0]],
                ..Row::default()
            },
            Row {
                before: [[0.0; 2], [-24.0 / l.powi(2), -3.0 / l]],
                on: [[1.0, 0.0], [-36.0 / l.powi(2), 9.0 / l]],
                right: [[0.0; 4], [-60.0 * rise(n - 2) / l.powi(3), 0.0, 0.0, 0.0]],
                ..Row::default()
            },
        ),
    };
    rows[0] = first;
    rows[n - 1] = last;
    eliminate(&mut rows);
    rows.iter()
        .map(|row| [row.right[0][0], row.right[1][0]])
        .collect()
}

/// Both coordinates at once; the last of the n unknown blocks borders the tridiagonal rest.
fn periodic(steps: &[f64], coordinates: &[Vec<f64>; 2]) -> [Vec<[f64; 2]>; 2] {
    let n = steps.len();
    let rise = |k: usize, i: usize| coordinates[k][i + 1] - coordinates[k][i];
    let mut rows: Vec<Row> = (0..n)
        .map(|i| {
            let before = (i + n - 1) % n;
            let (l, h) = (steps[before], steps[i]);
            let mut row = interior(l, h);
            for k in 0..2 {
                let force = forces(l, h, rise(k, before), rise(k, i));
                row.right[0][k] = force[0];
                row.right[1][k] = force[1];
            }
            row
        })
        .collect();
    let border = rows[n - 1];
    rows.truncate(n - 1);
    for i in 0..2 {
        for j in 0..2 {
            rows[0].right[i][2 + j] = rows[0].before[i][j];
            rows[n - 2].right[i][2 + j] += rows[n - 2].after[i][j];
        }
    }
    eliminate(&mut rows);
    let (first, last) = (rows[0].right, rows[n - 2].right);
    let (mut on, mut right) = (border.on, border.right);
    for i in 0..2 {
        for j in 0..2 {
            for k in 0..2 {
                on[i][j] -=
                    border.before[i][k] * last[k][2 + j] + border.after[i][k] * first[k][2 + j];
                right[i][j] -= border.before[i][k] * last[k][j] + border.after[i][k] * first[k][j];
            }
        }
    }
    let corner = solve(on, right);
    [0, 1].map(|k| {
        let inner = rows.iter().map(|row| {
            [0, 1].map(|i| {
                row.right[i][k] - row.right[i][2] * corner[0][k] - row.right[i][3] * corner[1][k]
            })
        });
        let mut derivatives: Vec<[f64; 2]> = inner.collect();
        derivatives.push([corner[0][k], corner[1][k]]);
        derivatives.push(derivatives[0]);
        derivatives
    })
}

/// Block Gauss elimination; the solution replaces the right-hand sides.
fn eliminate(rows: &mut [Row]) {
    for i in 0..rows.len() {
        if i > 0 {
            let above = rows[i - 1];
            let row = &mut rows[i];
            for j in 0..2 {
                for k in 0..2 {
                    let factor = row.before[j][k];
                    for m in 0..2 {
                        row.on[j][m] -= factor * above.after[k][m];
                    }
                    for m in 0..4 {
                        row.right[j][m] -= factor * above.right[k][m];
                    }
                }
            }
        }
        let row = &mut rows[i];
        let [upper, lower] = row.after;
        let after = solve(
            row.on,
            [
                [upper[0], upper[1], 0.0, 0.0],
                [lower[0], lower[1], 0.0, 0.0],
            ],
        );
        row.after = [[after[0][0], after[0][1]], [after[1][0], after[1][1]]];
        row.right = solve(row.on, row.right);
    }
    for i in (0..rows.len().saturating_sub(1)).rev() {
        let below = rows[i + 1].right;
        let row = &mut rows[i];
        for (right, after) in row.right.iter_mut().zip(row.after) {
            for (factor, unknowns) in after.iter().zip(below) {
                right
                    .iter_mut()
                    .zip(unknowns)
                    .for_each(|(x, y)| *x -= factor * y);
            }
        }
    }
}

/// Two equations, with row pivoting.
fn solve(a: Matrix, b: Columns) -> Columns {
    let (p, q) = if a[0][0].abs() >= a[1][0].abs() {
        (0, 1)
    } else {
        (1, 0)
    };
    let factor = a[q][0] / a[p][0];
    let pivot = a[q][1] - factor * a[p][1];
    let mut x = Columns::default();
    for m in 0..4 {
        x[1][m] = (b[q][m] - factor * b[p][m]) / pivot;
        x[0][m] = (b[p][m] - a[p][1] * x[1][m]) / a[p][0];
    }
    x
}
