//! Stokeslets, stresslets, rotlets and sources, at viscosity 1.

#![expect(
    clippy::needless_range_loop,
    reason = "index loops over small fixed arrays are what stays in registers"
)]

use f64_lanes::{Isa, Lanes};

use super::chain::{Chain, EIGHTH};
use super::pair::{MOST, Pair};
use super::vector::{broadcast, dot, scaled};

/// Singularities of Stokes flow.
///
/// Numbers per source: force 3, stresslet density 3 and normal 3, torque 3, flux 1, in this order.
/// `STRENGTHS` = 3 has the force, 6 the stresslet, 9 both, and 13 all of them. Numbers per target:
/// velocity 3, pressure 1, gradient 9 ($\partial u_i / \partial x_j$, row by row); `OUTPUTS` is 3,
/// 4 or 13 of them.
#[derive(Clone, Copy)]
pub(crate) struct Stokes<const STRENGTHS: usize, const OUTPUTS: usize>;

/// Where the pressure stands among the outputs.
const PRESSURE: usize = 3;
/// Where the gradient begins.
const GRADIENT: usize = 4;

impl<const STRENGTHS: usize, const OUTPUTS: usize> Pair for Stokes<STRENGTHS, OUTPUTS> {
    const STRENGTHS: usize = STRENGTHS;
    const OUTPUTS: usize = OUTPUTS;
    const ORDERS: [usize; 2] = {
        let first = if STRENGTHS == 6 { 2 } else { 1 };
        let velocity = if STRENGTHS == 3 { 2 } else { 3 };
        [first, velocity + (OUTPUTS > 3) as usize]
    };
    const FACTORS: [f64; MOST] = {
        let mut factors = [EIGHTH; MOST];
        let mut i = 0;
        while i < 3 {
            let density = if STRENGTHS == 6 { 0 } else { 3 };
            if STRENGTHS >= 6 {
                factors[density + i] = -6.0 * EIGHTH;
                factors[density + 3 + i] = 1.0;
            }
            i += 1;
        }
        factors[12] = 2.0 * EIGHTH;
        factors
    };

    #[inline(always)]
    fn add<S: Isa, const SINGULAR: bool>(
        x: &[Lanes<S>; 3],
        chain: &Chain<S, SINGULAR>,
        strength: &[f64],
        out: &mut [Lanes<S>; MOST],
    ) {
        let simd = x[0].0;
        if STRENGTHS != 6 {
            stokeslet::<S, SINGULAR, OUTPUTS>(x, chain, &broadcast(simd, strength, 0), out);
        }
        if STRENGTHS >= 6 {
            let first = if STRENGTHS == 6 { 0 } else { 3 };
            let density = broadcast(simd, strength, first);
            let normal = broadcast(simd, strength, first + 3);
            stresslet::<S, SINGULAR, OUTPUTS>(x, chain, &density, &normal, out);
        }
        if STRENGTHS == 13 {
            rotlet::<S, SINGULAR, OUTPUTS>(x, chain, &broadcast(simd, strength, 9), out);
            source::<S, SINGULAR, OUTPUTS>(x, chain, Lanes::splat(simd, strength[12]), out);
        }
    }
}

/// Adds $x_i w$ to the vector.
#[inline(always)]
fn add_multiple<S: Isa>(x: &[Lanes<S>; 3], w: Lanes<S>, out: &mut [Lanes<S>; MOST]) {
    for i in 0..3 {
        out[i] = x[i].mul_add(w, out[i]);
    }
}

/// Adds $x_i y_k$ to the gradient.
#[inline(always)]
fn add_outer<S: Isa>(x: &[Lanes<S>; 3], y: &[Lanes<S>; 3], out: &mut [Lanes<S>; MOST]) {
    for i in 0..3 {
        for k in 0..3 {
            let place = GRADIENT + 3 * i + k;
            out[place] = x[i].mul_add(y[k], out[place]);
        }
    }
}

/// Adds $\delta_{ik} w$ to the gradient.
#[inline(always)]
fn add_identity<S: Isa>(w: Lanes<S>, out: &mut [Lanes<S>; MOST]) {
    for i in 0..3 {
        out[GRADIENT + 4 * i] += w;
    }
}

/// $x_i w$.
#[inline(always)]
fn times<S: Isa>(x: &[Lanes<S>; 3], w: Lanes<S>) -> [Lanes<S>; 3] {
    [x[0] * w, x[1] * w, x[2] * w]
}

/// $x_i w + y_i$.
#[inline(always)]
fn times_add<S: Isa>(x: &[Lanes<S>; 3], w: Lanes<S>, y: &[Lanes<S>; 3]) -> [Lanes<S>; 3] {
    [
        x[0].mul_add(w, y[0]),
        x[1].mul_add(w, y[1]),
        x[2].mul_add(w, y[2]),
    ]
}

