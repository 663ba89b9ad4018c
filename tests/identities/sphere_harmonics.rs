//! Layer operators against what is known of them: eigenvalues on the sphere
//! (`data/sphere_harmonics.md`), and Gauss's identities on every kind of body.

use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::RigidMotion;
use axistokes::body::discretization::Discretization;
use axistokes::body::flow::Flow;
use axistokes::body::layers::{LayerWeights, Layers};
use axistokes::body::matrix::{LayerPotential, ModalMatrices};
use axistokes::body::surface::SurfaceModes;
use axistokes::geometry::curve::{Biconcave, Capsule, GeneratingCurve, Panels, Spheroid, Torus};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

const L_MAX: usize = 30;
const M_MAX: usize = 20;

/// The bases of `data/sphere_harmonics.md`.
#[derive(Clone, Copy, Debug)]
enum Basis {
    V,
    W,
    X,
}

/// Orthonormal $\bar P_l^m(\cos\theta)$ for one $m$ and every `l <= L_MAX`, divided by $\sin\theta$
/// if `m > 0`.
fn legendre(m: usize, sin: f64, cos: f64) -> Vec<f64> {
    let mut p = vec![0.0; L_MAX + 1];
    let mut first = (1.0 / (4.0 * PI)).sqrt();
    for k in 1..=m {
        let k = k as f64;
        first *= ((2.0 * k + 1.0) / (2.0 * k)).sqrt() * if k > 1.0 { sin } else { 1.0 };
    }
    for l in m..=L_MAX {
        p[l] = if l == m {
            first
        } else {
            let (l2, m2) = ((l * l) as f64, (m * m) as f64);
            let before = if l > m + 1 {
                let k2 = ((l - 1) * (l - 1)) as f64;
                ((k2 - m2) / (4.0 * k2 - 1.0)).sqrt() * p[l - 2]
            } else {
                0.0
            };
            ((4.0 * l2 - 1.0) / (l2 - m2)).sqrt() * (cos * p[l - 1] - before)
        };
    }
    p
}

/// $Y$, $dY/d\theta$ and $m Y/\sin\theta$ for $Y = \bar P_l^m$, all `[m][l]`, at one point of the
/// unit sphere.
struct Harmonics {
    y: Vec<Vec<f64>>,
    slope: Vec<Vec<f64>>,
    around: Vec<Vec<f64>>,
}

impl Harmonics {
    fn new(sin: f64, cos: f64) -> Self {
        let over: Vec<_> = (0..=M_MAX + 1).map(|m| legendre(m, sin, cos)).collect();
        let scale = |m: usize, by: f64| over[m].iter().map(|p| p * by).collect::<Vec<f64>>();
        let y: Vec<_> = (0..=M_MAX + 1)
            .map(|m| scale(m, if m == 0 { 1.0 } else { sin }))
            .collect();
        let around = (0..=M_MAX).map(|m| scale(m, m as f64)).collect();
        let slope = (0..=M_MAX)
            .map(|m| {
                let up = |l: usize| ((l - m) as f64 * (l + m + 1) as f64).sqrt() * y[m + 1][l];
                let down = |l: usize| ((l + m) as f64 * (l - m + 1) as f64).sqrt() * y[m - 1][l];
                (0..=L_MAX)
                    .map(|l| match m {
                        _ if l < m => 0.0,
                        0 => -up(l),
                        _ => 0.5 * (down(l) - up(l)),
                    })
                    .collect()
            })
            .collect();
        Self { y, slope, around }
    }
}

/// The harmonics of degree `l`, of every order at once: of $Y \cos m\varphi$.
fn density(
    discretization: &Discretization,
    harmonics: &[Harmonics],
    l: usize,
    basis: Basis,
) -> SurfaceModes {
    let mut density = SurfaceModes::zero(M_MAX, harmonics.len());
    for m in 0..=M_MAX.min(l) {
        for (k, (node, h)) in discretization.nodes().iter().zip(harmonics).enumerate() {
            let (sin, cos) = (node.r, node.z);
            let (y, slope, around) = (h.y[m][l], h.slope[m][l], h.around[m][l]);
            let radial = match basis {
                Basis::V => -((l + 1) as f64) * y,
                Basis::W => l as f64 * y,
                Basis::X => 0.0,
            };
            // The gradient is slope cos e_theta - around sin e_phi; X turns it about the radius.
            let (family, polar, azimuthal) = match basis {
                Basis::V | Basis::W => (0, slope, -around),
                Basis::X => (1, around, -slope),
            };
            density.component_mut(m, family, 0)[k] = radial * sin + polar * cos;
            density.component_mut(m, family, 1)[k] = azimuthal;
            density.component_mut(m, family, 2)[k] = radial * cos - polar * sin;
        }
    }
    density
}

/// The norm over the surface of mode `m` of `values - factor density`, up to a constant.
fn difference(
    body: &Discretization,
    values: &SurfaceModes,
    factor: f64,
    density: &SurfaceModes,
    m: usize,
) -> f64 {
    let mut sum = 0.0;
    for (family, j) in (0..2).flat_map(|f| (0..3).map(move |j| (f, j))) {
        let (values, density) = (
            values.component(m, family, j),
            density.component(m, family, j),
        );
        for (node, (v, d)) in body.nodes().iter().zip(values.iter().zip(density)) {
            sum += node.weight * (v - factor * d).powi(2);
        }
    }
    sum.sqrt()
}

