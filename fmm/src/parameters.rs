//! (temporary)

/// Sizes of everything.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Parameters {
    pub waves: usize,
    pub width: usize,
    pub points: usize,
    pub accuracy: f64,
}
