//! Flows of computed densities: against known ones inside and outside, against the Stokes
//! equations, and far away.

use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::body::dirichlet::{DirichletSolver, Formulation};
use axistokes::body::discretization::Discretization;
use axistokes::body::kernel::{FlowAt, Stokeslet};
use axistokes::body::surface::SurfaceModes;
use axistokes::geometry::curve::{GeneratingCurve, Panels, Spheroid, Torus};
use axistokes::progress::Silent;
use nalgebra::{Matrix3, Point3, Vector3};

fn spheroid() -> Arc<dyn GeneratingCurve> {
    Arc::new(Spheroid::new(1.0, 0.5).expect("a spheroid"))
}

fn torus() -> Arc<dyn GeneratingCurve> {
    Arc::new(Torus::new(1.0, 0.4).expect("a torus"))
}

fn stokeslet(at: [f64; 3], force: [f64; 3]) -> Stokeslet {
    Stokeslet {
        at: at.into(),
        force: force.into(),
    }
}

/// Outside both bodies, at a distance.
fn outer() -> [Stokeslet; 3] {
    [
        stokeslet([1.9, 0.6, 0.3], [1.0, -0.5, 0.8]),
        stokeslet([-0.4, -1.8, 1.1], [-0.3, 0.9, 0.2]),
        stokeslet([0.3, 0.2, -2.0], [0.6, 0.4, -1.0]),
    ]
}

fn velocity(stokeslets: &[Stokeslet], x: Vector3<f64>) -> Vector3<f64> {
    stokeslets.iter().map(|s| s.velocity(x)).sum()
}

fn pressure(stokeslets: &[Stokeslet], x: Vector3<f64>) -> f64 {
    stokeslets.iter().map(|s| s.pressure(x)).sum()
}

fn solver(
    curve: &Arc<dyn GeneratingCurve>,
    formulation: Formulation,
    panels: usize,
    n_max: usize,
) -> DirichletSolver {
    let panels = Panels::uniform(&**curve, panels).expect("panels");
    let discretization = Discretization::new(curve.clone(), panels, 16).expect("nodes");
    DirichletSolver::new(discretization, formulation, n_max, &Silent).expect("a solver")
}

/// The density that takes the boundary values of `stokeslets`.
fn density(solver: &DirichletSolver, stokeslets: &[Stokeslet]) -> SurfaceModes {
    let n_max = solver.modes() - 1;
    let data = SurfaceModes::sample(solver.discretization(), n_max, |x| velocity(stokeslets, x));
    solver.solve(&data.modes)
}

/// Largest error of the velocity at `targets`, and of the pressure's differences between them,
/// relative to the largest there.
fn errors(
    solver: &DirichletSolver,
    stokeslets: &[Stokeslet],
    targets: &[Point3<f64>],
) -> (f64, f64) {
    let density = density(solver, stokeslets);
    let flow = solver
        .flow(&density)
        .at(targets, 1e-14)
        .expect("targets far enough");
    let (mut error, mut largest) = ((0.0f64, 0.0f64), (0.0f64, 0.0f64));
    // The pressure of an interior flow is free up to a constant.
    let level = flow[0].pressure - pressure(stokeslets, targets[0].coords);
    for (target, flow) in targets.iter().zip(flow) {
        let (u, p) = (
            velocity(stokeslets, target.coords),
            pressure(stokeslets, target.coords),
        );
        error.0 = error.0.max((flow.velocity - u).amax());
        error.1 = error.1.max((flow.pressure - level - p).abs());
        largest = (largest.0.max(u.amax()), largest.1.max(p.abs()));
    }
    let error = (error.0 / largest.0, error.1 / largest.1);
    println!(
        "{:?} {:?}, {} panels x 16, modes 0..={}: velocity {:.1e}, pressure {:.1e}",
        solver.discretization().curve(),
        solver.formulation(),
        solver.discretization().panels().len(),
        solver.modes() - 1,
        error.0,
        error.1
    );
    error
}

fn ring(r: f64, z: f64) -> impl Iterator<Item = Point3<f64>> {
    (0..5).map(move |k| {
        let (sin, cos) = (0.3 + 2.0 * PI * f64::from(k) / 5.0).sin_cos();
        Point3::new(r * cos, r * sin, z)
    })
}