/// Eigenvalues `[l][s_v, s_w, s_x, d_v, d_w, d_x]`.
fn eigenvalues() -> Vec<Vec<Option<f64>>> {
    include_str!("../data/sphere_harmonics.csv")
        .lines()
        .filter(|line| !line.starts_with(['#', 'l']))
        .map(|line| line.split(',').skip(1).map(|x| x.parse().ok()).collect())
        .collect()
}

fn discretize(curve: Arc<dyn GeneratingCurve>, panels: Panels, order: usize) -> Discretization {
    Discretization::new(curve, panels, order).expect("nodes")
}

/// Largest errors, in the norm over the surface, relative to the result and to the density, over
/// every degree and order.
fn worst(layer: LayerPotential, panels: usize, order: usize) -> (f64, f64) {
    let sphere = Arc::new(Spheroid::sphere(1.0).expect("a sphere"));
    let panels = Panels::uniform(&*sphere, panels).expect("panels");
    let body = discretize(sphere, panels, order);
    let harmonics: Vec<_> = (body.nodes().iter())
        .map(|node| Harmonics::new(node.r, node.z))
        .collect();
    let matrices = ModalMatrices::of(layer, &body, M_MAX).expect("matrices");
    let first = if layer == LayerPotential::Single {
        0
    } else {
        3
    };
    let of_degree = |(l, eigenvalues): (usize, Vec<Option<f64>>)| {
        let mut errors = Vec::new();
        for (basis, factor) in [Basis::V, Basis::W, Basis::X]
            .into_iter()
            .zip(&eigenvalues[first..])
        {
            // W and X of degree 0 vanish.
            let Some(factor) = *factor else { continue };
            let density = density(&body, &harmonics, l, basis);
            let values = matrices.apply(&body, &density);
            for m in 0..=M_MAX.min(l) {
                let zero = SurfaceModes::zero(M_MAX, body.nodes().len());
                let norm = difference(&body, &density, 0.0, &zero, m);
                let error = difference(&body, &values, factor, &density, m) / norm;
                // Only S V_0 vanishes.
                let of_result = if factor == 0.0 {
                    error
                } else {
                    error / factor.abs()
                };
                errors.push((of_result, error, format!("{basis:?} {l} {m}")));
            }
        }
        errors
    };
    let errors: Vec<_> = (eigenvalues().into_par_iter().enumerate())
        .flat_map_iter(of_degree)
        .collect();
    let (relative, at) = (errors.iter()).fold((0.0, ""), |worst, (relative, _, at)| {
        if *relative > worst.0 {
            (*relative, at)
        } else {
            worst
        }
    });
    let absolute = errors.iter().map(|e| e.1).fold(0.0, f64::max);
    println!(
        "{layer:?}, {} panels x {order}: error {relative:.1e} of the result, at {at}; {absolute:.1e} of the density",
        body.panels().len()
    );
    (relative, absolute)
}

/// Every degree up to 30 and order up to 20; degree 30 itself takes some panels.
#[test]
fn sphere_eigenvalues() {
    let layers = [
        LayerPotential::Single,
        LayerPotential::Double,
        LayerPotential::SingleTraction,
    ];
    for layer in layers {
        let ten = [16, 32].map(|panels| worst(layer, panels, 10).1);
        let sixteen = [8, 16].map(|panels| worst(layer, panels, 16).1);
        let orders = [ten, sixteen].map(|[coarse, fine]| (coarse / fine).log2());
        println!("{layer:?}: orders {:.1} and {:.1}", orders[0], orders[1]);
        assert!(orders[0] > 9.5 && orders[1] > 15.0);
        let (relative, absolute) = worst(layer, 24, 16);
        assert!(relative <= 1e-12 && absolute <= 1e-14);
    }
}

/// A sphere, and bodies of every kind with panels that resolve them.
fn bodies() -> Vec<Discretization> {
    let curves: [Arc<dyn GeneratingCurve>; 7] = [
        Arc::new(Spheroid::sphere(1.0).expect("a sphere")),
        Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid")),
        Arc::new(Spheroid::new(0.05, 1.0).expect("a disc")),
        Arc::new(Torus::new(1.0, 0.25).expect("a torus")),
        Arc::new(Torus::new(1.0, 0.9).expect("a fat torus")),
        Arc::new(Capsule::new(0.5, 2.0).expect("a capsule")),
        Arc::new(Biconcave::new(1.0).expect("a red cell")),
    ];
    curves
        .into_iter()
        .map(|curve| {
            let panels = Panels::resolving(&*curve, 16, 1e-10).expect("panels");
            discretize(curve, panels.bisected(|_| true), 16)
        })
        .collect()
}

