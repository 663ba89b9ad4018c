//! The surfaces of bodies: traction and pressure of the whole flow there, and the rate of work.

use std::f64::consts::TAU;

use nalgebra::{Point3, Vector3};
use stokes_body::discretization::Discretization;
use stokes_body::flow::{AXIAL, Side, SurfaceStress};
use stokes_body::linear_flow;
use stokes_body::progress::{Progress, Silent};
use stokes_body::surface::SurfaceModes;

use super::error::SuspensionError;
use super::flow::{BodyFlow, Flow};

/// One body's surface as points with what acts there, in the laboratory.
///
/// The sum of weights times a field is its integral over the surface: of the traction, minus the
/// force that the body exerts on the fluid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surface {
    /// The points.
    pub points: Vec<Point3<f64>>,
    /// Outward unit normals.
    pub normals: Vec<Vector3<f64>>,
    /// Every point's share of the area.
    pub weights: Vec<f64>,
    /// Velocity of the surface, and of the fluid there.
    pub velocity: Vec<Vector3<f64>>,
    /// Force per area that the fluid exerts on the body, of the whole flow.
    pub traction: Vec<Vector3<f64>>,
    /// Pressure of the fluid.
    pub pressure: Vec<f64>,
}

/// Bodies whose tractions are found together.
const BODIES: usize = 64;
/// Half steps between the points of a ring and those at which the others' stress is sampled: as far
/// from them as can be.
const HALVES: usize = 1;

impl Flow {
    /// Traction and pressure of the fluid on the surfaces of some bodies, background included, with
    /// the normal out of the body: per area of the laboratory, as vectors in the body's frame. What
    /// was found once is kept.
    ///
    /// # Errors
    /// If there is no such body, a quadrature rule is missing, or the caller cancels.
    pub fn surface_stresses(
        &self,
        bodies: &[usize],
        progress: &dyn Progress,
    ) -> Result<Vec<&SurfaceStress>, SuspensionError> {
        let stresses = self.stresses();
        let count = stresses.len();
        if let Some(&body) = bodies.iter().find(|&&body| body >= count) {
            return Err(SuspensionError::NoBody {
                body,
                bodies: count,
            });
        }
        let missing = bodies
            .iter()
            .copied()
            .filter(|&body| stresses[body].get().is_none());
        let mut missing: Vec<usize> = missing.collect();
        // A body asked for twice is found once.
        missing.sort_unstable();
        missing.dedup();
        progress.begin("tractions", missing.len());
        for some in missing.chunks(BODIES) {
            if progress.is_cancelled() {
                return Err(SuspensionError::Interrupted);
            }
            for (&body, stress) in some.iter().zip(self.new_stresses(some)?) {
                stresses[body].get_or_init(|| stress);
            }
            progress.advance(some.len());
        }
        Ok(bodies
            .iter()
            .filter_map(|&body| stresses[body].get())
            .collect())
    }

    /// A body's own layers are taken mode by mode, what the others do on rings of points.
    fn new_stresses(&self, bodies: &[usize]) -> Result<Vec<SurfaceStress>, SuspensionError> {
        let mut targets = Vec::new();
        let mut rings = Vec::with_capacity(bodies.len());
        for &body in bodies {
            let BodyFlow {
                frame, disturbance, ..
            } = &self.bodies()[body];
            let points = ring_points(disturbance.discretization(), disturbance.azimuths()?);
            let first = targets.len();
            targets.extend(points.iter().map(|&x| frame.point_to_lab(x)));
            rings.push((body, first..targets.len()));
        }
        let found = self.of_others(&targets, &rings)?;
        let stresses = rings.iter().map(|(body, ring)| {
            let BodyFlow {
                frame, disturbance, ..
            } = &self.bodies()[*body];
            let nodes = disturbance.discretization().nodes();
            let own = disturbance.surface_stress(Side::Exterior)?;
            let samples = [disturbance.azimuths()?, HALVES];
            let n_max = (disturbance.modes() - 1).max(linear_flow::LAST_MODE);
            let mut at = found[ring.clone()].iter();
            let traction =
                SurfaceModes::of_samples(nodes.len(), n_max, samples, |k, [cos, sin]| {
                    let [across, along] = nodes[k].normal;
                    let normal = Vector3::new(across * cos, across * sin, along);
                    let mut at = at.next().copied().unwrap_or_default();
                    at.gradient += self.background().gradient;
                    frame.vector_to_body(at.stress() * frame.vector_to_lab(normal))
                });
            let mut at = found[ring.clone()].iter();
            let pressure = SurfaceModes::of_samples(nodes.len(), n_max, samples, |_, _| {
                at.next()
                    .map_or_else(Vector3::zeros, |at| at.pressure * Vector3::z())
            });
            let scale = frame.scale();
            let whole = |others: SurfaceModes, own: &SurfaceModes| {
                others.plus(1.0 / scale, own).scaled(self.viscosity())
            };
            Ok(SurfaceStress {
                traction: whole(traction, &own.traction),
                pressure_along_axis: whole(pressure, &own.pressure_along_axis),
            })
        });
        stresses.collect()
    }

