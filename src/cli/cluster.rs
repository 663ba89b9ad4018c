//! `axistokes gaps` and `axistokes grand`: what bodies in their places are to each other, whatever
//! is asked of them.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::args::{Gaps, Grand};
use super::failure::Failure;
use super::progress_bar::StderrBar;
use super::streams;
use axistokes::case::{Case, CaseError};
use axistokes::geometry::Relation;
use axistokes::output::digits::Known;
use axistokes::output::{Input, Place, exact};
use axistokes::solve::{SolveError, explain, question_of};
use axistokes::suspension::Body;
use axistokes::{GrandMatrix, Solver, SuspensionError};
use serde_json::{Value, json};

/// Prints the gaps between the bodies of a case that are no farther apart than asked.
pub fn gaps(arguments: &Gaps) -> Result<(), Failure> {
    let case = Case::read(&arguments.case).map_err(SolveError::from)?;
    let (suspension, _) = question_of(&case).map_err(SolveError::from)?;
    let found =
        (suspension.gaps(arguments.within)).map_err(|error| explain(&case, error.into()))?;
    let relation = |relation| match relation {
        Relation::Apart => "apart",
        Relation::Touching => "touching",
        Relation::Overlapping => "overlapping",
        Relation::Inside(_) => "inside",
    };
    if arguments.json {
        let gaps = found.iter().map(|gap| {
            json!({
                "bodies": gap.bodies.map(|body| body + 1),
                "distance": gap.distance,
                "relation": relation(gap.relation),
                "points": gap.points.map(|x| [x.x, x.y, x.z]),
                "normals": gap.normals.map(|n| [n.x, n.y, n.z]),
            })
        });
        let gaps: Vec<_> = gaps.collect();
        return streams::print(&format!("{}\n", json!({ "gaps": gaps })));
    }
    if found.is_empty() {
        let path = case.path.display();
        let near = match arguments.within {
            Some(length) => format!("within {length} of each other"),
            None => {
                "as near to each other as they are large (--within LENGTH looks farther)".into()
            }
        };
        return streams::print(&format!("{path}: no two bodies are {near}\n"));
    }
    let mut text = String::from(
        "bodies      distance     relation     nearest points: of the first, of the second\n",
    );
    for gap in &found {
        let [a, b] = gap
            .points
            .map(|x| format!("({:.6e}, {:.6e}, {:.6e})", x.x, x.y, x.z));
        let [i, j] = gap.bodies.map(|body| body + 1);
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "{i:4} {j:4}  {:13.6e}  {:11}  {a}  {b}",
            gap.distance,
            relation(gap.relation)
        );
    }
    streams::print(&text)
}

/// Prints the grand resistance and mobility matrices of the bodies of a case.
pub fn grand(arguments: &Grand) -> Result<(), Failure> {
    let case = Case::read(&arguments.case).map_err(SolveError::from)?;
    let (suspension, options) = question_of(&case).map_err(SolveError::from)?;
    let bar = StderrBar::stopped_by_ctrl_c()?;
    let mut solver = Solver::new(options);
    let explained = |error: SuspensionError| Failure::from(explain(&case, error));
    let resistance = (solver.grand_resistance(&suspension, &bar)).map_err(explained)?;
    let mobility = (solver.grand_mobility(&suspension, &bar)).map_err(explained)?;
    drop(bar);
    let text = if arguments.json {
        format!(
            "{}\n",
            grand_json(&case, &suspension.bodies, &resistance, &mobility)?
        )
    } else {
        grand_table(&case, &suspension.bodies, &resistance, &mobility)
    };
    streams::print(&text)?;
    let estimate = resistance.error_estimate.max(mobility.error_estimate);
    match super::solve::missed(&case, estimate) {
        Some(message) => Err(Failure::Missed(
            CaseError::new(case.path.display(), None, message).to_string(),
        )),
        None => Ok(()),
    }
}

fn grand_json(
    case: &Case,
    bodies: &[Body],
    resistance: &GrandMatrix,
    mobility: &GrandMatrix,
) -> Result<Value, Failure> {
    let of = |found: &GrandMatrix| {
        let rows = found
            .matrix
            .row_iter()
            .map(|row| row.iter().copied().collect());
        json!({
            "matrix": rows.collect::<Vec<Vec<f64>>>(),
            "error_estimate": found.error_estimate,
        })
    };
    let mut report =
        serde_json::to_value(Input::of(case)).map_err(|error| Failure::Other(error.to_string()))?;
    let places = case.bodies.iter().zip(bodies);
    let places: Vec<Place> = places
        .map(|(body, placed)| Place::of(body, placed))
        .collect();
    let shapes = (case.shapes.iter()).map(|(name, shape)| (name, &shape.value));
    let shapes: BTreeMap<_, _> = shapes.collect();
    report["bodies"] = json!(places);
    report["shapes"] = json!(shapes);
    report["resistance"] = of(resistance);
    report["mobility"] = of(mobility);
    Ok(report)
}

fn grand_table(
    case: &Case,
    bodies: &[Body],
    resistance: &GrandMatrix,
    mobility: &GrandMatrix,
) -> String {
    let mut text = format!(
        "{}: viscosity {}, everything in the units of the case\n\
         row and column 6 (i - 1) + k: component k of body i, k = 1 to 3 linear, 4 to 6 angular, about \
         the bodies' centres\n",
        case.path.display(),
        exact(case.viscosity)
    );
    // What a component counts as a length is to the power of: a torque is a force times a size, an
    // angular velocity a velocity over one.
    for (name, found, power) in [
        (
            "resistance: forces, torques = R (velocities, angular velocities)",
            resistance,
            1,
        ),
        (
            "mobility: velocities, angular velocities = M (forces, torques)",
            mobility,
            -1,
        ),
    ] {
        // Writing to a string does not fail.
        let _ = writeln!(
            text,
            "\n{name}; estimated error {:.1e}",
            found.error_estimate
        );
        let size = |component: usize| match component % 6 {
            0..3 => 1.0,
            _ => {
                let body = &bodies[component / 6];
                (body.shape.extent() * body.frame.scale()).powi(power)
            }
        };
        let columns = found.matrix.column_iter().map(|column| {
            let rows = column.iter().enumerate();
            rows.map(|(i, x)| x.abs() / size(i)).fold(0.0, f64::max)
        });
        let columns: Vec<f64> = columns.collect();
        for (i, row) in found.matrix.row_iter().enumerate() {
            let cells = row.iter().zip(&columns).map(|(&x, column)| {
                Known::relative(found.error_estimate, size(i) * column).number(x)
            });
            let _ = writeln!(text, "{}", cells.collect::<Vec<_>>().join("  "));
        }
    }
    text
}
