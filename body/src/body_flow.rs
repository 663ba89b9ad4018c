//! The flow around a body as it was solved for: the undisturbed flow and what the body adds to it.

use nalgebra::{Matrix3, Point3};
use panel_quadrature::QuadratureError;

use super::discretization::Discretization;
use super::flow::{Flow, FlowError, Side, first_not_finite};
use super::layers::Layers;
use super::linear_flow::LinearFlow;
use super::stresslet::stresslet;
use super::surface::SurfaceModes;
use crate::kernel::{FlowAt, FlowGradientAt};
use crate::progress::{Progress, Silent};
use bodies_of_revolution::{RigidMotion, Wrench};

/// Everything that a solved problem is made of, in the body's frame and for viscosity 1: the flow is
///
/// $$ u = u_\infty + D[\sigma] + S[\varrho], $$
///
/// and on the surface $u = U + \Omega \times x + u_s$.
#[derive(Clone, Debug)]
pub struct BodyFlow {
    /// Panels and nodes.
    pub discretization: Discretization,
    /// The densities $\sigma$ and $\varrho$ of the disturbance.
    pub layers: Layers,
    /// The undisturbed flow $u_\infty$.
    pub background: LinearFlow,
    /// The rigid motion $U$, $\Omega$ of the body, about the origin.
    pub motion: RigidMotion,
    /// The velocity $u_s$ of the surface relative to the rigid motion.
    pub slip: SurfaceModes,
}

/// Targets that are evaluated between two reports of progress.
const CHUNK: usize = 1024;

impl BodyFlow {
    /// The flow that the body adds to the undisturbed one.
    pub fn disturbance(&self) -> Flow<'_> {
        Flow::new(&self.discretization, self.layers.clone())
    }

    /// Velocity and pressure of the whole flow at every target, to the tolerance of [`Flow::at`]; on the surface, the limits from outside.
    ///
    /// Targets inside the body are not refused: there the layers go on to a flow that means nothing, and
    /// [`Outline::contains`](bodies_of_revolution::Outline::contains) tells which they are. One call for many targets is cheaper than many calls.
    ///
    /// # Errors
    /// As [`Flow::at`].
    pub fn at(&self, targets: &[Point3<f64>], tolerance: f64) -> Result<Vec<FlowAt>, FlowError> {
        self.evaluate(targets, tolerance, &Silent)
    }

    /// The same, telling where it is.
    pub fn evaluate(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
        progress: &dyn Progress,
    ) -> Result<Vec<FlowAt>, FlowError> {
        if let Some(index) = first_not_finite(targets) {
            return Err(FlowError::NotFinite { index });
        }
        progress.begin("evaluating", targets.len());
        let disturbance = self.disturbance();
        let mut flow = Vec::with_capacity(targets.len());
        for some in targets.chunks(CHUNK) {
            flow.extend(disturbance.at(some, tolerance)?);
            progress.advance(some.len());
        }
        for (flow, target) in flow.iter_mut().zip(targets) {
            flow.velocity += self.background.at(target.coords);
        }
        Ok(flow)
    }

    /// The same with the velocity gradient, and so the stress.
    ///
    /// # Errors
    /// As [`Flow::gradient_at`].
    pub fn gradient_at(
        &self,
        targets: &[Point3<f64>],
        tolerance: f64,
    ) -> Result<Vec<FlowGradientAt>, FlowError> {
        let mut flow = self.disturbance().gradient_at(targets, tolerance)?;
        for (flow, target) in flow.iter_mut().zip(targets) {
            flow.velocity += self.background.at(target.coords);
            flow.gradient += self.background.gradient;
        }
        Ok(flow)
    }

    /// Force and torque (about the origin) that the body exerts on the fluid: of the single layer alone, since neither a
    /// double layer nor a linear flow exerts any.
    pub fn wrench(&self) -> Wrench {
        self.layers.single.wrench(&self.discretization)
    }

    /// The stresslet about the origin, of the disturbance; see [`stresslet`].
    pub fn stresslet(&self) -> Matrix3<f64> {
        stresslet(&self.discretization, &self.layers)
    }

    /// The traction $\sigma\nu$ of the fluid on the surface, its normal pointing out of the body: of the whole flow, background included.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn traction(&self) -> Result<SurfaceModes, QuadratureError> {
        let of_body = self.disturbance().traction(Side::Exterior)?;
        Ok(of_body.plus(1.0, &self.background.traction(&self.discretization)))
    }

    /// The rate of work $-\int u \cdot \sigma\nu\, d\Gamma$ that the surface does on the fluid; in a fluid at rest at infinity, the dissipation.
    ///
    /// In the rigid motion it is $F \cdot U + T \cdot \Omega$; the traction is needed for the slip's part only.
    ///
    /// # Errors
    /// If a quadrature rule is missing.
    pub fn power(&self) -> Result<f64, QuadratureError> {
        let Wrench { force, torque } = self.wrench();
        let of_motion =
            force.dot(&self.motion.velocity) + torque.dot(&self.motion.angular_velocity);
        let slips = (0..self.slip.modes()).any(|n| self.slip.amplitude(n) > 0.0);
        let of_slip = if slips {
            -self
                .slip
                .inner_product(&self.discretization, &self.traction()?)
        } else {
            0.0
        };
        Ok(of_motion + of_slip)
    }

    /// The velocity of the surface, rigid motion and slip.
    pub fn surface_velocity(&self) -> SurfaceModes {
        SurfaceModes::of_motion(&self.discretization, &self.motion).plus(1.0, &self.slip)
    }
}
