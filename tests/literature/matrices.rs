//! Resistance and mobility matrices: each other's inverse, symmetric, and those of the literature.

use std::sync::Arc;

use axistokes::nalgebra::{Matrix6, Vector3};
use axistokes::{
    Biconcave, Capsule, GeneratingCurve, Polar, RigidBodyMatrices, Silent, Spheroid, Torus,
};

use super::resistance::{error, four, rows};

fn matrices(curve: Arc<dyn GeneratingCurve>) -> RigidBodyMatrices {
    RigidBodyMatrices::to_tolerance(curve, 1e-12, &Silent).expect("matrices")
}

/// Two independent equations: the combined field and the completed double layer.
#[test]
fn are_symmetric_and_inverse_to_each_other() {
    let curves: [Arc<dyn GeneratingCurve>; 6] = [
        Arc::new(Spheroid::sphere(2.0).expect("a sphere")),
        Arc::new(Spheroid::new(0.2, 1.0).expect("a disc")),
        Arc::new(Polar::new(&[1.0, 0.3, 0.1, 0.15]).expect("a pear")),
        Arc::new(Torus::new(1.0, 0.4).expect("a torus")),
        Arc::new(Capsule::new(0.5, 2.0).expect("a capsule")),
        Arc::new(Biconcave::new(1.0).expect("a red cell")),
    ];
    for curve in curves {
        let found = matrices(curve.clone());
        let (resistance, mobility) = (found.resistance.0, found.mobility.0);
        let inverse = (resistance * mobility - Matrix6::identity()).amax();
        let asymmetry = [resistance, mobility].map(|m| (m - m.transpose()).amax() / m.amax());
        let coupling = found.resistance.scalar_functions().yb / resistance.amax();
        println!(
            "{curve:?}: R M - 1 {inverse:.1e}, asymmetries {:.1e} and {:.1e}, coupling {coupling:.3}, {} panels, estimate {:.1e}",
            asymmetry[0],
            asymmetry[1],
            found.resolution.panels.len(),
            found.error_estimate
        );
        assert!(inverse <= 1e-12 && asymmetry[0] <= 4e-15 && asymmetry[1] <= 4e-15);
        assert!(resistance.symmetric_eigenvalues().min() > 0.0);
    }
}

#[test]
fn of_spheroids_are_those_of_the_table() {
    for row in rows(include_str!("../data/resistance_spheroid.csv")) {
        if !(0.1..=10.0).contains(&(row[0] / row[1])) {
            continue;
        }
        let curve = Arc::new(Spheroid::new(row[0], row[1]).expect("a spheroid"));
        let found = matrices(curve);
        let r = found.resistance.scalar_functions();
        let m = found.mobility.scalar_functions();
        let exact = four(&row, 6);
        let errors = [
            error([r.xa, r.ya, r.xc, r.yc], exact),
            error([m.xa, m.ya, m.xc, m.yc], exact.map(|x| 1.0 / x)),
        ];
        println!(
            "{} : {}: {:.1e} and {:.1e}, Y^B {:.1e}",
            row[0], row[1], errors[0], errors[1], r.yb
        );
        assert!(errors[0] <= 1e-12 && errors[1] <= 1e-12);
        assert!(r.yb.abs() <= 1e-11 && m.yb.abs() <= 1e-11);
    }
}

/// About its centre of reaction a pear's rotation and translation do not couple, in either matrix.
#[test]
fn about_the_center_of_reaction_nothing_couples() {
    let found = matrices(Arc::new(
        Polar::new(&[1.0, 0.3, 0.1, 0.15]).expect("a pear"),
    ));
    let center = found.resistance.center_of_reaction();
    assert!(center.z > 0.05 && found.mobility.scalar_functions().yb.abs() > 1e-4);
    let resistance = found.resistance.about(center);
    let mobility = found.mobility.about(center);
    assert!(resistance.scalar_functions().yb.abs() <= 1e-11);
    assert!(mobility.scalar_functions().yb.abs() <= 1e-11);
    assert!((resistance.0 * mobility.0 - Matrix6::identity()).amax() <= 1e-11);
    // What is along the axis does not depend on the point.
    let along = [&resistance, &found.resistance].map(|r| r.scalar_functions().xa);
    assert!((along[0] - along[1]).abs() <= 1e-13 * along[0]);
}

/// Signs and all: the matrices of a sphere about a point below its centre.
#[test]
fn about_another_point_a_sphere_couples_as_in_closed_form() {
    let pi = std::f64::consts::PI;
    let found = matrices(Arc::new(Spheroid::sphere(1.0).expect("a sphere")));
    // If the point of reference lies h below the centre, the sphere's centre moves with U + h Omega
    // x e_z, and T = h e_z x F.
    let h = 0.5;
    let below = found.resistance.about(Vector3::new(0.0, 0.0, -h));
    let functions = below.scalar_functions();
    assert!((functions.ya - 6.0 * pi).abs() < 1e-12);
    assert!((functions.yb + 6.0 * pi * h).abs() < 1e-12);
    assert!((functions.yc - (8.0 + 6.0 * h * h) * pi).abs() < 1e-12);
    assert!((below.center_of_reaction().z - h).abs() < 1e-13);
    let mobility = found.mobility.about(Vector3::new(0.0, 0.0, -h));
    let functions = mobility.scalar_functions();
    assert!((functions.yc - 1.0 / (8.0 * pi)).abs() < 1e-14);
    assert!((functions.ya - (1.0 / 6.0 + h * h / 8.0) / pi).abs() < 1e-14);
}
