//! Estimated errors of what [`Answer::error_estimate`] does not cover, from what the velocity is off by on the surfaces.
//!
//! The error of a flow is a flow too, and its boundary velocity $w$ is at most [`boundary_error`](super::suspension::BodyAnswer::boundary_error).
//! By the reciprocal theorem it changes a moment of the traction by the integral of $w \cdot t$ with the traction $t$ of another flow. For a sphere of
//! radius $a$ in the rate of strain $E$ that is $t = 5 E\nu$, so that the stresslet is off by at most $\frac{20}{\sqrt 3}\pi a^2 \max|w|$; in a
//! translation it is $\frac{3}{2a}U$, in a rotation $3\, \Omega \times \nu$. Other bodies are taken for spheres of their size. The pressure over a plane
//! with the velocity $w$ is at most $\frac{8}{3\sqrt 3}\max|w|/d$ at the distance $d$, or $2 k \max|w|$ if nothing on it is shorter than $1/k$. In narrow gaps there is
//! a solution on finer surfaces to compare with, and no estimate is less than three times the difference.

use std::f64::consts::PI;

use nalgebra::Point3;

use super::rounds::COMPARED;
use super::suspension::{Answer, BodyAnswer};
use bodies_of_revolution::Meridian;

/// How far the estimates stay above what is expected.
const SAFETY: f64 = 2.0;
/// How well the flows are evaluated that are compared.
const PRESSURES: f64 = 1e-9;
/// What is left to rounding.
const ROUNDING: f64 = 1e-14;

impl Answer {
    /// The estimated absolute error of a body's stresslet, in the Frobenius norm.
    pub fn stresslet_error(&self, body: usize) -> f64 {
        let area = self.size(body).powi(2);
        let bound = 20.0 / 3f64.sqrt() * PI * area * self.worst();
        let apart = self.finer.as_ref().map_or(0.0, |finer| {
            (self.bodies[body].stresslet - finer.bodies[body].stresslet).norm()
        });
        (SAFETY * bound).max(COMPARED * apart)
    }

    /// The estimated absolute error of the rate of work $F \cdot U + T \cdot \Omega$ of a body without slip.
    pub fn power_error(&self, body: usize) -> f64 {
        let (size, answer) = (self.size(body), &self.bodies[body]);
        let velocity = answer.motion.velocity.norm();
        let turning = size * answer.motion.angular_velocity.norm();
        let alone = size * (6.0 * PI * velocity + 3.0 * PI * PI * turning);
        let found = answer.wrench.force.norm() + answer.wrench.torque.norm() * 1.2 / size;
        let bound = alone.max(found) * self.worst();
        let power = |answer: &BodyAnswer| {
            answer.wrench.force.dot(&answer.motion.velocity)
                + answer.wrench.torque.dot(&answer.motion.angular_velocity)
        };
        let finer = self.finer.as_ref();
        let apart = finer.map_or(0.0, |it| (power(answer) - power(&it.bodies[body])).abs());
        (SAFETY * bound).max(COMPARED * apart)
    }

    /// The largest estimated absolute error of the pressures at some points of the fluid.
    pub fn pressure_error(&self, points: &[Point3<f64>]) -> f64 {
        let of_point = |point: &Point3<f64>| -> f64 {
            let of_body = |body: usize| {
                let layers = &self.flow.bodies[body];
                let (discretization, scale) = (&layers.discretization, layers.frame.scale());
                let at = Meridian::of(&layers.frame.point_to_body(*point));
                let nodes = discretization.nodes().iter();
                let distance = nodes.map(|node| (node.r - at.r).hypot(node.z - at.z));
                let distance = distance.fold(f64::INFINITY, f64::min);
                let panels = 0..discretization.panels().len();
                let shortest = panels.map(|panel| discretization.arc_length(panel));
                let shortest = shortest.fold(f64::INFINITY, f64::min);
                // The shortest wave that the nodes hold.
                let cut = shortest / (PI * discretization.order() as f64);
                let size = discretization.size();
                let near = 1.0 / distance.max(cut);
                2.0 * self.off(body) * near * (size / distance).min(1.0) / scale
            };
            (0..self.bodies.len()).map(of_body).sum()
        };
        let bound = points.iter().map(of_point).fold(0.0, f64::max);
        (SAFETY * bound).max(COMPARED * self.pressures_apart(points))
    }

    /// By how much the pressures on finer surfaces are others.
    fn pressures_apart(&self, points: &[Point3<f64>]) -> f64 {
        let Some(finer) = &self.finer else {
            return 0.0;
        };
        let pressures = [&self.flow, &finer.flow].map(|flow| flow.at(points, PRESSURES));
        let [Ok(own), Ok(better)] = pressures else {
            return 0.0;
        };
        let apart = own.iter().zip(&better);
        apart
            .map(|(a, b)| (a.pressure - b.pressure).abs())
            .fold(0.0, f64::max)
    }

    fn size(&self, body: usize) -> f64 {
        let layers = &self.flow.bodies[body];
        layers.frame.scale() * layers.discretization.size()
    }

    /// What the velocity is off by on a body, rounding included.
    fn off(&self, body: usize) -> f64 {
        self.bodies[body].boundary_error + ROUNDING * self.largest_speed
    }

    fn worst(&self) -> f64 {
        let bodies = 0..self.bodies.len();
        bodies.map(|body| self.off(body)).fold(0.0, f64::max)
    }
}
