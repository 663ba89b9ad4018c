//! Points and strengths that tests and examples share.

#![allow(
    dead_code,
    reason = "each test and example is a crate of its own and uses a part"
)]

use std::f64::consts::PI;

use fastrand::Rng;
use panel_quadrature::GaussLegendre;
use stokes_fmm::{Flow, Singularities, Strengths, Stresslets};

/// Sources with the normals of their stresslets.
#[derive(Clone, Default)]
pub struct Cloud {
    pub points: Vec<[f64; 3]>,
    pub normals: Vec<[f64; 3]>,
}

impl Cloud {
    /// Points with random normals.
    pub fn of(points: Vec<[f64; 3]>, random: &mut Rng) -> Self {
        let normals = points.iter().map(|_| direction(random)).collect();
        Self { points, normals }
    }

    /// Uniform in the unit cube.
    pub fn cube(count: usize, random: &mut Rng) -> Self {
        Self::of((0..count).map(|_| in_cube(random)).collect(), random)
    }

    /// Surfaces of randomly oriented spheroids with semi-axes 0.5, 0.5 and 1, of [`ON_SPHEROID`]
    /// points each, on a jittered cubic grid of spacing 2.4.
    pub fn spheroids(spheroids: usize, random: &mut Rng) -> Self {
        const SPACING: f64 = 2.4;
        let per_edge = (1..).find(|n: &usize| n.pow(3) >= spheroids).unwrap_or(1);
        let surface = spheroid();
        let mut cloud = Self::default();
        for number in 0..spheroids {
            let place = [
                number % per_edge,
                number / per_edge % per_edge,
                number / per_edge.pow(2),
            ];
            // The spheres around the spheroids must not overlap.
            let center = place.map(|i| SPACING * i as f64 + 0.4 * (random.f64() - 0.5));
            let frame = frame(random);
            cloud
                .normals
                .extend(surface.normals.iter().map(|n| turned(&frame, n)));
            cloud.points.extend(surface.points.iter().map(|x| {
                let x = turned(&frame, x);
                [0, 1, 2].map(|k| center[k] + x[k])
            }));
        }
        cloud
    }

    pub fn len(&self) -> usize {
        self.points.len()
    }
}

/// Points on the rings of a spheroid, and points per ring.
const RINGS: usize = 50;
const ON_RING: usize = 51;
/// Points on a spheroid.
pub const ON_SPHEROID: usize = RINGS * ON_RING;

/// The prolate spheroid around z.
fn spheroid() -> Cloud {
    let (across, along) = (0.5, 1.0);
    let mut cloud = Cloud::default();
    let rings = GaussLegendre::new(RINGS).expect("an order it has");
    for &z in rings.nodes() {
        for step in 0..ON_RING {
            let (sine, cosine) = (2.0 * PI * step as f64 / ON_RING as f64).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            let unit = [radius * cosine, radius * sine, z];
            cloud
                .points
                .push([across * unit[0], across * unit[1], along * unit[2]]);
            cloud.normals.push(normalized([
                unit[0] / across,
                unit[1] / across,
                unit[2] / along,
            ]));
        }
    }
    cloud
}

/// Uniform in the unit cube.
pub fn in_cube(random: &mut Rng) -> [f64; 3] {
    [0; 3].map(|_| random.f64())
}

/// A unit vector, any direction as likely as any other.
pub fn direction(random: &mut Rng) -> [f64; 3] {
    loop {
        let x = in_cube(random).map(|x| 2.0 * x - 1.0);
        if (0.01..=1.0).contains(&dot(x, x)) {
            return normalized(x);
        }
    }
}

/// Three unit vectors, each perpendicular to the others.
pub fn frame(random: &mut Rng) -> [[f64; 3]; 3] {
    let first = direction(random);
    let second = normalized(cross(first, direction(random)));
    [second, cross(first, second), first]
}

/// The vector whose components are along the axes of a frame.
pub fn turned(frame: &[[f64; 3]; 3], x: &[f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| x[0] * frame[0][k] + x[1] * frame[1][k] + x[2] * frame[2][k])
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub fn normalized(x: [f64; 3]) -> [f64; 3] {
    let length = dot(x, x).sqrt();
    x.map(|x| x / length)
}

/// Strengths of every kind, uniform in [-1/2, 1/2].
#[derive(Clone, Default)]
pub struct Amounts {
    pub forces: Vec<[f64; 3]>,
    pub densities: Vec<[f64; 3]>,
    pub normals: Vec<[f64; 3]>,
    pub torques: Vec<[f64; 3]>,
    pub fluxes: Vec<f64>,
}

impl Amounts {
    pub fn random(normals: &[[f64; 3]], random: &mut Rng) -> Self {
        let mut vectors = || -> Vec<[f64; 3]> {
            let one = |_: &_| in_cube(random).map(|x| x - 0.5);
            normals.iter().map(one).collect()
        };
        let (forces, densities, torques) = (vectors(), vectors(), vectors());
        Self {
            forces,
            densities,
            normals: normals.to_vec(),
            torques,
            fluxes: normals.iter().map(|_| random.f64() - 0.5).collect(),
        }
    }

    /// Those of some kinds.
    pub fn strengths(&self, singularities: Singularities) -> Strengths<'_> {
        use Singularities::{All, Both, Stokeslets, Stresslets as Layers};
        let all = singularities == All;
        Strengths {
            stokeslets: matches!(singularities, Stokeslets | Both | All).then_some(&self.forces),
            stresslets: matches!(singularities, Layers | Both | All).then_some(Stresslets {
                densities: &self.densities,
                normals: &self.normals,
            }),
            rotlets: all.then_some(&self.torques),
            fluxes: all.then_some(&self.fluxes),
        }
    }
}

/// $|a - b| / |b|$ in the Euclidean norm; 0 for two zeros.
pub fn relative_error(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let error: f64 = found
        .iter()
        .zip(expected)
        .map(|(a, b)| (a - b).powi(2))
        .sum();
    let size: f64 = expected.iter().map(|b| b * b).sum();
    if error == 0.0 {
        0.0
    } else {
        (error / size).sqrt()
    }
}

/// Relative errors of velocity, pressure and gradient; 0 for what is not there.
pub fn errors(found: &Flow, expected: &Flow) -> [f64; 3] {
    [
        relative_error(
            found.velocity.as_flattened(),
            expected.velocity.as_flattened(),
        ),
        relative_error(&found.pressure, &expected.pressure),
        relative_error(
            found.gradient.as_flattened().as_flattened(),
            expected.gradient.as_flattened().as_flattened(),
        ),
    ]
}

/// A part of a flow, every so many targets.
pub fn every(flow: &Flow, stride: usize) -> Flow {
    Flow {
        velocity: flow.velocity.iter().step_by(stride).copied().collect(),
        pressure: flow.pressure.iter().step_by(stride).copied().collect(),
        gradient: flow.gradient.iter().step_by(stride).copied().collect(),
    }
}

/// Every so many points.
pub fn thinned(points: &[[f64; 3]], stride: usize) -> Vec<[f64; 3]> {
    points.iter().step_by(stride).copied().collect()
}
