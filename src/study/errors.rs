//! Errors over panels and modes.

use super::error::StudyError;
use super::plan::MEMORY;
use super::setup::{Errors, Setup};
use super::size::bytes;
use super::spheroid::spheroid;
use stokes_body::dirichlet::{DirichletSolver, Formulation};
use stokes_body::progress::{Progress, Silent};
use stokes_body::surface::SurfaceModes;

/// Errors at or below this are rounding as much as discretisation, and say nothing about the order
/// of convergence.
pub const ROUNDING: f64 = 1e-12;

/// The finest tolerance of the evaluation: far below rounding, so that what is measured is the
/// density's error.
const EVALUATION: f64 = 1e-16;

/// Errors for every pair of panels and modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorTable {
    /// Nodes per panel.
    pub order: usize,
    /// Numbers of panels.
    pub panels: Vec<usize>,
    /// Highest modes.
    pub modes: Vec<usize>,
    /// A row for each number of panels, an entry for each highest mode; none where it would need
    /// too much memory.
    pub rows: Vec<Vec<Option<Errors>>>,
}

impl ErrorTable {
    /// Measures all errors of one order. One factorisation serves every number of modes: each mode
    /// is an equation by itself.
    ///
    /// # Errors
    /// If the order has no quadrature.
    pub fn measure(
        setup: &Setup,
        order: usize,
        panels: &[usize],
        modes: &[usize],
        progress: &dyn Progress,
    ) -> Result<Self, StudyError> {
        progress.begin("errors", panels.iter().map(|p| p * p).sum());
        let mut rows = Vec::with_capacity(panels.len());
        for &count in panels {
            rows.push(row(setup, order, count, modes)?);
            progress.advance(count * count);
        }
        Ok(Self {
            order,
            panels: panels.to_vec(),
            modes: modes.to_vec(),
            rows,
        })
    }

    /// Every entry with its panels and modes.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, Option<Errors>)> {
        self.panels
            .iter()
            .zip(&self.rows)
            .flat_map(|(&panels, row)| {
                let entries = self.modes.iter().zip(row);
                entries.map(move |(&modes, &errors)| (panels, modes, errors))
            })
    }

    /// Panels and absolute errors at one of the mode counts, by its place.
    pub fn column(&self, place: usize) -> Vec<(f64, f64)> {
        let rows = self.panels.iter().zip(&self.rows);
        rows.filter_map(|(&panels, row)| {
            let errors = row.get(place).copied().flatten()?;
            Some((panels as f64, errors.absolute))
        })
        .collect()
    }

    /// The order in panels that each row shows against the one before, with the most modes; none
    /// where the error is rounding.
    pub fn observed_orders(&self) -> Vec<Option<f64>> {
        let last = |k: usize| self.rows[k].last().copied().flatten();
        let order = |k: usize| {
            let (before, after) = (last(k.checked_sub(1)?)?, last(k)?);
            let ratio = self.panels[k] as f64 / self.panels[k - 1] as f64;
            (after.absolute > ROUNDING)
                .then(|| (before.absolute / after.absolute).ln() / ratio.ln())
        };
        (0..self.rows.len()).map(order).collect()
    }
}

fn row(
    setup: &Setup,
    order: usize,
    panels: usize,
    modes: &[usize],
) -> Result<Vec<Option<Errors>>, StudyError> {
    let fits = |&n: &usize| bytes(order, panels, n) <= MEMORY;
    let Some(most) = modes.iter().copied().filter(fits).max() else {
        return Ok(vec![None; modes.len()]);
    };
    let nodes = spheroid(panels, order)?;
    let solver = DirichletSolver::new(nodes, Formulation::CombinedField, most, &Silent)?;
    let entry = |&n: &usize| fits(&n).then(|| errors(setup, &solver, n)).transpose();
    modes.iter().map(entry).collect()
}

/// The errors with modes up to `n_max` only.
fn errors(setup: &Setup, solver: &DirichletSolver, n_max: usize) -> Result<Errors, StudyError> {
    let flow = |x| setup.velocity_on_body(x);
    let data = SurfaceModes::sample(solver.discretization(), n_max, flow).modes;
    let density = solver.solve(&data).truncated(n_max);
    let targets = setup.targets_of_body();
    let flow = solver.flow(&density);
    let values = flow.at(&targets, EVALUATION)?;
    Ok(setup.errors(values.iter().map(|value| value.velocity)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn observed_orders_stop_at_rounding() {
        let entry = |absolute| {
            vec![Some(Errors {
                absolute,
                relative: absolute,
            })]
        };
        let table = ErrorTable {
            order: 16,
            panels: vec![2, 4, 8, 16],
            modes: vec![20],
            rows: vec![entry(1e-2), entry(1e-2 / 32.0), entry(1e-14), vec![None]],
        };
        let orders = table.observed_orders();
        assert!((orders[1].unwrap() - 5.0).abs() < 1e-12);
        assert_eq!([orders[0], orders[2], orders[3]], [None; 3]);
        assert_eq!(table.column(0).len(), 3);
        assert_eq!(table.entries().count(), 4);
    }

    #[test]
    fn falls_over_panels_and_modes() {
        let table = ErrorTable::measure(&Setup::random(1), 10, &[2, 6], &[6, 24], &Silent).unwrap();
        let error = |i: usize, j: usize| table.rows[i][j].unwrap().absolute;
        assert!(error(1, 1) < 1e-2 * error(0, 1), "{table:?}");
        assert!(error(1, 1) < 1e-2 * error(1, 0), "{table:?}");
    }
}
