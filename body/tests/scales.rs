//! Lengths have no unit: what is computed for a shape is that of the same shape a power of two
//! larger, to the last bit.

use std::sync::Arc;

use bodies_of_revolution::{GeneratingCurve, Panels, RigidMotion, Spheroid};
use nalgebra::{Point3, Vector3};
use stokes_body::dirichlet::{DirichletSolver, Formulation};
use stokes_body::discretization::Discretization;
use stokes_body::flow::Flow;
use stokes_body::kernel::FlowGradientAt;
use stokes_body::layers::{LayerWeights, Layers};
use stokes_body::matrix::{LayerPotential, ModalMatrices};
use stokes_body::progress::Silent;
use stokes_body::resistance::RigidBodyMatrices;
use stokes_body::surface::SurfaceModes;

/// Sizes far apart: at the largest, entries of the two layers differ by 2^80 in magnitude.
const EXPONENTS: [i32; 4] = [-80, -20, 20, 80];

fn spheroid(size: f64) -> Discretization {
    let curve: Arc<dyn GeneratingCurve> = Arc::new(Spheroid::new(size, 0.5 * size).unwrap());
    let panels = Panels::uniform(&*curve, 5).unwrap();
    Discretization::new(curve, panels, 16).unwrap()
}

#[test]
fn matrices() {
    let n_max = 3;
    for layer in [LayerPotential::Double, LayerPotential::Single] {
        let of = |size: f64| ModalMatrices::of(layer, &spheroid(size), n_max).unwrap();
        let one = of(1.0);
        for size in EXPONENTS.map(|exponent| f64::from(exponent).exp2()) {
            let factor = match layer {
                LayerPotential::Single => size,
                _ => 1.0,
            };
            let other = of(size);
            for n in 0..=n_max {
                let (one, other) = (one.transposed(n), other.transposed(n));
                for j in 0..one.ncols() {
                    for i in 0..one.nrows() {
                        assert_eq!(
                            factor * one[(i, j)],
                            other[(i, j)],
                            "{layer:?} {size:e} {n}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn flows() {
    let of = |size: f64| -> Vec<FlowGradientAt> {
        let on = spheroid(size);
        let motion = RigidMotion {
            velocity: Vector3::new(0.3, 0.2, 1.0),
            angular_velocity: Vector3::new(0.1, 0.2, 0.3) / size,
        };
        let density = SurfaceModes::of_motion(&on, &motion);
        let weights = LayerWeights {
            double: 1.0,
            single: 1.0 / size,
        };
        let flow = Flow::new(on, Layers::weighted(&density, weights));
        // At poles, next to them, elsewhere on the surface, and away from it.
        let targets = [
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
            [1e-6, 0.0, 1.0],
            [1e-3, 1e-3, 1.0],
            [0.5, 0.0, 0.0],
            [0.0, 0.0, 1.5],
        ];
        let targets = targets.map(|x| Point3::from(x.map(|x| size * x)));
        flow.gradient_at(&targets, 1e-14).unwrap()
    };
    let one = of(1.0);
    for size in EXPONENTS.map(|exponent| f64::from(exponent).exp2()) {
        for (one, other) in one.iter().zip(of(size)) {
            assert_eq!(one.velocity, other.velocity, "{size:e}");
            assert_eq!(one.pressure, size * other.pressure, "{size:e}");
            assert_eq!(one.gradient, size * other.gradient, "{size:e}");
        }
    }
}

/// Equations, factored and solved.
#[test]
fn densities() {
    for formulation in [Formulation::CombinedField, Formulation::SingleLayer] {
        let of = |size: f64| -> Vec<Vector3<f64>> {
            let on = spheroid(size);
            let solver = DirichletSolver::new(on.clone(), formulation, 1, &Silent).unwrap();
            let motion = RigidMotion {
                velocity: Vector3::new(0.3, 0.2, 1.0),
                angular_velocity: Vector3::new(0.1, 0.2, 0.3) / size,
            };
            let density = solver.solve(&SurfaceModes::of_motion(&on, &motion));
            let nodes = 0..on.nodes().len();
            nodes.map(|k| density.at(k, 0.3).into()).collect()
        };
        let one = of(1.0);
        for size in EXPONENTS.map(|exponent| f64::from(exponent).exp2()) {
            let factor = match formulation {
                Formulation::SingleLayer => size,
                _ => 1.0,
            };
            for (one, other) in one.iter().zip(of(size)) {
                assert_eq!(*one, factor * other, "{formulation:?} {size:e}");
            }
        }
    }
}

#[test]
fn resistances_and_mobilities() {
    let of = |size: f64| {
        let curve: Arc<dyn GeneratingCurve> = Arc::new(Spheroid::new(size, 0.5 * size).unwrap());
        RigidBodyMatrices::to_tolerance(curve, 1e-8, &Silent).unwrap()
    };
    let one = of(1.0);
    assert!(one.error_estimate < 1e-8);
    for size in EXPONENTS.map(|exponent| f64::from(exponent).exp2()) {
        let other = of(size);
        assert_eq!(one.error_estimate, other.error_estimate, "{size:e}");
        for (k, power) in [1, 1, 1, 3, 3, 3].into_iter().enumerate() {
            let entry = size.powi(power) * one.resistance.0[(k, k)];
            assert_eq!(entry, other.resistance.0[(k, k)], "{size:e} {k}");
        }
    }
}
