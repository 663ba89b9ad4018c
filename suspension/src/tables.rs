//! What depends on a shape, its resolution and its layers alone: made once, shared by all bodies
//! that are alike in them.

use std::sync::{Arc, OnceLock};

use panel_quadrature::QuadratureError;

use super::upsampling::{self, Upsampling};
use bodies_of_revolution::Frame;
use stokes_body::discretization::Discretization;
use stokes_body::influence::Influence;
use stokes_body::layers::LayerWeights;
use stokes_body::matrix::ModalMatrices;
use stokes_body::surface_grid::SurfaceGrid;

/// Tables of one shape at one resolution, for the flow $w_D D[\sigma] + w_S S[\sigma]$ of a
/// density, in the body's frame.
#[derive(Debug)]
pub(crate) struct Tables {
    pub discretization: Discretization,
    pub n_max: usize,
    pub weights: LayerWeights,
    /// Made when they are first wanted: few problems need all.
    grid: OnceLock<SurfaceGrid>,
    influence: OnceLock<Influence>,
    upsamplings: [OnceLock<Arc<Upsampling>>; upsampling::LEVELS],
    point_sum: OnceLock<ModalMatrices>,
}

impl Tables {
    /// The tables for modes up to `n_max`.
    pub fn new(discretization: Discretization, n_max: usize, weights: LayerWeights) -> Self {
        Self {
            grid: OnceLock::new(),
            influence: OnceLock::new(),
            upsamplings: Default::default(),
            point_sum: OnceLock::new(),
            n_max,
            weights,
            discretization,
        }
    }

    /// Numbers that make up a field: six for each node and mode.
    pub fn field_len(&self) -> usize {
        6 * (self.n_max + 1) * self.discretization.nodes().len()
    }

    /// The surface as points.
    pub fn grid(&self) -> &SurfaceGrid {
        let make = || SurfaceGrid::new(&self.discretization, self.n_max);
        self.grid.get_or_init(make)
    }

    /// The rules for points close to the surface.
    pub fn influence(&self) -> Result<&Influence, QuadratureError> {
        if let Some(influence) = self.influence.get() {
            return Ok(influence);
        }
        let influence = Influence::new(self.discretization.order(), self.n_max)?;
        Ok(self.influence.get_or_init(|| influence))
    }

    /// The body with more points; levels go from few to many.
    pub fn upsampling(&self, level: usize) -> Result<Arc<Upsampling>, QuadratureError> {
        let made = &self.upsamplings[level];
        if let Some(upsampling) = made.get() {
            return Ok(upsampling.clone());
        }
        let upsampling = Upsampling::new(&self.discretization, self.n_max, level)?;
        Ok(made.get_or_init(|| Arc::new(upsampling)).clone())
    }

    /// What the sum over the body's points does at those points.
    pub fn point_sum(&self) -> &ModalMatrices {
        self.point_sum.get_or_init(|| self.new_point_sum())
    }

    /// The same for those who need it once: it is not kept.
    pub fn new_point_sum(&self) -> ModalMatrices {
        let azimuths = self.grid().azimuths();
        ModalMatrices::of_point_sum(&self.discretization, self.weights, self.n_max, azimuths)
    }
}

/// A body: its tables, and where it is.
#[derive(Clone, Debug)]
pub(crate) struct Member {
    pub tables: Arc<Tables>,
    pub frame: Frame,
}
