//! The radial chain: repeated derivatives $\frac1r \frac{d}{dr}$ of $B = r / 8\pi$. Every kernel is
//! made of them.

use f64_lanes::{Isa, Lanes};

use super::vector::scaled;

/// $1/8\pi$.
pub(crate) const EIGHTH: f64 = 0.125 * std::f64::consts::FRAC_1_PI;

/// $\kappa_n$, $n = 1, \dots, 4$: what $\beta_n$ is of $r^{1-2n}$.
pub(crate) const UNITS: [f64; 4] = [EIGHTH, -EIGHTH, 3.0 * EIGHTH, -15.0 * EIGHTH];

/// The radial chain of one register of pairs: that of the full kernels if `SINGULAR`, otherwise
/// that of their residuals.
pub(crate) struct Chain<S: Isa, const SINGULAR: bool> {
    pub r2: Lanes<S>,
    /// $B_1, \dots, B_4$.
    pub b: [Lanes<S>; 4],
}

/// $1/r, \dots, 1/r^7$ of $r^2$, and zeros where $r^2$ is `least` or less.
#[inline(always)]
fn powers<S: Isa, const TERMS: usize>(r2: Lanes<S>, least: Lanes<S>) -> [Lanes<S>; 4] {
    let inverse = r2.rsqrt_above::<TERMS>(least);
    let square = inverse * inverse;
    let cube = square * inverse;
    let fifth = square * cube;
    [inverse, cube, fifth, square * fifth]
}

impl<S: Isa> Chain<S, true> {
    /// The full chain, without the pairs whose $r^2$ is `least` or less.
    #[inline(always)]
    pub fn full<const TERMS: usize>(r2: Lanes<S>, least: Lanes<S>) -> Self {
        Self {
            r2,
            b: powers::<S, TERMS>(r2, least),
        }
    }
}

impl<S: Isa> Chain<S, false> {
    /// The full chain minus `mollified`; zero where $r^2$ is `reach2` or more. At $r = 0$ only the
    /// full part is left out.
    #[inline(always)]
    pub fn residual<const TERMS: usize>(
        r2: Lanes<S>,
        reach2: Lanes<S>,
        mollified: &[Lanes<S>; 4],
    ) -> Self {
        let zero = Lanes::splat(r2.0, 0.0);
        let mut b = powers::<S, TERMS>(r2, zero);
        for order in 0..4 {
            b[order] = r2.select_less(reach2, b[order] - mollified[order], zero);
        }
        Self { r2, b }
    }
}

/// The coefficients of the kernels. The closed forms of the full chain hold only for
/// $B_n = r^{1-2n}$.
impl<S: Isa, const SINGULAR: bool> Chain<S, SINGULAR> {
    /// $p\,B_n - q\,r^2 B_{n+1}$, and $(p - q) B_n$ for the full chain.
    #[inline(always)]
    pub fn combined(&self, p: f64, order: usize, q: f64) -> Lanes<S> {
        let low = self.b[order - 1];
        if SINGULAR {
            return if p - q == 1.0 {
                low
            } else {
                scaled(p - q, low)
            };
        }
        let high = scaled(-q, self.r2);
        high.mul_add(self.b[order], scaled(p, low))
    }

    /// Stokeslet: $a = 2 B_1 - r^2 B_2$ of $u = a f + b\,x (x \cdot f)$.
    #[inline(always)]
    pub fn a(&self) -> Lanes<S> {
        self.combined(2.0, 1, 1.0)
    }

    /// Stokeslet: $b = B_2$.
    #[inline(always)]
    pub fn b(&self) -> Lanes<S> {
        self.b[1]
    }

    /// $a'/r = 3 r^2 B_3 - 4 B_2$.
    #[inline(always)]
    pub fn a_slope(&self) -> Lanes<S> {
        if SINGULAR {
            -self.b[1]
        } else {
            self.combined(-4.0, 2, -3.0)
        }
    }

    /// $b'/r = -3 B_3$.
    #[inline(always)]
    pub fn b_slope(&self) -> Lanes<S> {
        scaled(-3.0, self.b[2])
    }

    /// $-\lambda_1/2 = (5 B_2 - 3 r^2 B_3)/2$: $1/r^3$ in full.
    #[inline(always)]
    pub fn dipole(&self) -> Lanes<S> {
        self.combined(2.5, 2, 1.5)
    }

    /// $\lambda_2/6 = (7 B_3 - 5 r^2 B_4)/2$: $1/r^5$ in full.
    #[inline(always)]
    pub fn quadrupole(&self) -> Lanes<S> {
        self.combined(3.5, 3, 2.5)
    }

    /// Stresslet: $c_5 = B_3$, of densities times $-6$.
    #[inline(always)]
    pub fn c5(&self) -> Lanes<S> {
        self.b[2]
    }

    /// Stresslet: $c_3 = (B_2 - r^2 B_3)/2$, zero in full.
    #[inline(always)]
    pub fn c3(&self) -> Lanes<S> {
        self.combined(0.5, 2, 0.5)
    }

    /// $c_5'/r = -5 B_4$.
    #[inline(always)]
    pub fn c5_slope(&self) -> Lanes<S> {
        scaled(-5.0, self.b[3])
    }

    /// $c_3'/r = -5 (B_3 - r^2 B_4)/2$, zero in full.
    #[inline(always)]
    pub fn c3_slope(&self) -> Lanes<S> {
        self.combined(-2.5, 3, -2.5)
    }

    /// $\nabla^2 B / 2 = (3 B_1 - r^2 B_2)/2$: $1/r$ in full.
    #[inline(always)]
    pub fn laplacian(&self) -> Lanes<S> {
        self.combined(1.5, 1, 0.5)
    }
}
