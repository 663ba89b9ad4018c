//! BiCGStab. It starts again from the true residual when its recurrences break down or when their
//! residual can no longer be trusted.

use super::gmres::STALLED;
use super::session::Session;
use super::vectors::{add_two, new_direction, not_finite};
use super::{KrylovError, Operator, Outcome, Stop};

/// Iterations without a new least residual after which the true one is computed.
const PATIENCE: usize = 100;

pub(super) fn iterate<O: Operator>(
    mut session: Session<'_, O>,
    start: Option<&[f64]>,
) -> Result<Outcome, KrylovError<O::Error>> {
    let mut r = vec![0.0; session.unknowns()];
    let (mut x, mut residual) = session.start(start, &mut r)?;
    if session.converged(residual) {
        return Ok(session.finish(x, r, residual, Stop::Converged));
    }
    let n = x.len();
    // The solution of the least true residual, and its residual.
    let (mut best, mut shadow) = (x.clone(), r.clone());
    let (mut p, mut v, mut t) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    loop {
        if session.exhausted() {
            return Ok(session.finish(best, shadow, residual, Stop::MaxIterations));
        }
        p.copy_from_slice(&r);
        let shadow_norm = residual * session.unit();
        let mut norm = shadow_norm;
        let mut rho = norm * norm;
        let (mut least, mut waited) = (norm, 0);
        let broken = loop {
            session.product(&p, &mut v, norm)?;
            let (along, size) = (session.sums.dot(&shadow, &v), session.sums.norm(&v));
            if !size.is_finite() {
                return Err(not_finite("a product of the operator", &v));
            }
            if along.abs() <= f64::EPSILON * shadow_norm * size {
                break true;
            }
            let alpha = rho / along;
            let half = session.sums.add_and_dot(&mut r, -alpha, &v, None).sqrt();
            if half <= session.target() {
                add_two(&mut x, alpha, &p, 0.0, &r);
                norm = half;
                session.record(norm)?;
                break false;
            }
            session.product(&r, &mut t, half)?;
            let (along, square) = (session.sums.dot(&t, &r), session.sums.dot(&t, &t));
            if !square.is_finite() {
                return Err(not_finite("a product of the operator", &t));
            }
            if along.abs() <= f64::EPSILON * half * square.sqrt() {
                add_two(&mut x, alpha, &p, 0.0, &r);
                norm = half;
                session.record(norm)?;
                break true;
            }
            let omega = along / square;
            add_two(&mut x, alpha, &p, omega, &r);
            norm = session.sums.add_and_dot(&mut r, -omega, &t, None).sqrt();
            if !norm.is_finite() {
                break true;
            }
            session.record(norm)?;
            if norm < STALLED * least {
                (least, waited) = (norm, 0);
            } else {
                waited += 1;
            }
            if norm <= session.target() || session.exhausted() || waited >= PATIENCE {
                break false;
            }
            let new_rho = session.sums.dot(&shadow, &r);
            if !new_rho.is_finite() || new_rho.abs() <= f64::EPSILON * shadow_norm * norm {
                break true;
            }
            new_direction(&mut p, &r, new_rho / rho * (alpha / omega), omega, &v);
            rho = new_rho;
        };
        // Quotients of nearly nothing may have taken the solution out of all range.
        let new = if session.sums.norm(&x).is_finite() {
            session.true_residual(&x, &mut r)?
        } else {
            f64::INFINITY
        };
        let stalled = new > STALLED * residual;
        if new < residual {
            best.copy_from_slice(&x);
            shadow.copy_from_slice(&r);
            residual = new;
        } else {
            x.copy_from_slice(&best);
            r.copy_from_slice(&shadow);
        }
        if session.converged(residual) {
            return Ok(session.finish(best, shadow, residual, Stop::Converged));
        }
        if session.exhausted() {
            return Ok(session.finish(best, shadow, residual, Stop::MaxIterations));
        }
        if stalled && !session.insist() {
            let stop = if broken {
                Stop::Breakdown
            } else {
                Stop::Stagnated
            };
            return Ok(session.finish(best, shadow, residual, stop));
        }
        if norm <= session.target() {
            session.distrust();
        }
    }
}
