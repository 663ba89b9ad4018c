//! The layers of all bodies as singularities at points of the laboratory: what sums are made over.

use std::ops::Range;

use bodies_of_revolution::Frame;
use stokes_fmm::{Singularities, Strengths, Stresslets};

/// Points with Stokeslets and stresslets.
#[derive(Clone, Debug)]
pub(crate) struct LayerPoints {
    pub positions: Vec<[f64; 3]>,
    pub normals: Vec<[f64; 3]>,
    pub stokeslets: Vec<[f64; 3]>,
    pub stresslets: Vec<[f64; 3]>,
    pub singularities: Singularities,
}

/// What the densities of single and double layer, times a point's share of the surface and turned
/// into the laboratory, are multiplied by to be a Stokeslet and a stresslet.
///
/// Shares of the surface grow with the square of the scale, and a single layer's density with the
/// inverse of the scale. This is the place where the sign is turned: a stresslet of the sum is
/// minus our double layer.
pub(crate) fn factors_of_layers(frame: &Frame) -> [f64; 2] {
    let scale = frame.scale();
    [scale, -scale * scale]
}

impl LayerPoints {
    /// Whether there are Stokeslets.
    pub fn has_stokeslets(&self) -> bool {
        self.singularities != Singularities::Stresslets
    }

    /// Whether there are stresslets.
    pub fn has_stresslets(&self) -> bool {
        self.singularities != Singularities::Stokeslets
    }

    /// The strengths of some of the points.
    pub fn strengths(&self, range: Range<usize>) -> Strengths<'_> {
        Strengths {
            stokeslets: self
                .has_stokeslets()
                .then(|| &self.stokeslets[range.clone()]),
            stresslets: self.has_stresslets().then(|| Stresslets {
                densities: &self.stresslets[range.clone()],
                normals: &self.normals[range],
            }),
            ..Strengths::default()
        }
    }
}
