//! Estimated errors of pressures, stresslets and powers, which [`Answer::error_estimate`] does not
//! cover.
//!
//! Of a body alone they are the differences from the finer solution that its error was estimated
//! with. Of many bodies they are bounds from the velocity by which the boundary condition is
//! missed: the error of a flow is a flow too, with a boundary velocity $w$ of at most
//! [`boundary_error`](super::answer::BodyAnswer::boundary_error). By the reciprocal theorem $w$
//! changes a moment of the traction by the integral of $w \cdot t$ with the traction $t$ of another
//! flow. For a sphere of radius $a$ in the rate of strain $E$ that is $t = 5 E\nu$, so that the
//! stresslet is off by at most $\frac{20}{\sqrt 3}\pi a^2 \max|w|$; in a translation $t$ is
//! $\frac{3}{2a}U$, in a rotation $3\, \Omega \times \nu$. Other bodies are taken for spheres of
//! their size. The pressure over a plane wall with the velocity $w$ is at most $\frac{8}{3\sqrt
//! 3}\max|w|/d$ at the distance $d$, or $2 k \max|w|$ if nothing on it is shorter than $1/k$. In
//! narrow gaps there is a solution on finer surfaces to compare with, and no estimate is less than
//! three times the difference.

use std::f64::consts::PI;

use bodies_of_revolution::Meridian;
use nalgebra::Point3;
use stokes_body::progress::Progress;
use stokes_body::refinement::error_estimate;

use super::answer::Answer;
use super::error::SuspensionError;
use super::estimate::COMPARED;

/// How far the estimates stay above what is expected.
const SAFETY: f64 = 2.0;
/// What is left to rounding.
const ROUNDING: f64 = 1e-14;

impl Answer {
    /// The estimated absolute error of a body's stresslet, in the Frobenius norm.
    ///
    /// # Errors
    /// If there is no such body.
    pub fn stresslet_error(&self, body: usize) -> Result<f64, SuspensionError> {
        self.check_body(body)?;
        let found = self.bodies[body].stresslet;
        let apart = self
            .finer
            .as_ref()
            .map_or(0.0, |finer| (found - finer.bodies[body].stresslet).norm());
        if self.is_direct() {
            return Ok(self.absolute_error(apart, found.norm()));
        }
        let area = self.size(body).powi(2);
        let bound = self.flow.viscosity() * 20.0 / 3f64.sqrt() * PI * area * self.worst();
        Ok((SAFETY * bound).max(COMPARED * apart))
    }

    /// The estimated absolute errors of [`Flow::powers`](super::flow::Flow::powers); not known for
    /// one of many bodies with a slip.
    ///
    /// # Errors
    /// If a quadrature rule is missing, or the caller cancels.
    pub fn power_errors(
        &self,
        progress: &dyn Progress,
    ) -> Result<Vec<Option<f64>>, SuspensionError> {
        if self.is_direct() {
            let found = self.flow.powers(progress)?;
            let finer = match &self.finer {
                Some(finer) => finer.flow.powers(progress)?,
                None => found.clone(),
            };
            let both = found.iter().zip(&finer);
            let errors = both.map(|(a, b)| Some(self.absolute_error((a - b).abs(), b.abs())));
            return Ok(errors.collect());
        }
        let of_body = |body: usize| {
            let slips = self.flow.bodies()[body].slip.is_some();
            (!slips).then(|| self.power_bound(body))
        };
        Ok((0..self.bodies.len()).map(of_body).collect())
    }

    /// The error of the rate of work $F \cdot U + T \cdot \Omega$ of one of many bodies.
    fn power_bound(&self, body: usize) -> f64 {
        let (size, answer) = (self.size(body), &self.bodies[body]);
        let velocity = answer.motion.velocity.norm();
        let turning = size * answer.motion.angular_velocity.norm();
        let alone = size * (6.0 * PI * velocity + 3.0 * PI * PI * turning);
        let found = answer.wrench.force.norm() + answer.wrench.torque.norm() * 1.2 / size;
        let bound = (self.flow.viscosity() * alone).max(found) * self.worst();
        let power = answer.wrench.power(&answer.motion);
        let apart = self.finer.as_ref().map_or(0.0, |finer| {
            let finer = &finer.bodies[body];
            (power - finer.wrench.power(&finer.motion)).abs()
        });
        (SAFETY * bound).max(COMPARED * apart)
    }

    /// The largest estimated absolute error of the pressures at the probes, which are at these
    /// points.
    pub fn pressure_error(&self, probes: &[Point3<f64>]) -> f64 {
        let (mut apart, mut largest) = (0.0f64, 0.0f64);
        let finer = self.finer.iter().flat_map(|finer| &finer.probes);
        for (a, b) in self.probes.iter().zip(finer) {
            apart = apart.max((a.pressure - b.pressure).abs());
            largest = largest.max(b.pressure.abs());
        }
        if self.is_direct() {
            return self.absolute_error(apart, largest);
        }
        let of_point = |point: &Point3<f64>| -> f64 {
            (0..self.bodies.len())
                .map(|body| self.pressure_bound(body, point))
                .sum()
        };
        let bound = probes.iter().map(of_point).fold(0.0, f64::max);
        (SAFETY * self.flow.viscosity() * bound).max(COMPARED * apart)
    }

    /// The pressure, for viscosity 1, that the error of a body's boundary velocity makes at a
    /// point.
    fn pressure_bound(&self, body: usize, point: &Point3<f64>) -> f64 {
        let of_body = &self.flow.bodies()[body];
        let (discretization, scale) = (of_body.disturbance.discretization(), of_body.frame.scale());
        let at = Meridian::of(&of_body.frame.point_to_body(*point));
        let nodes = discretization.nodes().iter();
        let distance = nodes.map(|node| (node.r - at.r).hypot(node.z - at.z));
        let distance = distance.fold(f64::INFINITY, f64::min);
        let panels = 0..discretization.panels().len();
        let shortest = panels.map(|panel| discretization.arc_length(panel));
        let shortest = shortest.fold(f64::INFINITY, f64::min);
        // The shortest wave that the nodes resolve.
        let cut = shortest / (PI * discretization.order() as f64);
        let size = discretization.size();
        let near = 1.0 / distance.max(cut);
        2.0 * self.off(body) * near * (size / distance).min(1.0) / scale
    }

    fn check_body(&self, body: usize) -> Result<(), SuspensionError> {
        let bodies = self.bodies.len();
        if body < bodies {
            return Ok(());
        }
        Err(SuspensionError::NoBody { body, bodies })
    }

    /// The error of a number about as large as `scale`, of a body alone whose finer solution
    /// differs by so much.
    fn absolute_error(&self, difference: f64, scale: f64) -> f64 {
        let on = self.flow.bodies()[0].disturbance.discretization();
        scale * error_estimate(on, difference / scale.max(f64::MIN_POSITIVE))
    }

    fn size(&self, body: usize) -> f64 {
        self.flow.bodies()[body].size()
    }

    /// By how much the velocity is off on a body, rounding included.
    fn off(&self, body: usize) -> f64 {
        let off = self.bodies[body].boundary_error.unwrap_or(0.0);
        off + ROUNDING * self.largest_speed
    }

    fn worst(&self) -> f64 {
        let bodies = 0..self.bodies.len();
        bodies.map(|body| self.off(body)).fold(0.0, f64::max)
    }
}
