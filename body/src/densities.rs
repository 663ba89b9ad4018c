//! The densities of both layers and the tangential derivatives of the double layer's, at the nodes.

use faer::MatRef;
use panel_quadrature::QuadratureError;

use super::discretization::Discretization;
use super::layers::Layers;
use crate::kernel::DENSITIES;

/// Modes of the densities that the fields of [`kernel::close`](crate::kernel) are made of:
/// $\sigma$, $\varrho$, $y^\theta = \partial_\ell \sigma$ and
/// $y^t = -r^{-1} \partial_\theta \sigma$, three cylindrical components each.
#[derive(Debug)]
pub(super) struct Densities {
    modes: usize,
    nodes: usize,
    /// Density `j` of family `f` of mode `n` at node `k` is at
    /// `((2 n + f) DENSITIES + j) nodes + k`.
    values: Vec<f64>,
}

impl Densities {
    /// The densities and derivatives of `layers`.
    pub fn new(discretization: &Discretization, layers: &Layers) -> Self {
        let nodes = discretization.nodes().len();
        let mut values = vec![0.0; 2 * layers.modes() * DENSITIES * nodes];
        for (place, rows) in values.chunks_mut(DENSITIES * nodes).enumerate() {
            let (n, family) = (place / 2, place % 2);
            for (which, density) in [&layers.double, &layers.single].into_iter().enumerate() {
                if n < density.modes() {
                    for j in 0..3 {
                        rows[(3 * which + j) * nodes..][..nodes]
                            .copy_from_slice(density.component(n, family, j));
                    }
                }
            }
            let (densities, derivatives) = rows.split_at_mut(6 * nodes);
            differentiate(discretization, n, &densities[..3 * nodes], derivatives);
        }
        Self {
            modes: layers.modes(),
            nodes,
            values,
        }
    }

    /// Modes, counting the zeroth.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// Rows of node values: density `j` of family `f` of mode `n` is row `(2 n + f) DENSITIES + j`.
    pub fn rows(&self) -> usize {
        2 * self.modes * DENSITIES
    }

    /// The values at the nodes of a panel, a column for each row.
    pub fn on_panel(&self, panel: usize, order: usize) -> MatRef<'_, f64> {
        MatRef::from_column_major_slice_with_stride(
            &self.values,
            self.nodes,
            self.rows(),
            self.nodes,
        )
        .subrows(panel * order, order)
    }

    /// The values at the nodes of one row.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.values[row * self.nodes..][..self.nodes]
    }

    /// Logarithm of each mode's largest coefficient of $\sigma$ and $\varrho$ relative to the
    /// largest of all.
    pub fn mode_decay(&self) -> Vec<f64> {
        let largest = |n: usize| {
            self.layer_rows(n..n + 1)
                .flat_map(|row| self.row(row))
                .fold(0.0f64, |most, x| most.max(x.abs()))
        };
        relative_logarithms((0..self.modes).map(largest).collect())
    }

    /// Panel after panel, the same of the largest Legendre coefficients along the panel.
    pub fn panel_decay(
        &self,
        discretization: &Discretization,
    ) -> Result<Vec<f64>, QuadratureError> {
        let order = discretization.order();
        let mut amplitudes = vec![0.0f64; self.nodes];
        for row in self.layer_rows(0..self.modes) {
            let panels = self.row(row).chunks(order);
            for (values, amplitudes) in panels.zip(amplitudes.chunks_mut(order)) {
                let coefficients = discretization.basis().coefficients(values)?;
                for (amplitude, coefficient) in amplitudes.iter_mut().zip(coefficients) {
                    *amplitude = amplitude.max(coefficient.abs());
                }
            }
        }
        Ok(relative_logarithms(amplitudes))
    }

    /// The rows of $\sigma$ and $\varrho$ of some modes.
    fn layer_rows(&self, modes: std::ops::Range<usize>) -> impl Iterator<Item = usize> + use<> {
        (2 * modes.start..2 * modes.end)
            .flat_map(|place| (0..6).map(move |j| place * DENSITIES + j))
    }
}

/// $y^\theta$ and $y^t$ of the components of $\sigma$ in one family of mode `n`.
fn differentiate(
    discretization: &Discretization,
    n: usize,
    sigma: &[f64],
    derivatives: &mut [f64],
) {
    let (order, basis) = (discretization.order(), discretization.basis());
    let matrix = basis.differentiation_matrix();
    let nodes = discretization.nodes();
    let n = n as f64;
    for (k, node) in nodes.iter().enumerate() {
        let (panel, local) = (k / order, k % order);
        // Arc length by reference interval: the node's weight is w times this times r.
        let arc = node.weight / (basis.weights()[local] * node.r);
        for j in 0..3 {
            let on_panel = &sigma[j * nodes.len() + panel * order..][..order];
            let sum: f64 = (0..order).map(|i| matrix[(local, i)] * on_panel[i]).sum();
            derivatives[j * nodes.len() + k] = sum / arc;
        }
        let [radial, azimuthal, axial] = [0, 1, 2].map(|j| sigma[j * nodes.len() + k]);
        let around = [n * radial + azimuthal, -(n * azimuthal + radial), n * axial];
        for (j, value) in around.into_iter().enumerate() {
            derivatives[(3 + j) * nodes.len() + k] = value / node.r;
        }
    }
}

/// Logarithms of amplitudes relative to the largest.
fn relative_logarithms(amplitudes: Vec<f64>) -> Vec<f64> {
    let largest = amplitudes.iter().fold(f64::MIN_POSITIVE, |a, &b| a.max(b));
    (amplitudes.iter())
        .map(|a| (a / largest).max(1e-300).ln())
        .collect()
}
