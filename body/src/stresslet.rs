//! The stresslet: what a body without net force does to the fluid far away.

use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector3};

use super::discretization::Discretization;
use super::layers::Layers;
use super::surface::SurfaceModes;

/// The stresslet of a flow $D[\sigma] + S[\varrho]$ about the origin, for viscosity 1: symmetric,
/// without trace, in units of velocity times area.
///
/// It is minus the symmetric traceless part of
///
/// $$ A_{jk} = \int \varrho_j x_k\\, d\Gamma +
///    \int (\nu_k \sigma_j + \nu_j \sigma_k)\\, d\Gamma , $$
///
/// since far away $u_i = S_{ij} F_j - \partial_k S_{ij}\\, A_{jk} + \dots$: the single layer's part
/// is Taylor's formula, the double layer's follows from
/// $D_{ij} \sigma_j = \sigma\cdot\nu\\, P^S_i -
/// (\sigma_j \nu_k + \sigma_k \nu_j)\\, \partial_k S_{ij}$,
/// its kernel being a stress of Stokeslets. The trace of $A$ does nothing because
/// $\partial_j S_{ij} = 0$, and the antisymmetric part is the torque. The sign is Batchelor's
/// (1970): that of the first moment of the traction on the body, so that a rigid sphere of radius
/// $a$ in the rate of strain $E$ has $\frac{20}{3}\pi a^3 E$ (Kim & Karrila 1991, section 2.3).
/// With a net force the stresslet depends on the origin.
pub fn stresslet(discretization: &Discretization, layers: &Layers) -> Matrix3<f64> {
    let moment = first_moment(discretization, &layers.single, |x, _, rho| {
        rho * x.transpose()
    }) + first_moment(discretization, &layers.double, |_, nu, sigma| {
        sigma * nu.transpose() + nu * sigma.transpose()
    });
    let symmetric = 0.5 * (moment + moment.transpose());
    Matrix3::from_diagonal_element(symmetric.trace() / 3.0) - symmetric
}

/// Cylindrical modes of a density that reach its integrals against tensors of the position or the
/// normal end with this one.
const LAST_MODE: usize = 2;
/// Azimuths for which the trapezoidal rule is exact: modes 0 to 2 of the density, one of the
/// position, one of the components.
const AZIMUTHS: usize = 8;

/// The integral over the surface of a tensor linear in the density and in position or normal; it is
/// given all three.
fn first_moment(
    discretization: &Discretization,
    density: &SurfaceModes,
    tensor: impl Fn(Vector3<f64>, Vector3<f64>, Vector3<f64>) -> Matrix3<f64>,
) -> Matrix3<f64> {
    let density = density.clone().truncated(LAST_MODE);
    let mut sum = Matrix3::zeros();
    for (k, node) in discretization.nodes().iter().enumerate() {
        for l in 0..AZIMUTHS {
            let theta = 2.0 * PI * l as f64 / AZIMUTHS as f64;
            let (sin, cos) = theta.sin_cos();
            let turned =
                |[r, t, z]: [f64; 3]| Vector3::new(r * cos - t * sin, r * sin + t * cos, z);
            let x = turned([node.r, 0.0, node.z]);
            let nu = turned([node.normal[0], 0.0, node.normal[1]]);
            sum += node.weight * tensor(x, nu, turned(density.at(k, theta)));
        }
    }
    2.0 * PI / AZIMUTHS as f64 * sum
}
