//! What the kernels know of a target ring and a source ring.

use pulp::Simd;

use f64_lanes::Lanes;

/// One target and a register of sources in the meridian half plane.
///
/// Symbols as in the module's formulas: target at radius `r`, source at radius `rp`, `a` $= r - r'$
/// and `b` $= z - z'$ given as differences, normals `(nu_r, nu_z)` at the source, `(mu_r, mu_z)` at
/// the target.
#[derive(Clone, Copy)]
pub(crate) struct Pair<S: Simd> {
    pub r: Lanes<S>,
    pub rp: Lanes<S>,
    pub a: Lanes<S>,
    pub b: Lanes<S>,
    pub nu_r: Lanes<S>,
    pub nu_z: Lanes<S>,
    pub mu_r: Lanes<S>,
    pub mu_z: Lanes<S>,
    /// $\rho^2 = a^2 + b^2$ and its inverse.
    pub rho2: Lanes<S>,
    pub inv_rho2: Lanes<S>,
    /// $1/R$ with $R = 2 r r'$.
    pub inv_big_r: Lanes<S>,
    /// $h = \chi - 1 = \rho^2 / R$.
    pub h: Lanes<S>,
    /// $1/r$ and $1/r'$.
    pub inv_r: Lanes<S>,
    pub inv_rp: Lanes<S>,
}

impl<S: Simd> Pair<S> {
    #[inline(always)]
    #[expect(
        clippy::too_many_arguments,
        reason = "one constructor, all of one kind, called once"
    )]
    pub fn new(
        r: Lanes<S>,
        rp: Lanes<S>,
        a: Lanes<S>,
        b: Lanes<S>,
        nu_r: Lanes<S>,
        nu_z: Lanes<S>,
        mu_r: Lanes<S>,
        mu_z: Lanes<S>,
    ) -> Self {
        let one = Lanes::splat(r.0, 1.0);
        let rho2 = a.mul_add(a, b * b);
        let inv_r = one / r;
        let inv_rp = one / rp;
        let inv_big_r = inv_r * inv_rp * 0.5;
        Self {
            r,
            rp,
            a,
            b,
            nu_r,
            nu_z,
            mu_r,
            mu_z,
            rho2,
            inv_rho2: one / rho2,
            inv_big_r,
            h: rho2 * inv_big_r,
            inv_r,
            inv_rp,
        }
    }
}

/// One azimuthal separation $t$ of such a pair: what the kernels in space are made of.
#[derive(Clone, Copy)]
pub(crate) struct Separation<S: Simd> {
    /// $\bar x$ in the target's frame.
    pub x: [Lanes<S>; 3],
    /// $\bar x$ in the source's frame.
    pub xp: [Lanes<S>; 3],
    /// $\nu'$ in the source's frame.
    pub nu: [Lanes<S>; 3],
    /// $\bar x \cdot \nu'$ and $\bar x \cdot \nu$.
    pub x_nu: Lanes<S>,
    pub x_mu: Lanes<S>,
    /// $\cos t$ and $\sin t$.
    pub cos: Lanes<S>,
    pub sin: Lanes<S>,
    /// $1/|\bar x|$.
    pub inv: Lanes<S>,
}

impl<S: Simd> Pair<S> {
    /// The separation at $1 - \cos t$ = `c` and $\sin t$ = `sin`; $|\bar x|^2 = \rho^2 + R c$.
    #[inline(always)]
    pub fn separation(&self, c: Lanes<S>, sin: Lanes<S>) -> Separation<S> {
        let q = self.rho2 + 2.0 * self.r * self.rp * c;
        Separation {
            x: [self.a + self.rp * c, self.rp * sin, self.b],
            xp: [self.a - self.r * c, self.r * sin, self.b],
            nu: [self.nu_r, Lanes::splat(c.0, 0.0), self.nu_z],
            x_nu: self.nu_r * (self.a - self.r * c) + self.nu_z * self.b,
            x_mu: self.mu_r * (self.a + self.rp * c) + self.mu_z * self.b,
            cos: 1.0 - c,
            sin,
            inv: 1.0 / q.sqrt(),
        }
    }
}
