//! Direct sums of Stokeslets and stresslets over points in space.

use std::f64::consts::PI;
use std::ops::{AddAssign, Range, SubAssign};

use nalgebra::{Matrix3, Point3, Vector3};
use pulp::{Arch, Simd, WithSimd};

use f64_lanes::{Lanes, PADDING};

/// Points of a surface that carry a double and a single layer, in structure-of-arrays form.
#[derive(Clone, Debug, Default)]
pub(crate) struct SurfacePoints {
    position: [Vec<f64>; 3],
    normal: [Vec<f64>; 3],
    /// Densities times the point's share of the area.
    double: [Vec<f64>; 3],
    single: [Vec<f64>; 3],
}

/// Velocity and pressure at a point, for viscosity 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlowAt {
    /// Velocity.
    pub velocity: Vector3<f64>,
    /// Pressure, zero at infinity.
    pub pressure: f64,
}

/// Velocity, pressure and velocity gradient at a point, for viscosity 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlowGradientAt {
    /// Velocity.
    pub velocity: Vector3<f64>,
    /// Pressure, zero at infinity.
    pub pressure: f64,
    /// Velocity gradient, $\partial u_i / \partial x_j$ in row $i$ and column $j$; in units of
    /// 1/time.
    pub gradient: Matrix3<f64>,
}

impl FlowGradientAt {
    /// The stress $-p I + \nabla u + (\nabla u)^\mathsf{T}$.
    pub fn stress(&self) -> Matrix3<f64> {
        self.gradient + self.gradient.transpose() - Matrix3::from_diagonal_element(self.pressure)
    }
}

impl AddAssign for FlowGradientAt {
    fn add_assign(&mut self, other: Self) {
        self.velocity += other.velocity;
        self.pressure += other.pressure;
        self.gradient += other.gradient;
    }
}

impl SubAssign for FlowGradientAt {
    fn sub_assign(&mut self, other: Self) {
        self.velocity -= other.velocity;
        self.pressure -= other.pressure;
        self.gradient -= other.gradient;
    }
}

impl From<FlowGradientAt> for FlowAt {
    fn from(at: FlowGradientAt) -> Self {
        Self {
            velocity: at.velocity,
            pressure: at.pressure,
        }
    }
}

/// One point of a surface, with its share of the layers.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Where it is.
    pub position: Vector3<f64>,
    /// The outward unit normal.
    pub normal: Vector3<f64>,
    /// The double layer's density times the point's share of the area.
    pub double: Vector3<f64>,
    /// The single layer's, likewise.
    pub single: Vector3<f64>,
}

impl SurfacePoints {
    pub fn with_capacity(count: usize) -> Self {
        let buffers = || std::array::from_fn(|_| Vec::with_capacity(count + PADDING));
        Self {
            position: buffers(),
            normal: buffers(),
            double: buffers(),
            single: buffers(),
        }
    }

    pub fn push(&mut self, point: SurfacePoint) {
        for k in 0..3 {
            self.position[k].push(point.position[k]);
            self.normal[k].push(point.normal[k]);
            self.double[k].push(point.double[k]);
            self.single[k].push(point.single[k]);
        }
    }

    /// Completes the last register with copies of the last point, of no strength.
    pub fn pad(&mut self) {
        while !self.len().is_multiple_of(PADDING) {
            let last = self.len() - 1;
            let position = Vector3::from_fn(|k, _| self.position[k][last]);
            self.push(SurfacePoint {
                position,
                normal: Vector3::zeros(),
                double: Vector3::zeros(),
                single: Vector3::zeros(),
            });
        }
    }

    /// Every point, without those that pad registers.
    pub fn for_each(&self, mut each: impl FnMut(SurfacePoint)) {
        let vector = |of: &[Vec<f64>; 3], i: usize| {
            Vector3::from(of.each_ref().map(|component| component[i]))
        };
        for i in 0..self.len() {
            let normal = vector(&self.normal, i);
            if normal != Vector3::zeros() {
                each(SurfacePoint {
                    position: vector(&self.position, i),
                    normal,
                    double: vector(&self.double, i),
                    single: vector(&self.single, i),
                });
            }
        }
    }

    /// Points, those that pad registers included.
    pub fn len(&self) -> usize {
        self.position[0].len()
    }

    /// Velocity and pressure of both layers at a target, and the velocity gradient if asked for
    /// (else zero), summed in the order of the points; `range` begins and ends where the points
    /// were padded.
    pub fn sum<const GRADIENT: bool>(
        &self,
        range: Range<usize>,
        target: Point3<f64>,
    ) -> FlowGradientAt {
        Arch::new().dispatch(Sum::<GRADIENT> {
            points: self,
            range,
            target,
        })
    }
}

struct Sum<'a, const GRADIENT: bool> {
    points: &'a SurfacePoints,
    range: Range<usize>,
    target: Point3<f64>,
}

