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

impl Parameters {
    pub fn new(tolerance: f64) -> Result<Self, crate::FmmError> {
        if !(1e-12..=1e-1).contains(&tolerance) {
            return Err(crate::FmmError::Tolerance(tolerance));
        }
        let (width, points, waves) = if tolerance >= 1e-3 {
            (6, 16, 10)
        } else if tolerance >= 1e-6 {
            (8, 24, 17)
        } else if tolerance >= 1e-9 {
            (12, 36, 24)
        } else {
            (16, 48, 32)
        };
        Ok(Self {
            width,
            points,
            waves,
            accuracy: 0.1 * tolerance,
            precision: f64_lanes::Precision::Full,
        })
    }
}
