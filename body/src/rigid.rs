//! Rigid motions of the surface, and the force and torque of a density.

use std::f64::consts::PI;

use bodies_of_revolution::{RigidMotion, Wrench};
use nalgebra::{DMatrix, Vector3};

use super::discretization::Discretization;
use super::surface::SurfaceModes;

impl SurfaceModes {
    /// The velocity of a rigid motion about the origin on the surface: modes 0 and 1, exactly.
    pub fn of_motion(discretization: &Discretization, motion: &RigidMotion) -> Self {
        let nodes = discretization.nodes();
        let mut modes = Self::zero(1, nodes.len());
        let (u, o) = (motion.velocity, motion.angular_velocity);
        for (k, node) in nodes.iter().enumerate() {
            let (r, z) = (node.r, node.z);
            // Mode 0: along and about the axis.
            modes.component_mut(0, 0, 2)[k] = u.z;
            modes.component_mut(0, 1, 1)[k] = -o.z * r;
            // Mode 1: u_r = (u_x + o_y z) cos + (u_y - o_x z) sin, and so on.
            let (first, second) = (u.x + o.y * z, u.y - o.x * z);
            modes.component_mut(1, 0, 0)[k] = first;
            modes.component_mut(1, 0, 1)[k] = -first;
            modes.component_mut(1, 0, 2)[k] = -o.y * r;
            modes.component_mut(1, 1, 0)[k] = second;
            modes.component_mut(1, 1, 1)[k] = -second;
            modes.component_mut(1, 1, 2)[k] = o.x * r;
        }
        modes
    }

    /// The integrals of the field and of $x \times$ the field over the surface: force and torque
    /// about the origin of the density of a single layer.
    pub fn wrench(&self, discretization: &Discretization) -> Wrench {
        let mut force = Vector3::zeros();
        let mut torque = Vector3::zeros();
        let at = |n: usize, family: usize, j: usize, k: usize| {
            if n < self.modes() {
                self.component(n, family, j)[k]
            } else {
                0.0
            }
        };
        for (k, node) in discretization.nodes().iter().enumerate() {
            let (r, z, weight) = (node.r, node.z, PI * node.weight);
            force.z += 2.0 * weight * at(0, 0, 2, k);
            torque.z -= 2.0 * weight * r * at(0, 1, 1, k);
            // The integral of e_r cos + ... : f_x from the radial and azimuthal parts of mode 1.
            let x = at(1, 0, 0, k) - at(1, 0, 1, k);
            let y = at(1, 1, 0, k) - at(1, 1, 1, k);
            let (axial_cos, axial_sin) = (at(1, 0, 2, k), at(1, 1, 2, k));
            force.x += weight * x;
            force.y += weight * y;
            torque.x += weight * (r * axial_sin - z * y);
            torque.y += weight * (z * x - r * axial_cos);
        }
        Wrench { force, torque }
    }
}

/// The inverse of a resistance matrix, of all six rigid motions or of some directions among them;
/// none if it has none.
///
/// Entries of translation and rotation differ by powers of a length. Each row and column is
/// multiplied by a power of two first. Otherwise pivots would depend on the unit of length, and
/// entries that are nothing but rounding would be taken for large ones.
pub fn inverse_of_resistance(resistance: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let diagonal = resistance.diagonal();
    let units = DMatrix::from_diagonal(&diagonal.map(|d| (-0.5 * d.abs().log2()).round().exp2()));
    let inverse = (&units * resistance * &units).try_inverse()?;
    Some(&units * inverse * &units)
}