fn motions() -> [RigidMotion; 4] {
    let motion = |velocity, angular_velocity| RigidMotion {
        velocity,
        angular_velocity,
    };
    [
        motion(Vector3::z(), Vector3::zeros()),
        motion(Vector3::x(), Vector3::zeros()),
        motion(Vector3::zeros(), Vector3::z()),
        motion(Vector3::zeros(), Vector3::new(0.6, -0.8, 0.0)),
    ]
}

/// Largest coefficient of mode `n` of `values` plus half of `density`.
fn largest_difference(values: &SurfaceModes, density: &SurfaceModes, n: usize) -> f64 {
    let mut most = 0.0f64;
    for (family, j) in (0..2).flat_map(|f| (0..3).map(move |j| (f, j))) {
        let (values, density) = (
            values.component(n, family, j),
            density.component(n, family, j),
        );
        let pairs = values.iter().zip(density);
        most = pairs.fold(most, |most, (v, d)| most.max((v + 0.5 * d).abs()));
    }
    most
}

#[test]
fn gauss_identities() {
    for body in bodies() {
        let double = ModalMatrices::of(LayerPotential::Double, &body, 1).expect("matrices");
        let mut worst = 0.0f64;
        for motion in motions() {
            let density = SurfaceModes::of_motion(&body, &motion);
            let values = double.apply(&body, &density);
            for n in 0..=1 {
                worst = worst.max(largest_difference(&values, &density, n));
            }
        }
        let single = ModalMatrices::of(LayerPotential::Single, &body, 0).expect("matrices");
        let mut normal = SurfaceModes::zero(0, body.nodes().len());
        for (k, node) in body.nodes().iter().enumerate() {
            normal.component_mut(0, 0, 0)[k] = node.normal[0];
            normal.component_mut(0, 0, 2)[k] = node.normal[1];
        }
        let of_normal = single.apply(&body, &normal).amplitude(0) / body.size();
        println!(
            "{:?}, {} panels: D of rigid motions {worst:.1e}, S of the normal {of_normal:.1e}",
            body.curve(),
            body.panels().len()
        );
        assert!(worst <= 1e-12 && of_normal <= 1e-12);
    }
}

/// A density without symmetry, smooth on the surface.
fn some_density(body: &Discretization) -> SurfaceModes {
    let field = |x: Vector3<f64>| {
        Vector3::new(
            1.0 + x.y * x.z,
            x.x - 0.5 * x.z * x.z,
            (0.7 * x.x + x.z).sin(),
        )
    };
    SurfaceModes::sample(body, 12, field).modes
}

/// The mean of a Stokes flow over a sphere of radius `R` around everything that drives it is $F / 6
/// \pi R$, however the force `F` is distributed.
#[test]
fn net_force() {
    for body in bodies() {
        let density = some_density(&body);
        let radius = 2.5 * body.size();
        let sphere = Arc::new(Spheroid::sphere(radius).expect("a sphere"));
        let panels = Panels::uniform(&*sphere, 4).expect("panels");
        let sphere = discretize(sphere, panels, 16);
        let around = 64;
        let mut targets = Vec::new();
        for node in sphere.nodes() {
            targets.extend((0..around).map(|k| {
                let (sin, cos) = (2.0 * PI * k as f64 / around as f64).sin_cos();
                Point3::new(node.r * cos, node.r * sin, node.z)
            }));
        }
        let mean = |double: f64, single: f64| {
            let weights = LayerWeights { double, single };
            let flow = Flow::new(&body, Layers::weighted(&density, weights));
            let at = flow.at(&targets, 1e-14).expect("targets far enough");
            let mut sum = Vector3::zeros();
            for (node, ring) in sphere.nodes().iter().zip(at.chunks(around as usize)) {
                let ring: Vector3<f64> = ring.iter().map(|at| at.velocity).sum();
                sum += node.weight * 2.0 * PI / around as f64 * ring;
            }
            sum / sphere.area()
        };
        let force = density.wrench(&body).force;
        let scale = force.norm() / (6.0 * PI * radius);
        let of_double = mean(1.0, 0.0).norm() / scale;
        let of_single = (mean(0.0, 1.0) - force / (6.0 * PI * radius)).norm() / scale;
        println!(
            "{:?}: net force of D {of_double:.1e}, of S {of_single:.1e}",
            body.curve()
        );
        assert!(of_double <= 1e-13 && of_single <= 1e-13);
    }
}

/// Outside, the double layer of a rigid motion is at rest.
#[test]
fn rigid_motions_are_at_rest_outside() {
    for body in bodies() {
        let s = 2.0 * body.size();
        let targets = [
            Point3::new(s, 0.0, 0.1),
            Point3::new(0.3, -0.4, s),
            Point3::new(-s, s, -s),
        ];
        for motion in motions() {
            let density = SurfaceModes::of_motion(&body, &motion);
            let weights = LayerWeights {
                double: 1.0,
                single: 0.0,
            };
            let flow = Flow::new(&body, Layers::weighted(&density, weights));
            for at in flow.at(&targets, 1e-14).expect("targets far enough") {
                assert!(
                    at.velocity.amax() <= 1e-13 && at.pressure.abs() <= 1e-12,
                    "{at:?}"
                );
            }
        }
    }
}
