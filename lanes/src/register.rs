//! One SIMD register of doubles and its arithmetic.

use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

use pulp::Simd;

/// One register of doubles.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd>(pub S, pub S::f64s);

impl<S: Simd> Lanes<S> {
    /// How many doubles a register holds.
    pub const COUNT: usize = size_of::<S::f64s>() / size_of::<f64>();

    /// `x` in every lane.
    #[inline(always)]
    pub fn splat(simd: S, x: f64) -> Self {
        Self(simd, simd.splat_f64s(x))
    }

    /// Register number `index` of a padded buffer.
    #[inline(always)]
    pub fn load(simd: S, buffer: &[f64], index: usize) -> Self {
        Self(simd, S::as_simd_f64s(buffer).0[index])
    }

    /// Stores into register number `index` of a padded buffer.
    #[inline(always)]
    pub fn store(self, buffer: &mut [f64], index: usize) {
        S::as_mut_simd_f64s(buffer).0[index] = self.1;
    }

    /// `self * a + b`, rounded once where the machine can.
    #[inline(always)]
    pub fn mul_add(self, a: Self, b: Self) -> Self {
        Self(self.0, self.0.mul_add_e_f64s(self.1, a.1, b.1))
    }

    /// Square root.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(self.0, self.0.sqrt_f64s(self.1))
    }

    /// The sum of the lanes.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.0.reduce_sum_f64s(self.1)
    }

    /// The smallest lane.
    #[inline(always)]
    pub fn min(self) -> f64 {
        self.0.reduce_min_f64s(self.1)
    }

    /// The largest lane.
    #[inline(always)]
    pub fn max(self) -> f64 {
        self.0.reduce_max_f64s(self.1)
    }

    /// The larger of each two lanes.
    #[inline(always)]
    pub fn larger(self, other: Self) -> Self {
        Self(self.0, self.0.max_f64s(self.1, other.1))
    }

    /// `yes` in the lanes where `self < bound`, `no` elsewhere.
    #[inline(always)]
    pub fn select_less(self, bound: Self, yes: Self, no: Self) -> Self {
        let mask = self.0.less_than_f64s(self.1, bound.1);
        // `select_f64s` would do, but is a call where the compiler does not inline it.
        let chosen = (self.0).select_u64s(mask, pulp::cast(yes.1), pulp::cast(no.1));
        Self(self.0, pulp::cast(chosen))
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $simd_method:ident) => {
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0, self.0.$simd_method(self.1, other.1))
            }
        }

        impl<S: Simd> $trait<f64> for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                self.$method(Self::splat(self.0, other))
            }
        }

        impl<S: Simd> $trait<Lanes<S>> for f64 {
            type Output = Lanes<S>;
            #[inline(always)]
            fn $method(self, other: Lanes<S>) -> Lanes<S> {
                Lanes::splat(other.0, self).$method(other)
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> AddAssign for Lanes<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // `neg_f64s` would do, but is a call where the compiler does not inline it.
        Self::splat(self.0, -0.0) - self
    }
}
