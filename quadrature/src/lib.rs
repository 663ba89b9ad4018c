//! Quadrature on panels.
