//! Close evaluation: velocity, pressure and gradient at any distance from the surface, against exact flows.

use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::body::flow::Side;
use axistokes::curve::{GeneratingCurve, Meridian};
use axistokes::*;
use nalgebra::{Matrix3, Point3, Vector3};

/// The velocity gradient of a Stokeslet: with d from its place,
/// 8 pi du_i/dx_j = (-f_i d_j + f_j d_i + (d.f) delta_ij)/d^3 - 3 (d.f) d_i d_j/d^5.
fn gradient(stokeslet: &Stokeslet, x: Vector3<f64>) -> Matrix3<f64> {
    let (d, f) = (x - stokeslet.at, stokeslet.force);
    let r = d.norm();
    let (along, r3) = (d.dot(&f), r.powi(3));
    (d * f.transpose() - f * d.transpose() + Matrix3::identity() * along) / (8.0 * PI * r3)
        - d * d.transpose() * (3.0 * along / (8.0 * PI * r3 * r * r))
}

struct Known(Vec<Stokeslet>);

impl Known {
    fn velocity(&self, x: Vector3<f64>) -> Vector3<f64> {
        self.0.iter().map(|s| s.velocity(x)).sum()
    }
    fn pressure(&self, x: Vector3<f64>) -> f64 {
        self.0.iter().map(|s| s.pressure(x)).sum()
    }
    fn gradient(&self, x: Vector3<f64>) -> Matrix3<f64> {
        self.0.iter().map(|s| gradient(s, x)).sum()
    }
}

/// Stokeslets that the thesis puts into its spheroid 0.5 x 1, within a tenth of the axis.
fn inside() -> Known {
    let mut random = fastrand::Rng::with_seed(7);
    let mut number = || 2.0 * random.f64() - 1.0;
    Known(
        (0..5)
            .map(|_| Stokeslet {
                at: Vector3::new(0.1 * number(), 0.1 * number(), 0.4 * number()),
                force: Vector3::new(number(), number(), number()),
            })
            .collect(),
    )
}

/// Points at a distance from random places of the surface, the poles among them, on one side.
fn targets(
    curve: &dyn GeneratingCurve,
    distance: f64,
    side: Side,
    count: usize,
) -> Vec<Point3<f64>> {
    let mut random = fastrand::Rng::with_seed(9);
    let ends = curve.breakpoints();
    let (first, last) = (ends[0], ends[ends.len() - 1]);
    (0..count)
        .map(|k| {
            let s = match k {
                0 => first,
                1 => last,
                2 => 0.5 * (first + last),
                _ => first + (last - first) * random.f64(),
            };
            let theta = 2.0 * PI * random.f64();
            let Meridian { r, z } = curve.point(s);
            let t = curve.tangent(s);
            let signed = if side == Side::Exterior {
                distance
            } else {
                -distance
            } / t.r.hypot(t.z);
            let (r, z) = (r - signed * t.z, z + signed * t.r);
            Point3::new(r * theta.cos(), r * theta.sin(), z)
        })
        .collect()
}

#[derive(Debug, Default, Clone, Copy)]
struct Errors {
    velocity: f64,
    pressure: f64,
    gradient: f64,
}

fn errors(known: &Known, targets: &[Point3<f64>], found: &[FlowGradientAt], offset: f64) -> Errors {
    let mut errors = Errors::default();
    for (x, at) in targets.iter().zip(found) {
        let x = x.coords;
        errors.velocity = errors
            .velocity
            .max((at.velocity - known.velocity(x)).norm());
        errors.pressure = errors
            .pressure
            .max((at.pressure - offset - known.pressure(x)).abs());
        errors.gradient = errors
            .gradient
            .max((at.gradient - known.gradient(x)).norm());
    }
    errors
}

#[test]
fn thesis_body_from_outside() {
    let curve = Arc::new(Spheroid::new(1.0, 0.5).unwrap());
    let known = inside();
    for (panels, modes) in [(8, 60), (12, 80)] {
        let panels = Panels::equal_arcs(&*curve, panels).unwrap();
        let nodes = Discretization::new(curve.clone(), panels, 16).unwrap();
        let solver =
            DirichletSolver::new(nodes, Formulation::CombinedField, modes, &Silent).unwrap();
        let data = SurfaceModes::sample(solver.discretization(), modes, |x| known.velocity(x));
        let density = solver.solve(&data.modes);
        let flow = solver.flow(&density);
        for k in [0, 1, 2, 3, 4, 6, 8, 10, 12, 14, 16] {
            let distance = 10f64.powi(-k);
            let targets = targets(&*curve, distance, Side::Exterior, 200);
            let start = std::time::Instant::now();
            let found = flow.gradient_at(&targets, 1e-13).unwrap();
            let full = start.elapsed().as_secs_f64();
            let start = std::time::Instant::now();
            flow.at(&targets, 1e-13).unwrap();
            let plain = start.elapsed().as_secs_f64();
            let e = errors(&known, &targets, &found, 0.0);
            println!(
                "{modes} modes, 1e-{k}: {:.1e} {:.1e} {:.1e}; {:.0} us, {:.0} us",
                e.velocity,
                e.pressure,
                e.gradient,
                full * 5e3,
                plain * 5e3
            );
        }
    }
}
