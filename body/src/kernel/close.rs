//! Velocity, pressure and velocity gradient of both layers at a ring, from densities on other
//! rings.
//!
//! The gradient and the pressure of a double layer have kernels of strength $1/|\bar x|^3$, which
//! lose all digits next to the surface. Integration by parts on the closed surface moves one
//! derivative to the density. With the tangential operators
//! $\mathcal M_{ij} = \nu_j \partial_i - \nu_i \partial_j$ (Günter; Kupradze 1979, chapter V),
//! $\tau_i = \mathcal M_{ij}\sigma_j$ and $G = 1/4\pi|\bar x|$
//!
//! $$ D[\sigma]_i = \int (\nu'\\!\cdot\nabla' G)\\, \sigma_i - \int G\\, \tau_i +
//!    2 \int S_{ij} \tau_j , \qquad
//!    p = \int P^S_j (\varrho + 2\tau)_j , $$
//! $$ \partial_l u_i = \int \partial_l S_{ij} (\varrho + 2\tau)_j - \int \partial_l G\\, \tau_i +
//!    \Bigl(\nabla \times \int G\\, (\nu\times\nabla) \sigma_i\Bigr)_l $$
//!
//! for $u = D[\sigma] + S[\varrho]$ off the surface, with nothing stronger than $1/|\bar x|^2$. The
//! velocity is computed from $D$ and $S$ as they are.
//!
//! On a surface of revolution with unit tangent $t$ along the curve (arc length $\ell$),
//! $\nu \times t = e_\theta$ and
//! $\nu\times\nabla = e_\theta \partial_\ell - t\\, r^{-1} \partial_\theta$: the tensor
//! $(\nu\times\nabla)_m \sigma_i$ has the six components $y^\theta_i = \partial_\ell \sigma_i$ and
//! $y^t_i = -r^{-1} (\partial_\theta \sigma)_i$.

use std::f64::consts::PI;

use pulp::Simd;

use super::double_layer::DoubleLayer;
use super::invariant::{Kernel, Parity};
use super::moments::{CubicMoments, Moments};
use super::pair::{Pair, Separation};
use super::pressure::SingleLayerPressure;
use super::single_layer::SingleLayer;
use f64_lanes::Lanes;

/// Components of the densities: $\sigma$, $\varrho$, $y^\theta$, $y^t$, three each (radial,
/// azimuthal, axial).
pub(crate) const DENSITIES: usize = 12;

/// A kernel that takes densities to fields, mode by mode.
///
/// A component of density or field belongs to the first family of a mode as $\cos n\theta$ or as
/// $\sin n\theta$: as $\sin$ the azimuthal components of vectors and those with one azimuthal index
/// of tensors; but in $y^t$ the other two.
pub(crate) trait Potential<const K: usize, const FIELDS: usize>: Kernel<K> {
    /// The fields of one mode of the first family, from the kernel's entries and the densities of
    /// that mode and family; the second family has the same.
    fn fields<S: Simd>(
        normal: [Lanes<S>; 2],
        entries: &[Lanes<S>; K],
        densities: &[Lanes<S>; DENSITIES],
    ) -> [Lanes<S>; FIELDS];
}

/// Velocity and pressure: four fields.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VelocityPressure;

/// Velocity, pressure, and the velocity gradient row by row: $\partial_j u_i$ is field
/// $4 + 3i + j$, of thirteen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VelocityPressureGradient;

/// Entries of the double layer, the single layer and its pressure.
const FLOW: usize = 9 + 9 + 3;
/// Three vectors at three components each times $\cos t$, $\sin t$ and 1, and the triple products
/// $x_i x_l x'_k$.
const GRADIENT: usize = FLOW + 27 + 18;

