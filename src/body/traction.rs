//! The traction on the surface.

use panel_quadrature::QuadratureError;

use super::body_flow::BodyFlow;
use super::dirichlet::{DirichletSolver, Formulation};
use super::matrix::{LayerPotential, ModalMatrices};
use super::surface::SurfaceModes;
use crate::progress::Silent;

impl BodyFlow {
    /// The traction $(-p + \nabla u + \nabla u^\mathsf{T}) \nu$ of the disturbance, for viscosity 1 and with the outward normal: force per
    /// area that the fluid exerts on the body, at the nodes. The background's own traction is not in it.
    ///
    /// Outside, the disturbance is the flow of a single layer alone: $S\varrho = u$ on the surface, and then the traction is
    /// $-\frac12\varrho + T\varrho$ (Pozrikidis 1992, section 4.2). What $S$ leaves open of $\varrho$, a multiple of the normal, has no traction
    /// outside. Equation and traction take as long as the solution itself.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn traction(&self) -> Result<SurfaceModes, QuadratureError> {
        let nodes = &self.discretization;
        let data = self
            .surface_velocity()
            .plus(-1.0, &self.background.on(nodes).modes);
        let n_max = data.modes() - 1;
        let solver = DirichletSolver::new(nodes.clone(), Formulation::SingleLayer, n_max, &Silent)?;
        let density = solver.solve(&data);
        let matrices = ModalMatrices::of(LayerPotential::SingleTraction, nodes, n_max)?;
        Ok(matrices.apply(nodes, &density).plus(-0.5, &density))
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use nalgebra::{Matrix3, Vector3};

    use super::*;
    use crate::body::discretization::Discretization;
    use crate::body::layers::Layers;
    use crate::body::linear_flow::LinearFlow;
    use crate::body::rigid::{RigidMotion, Wrench};
    use crate::curve::{Panels, Spheroid};

    /// A unit sphere in a flow; the traction needs no densities.
    fn sphere(motion: RigidMotion, background: LinearFlow) -> BodyFlow {
        let curve = Arc::new(Spheroid::sphere(1.0).unwrap());
        let panels = Panels::equal_arcs(&*curve, 4).unwrap();
        let discretization = Discretization::new(curve, panels, 16).unwrap();
        let none = SurfaceModes::zero(0, discretization.nodes().len());
        BodyFlow {
            layers: Layers {
                double: none.clone(),
                single: none.clone(),
            },
            discretization,
            background,
            motion,
            slip: none,
        }
    }

    /// The largest difference from a traction given as a function of the normal.
    fn error(flow: &BodyFlow, exact: impl Fn(Vector3<f64>) -> Vector3<f64>) -> f64 {
        let traction = flow.traction().unwrap();
        let nodes = flow.discretization.nodes().iter().enumerate();
        let errors = nodes.flat_map(|(k, node)| {
            let (traction, exact) = (&traction, &exact);
            [0.3, 1.7, 4.0].map(move |theta: f64| {
                let (sin, cos) = theta.sin_cos();
                let [r, t, z] = traction.at(k, theta);
                let computed = Vector3::new(r * cos - t * sin, r * sin + t * cos, z);
                (computed - exact(Vector3::new(node.r * cos, node.r * sin, node.z))).norm()
            })
        });
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn of_a_sphere_that_moves_turns_or_is_strained() {
        // Kim and Karrila 1991, chapter 4: -3 U/2a, -3 Omega x n, and 5 E n with the background's 2 E n.
        let (u, omega) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(-0.5, 0.2, 1.0));
        let motion = RigidMotion {
            velocity: u,
            angular_velocity: omega,
        };
        let moving = sphere(motion, LinearFlow::rest());
        let found = error(&moving, |n| -1.5 * u - 3.0 * omega.cross(&n));
        assert!(found < 1e-11, "{found:e}");
        let wrench = Wrench::of(&moving.discretization, &moving.traction().unwrap());
        assert!((wrench.force + 6.0 * std::f64::consts::PI * u).norm() < 1e-11);
        let strain = Matrix3::new(1.0, 0.3, 0.0, 0.3, -0.4, 0.1, 0.0, 0.1, -0.6);
        let background = LinearFlow {
            velocity: Vector3::zeros(),
            gradient: strain,
        };
        let strained = sphere(RigidMotion::rest(), background);
        let found = error(&strained, |n| 3.0 * strain * n);
        assert!(found < 1e-11, "{found:e}");
    }
}
