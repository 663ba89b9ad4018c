//! The answer to a case.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::{Imposed, Input, Place};
use crate::case::{Background, ShapeSpec};

/// Everything one solve reports; as JSON it is the contract of `axistokes solve --json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// What was asked, of the whole case.
    #[serde(flatten)]
    pub input: Input,
    /// The undisturbed flow, in the words of the case; none if the fluid is at rest.
    pub background: Option<Background>,
    /// The shapes by name, in the words of the case.
    pub shapes: BTreeMap<String, ShapeSpec>,
    /// One entry per body, in the order of the case.
    pub bodies: Vec<BodyReport>,
    /// One entry per probe, in the order of the case.
    pub probes: Vec<ProbeReport>,
    /// Estimated error: of the velocities at the probes relative to the largest speed imposed, and
    /// of forces, torques and rigid velocities relative to their largest value.
    pub error_estimate: f64,
    /// The largest speed on the surfaces of all bodies, imposed or found.
    pub largest_speed: f64,
    /// Estimated error of the pressures at the probes, absolute.
    pub pressure_error_estimate: f64,
    /// Iterations of the linear solver; 0 for a direct solve.
    pub iterations: usize,
    /// Products with the system's matrix, those of coarser solutions before the last one included;
    /// 0 for a direct solve.
    pub products: usize,
    /// The relative residual that the iteration came to.
    pub residual: Option<f64>,
    /// Why the iteration ended.
    pub stop: Stop,
    /// Unknowns of the linear system, all modes together.
    pub unknowns: usize,
    /// Points on the surfaces of all bodies that the interactions are summed over; a single body
    /// has none.
    pub points: Option<usize>,
    /// One entry per shape and resolution in use.
    pub discretization: Vec<Discretization>,
    /// Seconds spent in each stage.
    pub timings: Timings,
    /// Error against the known flow, only for a case with `[test]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub test: Option<KnownFlowReport>,
}

/// Motion and load of one body, in the laboratory frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BodyReport {
    /// Where it is.
    #[serde(flatten)]
    pub place: Place,
    /// What was imposed on it; not in a case with `[test]`, whose known flow takes its place.
    pub imposed: Option<Imposed>,
    /// Velocity of the centre.
    pub velocity: [f64; 3],
    /// Angular velocity.
    pub angular_velocity: [f64; 3],
    /// Force exerted by the body on the fluid.
    pub force: [f64; 3],
    /// Torque about the centre exerted by the body on the fluid.
    pub torque: [f64; 3],
    /// Stresslet about the centre, row by row: symmetric, without trace.
    pub stresslet: [[f64; 3]; 3],
    /// Its estimated error, absolute.
    pub stresslet_error_estimate: f64,
    /// Rate of work that the surface does on the fluid; not for a case with `[test]`, whose
    /// tractions would cost more than its answer.
    pub power: Option<f64>,
    /// Its estimated error, absolute; not known for one of many bodies with a slip.
    pub power_error_estimate: Option<f64>,
}

/// The flow at one probe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ProbeReport {
    /// The probe, as in the case.
    pub point: [f64; 3],
    /// Total velocity, background included.
    pub velocity: [f64; 3],
    /// Pressure, vanishing at infinity.
    pub pressure: f64,
}

/// How one shape was discretised.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Discretization {
    /// Name of the shape.
    pub shape: String,
    /// Panels on its generating curve.
    pub panels: usize,
    /// Nodes on a panel.
    pub order: usize,
    /// Azimuthal modes.
    pub modes: usize,
    /// Bodies that are so discretised; not in a report of shapes alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bodies: Option<usize>,
}

/// Why the solution of the linear system ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stop {
    /// It was solved directly.
    #[default]
    Direct,
    /// The residual is as small as it was to be.
    Converged,
    /// The residual no longer fell, not far above what it was to be: the error estimate tells
    /// whether that was enough.
    Stagnated,
    /// No more iterations were allowed, not far above what it was to be: the error estimate tells
    /// whether they were enough.
    Exhausted,
}

