//! Linear operators that are known by their products.

/// A linear operator, known by its products.
pub trait Operator {
    /// Why a product cannot be made.
    type Error;

    /// Writes the product with `x` to `y`, with an error of at most `tolerance` times the Euclidean
    /// norm of `x`.
    ///
    /// What `y` contains before the call has no meaning.
    ///
    /// # Errors
    /// Its own; they end the iteration.
    fn apply(&mut self, x: &[f64], y: &mut [f64], tolerance: f64) -> Result<(), Self::Error>;
}
