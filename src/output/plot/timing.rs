//! Figure 3.3: time of each stage against unknowns, with fitted exponents.

use super::canvas::{Canvas, PlotError, diagrams, power_of_ten};
use super::colour::DISTINCT;
use super::frame::{Axis, Frame, Style};
use crate::study::timing::{STAGES, TimingTable};

/// A column for each order.
///
/// # Errors
/// If the plotting library fails.
pub fn timing(tables: &[TimingTable]) -> Result<String, PlotError> {
    diagrams(tables.len(), 1, |canvas, column, _, corner| {
        diagram(canvas, corner, &tables[column])
    })
}

fn diagram(canvas: &Canvas<'_>, corner: (i32, i32), table: &TimingTable) -> Result<(), PlotError> {
    let points = || table.rows.iter().map(|t| t.points as f64);
    let seconds = || table.rows.iter().flat_map(|t| t.seconds);
    let title = format!("Time of each stage, {} nodes per panel", table.order);
    let x = decades(
        points(),
        "unknowns N = nodes per panel × panels × (2 modes + 1)",
    );
    let y = decades(seconds(), "wall-clock time / s");
    let frame = Frame::new(canvas, corner, &title, x, y)?;
    frame.legend(0, None, "stage, fit T ∝ N^α")?;
    let laws = table.laws();
    for (k, (name, law)) in STAGES.iter().zip(laws).enumerate() {
        let style = Style {
            colour: DISTINCT[k],
            mark: k,
            joined: false,
        };
        let curve = table.rows.iter().map(|t| (t.points as f64, t.seconds[k]));
        if let (Some(law), [first, .., last]) = (law, table.fitted()) {
            let at = |n: usize| (n as f64, law.at(n as f64));
            frame.dashed(at(first.points), at(last.points), style.colour)?;
        }
        frame.curve(&curve.collect::<Vec<_>>(), &style)?;
        let exponent = law.map_or(String::new(), |law| format!(", α = {:.2}", law.exponent));
        frame.legend(k + 1, Some(&style), &format!("{name}{exponent}"))?;
    }
    Ok(())
}

/// The axis of whole decades around positive values.
fn decades(values: impl Iterator<Item = f64>, name: &'static str) -> Axis {
    let logs = values.filter(|v| *v > 0.0).map(f64::log10);
    let (least, most) = logs.fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)));
    let (from, to) = if least <= most {
        (
            least.floor() as i32,
            (most.ceil() as i32).max(least.floor() as i32 + 1),
        )
    } else {
        (0, 1)
    };
    Axis {
        range: [f64::from(from), f64::from(to)],
        ticks: (from..=to)
            .map(|d| (f64::from(d), power_of_ten(d)))
            .collect(),
        name,
    }
}