#[test]
fn inside_a_spheroid() {
    let targets: Vec<_> = ring(0.2, 0.3)
        .chain(ring(0.1, -0.6))
        .chain(ring(0.0, 0.1))
        .collect();
    let results: Vec<_> = [(2, 30), (4, 40), (8, 50), (12, 60)]
        .into_iter()
        .map(|(panels, n_max)| {
            let solver = solver(&spheroid(), Formulation::InteriorDoubleLayer, panels, n_max);
            errors(&solver, &outer(), &targets)
        })
        .collect();
    assert!(
        results
            .windows(2)
            .take(2)
            .all(|e| e[1].0 < 1e-2 * e[0].0 || e[1].0 <= 1e-12)
    );
    assert!(results[3].0 <= 1e-13 && results[3].1 <= 1e-13);
}

#[test]
fn inside_a_torus() {
    let targets: Vec<_> = ring(1.0, 0.0)
        .chain(ring(1.1, 0.1))
        .chain(ring(0.85, -0.1))
        .collect();
    let results: Vec<_> = [(4, 30), (8, 50), (12, 70)]
        .into_iter()
        .map(|(panels, n_max)| {
            let solver = solver(&torus(), Formulation::InteriorDoubleLayer, panels, n_max);
            errors(&solver, &outer(), &targets)
        })
        .collect();
    assert!(results[2].0 <= 1e-13 && results[2].1 <= 1e-13);
}

/// Inside the spheroid.
fn inner() -> [Stokeslet; 3] {
    [
        stokeslet([0.1, 0.05, 0.3], [1.0, -0.5, 0.8]),
        stokeslet([-0.15, 0.1, -0.2], [-0.3, 0.9, 0.2]),
        stokeslet([0.0, -0.1, 0.5], [0.6, 0.4, -1.0]),
    ]
}

#[test]
fn outside_with_the_single_layer() {
    let targets: Vec<_> = ring(1.0, 0.3)
        .chain(ring(0.4, -1.5))
        .chain(ring(0.0, 1.8))
        .collect();
    let results: Vec<_> = [(4, 30), (8, 50), (12, 70)]
        .into_iter()
        .map(|(panels, n_max)| {
            let solver = solver(&spheroid(), Formulation::SingleLayer, panels, n_max);
            errors(&solver, &inner(), &targets)
        })
        .collect();
    // Each is ten times better than the one before, until rounding is left.
    let floor = 1e-14;
    let falls = |e: &[(f64, f64)]| e[1].0 < (1e-1 * e[0].0).max(floor);
    assert!(results.windows(2).all(falls));
    assert!(results[2].0 <= floor);
}

#[test]
fn force_and_torque_are_those_of_what_is_inside() {
    let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
    for s in inner() {
        force += s.force;
        torque += s.at.cross(&s.force);
    }
    for formulation in [Formulation::CombinedField, Formulation::SingleLayer] {
        let solver = solver(&spheroid(), formulation, 12, 40);
        let wrench = solver.wrench(&density(&solver, &inner()));
        let of_force = (wrench.force - force).norm() / force.norm();
        let of_torque = (wrench.torque - torque).norm() / torque.norm();
        println!("{formulation:?}: force {of_force:.1e}, torque {of_torque:.1e}");
        assert!(of_force <= 1e-12 && of_torque <= 1e-12);
    }
}

/// First and second derivatives by central differences of fourth order.
struct Derivatives {
    gradient: Matrix3<f64>,
    laplacian: Vector3<f64>,
    pressure_gradient: Vector3<f64>,
}

fn derivatives(at: impl Fn(&[Point3<f64>]) -> Vec<FlowAt>, x: Point3<f64>, h: f64) -> Derivatives {
    let steps = [-2.0, -1.0, 0.0, 1.0, 2.0];
    let first = [1.0, -8.0, 0.0, 8.0, -1.0].map(|c| c / (12.0 * h));
    let second = [-1.0, 16.0, -30.0, 16.0, -1.0].map(|c| c / (12.0 * h * h));
    let mut result = Derivatives {
        gradient: Matrix3::zeros(),
        laplacian: Vector3::zeros(),
        pressure_gradient: Vector3::zeros(),
    };
    for k in 0..3 {
        let points = steps.map(|s| x + s * h * Vector3::ith(k, 1.0));
        let flow = at(&points);
        for (s, flow) in flow.iter().enumerate() {
            let column = result.gradient.column(k) + first[s] * flow.velocity;
            result.gradient.set_column(k, &column);
            result.laplacian += second[s] * flow.velocity;
            result.pressure_gradient[k] += first[s] * flow.pressure;
        }
    }
    result
}

