//! The size of a discretisation: its points, and the memory of its matrices.

/// $N$: the nodes along the curve times the azimuthal degrees of freedom, $p\\, n_p (2 n_f + 1)$.
pub fn points(order: usize, panels: usize, modes: usize) -> usize {
    order * panels * (2 * modes + 1)
}

/// Bytes of the matrices of modes up to `modes`, with their factors.
pub fn bytes(order: usize, panels: usize, modes: usize) -> usize {
    let unknowns = 3 * order * panels;
    2 * size_of::<f64>() * unknowns * unknowns * (modes + 1)
}
