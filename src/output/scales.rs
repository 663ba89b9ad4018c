//! How large the numbers of a report are, and how far they may be off.
//!
//! A flow of speed $U$ around a body of size $a$ goes with forces of about $6\pi\mu a U$, and so
//! on. Which scale the estimated error of a report is relative to, [`Report::error_estimate`] says.

use std::f64::consts::PI;

use super::digits::Known;
use super::{BodyReport, Report};

/// Forces and motions below this part of what the largest speed goes with count as if they were
/// that large: so the estimate has it.
const SMALL: f64 = 1e-2;

/// The scales of a report's numbers.
pub(super) struct Scales<'r> {
    report: &'r Report,
    /// Absolute errors of the motions, as velocities, and of forces.
    of_motions: f64,
    of_forces: f64,
}

impl<'r> Scales<'r> {
    pub(super) fn new(report: &'r Report) -> Self {
        let speed = report.largest_speed;
        let motion = match &report.bodies[..] {
            [alone] => {
                let turning = alone.place.size * norm(&alone.angular_velocity);
                norm(&alone.velocity).max(turning).max(SMALL * speed)
            }
            _ => speed,
        };
        let force = report.bodies.iter().map(|body| {
            let torque = norm(&body.torque) / body.place.size;
            let small = SMALL * drag(report, body);
            norm(&body.force).max(torque).max(small)
        });
        Self {
            report,
            of_motions: report.error_estimate * motion,
            of_forces: report.error_estimate * force.fold(0.0, f64::max),
        }
    }

    pub(super) fn velocity(&self) -> Known {
        Known::absolute(self.of_motions, self.report.largest_speed)
    }

    pub(super) fn angular_velocity(&self, body: &BodyReport) -> Known {
        let scale = self.report.largest_speed / body.place.size;
        Known::absolute(self.of_motions / body.place.size, scale)
    }

    pub(super) fn force(&self, body: &BodyReport) -> Known {
        Known::absolute(self.of_forces, drag(self.report, body))
    }

    pub(super) fn torque(&self, body: &BodyReport) -> Known {
        let scale = body.place.size * drag(self.report, body);
        Known::absolute(body.place.size * self.of_forces, scale)
    }

    pub(super) fn stresslet(&self, body: &BodyReport) -> Known {
        let scale = body.place.size * drag(self.report, body);
        Known::absolute(body.stresslet_error_estimate, scale)
    }

    /// Where the error is not known, it is that of forces.
    pub(super) fn power(&self, body: &BodyReport) -> Known {
        let speed = self.report.largest_speed;
        let error = body.power_error_estimate;
        let error = error.unwrap_or(speed * self.of_forces);
        Known::absolute(error, speed * drag(self.report, body))
    }

    pub(super) fn flow(&self) -> Known {
        Known::relative(self.report.error_estimate, self.report.largest_speed)
    }

    pub(super) fn pressure(&self) -> Known {
        let sizes = self.report.bodies.iter().map(|body| body.place.size);
        let scale =
            self.report.input.viscosity * self.report.largest_speed / sizes.fold(0.0, f64::max);
        Known::absolute(self.report.pressure_error_estimate, scale)
    }
}

/// The drag of a sphere of a body's size at the largest speed.
fn drag(report: &Report, body: &BodyReport) -> f64 {
    6.0 * PI * report.input.viscosity * body.place.size * report.largest_speed
}

pub(super) fn norm(v: &[f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
