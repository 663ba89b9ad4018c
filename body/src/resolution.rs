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