#[test]
fn computed_flows_satisfy_the_stokes_equations() {
    let outside = [Point3::new(0.9, -0.3, 0.4), Point3::new(0.2, 0.1, -1.6)];
    let inside = [Point3::new(0.1, -0.05, 0.2), Point3::new(0.0, 0.1, -0.5)];
    let cases = [
        (Formulation::CombinedField, inner(), outside),
        (Formulation::SingleLayer, inner(), outside),
        (Formulation::InteriorDoubleLayer, outer(), inside),
    ];
    for (formulation, stokeslets, points) in cases {
        // Few panels and modes: whatever the density, the equations hold.
        let solver = solver(&spheroid(), formulation, 6, 12);
        let density = density(&solver, &stokeslets);
        let flow = solver.flow(&density);
        let at = |x: &[Point3<f64>]| flow.at(x, 1e-14).expect("targets far enough");
        let (mut divergence, mut momentum) = (0.0f64, 0.0f64);
        for x in points {
            let d = derivatives(at, x, 4e-3);
            divergence = divergence.max(d.gradient.trace().abs() / d.gradient.norm());
            let residual = d.laplacian - d.pressure_gradient;
            momentum = momentum.max(residual.norm() / d.laplacian.norm());
        }
        println!("{formulation:?}: divergence {divergence:.1e}, momentum {momentum:.1e}");
        assert!(divergence <= 1e-6 && momentum <= 1e-6);
    }
}

/// Far away the flow is that of the total force, up to one order more.
#[test]
fn decay() {
    let solver = solver(&spheroid(), Formulation::CombinedField, 8, 30);
    let density = density(&solver, &inner());
    let total = Stokeslet {
        at: Vector3::zeros(),
        force: solver.wrench(&density).force,
    };
    let direction = Vector3::new(0.5, -0.7, 0.4).normalize();
    let mut rest = Vec::new();
    for distance in [1e1, 1e2, 1e3, 1e4_f64] {
        let x: Vector3<f64> = distance * direction;
        let at = solver
            .flow(&density)
            .at(&[x.into()], 1e-14)
            .expect("far enough")[0];
        let velocity = (at.velocity - total.velocity(x)).norm() / total.velocity(x).norm();
        let pressure = (at.pressure - total.pressure(x)).abs() * distance * distance;
        println!(
            "distance {distance}: {velocity:.2e} of the velocity is not the total force's; pressure {pressure:.2e}"
        );
        rest.push(velocity);
    }
    assert!(
        rest.windows(2)
            .skip(1)
            .all(|r| (r[0] / r[1] - 10.0).abs() < 1.0)
    );
}

/// The tolerance of an evaluation, relative to the density (pressure: to the density over the
/// distance), against a much finer evaluation.
#[test]
fn evaluation_keeps_its_tolerance() {
    let ring = vec![stokeslet([0.7, 0.6, 0.1], [1.0, -0.5, 0.8])];
    for (curve, formulation, stokeslets) in [
        (spheroid(), Formulation::CombinedField, inner().to_vec()),
        (torus(), Formulation::CombinedField, ring),
        (torus(), Formulation::InteriorDoubleLayer, outer().to_vec()),
    ] {
        let outwards = if formulation == Formulation::InteriorDoubleLayer {
            -0.9
        } else {
            1.0
        };
        let solver = solver(&curve, formulation, 12, 50);
        let density = density(&solver, &stokeslets);
        let largest = (0..=50).map(|n| density.amplitude(n)).fold(0.0, f64::max);
        let flow = solver.flow(&density);
        for tolerance in [1e-6, 1e-10, 1e-13] {
            let (mut velocity, mut pressure, mut count) = (0.0f64, 0.0f64, 0);
            for distance in (1..=12).map(|k| 0.035 * f64::from(k) * outwards) {
                let targets: Vec<_> = (solver.discretization().nodes().iter().step_by(11))
                    .map(|node| {
                        let [r, z] = node.normal.map(|n| distance * n);
                        Point3::new(node.r + r, 0.0, node.z + z)
                    })
                    .collect();
                let (Ok(some), Ok(fine)) = (flow.at(&targets, tolerance), flow.at(&targets, 1e-20))
                else {
                    continue;
                };
                for (some, fine) in some.iter().zip(fine) {
                    count += 1;
                    velocity = velocity.max((some.velocity - fine.velocity).amax() / largest);
                    let error = (some.pressure - fine.pressure).abs() * distance.abs();
                    pressure = pressure.max(error / largest);
                }
            }
            println!(
                "{curve:?} {formulation:?} to {tolerance:.0e}: velocity {velocity:.1e}, pressure {pressure:.1e} at {count} points"
            );
            assert!(count > 40);
            // At the least tolerance rounding shows, most in the pressure.
            assert!(velocity <= tolerance && pressure <= 3.0 * tolerance);
        }
    }
}
