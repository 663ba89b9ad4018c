//! The convergence study as tables for people and as CSV.

use std::fmt::{self, Write};

use crate::study::errors::{ErrorTable, ROUNDING};
use crate::study::points;
use crate::study::power_law::PowerLaw;
use crate::study::setup::Errors;
use crate::study::timing::{STAGES, TimingTable};

/// Errors of one order: absolute with the observed order in panels, then relative.
pub fn errors_table(table: &ErrorTable) -> String {
    let mut out = String::new();
    // writing to a string does not fail
    let _ = write_errors(&mut out, table);
    out
}

fn write_errors(out: &mut String, table: &ErrorTable) -> fmt::Result {
    let order = table.order;
    writeln!(
        out,
        "absolute error (3.140), {order} nodes per panel; panels down, highest mode across"
    )?;
    write_heads(out, table)?;
    writeln!(out, "  order in panels")?;
    for (k, observed) in table.observed_orders().into_iter().enumerate() {
        write_row(out, table, k, |e| e.absolute)?;
        match observed {
            Some(observed) => writeln!(out, "  {observed:15.1}")?,
            None => writeln!(out, "  {:>15}", "-")?,
        }
    }
    writeln!(
        out,
        "  (order: from one row to the next, with the most modes, while the error is above {ROUNDING:e})"
    )?;
    writeln!(out, "\nrelative error (3.141), {order} nodes per panel")?;
    write_heads(out, table)?;
    writeln!(out)?;
    for k in 0..table.rows.len() {
        write_row(out, table, k, |e| e.relative)?;
        writeln!(out)?;
    }
    if table.entries().any(|(_, _, errors)| errors.is_none()) {
        writeln!(out, "  (\"-\": left out, for want of memory)")?;
    }
    Ok(())
}

fn write_heads(out: &mut String, table: &ErrorTable) -> fmt::Result {
    write!(out, "{:>8}", "")?;
    table.modes.iter().try_for_each(|n| write!(out, " {n:>8}"))
}

fn write_row(
    out: &mut String,
    table: &ErrorTable,
    k: usize,
    of: fn(&Errors) -> f64,
) -> fmt::Result {
    write!(out, "{:>8}", table.panels[k])?;
    table.rows[k].iter().try_for_each(|errors| match errors {
        Some(errors) => write!(out, " {:8.1e}", of(errors)),
        None => write!(out, " {:>8}", "-"),
    })
}

/// Times of one order, with the exponents of $T \propto N^\alpha$.
pub fn timing_table(table: &TimingTable) -> String {
    let mut out = String::new();
    // writing to a string does not fail
    let _ = write_timing(&mut out, table);
    out
}

fn write_timing(out: &mut String, table: &TimingTable) -> fmt::Result {
    writeln!(
        out,
        "seconds of each stage, {} nodes per panel (medians); N = nodes per panel x panels x (2 modes + 1)",
        table.order
    )?;
    write!(
        out,
        "{:>8} {:>6} {:>8} {:>5}",
        "panels", "modes", "N", "runs"
    )?;
    STAGES
        .iter()
        .try_for_each(|stage| write!(out, " {stage:>9}"))?;
    writeln!(out, "  assemble/factor")?;
    for t in &table.rows {
        write!(
            out,
            "{:>8} {:>6} {:>8} {:>5}",
            t.panels, t.modes, t.points, t.runs
        )?;
        t.seconds
            .iter()
            .try_for_each(|s| write!(out, " {s:9.2e}"))?;
        let [assemble, factor, ..] = t.seconds;
        writeln!(out, "  {:15.2}", assemble / factor)?;
    }
    write!(out, "{:>30}", "alpha, T ~ N^alpha")?;
    for law in table.laws() {
        match law {
            Some(PowerLaw { exponent, .. }) => write!(out, " {exponent:9.2}")?,
            None => write!(out, " {:>9}", "-")?,
        }
    }
    match table.fitted() {
        [first, .., last] => writeln!(out, "  (N from {} to {})", first.points, last.points)?,
        _ => writeln!(out)?,
    }
    if !table.left_out.is_empty() {
        writeln!(
            out,
            "  (left out, for want of memory: {:?} panels)",
            table.left_out
        )?;
    }
    Ok(())
}

/// Every error, one line each; what was left out has none.
pub fn errors_csv(tables: &[ErrorTable]) -> String {
    let mut out = String::from("order,panels,modes,unknowns,absolute_error,relative_error\n");
    for table in tables {
        for (panels, modes, errors) in table.entries() {
            let Some(Errors { absolute, relative }) = errors else {
                continue;
            };
            let order = table.order;
            let unknowns = points(order, panels, modes);
            // writing to a string does not fail
            let _ = writeln!(
                out,
                "{order},{panels},{modes},{unknowns},{absolute:e},{relative:e}"
            );
        }
    }
    out
}

/// Every time, one line for each resolution.
pub fn timing_csv(tables: &[TimingTable]) -> String {
    let mut out = String::from("order,panels,modes,unknowns,runs");
    for stage in STAGES {
        out.push_str(&format!(",{stage}_seconds"));
    }
    out.push('\n');
    for table in tables {
        for t in &table.rows {
            let seconds: String = t.seconds.iter().map(|s| format!(",{s:e}")).collect();
            let head = [table.order, t.panels, t.modes, t.points, t.runs];
            out.push_str(&head.map(|x| x.to_string()).join(","));
            out.push_str(&seconds);
            out.push('\n');
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::timing::Timing;

    fn errors() -> ErrorTable {
        let entry = |absolute| {
            Some(Errors {
                absolute,
                relative: 2.0 * absolute,
            })
        };
        ErrorTable {
            order: 16,
            panels: vec![2, 4],
            modes: vec![10, 20],
            rows: vec![vec![entry(0.25), entry(0.125)], vec![entry(0.0625), None]],
        }
    }

    #[test]
    fn csv_has_every_error_that_was_measured() {
        let expected = "order,panels,modes,unknowns,absolute_error,relative_error\n\
            16,2,10,672,2.5e-1,5e-1\n16,2,20,1312,1.25e-1,2.5e-1\n16,4,10,1344,6.25e-2,1.25e-1\n";
        assert_eq!(errors_csv(&[errors()]), expected);
    }

    #[test]
    fn tables_say_what_is_left_out() {
        let text = errors_table(&errors());
        assert!(text.contains("left out"), "{text}");
        let row = |points| Timing {
            panels: 2,
            modes: 10,
            points,
            runs: 7,
            seconds: [1.0, 2.0, 3.0, 4.0].map(|s| s * points as f64),
        };
        let table = TimingTable {
            order: 10,
            rows: vec![row(10), row(100)],
            left_out: vec![90],
        };
        let text = timing_table(&table);
        assert!(
            text.contains("[90] panels") && text.contains("1.00"),
            "{text}"
        );
        let csv = timing_csv(&[table]);
        assert_eq!(csv.lines().nth(1), Some("10,2,10,10,7,1e1,2e1,3e1,4e1"));
    }
}