/// The index pairs $i \le l$ of the triple products.
const PAIRS: [[usize; 2]; 6] = [[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]];
/// Which of [`PAIRS`] an index pair is.
const PAIR_OF: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];
/// Whether a component of the three vectors is odd in $t$.
const VECTOR_IS_ODD: [[bool; 3]; 3] = [
    [false, true, false],
    [false, true, false],
    [true, false, true],
];

const fn parity(odd: bool) -> Parity {
    if odd { Parity::Odd } else { Parity::Even }
}

impl Kernel<FLOW> for VelocityPressure {
    const PARITY: [Parity; FLOW] = {
        let mut all = [Parity::Even; FLOW];
        let mut k = 0;
        while k < FLOW {
            all[k] = if k < 18 {
                Parity::OF_VELOCITY[k % 9]
            } else {
                Parity::OF_PRESSURE[k - 18]
            };
            k += 1;
        }
        all
    };

    #[inline(always)]
    fn mode<S: Simd>(&self, pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; FLOW] {
        let mut entries = [m.e0; FLOW];
        entries[..9].copy_from_slice(&DoubleLayer.mode(pair, m));
        entries[9..18].copy_from_slice(&SingleLayer.mode(pair, m));
        entries[18..].copy_from_slice(&SingleLayerPressure.mode(pair, m));
        entries
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, s: &Separation<S>) -> [Lanes<S>; FLOW] {
        let mut entries = [s.inv; FLOW];
        entries[..9].copy_from_slice(&DoubleLayer.sample(s));
        entries[9..18].copy_from_slice(&SingleLayer.sample(s));
        entries[18..].copy_from_slice(&SingleLayerPressure.sample(s));
        entries
    }
}

impl Kernel<GRADIENT> for VelocityPressureGradient {
    const PARITY: [Parity; GRADIENT] = {
        let mut all = [Parity::Even; GRADIENT];
        let mut k = 0;
        while k < GRADIENT {
            all[k] = if k < FLOW {
                VelocityPressure::PARITY[k]
            } else if k < FLOW + 27 {
                let place = k - FLOW;
                // cos t, sin t, 1.
                parity(VECTOR_IS_ODD[place / 9][place / 3 % 3] != (place % 3 == 1))
            } else {
                let [i, l] = PAIRS[(k - FLOW - 27) / 3];
                parity(((i == 1) != (l == 1)) != ((k - FLOW - 27) % 3 == 1))
            };
            k += 1;
        }
        all
    };

    #[inline(always)]
    fn mode<S: Simd>(&self, pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; GRADIENT] {
        let mut entries = [m.e0; GRADIENT];
        entries[..FLOW].copy_from_slice(&VelocityPressure.mode(pair, m));
        entries[FLOW..FLOW + 27].copy_from_slice(&turned_vectors(pair, m));
        entries[FLOW + 27..].copy_from_slice(&triple_products(pair, &m.cubic(pair)));
        entries
    }

    #[inline(always)]
    fn sample<S: Simd>(&self, s: &Separation<S>) -> [Lanes<S>; GRADIENT] {
        let mut entries = [s.inv; GRADIENT];
        entries[..FLOW].copy_from_slice(&VelocityPressure.sample(s));
        let inv2 = s.inv * s.inv;
        let inv3 = s.inv * inv2;
        let strength = (1.0 / (4.0 * PI)) * inv3;
        let [x, y, z] = s.x;
        let [tangent_r, tangent_z] = [s.nu[2], -s.nu[0]];
        // x, -x cross e_theta', -x cross t'.
        let vectors = [
            [x, y, z],
            [z * s.cos, -(z * s.sin), y * s.sin - x * s.cos],
            [
                -(tangent_r * z * s.sin + tangent_z * y),
                tangent_z * x - tangent_r * z * s.cos,
                tangent_r * (x * s.sin + y * s.cos),
            ],
        ];
        let turns = [s.cos, s.sin, Lanes::splat(s.inv.0, 1.0)];
        for (k, entry) in entries[FLOW..FLOW + 27].iter_mut().enumerate() {
            *entry = strength * vectors[k / 9][k / 3 % 3] * turns[k % 3];
        }
        let strength = (-3.0 / (8.0 * PI)) * inv3 * inv2;
        for (k, entry) in entries[FLOW + 27..].iter_mut().enumerate() {
            let [i, l] = PAIRS[k / 3];
            *entry = strength * s.x[i] * s.x[l] * s.xp[k % 3];
        }
        entries
    }
}