/// $u = a f + b\,x (x \cdot f)$, $p = -\lambda_1 (x \cdot f)$.
#[inline(always)]
fn stokeslet<S: Isa, const SINGULAR: bool, const OUTPUTS: usize>(
    x: &[Lanes<S>; 3],
    chain: &Chain<S, SINGULAR>,
    force: &[Lanes<S>; 3],
    out: &mut [Lanes<S>; MOST],
) {
    let along = dot(x, force);
    if SINGULAR && OUTPUTS <= PRESSURE {
        // One multiplication less than by a and b.
        let turned = times_add(x, along * (chain.a() * chain.a()), force);
        add_multiple(&turned, chain.a(), out);
        return;
    }
    add_multiple(force, chain.a(), out);
    add_multiple(x, chain.b() * along, out);
    if OUTPUTS > PRESSURE {
        out[PRESSURE] = scaled(2.0, chain.dipole()).mul_add(along, out[PRESSURE]);
    }
    if OUTPUTS > GRADIENT {
        let tangent = times(x, chain.b_slope() * along);
        let row = times_add(force, chain.b(), &tangent);
        add_outer(force, &times(x, chain.a_slope()), out);
        add_outer(x, &row, out);
        add_identity(chain.b() * along, out);
    }
}

/// $u = c_5\,x (x \cdot q)(x \cdot n) + c_3 [(q \cdot n) x + (x \cdot q) n + (x \cdot n) q]$,
/// $p = -2 [\lambda_1 (q \cdot n) + \lambda_2 (x \cdot q)(x \cdot n)]$, with $-6$ in $q$ already.
#[inline(always)]
fn stresslet<S: Isa, const SINGULAR: bool, const OUTPUTS: usize>(
    x: &[Lanes<S>; 3],
    chain: &Chain<S, SINGULAR>,
    q: &[Lanes<S>; 3],
    n: &[Lanes<S>; 3],
    out: &mut [Lanes<S>; MOST],
) {
    let (xq, xn) = (dot(x, q), dot(x, n));
    let both = xq * xn;
    let radial = chain.c5() * both;
    // The product q.n is the same in all lanes, but one more register costs less than a layout of
    // its own.
    let qn = dot(q, n);
    if SINGULAR {
        add_multiple(x, radial, out);
    } else {
        let c3 = chain.c3();
        add_multiple(x, c3.mul_add(qn, radial), out);
        add_multiple(n, c3 * xq, out);
        add_multiple(q, c3 * xn, out);
    }
    if OUTPUTS > PRESSURE {
        let trace = scaled(-2.0 / 3.0, qn);
        let quadrupole = scaled(2.0, chain.quadrupole());
        out[PRESSURE] = quadrupole.mul_add(both, chain.dipole().mul_add(trace, out[PRESSURE]));
    }
    if OUTPUTS > GRADIENT {
        let row = times(q, chain.c5() * xn);
        let row = times_add(n, chain.c5() * xq, &row);
        if SINGULAR {
            add_outer(x, &times_add(x, chain.c5_slope() * both, &row), out);
            add_identity(radial, out);
        } else {
            let (c3, slope) = (chain.c3(), chain.c3_slope());
            let outward = chain.c5_slope().mul_add(both, slope * qn);
            add_outer(x, &times_add(x, outward, &row), out);
            add_identity(c3.mul_add(qn, radial), out);
            add_outer(n, &times_add(x, slope * xq, &times(q, c3)), out);
            add_outer(q, &times_add(x, slope * xn, &times(n, c3)), out);
        }
    }
}

/// $u = -\frac12 \lambda_1\,t \times x$, $p = 0$.
#[inline(always)]
fn rotlet<S: Isa, const SINGULAR: bool, const OUTPUTS: usize>(
    x: &[Lanes<S>; 3],
    chain: &Chain<S, SINGULAR>,
    torque: &[Lanes<S>; 3],
    out: &mut [Lanes<S>; MOST],
) {
    let t = torque;
    let cross = [
        t[1] * x[2] - t[2] * x[1],
        t[2] * x[0] - t[0] * x[2],
        t[0] * x[1] - t[1] * x[0],
    ];
    let dipole = chain.dipole();
    add_multiple(&cross, dipole, out);
    if OUTPUTS > GRADIENT {
        add_outer(&cross, &times(x, scaled(-3.0, chain.quadrupole())), out);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            let turn = dipole * t[i];
            out[GRADIENT + 3 * k + j] += turn;
            out[GRADIENT + 3 * j + k] = out[GRADIENT + 3 * j + k] - turn;
        }
    }
}

/// $u = -s \lambda_1 x$, $p = 0$, with 2 in $s$ already.
#[inline(always)]
fn source<S: Isa, const SINGULAR: bool, const OUTPUTS: usize>(
    x: &[Lanes<S>; 3],
    chain: &Chain<S, SINGULAR>,
    flux: Lanes<S>,
    out: &mut [Lanes<S>; MOST],
) {
    let dipole = chain.dipole() * flux;
    add_multiple(x, dipole, out);
    if OUTPUTS > GRADIENT {
        let outward = scaled(-3.0, chain.quadrupole()) * flux;
        add_outer(x, &times(x, outward), out);
        add_identity(dipole, out);
    }
}
