//! Resistance and mobility of shapes, as JSON and as a table.

use std::collections::BTreeMap;
use std::fmt::{self, Write};

use nalgebra::Matrix6;
use serde::{Deserialize, Serialize};

use super::digits::Known;
use super::table::exact;
use super::{Discretization, Input, error_line};
use crate::case::{Case, ShapeSpec};
use stokes_body::resistance::{RigidBodyMatrices, ScalarFunctions};

/// What `axistokes resistance` reports.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ResistanceReport {
    /// What was asked, with the viscosity that the matrices are for.
    #[serde(flatten)]
    pub input: Input,
    /// One entry per shape of the case, by name.
    pub shapes: Vec<ShapeReport>,
}

/// Resistance and mobility of one shape about its origin, in the frame whose z axis is the symmetry
/// axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShapeReport {
    /// Velocity and angular velocity to the force and torque exerted on the fluid, row by row.
    pub resistance: [[f64; 6]; 6],
    /// Force and torque to velocity and angular velocity, row by row.
    pub mobility: [[f64; 6]; 6],
    /// Scalar functions of both for viscosity 1: `XA`, `YA`, `YB`, `XC`, `YC` of the resistance and
    /// `xa`, `ya`, `yb`, `xc`, `yc` of the mobility; see [`ScalarFunctions`]; and those of strain,
    /// `XG`, `YG`, `YH`, `XM`, `YM`, `ZM`, see [`stokes_body::strain`].
    pub functions: BTreeMap<String, f64>,
    /// Einstein's coefficient of a dilute suspension of free bodies in all directions, without
    /// Brownian motion: the viscosity is that of the fluid times one plus this times the volume
    /// fraction.
    pub intrinsic_viscosity: f64,
    /// Bretherton's constant: how a free body turns in a strain, (r^2 - 1)/(r^2 + 1) for a spheroid
    /// of aspect ratio r.
    pub bretherton_constant: f64,
    /// The point about which rotation and translation do not couple.
    pub center_of_reaction: [f64; 3],
    /// Estimated error of every entry (i, j) of the matrices relative to the root of the product of
    /// entries (i, i) and (j, j).
    pub error_estimate: f64,
    /// The shape in the words of the case.
    pub definition: Option<ShapeSpec>,
    /// The shape's name, and how it was discretised.
    #[serde(flatten)]
    pub discretization: Discretization,
}

/// The scalar functions as Kim & Karrila name them, `XA` for $X^A$, in the order of
/// [`ScalarFunctions`].
const RESISTANCE_FUNCTIONS: [&str; 5] = ["XA", "YA", "YB", "XC", "YC"];
const MOBILITY_FUNCTIONS: [&str; 5] = ["xa", "ya", "yb", "xc", "yc"];
const STRAIN_FUNCTIONS: [&str; 6] = ["XG", "YG", "YH", "XM", "YM", "ZM"];

fn rows(matrix: Matrix6<f64>) -> [[f64; 6]; 6] {
    matrix.transpose().into()
}

impl ShapeReport {
    /// The report of a shape that was computed for viscosity 1.
    pub fn new(
        shape: &str,
        definition: &ShapeSpec,
        matrices: &RigidBodyMatrices,
        viscosity: f64,
    ) -> Self {
        let values = |f: ScalarFunctions| [f.xa, f.ya, f.yb, f.xc, f.yc];
        let of_resistance = values(matrices.resistance.scalar_functions());
        let of_mobility = values(matrices.mobility.scalar_functions());
        let s = &matrices.strain;
        let of_strain = [s.xg, s.yg, s.yh, s.xm, s.ym, s.zm];
        let functions = (RESISTANCE_FUNCTIONS.into_iter().zip(of_resistance))
            .chain(MOBILITY_FUNCTIONS.into_iter().zip(of_mobility))
            .chain(STRAIN_FUNCTIONS.into_iter().zip(of_strain))
            .map(|(name, value)| (name.to_owned(), value));
        Self {
            resistance: rows(viscosity * matrices.resistance.0),
            mobility: rows(matrices.mobility.0 / viscosity),
            functions: functions.collect(),
            intrinsic_viscosity: matrices.free.intrinsic_viscosity(matrices.volume),
            bretherton_constant: matrices.free.bretherton_constant(),
            center_of_reaction: matrices.resistance.center_of_reaction().into(),
            error_estimate: matrices.error_estimate,
            definition: Some(definition.clone()),
            discretization: Discretization {
                shape: shape.to_owned(),
                panels: matrices.resolution.panels.len(),
                order: matrices.resolution.order,
                modes: matrices.resolution.modes,
                bodies: None,
            },
        }
    }
}