/// Modes of $v_l \cos t$, $v_l \sin t$ and $v_l$ over $4\pi|\bar x|^3$ for the vectors
/// $v = \bar x$, $-\bar x \times e'_\theta$ and $-\bar x \times t'$.
#[inline(always)]
fn turned_vectors<S: Simd>(pair: &Pair<S>, m: &Moments<S>) -> [Lanes<S>; 27] {
    let Pair {
        r,
        rp,
        a,
        b,
        nu_r,
        nu_z,
        ..
    } = *pair;
    let factor = 1.0 / (4.0 * PI);
    let moments = square_moments(pair, m, factor);
    let (t_r, t_z) = (nu_z, -nu_r);
    let zero = Lanes::splat(r.0, 0.0);
    let rows = [
        moments.even(a, rp),
        moments.odd(rp),
        moments.even(b, zero),
        moments.even(b, -b),
        moments.odd(-b),
        moments.even(-a, r),
        moments.odd(-(t_r * b + t_z * rp)),
        moments.even(t_z * a - t_r * b, t_z * rp + t_r * b),
        moments.odd(t_r * r),
    ];
    let mut entries = [zero; 27];
    for (k, entry) in entries.iter_mut().enumerate() {
        *entry = rows[k / 3][k % 3];
    }
    entries
}

/// Moments of $c^k q^{-3/2}$ with $\cos nt$ ($k = 0, 1, 2$) and of $c^k \sin t\\, q^{-3/2}$ with
/// $\sin nt$ ($k = 0, 1$).
#[derive(Clone, Copy)]
struct SquareMoments<S: Simd> {
    cos: [Lanes<S>; 3],
    sin: [Lanes<S>; 2],
}

/// The moments times `factor`.
#[inline(always)]
fn square_moments<S: Simd>(pair: &Pair<S>, m: &Moments<S>, factor: f64) -> SquareMoments<S> {
    let over_big_r = factor * pair.inv_big_r;
    let twice_n_e0 = (2.0 * m.n) * m.e0;
    SquareMoments {
        cos: [
            factor * m.e1 * pair.inv_rho2,
            over_big_r * (m.e0 - m.e1),
            over_big_r * (m.e_minus1_over_big_r + pair.h * (m.e1 - 2.0 * m.e0)),
        ],
        sin: [
            over_big_r * twice_n_e0,
            over_big_r * (m.e0_sin - pair.h * twice_n_e0),
        ],
    }
}

// Methods, not closures: these would not be compiled for the instruction set that was chosen.
impl<S: Simd> SquareMoments<S> {
    /// The modes of $v \cos t$, $v \sin t$ and $v$ over $q^{3/2}$ for the even $v$ = `e0` + `e1`
    /// $c$.
    #[inline(always)]
    fn even(&self, e0: Lanes<S>, e1: Lanes<S>) -> [Lanes<S>; 3] {
        let ([u0, u1, u2], [v0, v1]) = (self.cos, self.sin);
        [
            e0 * (u0 - u1) + e1 * (u1 - u2),
            e0 * v0 + e1 * v1,
            e0 * u0 + e1 * u1,
        ]
    }

    /// The same for the odd $v$ = `o` $\sin t$.
    #[inline(always)]
    fn odd(&self, o: Lanes<S>) -> [Lanes<S>; 3] {
        let ([_, u1, u2], [v0, v1]) = (self.cos, self.sin);
        [o * (v0 - v1), o * (2.0 * u1 - u2), o * v0]
    }
}

