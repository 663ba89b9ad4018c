//! Kernels as values: their numbers, and the code that is compiled for each of them. All other code
//! is compiled once.

use f64_lanes::Precision;

use crate::direct::chunks::add_chunk;
use crate::far::{Far, Fields, lay_charges};
use crate::flow::{Output, Singularities};
use crate::kernel::{Laplace, Numbers, Stokes};
use crate::near_field::{AddTile, add_tile};
use crate::symbol::Term;

/// Charges and dipoles of a block of sources: strengths of all, number of the block's first, and
/// the block's part of each column.
type LayCharges = fn(&[Vec<f64>], usize, &mut [&mut [f64]]);
/// Adds what all sources do to a chunk of targets: see [`add_chunk`].
type AddChunk = fn(Precision, &[f64], &[[f64; 3]], &mut [f64]);

/// A kernel that is chosen at run time.
pub(crate) struct Kernel {
    pub numbers: Numbers,
    pub fields: Fields,
    /// Digits of margin.
    pub derivatives: usize,
    /// The kernel as products among plane waves.
    pub symbol: fn() -> Vec<Term>,
    pub lay_charges: LayCharges,
    pub add_tile: AddTile,
    pub add_chunk: AddChunk,
}

impl Kernel {
    pub const fn of<K: Far>() -> Self {
        Self {
            numbers: Numbers::of::<K>(),
            fields: Fields::of::<K>(),
            derivatives: K::DERIVATIVES,
            symbol: K::symbol,
            lay_charges: lay_charges::<K>,
            add_tile: add_tile::<K>,
            add_chunk: add_chunk::<K>,
        }
    }

    /// The kernel of Stokes flow that is asked for.
    pub fn stokes(singularities: Singularities, output: Output) -> &'static Self {
        match (singularities, output) {
            (Singularities::Stokeslets, Output::Velocity) => &const { Self::of::<Stokes<3, 3>>() },
            (Singularities::Stokeslets, Output::Pressure) => &const { Self::of::<Stokes<3, 4>>() },
            (Singularities::Stokeslets, Output::Gradient) => &const { Self::of::<Stokes<3, 13>>() },
            (Singularities::Stresslets, Output::Velocity) => &const { Self::of::<Stokes<6, 3>>() },
            (Singularities::Stresslets, Output::Pressure) => &const { Self::of::<Stokes<6, 4>>() },
            (Singularities::Stresslets, Output::Gradient) => &const { Self::of::<Stokes<6, 13>>() },
            (Singularities::Both, Output::Velocity) => &const { Self::of::<Stokes<9, 3>>() },
            (Singularities::Both, Output::Pressure) => &const { Self::of::<Stokes<9, 4>>() },
            (Singularities::Both, Output::Gradient) => &const { Self::of::<Stokes<9, 13>>() },
            (Singularities::All, Output::Velocity) => &const { Self::of::<Stokes<13, 3>>() },
            (Singularities::All, Output::Pressure) => &const { Self::of::<Stokes<13, 4>>() },
            (Singularities::All, Output::Gradient) => &const { Self::of::<Stokes<13, 13>>() },
        }
    }

    /// The kernel of charges, with the gradient if `gradient`.
    pub fn laplace(gradient: bool) -> &'static Self {
        if gradient {
            &const { Self::of::<Laplace<4>>() }
        } else {
            &const { Self::of::<Laplace<1>>() }
        }
    }
}
