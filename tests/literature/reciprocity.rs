//! The resistance matrix is symmetric and positive (Lorentz), whatever the shape.

use std::sync::Arc;

use axistokes::geometry::curve::{GeneratingCurve, Panels, Polar};
use nalgebra::{Matrix6, Vector3};

use super::resistance::Resistor;

#[test]
fn of_a_body_without_fore_aft_symmetry() {
    for coefficients in [
        vec![1.0, 0.2, 0.1, 0.15],
        vec![1.0, 0.0, 0.0, -0.3, 0.0, 0.1],
    ] {
        let curve: Arc<dyn GeneratingCurve> = Arc::new(Polar::new(&coefficients).expect("a body"));
        let panels = Panels::resolving(&*curve, 16, 1e-10).expect("panels");
        let resistor = Resistor::new(&curve, panels, 16);
        let size = resistor.size();
        // Unit velocities and angular velocities, torques in units of the body's size: all entries
        // are alike.
        let mut matrix = Matrix6::zeros();
        for k in 0..6 {
            let unit = Vector3::ith(k % 3, 1.0);
            let wrench = if k < 3 {
                resistor.wrench(unit, Vector3::zeros())
            } else {
                resistor.wrench(Vector3::zeros(), unit / size)
            };
            for i in 0..3 {
                matrix[(i, k)] = wrench.force[i];
                matrix[(i + 3, k)] = wrench.torque[i] / size;
            }
        }
        let asymmetry = (matrix - matrix.transpose()).amax() / matrix.amax();
        let coupling = matrix[(0, 4)].abs() / matrix.amax();
        let least = matrix.symmetric_eigenvalues().min();
        println!(
            "polar {coefficients:?}: asymmetry {asymmetry:.1e} of the largest entry, coupling {coupling:.3} of it, least eigenvalue {least:.3}"
        );
        assert!(asymmetry <= 1e-12 && coupling > 1e-3 && least > 0.0);
    }
}
