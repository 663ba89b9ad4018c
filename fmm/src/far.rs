//! What a kernel is to the grids: charges laid on them, and potentials read off.

use crate::kernel::{Laplace, MOST, Pair, Stokes};
use crate::symbol::{self, Term};

/// Most densities and potentials of any kernel.
pub(crate) const FIELDS: usize = 4;

/// The far side of a kernel.
///
/// A source has on each of `DENSITIES` scalar fields the density
/// $c\\,\delta(y - y_0) + d\cdot\nabla\delta(y - y_0)$, with its charge $c$ and, if there are
/// `DIPOLES`, its dipole $d$. The symbol of the kernel turns these into `POTENTIALS` scalar fields.
/// A target reads these and, if there are `GRADIENTS`, their derivatives.
pub(crate) trait Far: Pair {
    const DENSITIES: usize;
    const POTENTIALS: usize;
    const DIPOLES: bool;
    const GRADIENTS: bool;
    /// Digits of margin: one for dipoles and one for pressures, which are derivatives of the flow
    /// of Stokeslets, and two for gradients of any flow.
    const DERIVATIVES: usize;

    /// The kernel as products among plane waves.
    fn symbol() -> Vec<Term>;

    /// Charges and dipoles of a source of this strength.
    fn charges(strength: &[f64]) -> ([f64; FIELDS], [[f64; 3]; FIELDS]);
}

/// Charges and dipoles of a block of sources, the first of which has the number `first`.
pub(crate) fn lay_charges<K: Far>(strengths: &[Vec<f64>], first: usize, block: &mut [&mut [f64]]) {
    let mut strength = [0.0; MOST];
    for i in 0..block[0].len() {
        for (value, column) in strength.iter_mut().zip(strengths) {
            *value = column[first + i];
        }
        let (charge, dipole) = K::charges(&strength);
        for density in 0..K::DENSITIES {
            block[density][i] = charge[density];
            for axis in 0..if K::DIPOLES { 3 } else { 0 } {
                block[K::DENSITIES + 3 * density + axis][i] = dipole[density][axis];
            }
        }
    }
}

/// The numbers of a kernel's fields, for the code that need not be compiled for each kernel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fields {
    pub densities: usize,
    pub potentials: usize,
    pub dipoles: bool,
    pub gradients: bool,
}

impl Fields {
    pub const fn of<K: Far>() -> Self {
        Self {
            densities: K::DENSITIES,
            potentials: K::POTENTIALS,
            dipoles: K::DIPOLES,
            gradients: K::GRADIENTS,
        }
    }

    /// Fields that a grid must have room for.
    pub fn most(self) -> usize {
        self.densities.max(self.potentials)
    }
}

impl<const STRENGTHS: usize, const OUTPUTS: usize> Far for Stokes<STRENGTHS, OUTPUTS> {
    const DENSITIES: usize = if STRENGTHS == 3 { 3 } else { 4 };
    const POTENTIALS: usize = if OUTPUTS == 3 { 3 } else { 4 };
    const DIPOLES: bool = STRENGTHS != 3;
    const GRADIENTS: bool = OUTPUTS == 13;
    const DERIVATIVES: usize = if OUTPUTS == 13 {
        2
    } else {
        (STRENGTHS != 3) as usize + (OUTPUTS == 4) as usize
    };

    fn symbol() -> Vec<Term> {
        symbol::stokes(Self::DENSITIES == 4, Self::POTENTIALS == 4)
    }

    #[inline(always)]
    fn charges(strength: &[f64]) -> ([f64; FIELDS], [[f64; 3]; FIELDS]) {
        let mut charge = [0.0; FIELDS];
        let mut dipole = [[0.0; 3]; FIELDS];
        if STRENGTHS != 6 {
            charge[..3].copy_from_slice(&strength[..3]);
        }
        if STRENGTHS != 3 {
            // A stresslet is a symmetric force dipole and a sink: T_ijk = S_ij,k + S_ik,j +
            // delta_jk lap B_,i.
            let first = if STRENGTHS == 6 { 0 } else { 3 };
            let (q, n) = (&strength[first..][..3], &strength[first + 3..][..3]);
            for (j, dipole) in dipole[..3].iter_mut().enumerate() {
                *dipole = [0, 1, 2].map(|k| q[j] * n[k] + n[j] * q[k]);
                charge[3] -= q[j] * n[j];
            }
        }
        if STRENGTHS == 13 {
            // A rotlet is an antisymmetric force dipole.
            let t = &strength[9..12];
            for (j, k, l) in [(0, 1, 2), (1, 2, 0), (2, 0, 1)] {
                dipole[j][l] -= 0.5 * t[k];
                dipole[j][k] += 0.5 * t[l];
            }
            charge[3] += strength[12];
        }
        (charge, dipole)
    }
}

impl<const OUTPUTS: usize> Far for Laplace<OUTPUTS> {
    const DENSITIES: usize = 1;
    const POTENTIALS: usize = 1;
    const DIPOLES: bool = false;
    const GRADIENTS: bool = OUTPUTS == 4;
    const DERIVATIVES: usize = (OUTPUTS == 4) as usize;

    fn symbol() -> Vec<Term> {
        symbol::laplace()
    }

    #[inline(always)]
    fn charges(strength: &[f64]) -> ([f64; FIELDS], [[f64; 3]; FIELDS]) {
        ([strength[0], 0.0, 0.0, 0.0], [[0.0; 3]; FIELDS])
    }
}
