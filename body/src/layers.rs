//! The layer potentials that make up a flow.

use super::surface::SurfaceModes;

/// How much of each layer potential of one density makes up a flow: $u = w_D D[\sigma] + w_S
/// S[\sigma]$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerWeights {
    /// Weight $w_D$ of the double layer, a number.
    pub double: f64,
    /// Weight $w_S$ of the single layer; beside a double layer, in units of 1/length.
    pub single: f64,
}

impl LayerWeights {
    /// The double layer alone.
    pub const DOUBLE: Self = Self {
        double: 1.0,
        single: 0.0,
    };
    /// The single layer alone.
    pub const SINGLE: Self = Self {
        double: 0.0,
        single: 1.0,
    };
}

/// Densities on a surface: the flow $D[\sigma] + S[\varrho]$, for viscosity 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    /// The density $\sigma$ of the double layer, a velocity.
    pub double: SurfaceModes,
    /// The density $\varrho$ of the single layer, a force per area.
    pub single: SurfaceModes,
}

impl Layers {
    /// Both layers of one density.
    pub fn weighted(density: &SurfaceModes, weights: LayerWeights) -> Self {
        Self {
            double: density.scaled(weights.double),
            single: density.scaled(weights.single),
        }
    }

    /// Modes of the density with more of them, counting the zeroth.
    pub fn modes(&self) -> usize {
        self.double.modes().max(self.single.modes())
    }
}
