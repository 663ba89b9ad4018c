//! `axistokes gaps` and `axistokes grand`: what bodies in their places are to each other, whatever
//! is asked of them.

use std::fmt::Write;

use super::args::{Gaps, Grand};
use super::failure::Failure;
use super::progress_bar::StderrBar;
use super::streams;
use axistokes::case::Case;
use axistokes::geometry::{Placed, Relation};
use axistokes::solve::{SolveError, question_of};
use axistokes::{GrandMatrix, Solver};
use serde_json::json;

/// Prints the gaps between the bodies of a case that are no farther apart than asked.
pub fn gaps(arguments: &Gaps) -> Result<(), Failure> {
    let case = Case::read(&arguments.case).map_err(SolveError::from)?;
    let (suspension, _) = question_of(&case).map_err(SolveError::from)?;
    let placed = suspension.bodies.iter().map(|body| Placed {
        curve: &*body.shape,
        frame: body.frame,
        reach: arguments
            .within
            .unwrap_or(2.0 * body.shape.extent() * body.frame.scale()),
    });
    let found = axistokes::gaps(&placed.collect::<Vec<_>>())
        .map_err(|error| Failure::Input(format!("{}: {error}", case.path.display())))?;
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
    let resistance = solver.grand_resistance(&suspension, &bar)?;
    let mobility = solver.grand_mobility(&suspension, &bar)?;
    drop(bar);
    let estimate = resistance.error_estimate.max(mobility.error_estimate);
    if arguments.json {
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
        let both = json!({ "resistance": of(&resistance), "mobility": of(&mobility) });
        streams::print(&format!("{both}\n"))?;
    } else {
        let mut text = String::from(
            "row and column 6 i + k: component k of body i + 1, three linear and three angular, \
             about the bodies' centres\n",
        );
        let named = [
            ("resistance: forces, torques = R (velocities)", &resistance),
            ("mobility: velocities = M (forces, torques)", &mobility),
        ];
        for (name, found) in named {
            // Writing to a string does not fail.
            let _ = writeln!(
                text,
                "\n{name}; estimated error {:.1e}",
                found.error_estimate
            );
            for row in found.matrix.row_iter() {
                let cells: Vec<String> = row.iter().map(|x| format!("{x:14.6e}")).collect();
                let _ = writeln!(text, "{}", cells.join(" "));
            }
        }
        streams::print(&text)?;
    }
    match super::solve::missed(&case, estimate) {
        Some(message) => Err(Failure::Missed(format!(
            "{}: {message}",
            case.path.display()
        ))),
        None => Ok(()),
    }
}
