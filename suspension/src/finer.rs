//! A class of bodies on a finer surface, where the error of a solution shows: four more nodes on
//! each panel, more modes.

use std::sync::{Arc, OnceLock};

use panel_quadrature::QuadratureError;
use stokes_body::discretization::Discretization;
use stokes_body::layers::{LayerWeights, Layers};
use stokes_body::matrix::{LayerPotential, ModalMatrices};
use stokes_body::refinement::EXTRA_ORDER;
use stokes_body::surface::SurfaceModes;

use super::tables::Tables;

/// Which densities a sum is made of.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Part {
    /// Those that were solved for.
    Solved,
    /// The single layers of free bodies.
    Forces,
}

impl Part {
    pub const ALL: [Self; 2] = [Self::Solved, Self::Forces];
}

/// The velocity that a body's layers make on its own surface, from outside.
#[derive(Debug)]
enum Own {
    /// A held body's layers have one density.
    OneDensity(ModalMatrices),
    /// A free body's single layer is a rigid motion.
    TwoDensities {
        double: ModalMatrices,
        single: ModalMatrices,
    },
}

/// A finer surface, and what is made for it when it is first wanted.
#[derive(Debug)]
pub(crate) struct FinerSurface {
    pub discretization: Discretization,
    pub n_max: usize,
    weights: LayerWeights,
    is_free: bool,
    own: OnceLock<Own>,
    tables: [OnceLock<Arc<Tables>>; Part::ALL.len()],
}

impl FinerSurface {
    /// The finer surface of bodies with these tables.
    pub fn new(tables: &Tables, n_max: usize, is_free: bool) -> Result<Self, QuadratureError> {
        let from = &tables.discretization;
        Ok(Self {
            discretization: from.with_order(from.order() + EXTRA_ORDER)?,
            n_max,
            weights: tables.weights,
            is_free,
            own: OnceLock::new(),
            tables: Default::default(),
        })
    }

    /// The same surface with nothing made for it yet.
    pub fn copy(&self) -> Self {
        Self {
            discretization: self.discretization.clone(),
            n_max: self.n_max,
            weights: self.weights,
            is_free: self.is_free,
            own: OnceLock::new(),
            tables: Default::default(),
        }
    }

    /// The tables for the layers of a part.
    pub fn tables(&self, part: Part) -> &Arc<Tables> {
        let weights = match part {
            Part::Solved => self.weights,
            Part::Forces => LayerWeights::SINGLE,
        };
        let make = || {
            Arc::new(Tables::new(
                self.discretization.clone(),
                self.n_max,
                weights,
            ))
        };
        self.tables[part as usize].get_or_init(make)
    }

    /// Densities on this surface, interpolated from the one that they were found on.
    pub fn resampled(
        &self,
        from: &Discretization,
        layers: &Layers,
    ) -> Result<Layers, QuadratureError> {
        let resampled =
            |field: &SurfaceModes| field.resampled(from, &self.discretization, self.n_max);
        Ok(Layers {
            double: resampled(&layers.double)?,
            single: resampled(&layers.single)?,
        })
    }

    /// The scaled modes of a part of the densities.
    pub fn field(&self, part: Part, layers: &Layers) -> Vec<f64> {
        let mut field = match part {
            Part::Solved if self.weights.double != 0.0 => {
                layers.double.scaled_by_roots(&self.discretization)
            }
            Part::Forces if !self.is_free => Vec::new(),
            Part::Solved | Part::Forces => layers.single.scaled_by_roots(&self.discretization),
        };
        field.resize(self.tables(part).field_len(), 0.0);
        field
    }

    /// The velocity that the layers make on the surface itself, from outside.
    pub fn velocity(&self, layers: &Layers) -> Result<SurfaceModes, QuadratureError> {
        let on = &self.discretization;
        Ok(match self.own()? {
            Own::OneDensity(matrices) if self.weights.double == 0.0 => {
                matrices.apply(on, &layers.single)
            }
            Own::OneDensity(matrices) => matrices.apply(on, &layers.double),
            Own::TwoDensities { double, single } => {
                let of_single = single.apply(on, &layers.single);
                double.apply(on, &layers.double).plus(1.0, &of_single)
            }
        })
    }

    fn own(&self) -> Result<&Own, QuadratureError> {
        if let Some(own) = self.own.get() {
            return Ok(own);
        }
        let matrices = ModalMatrices::from_outside(&self.discretization, self.weights, self.n_max)?;
        let own = if self.is_free {
            Own::TwoDensities {
                double: matrices,
                single: ModalMatrices::of(LayerPotential::Single, &self.discretization, 1)?,
            }
        } else {
            Own::OneDensity(matrices)
        };
        Ok(self.own.get_or_init(|| own))
    }
}