/// Seconds of wall clock spent in each stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Timings {
    /// Assembling the modal matrices; of many bodies, finding what is near each other too.
    pub assemble: f64,
    /// Factoring them.
    pub factor: f64,
    /// Solving: substitutions, or iterations.
    pub iterate: f64,
    /// Evaluating the flow at the probes.
    pub evaluate: f64,
    /// Everything else: choosing resolutions, and estimating the error of every round.
    pub estimate: f64,
}

/// Largest error of the velocity at the probes against a known flow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct KnownFlowReport {
    /// Largest error in units of velocity.
    pub absolute_error: f64,
    /// The same, relative to the largest speed of the known flow on the bodies.
    pub relative_error: f64,
}

impl Report {
    /// Which number is the first that is infinite or not a number, if one is: such a report must
    /// not be shown.
    pub fn not_finite(&self) -> Option<String> {
        let finite = |v: &[f64; 3]| v.iter().all(|x| x.is_finite());
        for (number, body) in (1..).zip(&self.bodies) {
            let quantities = [
                ("velocity", &body.velocity),
                ("angular velocity", &body.angular_velocity),
                ("force", &body.force),
                ("torque", &body.torque),
            ];
            if let Some((name, _)) = quantities.iter().find(|(_, v)| !finite(v)) {
                return Some(format!("{name} of body {number}"));
            }
            if !body.stresslet.iter().all(finite) {
                return Some(format!("stresslet of body {number}"));
            }
            if !body.stresslet_error_estimate.is_finite() {
                return Some(format!("error estimate of the stresslet of body {number}"));
            }
            if [body.power, body.power_error_estimate]
                .iter()
                .flatten()
                .any(|x| !x.is_finite())
            {
                return Some(format!("power of body {number}"));
            }
        }
        for (number, probe) in (1..).zip(&self.probes) {
            if !finite(&probe.velocity) {
                return Some(format!("velocity at probe {number}"));
            }
            if !probe.pressure.is_finite() {
                return Some(format!("pressure at probe {number}"));
            }
        }
        if !self.error_estimate.is_finite() {
            return Some("error estimate".into());
        }
        if !self.pressure_error_estimate.is_finite() {
            return Some("error estimate of the pressures".into());
        }
        let test = self.test.unwrap_or_default();
        if !(test.absolute_error.is_finite() && test.relative_error.is_finite()) {
            return Some("error against the known flow".into());
        }
        None
    }

    /// One JSON object on one line; every number reads back to the same double.
    pub fn json(&self) -> serde_json::Result<String> {
        serde_json::to_string(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_has_the_names_of_the_contract() {
        let report = Report {
            bodies: vec![BodyReport {
                force: [0.1, 1.0 / 3.0, std::f64::consts::PI],
                ..BodyReport::default()
            }],
            probes: vec![ProbeReport::default()],
            discretization: vec![Discretization {
                shape: "rod".into(),
                ..Discretization::default()
            }],
            ..Report::default()
        };
        let json = report.json().unwrap();
        let value: serde_json::Value = serde_json::from_str(&json).unwrap();
        let mut keys: Vec<_> = value.as_object().unwrap().keys().collect();
        keys.sort();
        let expected = [
            "background",
            "bodies",
            "case",
            "discretization",
            "error_estimate",
            "iterations",
            "largest_speed",
            "points",
            "pressure_error_estimate",
            "probes",
            "products",
            "residual",
            "shapes",
            "stop",
            "timings",
            "tolerance",
            "unknowns",
            "version",
            "viscosity",
        ];
        assert_eq!(keys, expected);
        assert!(json.contains("[0.1,0.3333333333333333,3.141592653589793]"));
        assert_eq!(serde_json::from_str::<Report>(&json).unwrap(), report);
    }

    #[test]
    fn test_appears_only_when_given() {
        let report = Report {
            test: Some(KnownFlowReport::default()),
            ..Report::default()
        };
        let json = report.json().unwrap();
        assert!(json.ends_with(r#""test":{"absolute_error":0.0,"relative_error":0.0}}"#));
    }

    #[test]
    fn a_number_that_is_not_finite_is_named() {
        let mut report = Report {
            bodies: vec![BodyReport::default()],
            ..Report::default()
        };
        assert_eq!(report.not_finite(), None);
        report.bodies[0].torque[1] = f64::NAN;
        assert_eq!(report.not_finite().unwrap(), "torque of body 1");
    }
}
