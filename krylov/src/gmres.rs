//! GMRES by modified Gram–Schmidt and Givens rotations.

use std::f64::consts::FRAC_1_SQRT_2;

use super::session::Session;
use super::vectors::{combine, not_finite, scale};
use super::{KrylovError, Operator, Outcome, Stop};

/// A cycle that leaves more than this of the residual has stagnated.
pub(super) const STALLED: f64 = 0.999;

/// The least-squares problem of one cycle. Rotations make it triangular, and it grows by one column
/// per iteration.
struct LeastSquares {
    /// Columns of the triangle, each of `restart + 1` entries. The newest has an entry below the
    /// diagonal until it is rotated.
    columns: Vec<f64>,
    stride: usize,
    rotations: Vec<(f64, f64)>,
    /// Right-hand side, rotated.
    rotated: Vec<f64>,
    solution: Vec<f64>,
}

impl LeastSquares {
    fn new(stride: usize) -> Self {
        Self {
            columns: Vec::new(),
            stride,
            rotations: Vec::new(),
            rotated: Vec::new(),
            solution: Vec::new(),
        }
    }

    fn begin(&mut self, residual: f64) {
        self.columns.clear();
        self.rotations.clear();
        self.rotated.clear();
        self.rotated.push(residual);
    }

    /// A column for coefficients of the next vector.
    fn next_column(&mut self) -> &mut [f64] {
        let from = self.columns.len();
        self.columns.resize(from + self.stride, 0.0);
        &mut self.columns[from..]
    }

    /// Rotates the last column and gives the residual's norm.
    fn rotate(&mut self) -> f64 {
        let k = self.rotations.len();
        let column = &mut self.columns[k * self.stride..];
        for (i, &(cos, sin)) in self.rotations.iter().enumerate() {
            let (upper, lower) = (column[i], column[i + 1]);
            column[i] = cos * upper + sin * lower;
            column[i + 1] = cos * lower - sin * upper;
        }
        let length = column[k].hypot(column[k + 1]);
        let (cos, sin) = if length > 0.0 {
            (column[k] / length, column[k + 1] / length)
        } else {
            (1.0, 0.0)
        };
        column[k] = length;
        column[k + 1] = 0.0;
        self.rotations.push((cos, sin));
        let last = self.rotated[k];
        self.rotated[k] = cos * last;
        self.rotated.push(-sin * last);
        (sin * last).abs()
    }

    /// The coefficients of the least residual.
    ///
    /// In the invariant space of a singular operator the last directions do not lower the residual,
    /// but have coefficients so large that their rounding errors exceed the gain. These directions
    /// are left out.
    fn solve(&mut self) -> &[f64] {
        let stride = self.stride;
        let mut steps = self.rotations.len();
        let diagonal = |k: usize| self.columns[k * stride + k];
        let largest = (0..steps).map(diagonal).fold(0.0, f64::max);
        let mut left = self.rotated[steps].powi(2);
        while steps > 0 {
            left += self.rotated[steps - 1].powi(2);
            self.solution.clear();
            self.solution.extend_from_slice(&self.rotated[..steps]);
            for k in (0..steps).rev() {
                let column = &self.columns[k * stride..];
                self.solution[k] /= column[k];
                let (above, last) = self.solution.split_at_mut(k);
                for (y, h) in above.iter_mut().zip(column) {
                    *y -= h * last[0];
                }
            }
            let size = self.solution.iter().map(|y| y * y).sum::<f64>().sqrt();
            if 10.0 * f64::EPSILON * largest * size <= left.sqrt() {
                break;
            }
            steps -= 1;
        }
        &self.solution[..steps]
    }
}

/// Makes `w` orthogonal to the basis and writes to `column` the coefficients and, last, the norm of
/// the remainder. Returns false if the remainder is rounding error only.
fn orthogonalize<O: Operator>(
    session: &mut Session<'_, O>,
    basis: &[Vec<f64>],
    w: &mut [f64],
    column: &mut [f64],
) -> bool {
    let size = basis.len();
    let mut left: f64;
    let mut before = f64::INFINITY;
    let mut first = true;
    loop {
        let mut product = session.sums.dot(w, &basis[0]);
        for (i, vector) in basis.iter().enumerate() {
            column[i] += product;
            let next = basis.get(i + 1).map(Vec::as_slice);
            product = session.sums.add_and_dot(w, -product, vector, next);
        }
        left = product.sqrt();
        if first {
            let squares = column[..size].iter().map(|h| h * h).sum::<f64>();
            before = (squares + product).sqrt();
        }
        // Once more if digits were lost: twice is enough (L. Giraud et al., 2005).
        if !first || left > FRAC_1_SQRT_2 * before || !left.is_finite() {
            break;
        }
        first = false;
    }
    column[size] = left;
    left > 4.0 * f64::EPSILON * before
}

pub(super) fn iterate<O: Operator>(
    mut session: Session<'_, O>,
    start: Option<&[f64]>,
    restart: usize,
) -> Result<Outcome, KrylovError<O::Error>> {
    let mut r = vec![0.0; session.unknowns()];
    let (mut x, mut residual) = session.start(start, &mut r)?;
    if session.converged(residual) {
        return Ok(session.finish(x, r, residual, Stop::Converged));
    }
    let n = x.len();
    let restart = restart.min(n);
    // The first vector is the residual of x while no cycle is under way.
    let mut basis = vec![r];
    let mut candidate = vec![0.0; n];
    let mut small = LeastSquares::new(restart + 1);
    loop {
        if session.exhausted() {
            return Ok(session.finish(x, basis.swap_remove(0), residual, Stop::MaxIterations));
        }
        let size = residual * session.unit();
        scale(&mut basis[0], 1.0 / size);
        small.begin(size);
        let mut believed = size;
        for k in 0..restart {
            if basis.len() < k + 2 {
                basis.push(vec![0.0; n]);
            }
            let (done, rest) = basis.split_at_mut(k + 1);
            let w = &mut rest[0];
            session.product(&done[k], w, believed)?;
            let column = small.next_column();
            let more = orthogonalize(&mut session, done, w, column);
            let left = column[k + 1];
            if !left.is_finite() {
                // Only rounding has been taken from an entry that is not finite: it still is not.
                return Err(not_finite("a product of the operator", w));
            }
            if more {
                scale(w, 1.0 / left);
            } else {
                column[k + 1] = 0.0;
            }
            believed = small.rotate();
            session.record(believed)?;
            if !more || believed <= session.target() || session.exhausted() {
                break;
            }
        }
        combine(&mut candidate, &x, small.solve(), &basis);
        let new = session.true_residual(&candidate, &mut basis[1])?;
        let stalled = new.is_nan() || new > STALLED * residual;
        if new < residual {
            std::mem::swap(&mut x, &mut candidate);
            basis.swap(0, 1);
            residual = new;
        } else {
            scale(&mut basis[0], size);
        }
        if session.converged(residual) {
            return Ok(session.finish(x, basis.swap_remove(0), residual, Stop::Converged));
        }
        if session.exhausted() {
            return Ok(session.finish(x, basis.swap_remove(0), residual, Stop::MaxIterations));
        }
        if stalled && !session.insist() {
            return Ok(session.finish(x, basis.swap_remove(0), residual, Stop::Stagnated));
        }
        if believed <= session.target() {
            session.distrust();
        }
    }
}
