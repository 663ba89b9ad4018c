//! Direct sums of Stokeslets and stresslets over points in space.

use std::f64::consts::PI;

use nalgebra::{Point3, Vector3};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

use crate::special::lanes::{Lanes, PADDING};

/// Points of a surface that carry a combined field, in structure-of-arrays form.
#[derive(Clone, Debug, Default)]
pub(crate) struct SurfacePoints {
    position: [Vec<f64>; 3],
    normal: [Vec<f64>; 3],
    /// Density times the point's share of the area.
    strength: [Vec<f64>; 3],
}

/// How much of each layer potential of a density makes up a flow: $u = w_D D[\sigma] + w_S S[\sigma]$.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerWeights {
    /// Weight $w_D$ of the double layer, a number.
    pub double: f64,
    /// Weight $w_S$ of the single layer; beside a double layer, in units of 1/length.
    pub single: f64,
}

/// Velocity and pressure at a point, for viscosity 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowAt {
    /// Velocity.
    pub velocity: Vector3<f64>,
    /// Pressure, zero at infinity.
    pub pressure: f64,
}

impl SurfacePoints {
    pub fn with_capacity(count: usize) -> Self {
        let buffers = || std::array::from_fn(|_| Vec::with_capacity(count + PADDING));
        Self {
            position: buffers(),
            normal: buffers(),
            strength: buffers(),
        }
    }

    pub fn push(&mut self, position: Vector3<f64>, normal: Vector3<f64>, strength: Vector3<f64>) {
        for k in 0..3 {
            self.position[k].push(position[k]);
            self.normal[k].push(normal[k]);
            self.strength[k].push(strength[k]);
        }
    }

    /// Completes the last register with points far away from everything, of no strength.
    pub fn pad(&mut self) {
        while !self.position[0].len().is_multiple_of(PADDING) {
            self.push(Vector3::repeat(1e100), Vector3::zeros(), Vector3::zeros());
        }
    }

    /// Velocity and pressure of the layer potentials at every target, the sum in the order of the points; parallel over targets.
    pub fn flow(&self, weights: LayerWeights, targets: &[Point3<f64>]) -> Vec<FlowAt> {
        targets
            .par_iter()
            .map(|&target| {
                Arch::new().dispatch(Sum {
                    points: self,
                    weights,
                    target,
                })
            })
            .collect()
    }
}

struct Sum<'a> {
    points: &'a SurfacePoints,
    weights: LayerWeights,
    target: Point3<f64>,
}

impl WithSimd for Sum<'_> {
    type Output = FlowAt;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> FlowAt {
        let Self {
            points,
            weights,
            target,
        } = self;
        let splat = |x| Lanes::splat(simd, x);
        let target = [splat(target.x), splat(target.y), splat(target.z)];
        let [x, y, z] = points.position.each_ref().map(|b| S::as_simd_f64s(b).0);
        let [nx, ny, nz] = points.normal.each_ref().map(|b| S::as_simd_f64s(b).0);
        let [fx, fy, fz] = points.strength.each_ref().map(|b| S::as_simd_f64s(b).0);
        let mut velocity = [splat(0.0); 3];
        let mut pressure = splat(0.0);
        let one = splat(1.0);
        // Common factor 1/(8 pi) left to the end.
        let (six, four) = (splat(6.0 * weights.double), splat(4.0 * weights.double));
        let (single, twice) = (splat(weights.single), splat(2.0 * weights.single));
        for i in 0..x.len() {
            let position = [Lanes(simd, x[i]), Lanes(simd, y[i]), Lanes(simd, z[i])];
            let f = [Lanes(simd, fx[i]), Lanes(simd, fy[i]), Lanes(simd, fz[i])];
            let n = [Lanes(simd, nx[i]), Lanes(simd, ny[i]), Lanes(simd, nz[i])];
            let d = [
                target[0] - position[0],
                target[1] - position[1],
                target[2] - position[2],
            ];
            let inv2 = one / dot(&d, &d);
            let inv = inv2.sqrt();
            let inv3 = inv * inv2;
            let (df, dn, nf) = (dot(&d, &f), dot(&d, &n), dot(&n, &f));
            // 6 w_D (d.f)(d.n)/|d|^5 + w_S (d.f)/|d|^3 along d, w_S/|d| along f.
            let stresslet = six * dn * inv2;
            let along_d = df * inv3 * (stresslet + single);
            let along_f = single * inv;
            for k in 0..3 {
                velocity[k] = velocity[k] + along_d.mul_add(d[k], along_f * f[k]);
            }
            // 4 w_D (-n.f + 3 (d.f)(d.n)/|d|^2)/|d|^3 + 2 w_S (d.f)/|d|^3.
            let in_brackets = df.mul_add(2.0 * stresslet + twice, -(four * nf));
            pressure = inv3.mul_add(in_brackets, pressure);
        }
        let factor = 1.0 / (8.0 * PI);
        FlowAt {
            velocity: Vector3::new(velocity[0].sum(), velocity[1].sum(), velocity[2].sum())
                * factor,
            pressure: pressure.sum() * factor,
        }
    }
}

#[inline(always)]
fn dot<S: Simd>(a: &[Lanes<S>; 3], b: &[Lanes<S>; 3]) -> Lanes<S> {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}
