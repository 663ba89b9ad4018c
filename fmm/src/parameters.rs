//! (temporary)

/// Sizes of everything.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parameters {
    pub waves: usize,
    pub width: usize,
    pub points: usize,
    pub accuracy: f64,
    pub precision: f64_lanes::Precision,
}