/// Modes of $-\frac{3}{8\pi} \bar x_i \bar x_l \bar x'_k / |\bar x|^5$, the first two indices in
/// the target's frame, the last in the source's.
#[inline(always)]
fn triple_products<S: Simd>(pair: &Pair<S>, moments: &CubicMoments<S>) -> [Lanes<S>; 18] {
    let Pair { r, rp, a, b, .. } = *pair;
    let CubicMoments { g, h } = *moments;
    let (a2, rp2, product) = (a * a, rp * rp, r * rp);
    // x_r = a + r' c, x'_r = a - r c, and x_r x'_r = a^2 (1 - c) - r r' c^2 since r - r' = a.
    let along_g = a * g[0] + rp * g[1];
    let along_h = a * h[0] + rp * h[1];
    let back_h = a * h[0] - r * h[1];
    let sin2 = 2.0 * g[1] - g[2];
    let mut entries = [
        a * (a2 * (g[0] - g[1]) - product * g[2]) + rp * (a2 * (g[1] - g[2]) - product * g[3]),
        r * (a2 * h[0] + 2.0 * a * rp * h[1] + rp2 * h[2]),
        b * (a2 * g[0] + 2.0 * a * rp * g[1] + rp2 * g[2]),
        rp * (a2 * (h[0] - h[1]) - product * h[2]),
        product * (2.0 * a * g[1] + (2.0 * rp - a) * g[2] - rp * g[3]),
        b * rp * along_h,
        b * (a2 * (g[0] - g[1]) - product * g[2]),
        b * r * along_h,
        b * b * along_g,
        rp2 * (2.0 * a * g[1] - (a + 2.0 * r) * g[2] + r * g[3]),
        rp2 * r * (2.0 * h[1] - h[2]),
        rp2 * b * sin2,
        b * rp * back_h,
        b * product * sin2,
        b * b * rp * h[0],
        b * b * (a * g[0] - r * g[1]),
        b * b * r * h[0],
        b * b * b * g[0],
    ];
    for entry in &mut entries {
        *entry = *entry * (-3.0 / (8.0 * PI));
    }
    entries
}

/// $\varrho + 2\tau$ and $\tau$.
#[inline(always)]
fn moved<S: Simd>(
    [nu_r, nu_z]: [Lanes<S>; 2],
    densities: &[Lanes<S>; DENSITIES],
) -> [[Lanes<S>; 3]; 2] {
    let [
        _,
        _,
        _,
        rho_r,
        rho_t,
        rho_z,
        yt_r,
        _,
        yt_z,
        ys_r,
        ys_t,
        ys_z,
    ] = *densities;
    let tau = [
        yt_z + nu_r * ys_t,
        -(nu_r * ys_r + nu_z * ys_z),
        nu_z * ys_t - yt_r,
    ];
    let moved = [
        rho_r + (tau[0] + tau[0]),
        rho_t + (tau[1] + tau[1]),
        rho_z + (tau[2] + tau[2]),
    ];
    [moved, tau]
}

/// Velocity and pressure from their entries.
#[inline(always)]
fn flow_fields<S: Simd>(
    entries: &[Lanes<S>],
    densities: &[Lanes<S>; DENSITIES],
    moved: &[Lanes<S>; 3],
) -> [Lanes<S>; 4] {
    let zero = Lanes::splat(moved[0].0, 0.0);
    let mut fields = [zero; 4];
    for i in 0..3 {
        for j in 0..3 {
            let (double, single) = (entries[3 * i + j], entries[9 + 3 * i + j]);
            let sum = double.mul_add(densities[j], single * densities[3 + j]);
            // From sin to cos an odd kernel changes sign.
            fields[i] = if j == 1 && i != 1 {
                fields[i] - sum
            } else {
                fields[i] + sum
            };
        }
    }
    fields[3] = entries[18] * moved[0] - entries[19] * moved[1] + entries[20] * moved[2];
    fields
}