    /// The surface of a body as points, with what acts there; in the laboratory.
    ///
    /// # Errors
    /// If there is no such body, or a quadrature rule is missing.
    pub fn surface(&self, body: usize) -> Result<Surface, SuspensionError> {
        let stresses = self.surface_stresses(&[body], &Silent)?;
        let found = self.bodies().get(body).zip(stresses.first());
        Ok(found.map_or_else(Surface::default, |(body, stress)| body.surface(stress)))
    }

    /// The rate of work $-\int u \cdot \sigma\nu\\, d\Gamma$ that every body's surface does on the
    /// fluid; of a swimmer its slip included. In a fluid at rest far away, the sum is the
    /// dissipation.
    ///
    /// In the rigid motion it is $F \cdot U + T \cdot \Omega$; the traction is needed for the
    /// slip's part only.
    ///
    /// # Errors
    /// If a quadrature rule is missing, or the caller cancels.
    pub fn powers(&self, progress: &dyn Progress) -> Result<Vec<f64>, SuspensionError> {
        let slips = (0..self.bodies().len()).filter(|&body| self.bodies()[body].slip.is_some());
        let slips: Vec<usize> = slips.collect();
        let mut powers: Vec<f64> = (self.bodies().iter())
            .map(|body| {
                let scale = body.frame.scale();
                self.viscosity() * scale * body.wrench.power(&body.motion)
            })
            .collect();
        for (&body, stress) in slips.iter().zip(self.surface_stresses(&slips, progress)?) {
            let of = &self.bodies()[body];
            if let Some(slip) = &of.slip {
                let area = of.frame.scale().powi(2);
                powers[body] -= area * slip.inner_product(of.on(), &stress.traction);
            }
        }
        Ok(powers)
    }
}

impl BodyFlow {
    fn surface(&self, stress: &SurfaceStress) -> Surface {
        let (nodes, frame) = (self.on().nodes(), &self.frame);
        let velocity = self.surface_velocity();
        let azimuths = 2 * stress.traction.modes().max(velocity.modes()) + 1;
        let mut surface = Surface::default();
        for (k, node) in nodes.iter().enumerate() {
            for l in 0..azimuths {
                let theta = TAU * l as f64 / azimuths as f64;
                let (sin, cos) = theta.sin_cos();
                let turned =
                    |[r, t, z]: [f64; 3]| Vector3::new(r * cos - t * sin, r * sin + t * cos, z);
                let to_lab = |vector: [f64; 3]| frame.vector_to_lab(turned(vector));
                let point = turned([node.r, 0.0, node.z]);
                surface.points.push(frame.point_to_lab(point.into()));
                surface
                    .normals
                    .push(to_lab([node.normal[0], 0.0, node.normal[1]]));
                let share = TAU / azimuths as f64 * node.weight;
                surface.weights.push(share * frame.scale().powi(2));
                surface.velocity.push(to_lab(velocity.at(k, theta)));
                surface.traction.push(to_lab(stress.traction.at(k, theta)));
                let pressure = stress.pressure_along_axis.at(k, theta)[AXIAL];
                surface.pressure.push(pressure);
            }
        }
        surface
    }
}

/// Points on rings of so many, ring after ring, between those of the densities; in the body's
/// frame.
fn ring_points(discretization: &Discretization, azimuths: usize) -> Vec<Point3<f64>> {
    let nodes = discretization.nodes();
    let mut points = Vec::with_capacity(nodes.len() * azimuths);
    SurfaceModes::of_samples(nodes.len(), 0, [azimuths, HALVES], |k, [cos, sin]| {
        points.push(Point3::new(nodes[k].r * cos, nodes[k].r * sin, nodes[k].z));
        Vector3::zeros()
    });
    points
}
