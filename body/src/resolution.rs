//! How finely a body is discretised.

use bodies_of_revolution::Panels;

/// A resolution: how finely curve and azimuth are discretised.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolution {
    /// Panels on the generating curve.
    pub panels: Panels,
    /// Gauss–Legendre nodes on each panel.
    pub order: usize,
    /// Azimuthal modes kept: the density's Fourier series ends with this one.
    pub modes: usize,
}

/// Modes of the solution that checks one of so many.
pub fn checking_modes(modes: usize) -> usize {
    modes + 4.max(modes / 4)
}

/// Entries of all the matrices of the solution that checks one with so many panels, nodes on each,
/// and modes.
pub fn matrix_entries(panels: usize, order: usize, modes: usize) -> f64 {
    let unknowns = (3 * panels * (order + super::refinement::EXTRA_ORDER)) as f64;
    unknowns * unknowns * (checking_modes(modes) + 1) as f64
}
