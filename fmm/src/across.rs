//! Charges on grids to potentials on grids, by plane waves.

use f64_lanes::{Isa, WithIsa, dispatch};
use rayon::prelude::*;

use crate::far::Fields;
use crate::symbol::Symbol;
use crate::transfer::GridShape;
use crate::transform::{BATCH, Scratch, Transform};

/// A transform of grids and what happens to their waves.
#[derive(Clone, Debug)]
pub(crate) struct Across {
    pub transform: Transform,
    pub symbol: Symbol,
}

impl Across {
    /// Waves of the potentials of the boxes of numbers `batches`, of side `side`: batch by batch,
    /// and within a batch field by field.
    pub fn forward(
        &self,
        fields: Fields,
        shape: GridShape,
        side: f64,
        boxes: &[&mut [f64]],
        numbers: &[u32],
        waves: &mut Vec<f64>,
    ) {
        let field = self.transform.waves_len();
        waves.resize(
            numbers.len().div_ceil(BATCH) * fields.potentials * field,
            0.0,
        );
        let batches = waves
            .par_chunks_exact_mut(fields.potentials * field)
            .zip(numbers.par_chunks(BATCH));
        let memory = || {
            (
                self.transform.scratch(),
                vec![0.0; fields.densities * field],
            )
        };
        batches.for_each_init(memory, |(scratch, densities), (potentials, batch)| {
            let transform = &self.transform;
            dispatch(Forward {
                transform,
                shape,
                boxes,
                batch,
                densities,
                scratch,
            });
            dispatch(Multiply {
                symbol: &self.symbol,
                side,
                densities,
                potentials,
            });
        });
    }

    /// Writes one potential to the grids of the boxes of these numbers. `waves_of(batch, out)`
    /// gives the waves of a batch.
    pub fn backward(
        &self,
        shape: GridShape,
        potential: usize,
        boxes: &mut [&mut [f64]],
        numbers: &[u32],
        waves_of: impl Fn(usize, &mut [f64]) + Sync,
    ) {
        let field = potential * shape.field()..(potential + 1) * shape.field();
        let mut own: Vec<Option<&mut [f64]>> = boxes
            .iter_mut()
            .map(|grid| Some(&mut grid[field.clone()]))
            .collect();
        let grids = numbers
            .iter()
            .filter_map(|&number| own[number as usize].take());
        let mut grids: Vec<&mut [f64]> = grids.collect();
        let memory = || {
            (
                self.transform.scratch(),
                vec![0.0; self.transform.waves_len()],
            )
        };
        let batches = grids.par_chunks_mut(BATCH).enumerate();
        batches.for_each_init(memory, |(scratch, waves), (batch, grids)| {
            waves_of(batch, waves);
            dispatch(Backward {
                transform: &self.transform,
                waves,
                grids,
                stride: shape.stride(),
                scratch,
            });
        });
    }
}

/// The waves of a batch of boxes.
struct Forward<'a> {
    transform: &'a Transform,
    shape: GridShape,
    boxes: &'a [&'a mut [f64]],
    batch: &'a [u32],
    densities: &'a mut [f64],
    scratch: &'a mut Scratch,
}

impl WithIsa for Forward<'_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        let field = self.shape.field();
        for (density, waves) in self
            .densities
            .chunks_exact_mut(self.transform.waves_len())
            .enumerate()
        {
            let mut grids = [&[][..]; BATCH];
            for (lane, grid) in grids.iter_mut().enumerate() {
                // A batch that is not full repeats its last box: nobody reads those lanes.
                let number = self.batch[lane.min(self.batch.len() - 1)] as usize;
                *grid = &self.boxes[number][density * field..][..field];
            }
            self.transform
                .forward(simd, grids, self.shape.stride(), waves, self.scratch);
        }
    }
}

/// Densities to potentials.
struct Multiply<'a> {
    symbol: &'a Symbol,
    side: f64,
    densities: &'a [f64],
    potentials: &'a mut [f64],
}

impl WithIsa for Multiply<'_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        self.symbol
            .apply(simd, self.side, self.densities, self.potentials);
    }
}

/// Waves of a batch to one field of its boxes.
struct Backward<'a, 'b> {
    transform: &'a Transform,
    waves: &'a [f64],
    grids: &'a mut [&'b mut [f64]],
    stride: usize,
    scratch: &'a mut Scratch,
}

impl WithIsa for Backward<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn with_isa<S: Isa>(self, simd: S) {
        let Self {
            transform,
            waves,
            grids,
            stride,
            scratch,
        } = self;
        transform.backward(simd, waves, grids, stride, scratch);
    }
}
