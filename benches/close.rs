//! What a point costs by its distance from the surface: `cargo bench --bench close`.
//!
//! One thread, the thesis's body with 8 panels of 16 nodes and 60 modes; each figure is the median
//! of seven rounds in which all distances take turns, so that ratios mean something on a noisy
//! machine.

use std::sync::Arc;
use std::time::Instant;

use axistokes::body::{DirichletSolver, Discretization, Formulation, Stokeslet, SurfaceModes};
use axistokes::geometry::curve::GeneratingCurve;
use axistokes::nalgebra::{Point3, Vector3};
use axistokes::*;

const DISTANCES: [f64; 10] = [3.0, 0.3, 1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
const ROUNDS: usize = 7;
const TOLERANCE: f64 = 1e-13;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()?;
    let curve = Arc::new(Spheroid::new(1.0, 0.5)?);
    let panels = Panels::equal_arcs(&*curve, 8)?;
    let nodes = Discretization::new(curve.clone(), panels, 16)?;
    let solver = DirichletSolver::new(nodes, Formulation::CombinedField, 60, &Silent)?;
    let inside = Stokeslet {
        at: Vector3::new(0.1, -0.05, 0.3),
        force: Vector3::new(1.0, 0.3, -0.5),
    };
    let data = SurfaceModes::sample(solver.discretization(), 60, |x| inside.velocity(x));
    let density = solver.solve(&data.modes);
    let flow = solver.flow(&density);
    let places: Vec<Vec<Point3<f64>>> = DISTANCES.map(|d| targets(&*curve, d)).into();
    let mut seconds = vec![[Vec::new(), Vec::new()]; DISTANCES.len()];
    for round in 0..=ROUNDS {
        for (targets, seconds) in places.iter().zip(&mut seconds) {
            let start = Instant::now();
            flow.at(targets, TOLERANCE)?;
            let plain = start.elapsed().as_secs_f64();
            let start = Instant::now();
            flow.gradient_at(targets, TOLERANCE)?;
            let full = start.elapsed().as_secs_f64();
            // The first round fills caches and pages.
            if round > 0 {
                seconds[0].push(plain / targets.len() as f64);
                seconds[1].push(full / targets.len() as f64);
            }
        }
    }
    let median = |seconds: &[f64]| {
        let mut sorted = seconds.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    };
    let far = [0, 1].map(|k| median(&seconds[0][k]));
    println!("distance   velocity, pressure       with gradient");
    for (distance, seconds) in DISTANCES.iter().zip(&seconds) {
        let [plain, full] = [0, 1].map(|k| median(&seconds[k]));
        println!(
            "{distance:7.0e}   {:7.1} us, {:5.1} x   {:7.1} us, {:5.1} x",
            1e6 * plain,
            plain / far[0],
            1e6 * full,
            full / far[1]
        );
    }
    Ok(())
}

/// Places all over the surface, so far outside.
fn targets(curve: &dyn GeneratingCurve, distance: f64) -> Vec<Point3<f64>> {
    (0..64)
        .map(|k| {
            let s = std::f64::consts::PI * (f64::from(k) + 0.4) / 64.0;
            let (p, t) = (curve.point(s), curve.tangent(s));
            let speed = t.r.hypot(t.z);
            let (r, z) = (p.r - distance * t.z / speed, p.z + distance * t.r / speed);
            let (sin, cos) = f64::from(k).sin_cos();
            Point3::new(r * cos, r * sin, z)
        })
        .collect()
}
