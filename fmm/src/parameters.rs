//! Numbers of waves, grid points and digits for a tolerance.