/// A component of one of the vectors times a density turned into the target's frame, from its three
/// entries.
#[inline(always)]
fn turned<S: Simd>(
    entries: &[Lanes<S>],
    vector_is_odd: bool,
    density: &[Lanes<S>; 3],
    is_sin: [bool; 3],
) -> [Lanes<S>; 3] {
    // From sin to cos an odd kernel changes sign; sin t is as odd as the vector is not.
    let [r, t, z] = *density;
    let cos_r = if is_sin[0] && vector_is_odd { -r } else { r };
    let cos_t = if is_sin[1] && vector_is_odd { -t } else { t };
    let one_z = if is_sin[2] && vector_is_odd { -z } else { z };
    let sin_r = if is_sin[0] && !vector_is_odd { -r } else { r };
    let sin_t = if is_sin[1] && !vector_is_odd { -t } else { t };
    [
        entries[0] * cos_r + entries[1] * sin_t,
        entries[0] * cos_t - entries[1] * sin_r,
        entries[2] * one_z,
    ]
}

impl Potential<FLOW, 4> for VelocityPressure {
    #[inline(always)]
    fn fields<S: Simd>(
        normal: [Lanes<S>; 2],
        entries: &[Lanes<S>; FLOW],
        densities: &[Lanes<S>; DENSITIES],
    ) -> [Lanes<S>; 4] {
        let [moved, _] = moved(normal, densities);
        flow_fields(entries, densities, &moved)
    }
}

impl Potential<GRADIENT, 13> for VelocityPressureGradient {
    #[inline(always)]
    fn fields<S: Simd>(
        normal: [Lanes<S>; 2],
        entries: &[Lanes<S>; GRADIENT],
        densities: &[Lanes<S>; DENSITIES],
    ) -> [Lanes<S>; 13] {
        const POLAR: [bool; 3] = [false, true, false];
        const AXIAL: [bool; 3] = [true, false, true];
        let [moved, tau] = moved(normal, densities);
        let flow = flow_fields(entries, densities, &moved);
        let mut fields = [flow[3]; 13];
        fields[..4].copy_from_slice(&flow);
        let along_theta = [densities[6], densities[7], densities[8]];
        let along_curve = [densities[9], densities[10], densities[11]];
        let mut of_moved = [[flow[3]; 3]; 3];
        for l in 0..3 {
            let [position, theta, curve] = [0, 1, 2].map(|v| FLOW + 9 * v + 3 * l);
            let odd = VECTOR_IS_ODD.map(|odd| odd[l]);
            of_moved[l] = turned(&entries[position..], odd[0], &moved, POLAR);
            let of_tau = turned(&entries[position..], odd[0], &tau, POLAR);
            let of_theta = turned(&entries[theta..], odd[1], &along_theta, POLAR);
            let of_curve = turned(&entries[curve..], odd[2], &along_curve, AXIAL);
            for i in 0..3 {
                fields[4 + 3 * i + l] = of_tau[i] + (of_theta[i] + of_curve[i]);
            }
        }
        // dS_ij/dx_l = (-delta_ij x_l + delta_il x_j + delta_jl x_i)/(8 pi |x|^3)
        //              - 3 x_i x_j x_l/(8 pi |x|^5).
        for i in 0..3 {
            for l in 0..3 {
                let triple = &entries[FLOW + 27 + 3 * PAIR_OF[i][l]..][..3];
                let across = triple[1] * moved[1];
                let across = if (i == 1) == (l == 1) {
                    -across
                } else {
                    across
                };
                let mut sum = triple[0] * moved[0] + across + triple[2] * moved[2];
                sum += 0.5 * (of_moved[i][l] - of_moved[l][i]);
                if i == l {
                    sum += 0.5 * flow[3];
                }
                fields[4 + 3 * i + l] += sum;
            }
        }
        fields
    }
}