impl<'a, const GRADIENT: bool> WithSimd for Sum<'a, GRADIENT> {
    type Output = FlowGradientAt;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> FlowGradientAt {
        let Self {
            points,
            range,
            target,
        } = self;
        let splat = |x| Lanes::splat(simd, x);
        let target = [splat(target.x), splat(target.y), splat(target.z)];
        let registers = |buffer: &'a Vec<f64>| S::as_simd_f64s(&buffer[range.clone()]).0;
        let [x, y, z] = points.position.each_ref().map(registers);
        let [nx, ny, nz] = points.normal.each_ref().map(registers);
        let [fx, fy, fz] = points.double.each_ref().map(registers);
        let [gx, gy, gz] = points.single.each_ref().map(registers);
        let mut velocity = [splat(0.0); 3];
        let mut pressure = splat(0.0);
        let mut gradient = [[splat(0.0); 3]; 3];
        let one = splat(1.0);
        // Common factor 1/(8 pi) left to the end.
        for i in 0..x.len() {
            let position = [Lanes(simd, x[i]), Lanes(simd, y[i]), Lanes(simd, z[i])];
            let f = [Lanes(simd, fx[i]), Lanes(simd, fy[i]), Lanes(simd, fz[i])];
            let g = [Lanes(simd, gx[i]), Lanes(simd, gy[i]), Lanes(simd, gz[i])];
            let n = [Lanes(simd, nx[i]), Lanes(simd, ny[i]), Lanes(simd, nz[i])];
            let d = [
                target[0] - position[0],
                target[1] - position[1],
                target[2] - position[2],
            ];
            let inv2 = one / dot(&d, &d);
            let inv = inv2.sqrt();
            // The direction e = d/|d|: zero where |d|^2 overflows, and with it all that decays
            // faster than 1/|d|.
            let e = [inv * d[0], inv * d[1], inv * d[2]];
            let (ef, eg, en, nf) = (dot(&e, &f), dot(&e, &g), dot(&e, &n), dot(&n, &f));
            // u = (6 (e.f)(e.n)/|d|^2 + (e.g)/|d|) e + g/|d|.
            let both = 6.0 * ef * en * inv;
            let along_e = inv * (both + eg);
            for k in 0..3 {
                velocity[k] += along_e.mul_add(e[k], inv * g[k]);
            }
            // p = 4 (-n.f + 3 (e.f)(e.n))/|d|^3 + 2 (e.g)/|d|^2.
            let isotropic = inv2 * (both + eg);
            pressure += 2.0 * isotropic - 4.0 * (inv * inv2 * nf);
            if GRADIENT {
                // du_k/dx_j = e_k w_j + isotropic delta_kj - g_k e_j/|d|^2.
                let twist = 6.0 * inv * inv2;
                let (along_f, along_n) = (twist * en, twist * ef);
                let radial = -inv2 * (5.0 * both + 3.0 * eg);
                for j in 0..3 {
                    let w = radial * e[j] + inv2 * g[j] + along_f * f[j] + along_n * n[j];
                    let away = inv2 * e[j];
                    for k in 0..3 {
                        gradient[k][j] = e[k].mul_add(w, gradient[k][j] - away * g[k]);
                    }
                    gradient[j][j] += isotropic;
                }
            }
        }
        let factor = 1.0 / (8.0 * PI);
        FlowGradientAt {
            velocity: Vector3::from_fn(|k, _| factor * velocity[k].sum()),
            pressure: factor * pressure.sum(),
            gradient: Matrix3::from_fn(|i, j| factor * gradient[i][j].sum()),
        }
    }
}

/// The velocity at `target` of $w_D D + w_S S$ over points, of weights $[w_D, w_S]$ and one
/// density; the arrays are whole registers long.
pub(crate) fn layer_velocity(
    weights: [f64; 2],
    position: [&[f64]; 3],
    normal: [&[f64]; 3],
    strength: [&[f64]; 3],
    target: Point3<f64>,
) -> Vector3<f64> {
    Arch::new().dispatch(LayerVelocity {
        weights,
        position,
        normal,
        strength,
        target,
    })
}

struct LayerVelocity<'a> {
    weights: [f64; 2],
    position: [&'a [f64]; 3],
    normal: [&'a [f64]; 3],
    strength: [&'a [f64]; 3],
    target: Point3<f64>,
}

impl WithSimd for LayerVelocity<'_> {
    type Output = Vector3<f64>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Vector3<f64> {
        let splat = |x| Lanes::splat(simd, x);
        let [double, single] = [splat(6.0 * self.weights[0]), splat(self.weights[1])];
        let target = [
            splat(self.target.x),
            splat(self.target.y),
            splat(self.target.z),
        ];
        let [x, y, z] = self.position.map(|buffer| S::as_simd_f64s(buffer).0);
        let [nx, ny, nz] = self.normal.map(|buffer| S::as_simd_f64s(buffer).0);
        let [fx, fy, fz] = self.strength.map(|buffer| S::as_simd_f64s(buffer).0);
        let mut velocity = [splat(0.0); 3];
        let one = splat(1.0);
        for i in 0..x.len() {
            let d = [
                target[0] - Lanes(simd, x[i]),
                target[1] - Lanes(simd, y[i]),
                target[2] - Lanes(simd, z[i]),
            ];
            let f = [Lanes(simd, fx[i]), Lanes(simd, fy[i]), Lanes(simd, fz[i])];
            let n = [Lanes(simd, nx[i]), Lanes(simd, ny[i]), Lanes(simd, nz[i])];
            let inv2 = one / dot(&d, &d);
            let inv = inv2.sqrt();
            let (df, dn) = (dot(&d, &f), dot(&d, &n));
            // (6 w_D (d.n)/|d|^5 + w_S/|d|^3) (d.f) d + w_S f/|d|.
            let along = (double * dn).mul_add(inv2, single) * df * inv2 * inv;
            let straight = single * inv;
            for k in 0..3 {
                velocity[k] += along.mul_add(d[k], straight * f[k]);
            }
        }
        let factor = 1.0 / (8.0 * PI);
        Vector3::from_fn(|k, _| factor * velocity[k].sum())
    }
}

#[inline(always)]
fn dot<S: Simd>(a: &[Lanes<S>; 3], b: &[Lanes<S>; 3]) -> Lanes<S> {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}