impl ResistanceReport {
    /// The largest of the shapes' estimated errors.
    pub fn error_estimate(&self) -> f64 {
        let errors = self.shapes.iter().map(|shape| shape.error_estimate);
        errors.fold(0.0, f64::max)
    }

    /// The name of the first shape with a number that is infinite or not a number: such a report
    /// must not be shown.
    pub fn not_finite(&self) -> Option<String> {
        let finite = |shape: &&ShapeReport| {
            let matrices = [shape.resistance, shape.mobility];
            let mut entries = matrices.iter().flatten().flatten();
            entries.all(|x| x.is_finite()) && shape.error_estimate.is_finite()
        };
        let shape = self.shapes.iter().find(|shape| !finite(shape))?;
        Some(format!("shapes.{}", shape.discretization.shape))
    }

    /// One JSON object on one line; every number reads back to the same double.
    pub fn json(&self) -> serde_json::Result<String> {
        serde_json::to_string(self)
    }

    /// The report as aligned text.
    pub fn table(&self, case: &Case) -> String {
        let mut text = String::new();
        // writing to a string does not fail
        let _ = self.write(&mut text, case);
        text
    }

    fn write(&self, out: &mut String, case: &Case) -> fmt::Result {
        writeln!(
            out,
            "{}: viscosity {}, everything in the units of the case",
            case.path.display(),
            exact(case.viscosity)
        )?;
        writeln!(
            out,
            "matrices about the origin of the shape, its axis along z; functions for viscosity 1, named as in Kim & Karrila (1991), not divided by 6 pi a:\n  \
             translation U across the axis d: torque YB (U x d); force F across it: angular velocity yb (F x d)"
        )?;
        self.shapes
            .iter()
            .try_for_each(|shape| shape.write(out, case))
    }
}

impl ShapeReport {
    fn write(&self, out: &mut String, case: &Case) -> fmt::Result {
        let d = &self.discretization;
        writeln!(
            out,
            "\n{}: {} panels of {} nodes, {}",
            d.shape,
            d.panels,
            d.order,
            error_line(case, self.error_estimate)
        )?;
        for (name, &value) in &self.functions {
            writeln!(out, "  {name} {}", self.known_function(name).number(value))?;
        }
        // Of order one, but for the centre, which is as far away as the body is large.
        let [across, turning] = [self.resistance[0][0], self.resistance[3][3]];
        let length = (turning / across).sqrt();
        let known = |scale| Known::relative(self.error_estimate, scale);
        writeln!(
            out,
            "  centre of reaction {}",
            known(length).row(&self.center_of_reaction, &[])
        )?;
        writeln!(
            out,
            "  intrinsic viscosity {}",
            known(1.0).number(self.intrinsic_viscosity)
        )?;
        writeln!(
            out,
            "  Bretherton constant {}",
            known(1.0).number(self.bretherton_constant)
        )?;
        for (name, matrix) in [
            (
                "resistance: force, torque = R (velocity, angular velocity)",
                &self.resistance,
            ),
            (
                "mobility: velocity, angular velocity = M (force, torque)",
                &self.mobility,
            ),
        ] {
            writeln!(out, "  {name}")?;
            for (i, row) in matrix.iter().enumerate() {
                let entry =
                    |(j, &x): (usize, &f64)| known((matrix[i][i] * matrix[j][j]).sqrt()).number(x);
                let entries: Vec<String> = row.iter().enumerate().map(entry).collect();
                writeln!(out, "  {}", entries.join("  "))?;
            }
        }
        Ok(())
    }

    /// How well a function is known: relative to the root of the product of the two that it couples
    /// if it is one that couples, else to itself.
    fn known_function(&self, name: &str) -> Known {
        let [first, second] = match name {
            "YB" => ["YA", "YC"],
            "yb" => ["ya", "yc"],
            "XG" => ["XA", "XM"],
            "YG" => ["YA", "YM"],
            "YH" => ["YC", "YM"],
            itself => [itself; 2],
        };
        let value = |name| self.functions.get(name).copied().unwrap_or_default();
        Known::relative(self.error_estimate, (value(first) * value(second)).sqrt())
    }
}
