//! How much of the study to do.

/// The most memory that matrices and factors may take together, in bytes.
pub const MEMORY: usize = 6_000_000_000;

/// Azimuthal modes for each panel in the timing study, and of the thesis's largest resolution.
pub const MODES_PER_PANEL: usize = 5;

/// Resolutions of both parts of the study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Nodes per panel, one study for each.
    pub orders: Vec<usize>,
    /// Numbers of panels of the error study, increasing.
    pub panels: Vec<usize>,
    /// Highest modes of the error study, increasing.
    pub modes: Vec<usize>,
    /// Numbers of panels of the timing study, increasing; modes are in proportion.
    pub timing_panels: Vec<usize>,
}

impl Plan {
    /// The thesis's ranges: 2 to 30 panels, 10 to 150 modes.
    pub fn full(orders: Vec<usize>) -> Self {
        Self {
            orders,
            panels: vec![2, 4, 6, 8, 10, 12, 16, 20, 24, 30],
            modes: vec![10, 20, 40, 60, 80, 100, 150],
            timing_panels: vec![4, 6, 8, 12, 16, 20, 24, 30],
        }
    }

    /// Enough to see convergence down to rounding.
    pub fn quick(orders: Vec<usize>) -> Self {
        Self {
            orders,
            panels: vec![2, 4, 6, 8, 12],
            modes: vec![10, 20, 40, 60, 80],
            timing_panels: vec![2, 4, 6, 8, 10, 12],
        }
    }

    /// For tests: the fewest resolutions that reach rounding.
    pub fn tiny(orders: Vec<usize>) -> Self {
        Self {
            orders,
            panels: vec![2, 4, 8, 12],
            modes: vec![20, 80],
            timing_panels: vec![2, 3, 4],
        }
    }
}
