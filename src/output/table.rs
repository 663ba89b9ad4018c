//! The answer as a table for people.

use super::digits::Known;
use super::scales::{Scales, norm};
use super::{BodyReport, Discretization, KnownFlowReport, Report, Stop};
use crate::case::{Body, Case, Component};
use std::fmt::{self, Write};

/// The most bodies that the table shows one by one, unless told to show all.
pub const FEW_BODIES: usize = 20;

/// The report as aligned text; units are those of the case, made consistent by its viscosity. Of
/// more than [`FEW_BODIES`] it shows what they have in common, or `all` of them.
pub fn table(case: &Case, report: &Report, all: bool) -> String {
    let mut text = String::new();
    // writing to a string does not fail
    let _ = write_table(&mut text, case, report, all);
    text
}

fn write_table(out: &mut String, case: &Case, report: &Report, all: bool) -> fmt::Result {
    writeln!(
        out,
        "{}: viscosity {}, everything in the units of the case",
        case.path.display(),
        exact(case.viscosity)
    )?;
    write_error(out, case, report)?;
    if let Some(test) = &report.test {
        write_known_flow(out, test)?;
    }
    if all || report.bodies.len() <= FEW_BODIES {
        write_bodies(out, case, report)?;
    } else {
        write_summary(out, report)?;
    }
    if !report.probes.is_empty() {
        write_probes(out, report)?;
    }
    write_discretization(out, &report.discretization)?;
    let (stop, residual) = (report.stop, report.residual.unwrap_or_default());
    let how = match stop {
        Stop::Direct => "",
        Stop::Converged => "to",
        Stop::Stagnated => "stagnated at",
        Stop::Exhausted => "(no more were allowed) to",
    };
    let solve = if stop == Stop::Direct {
        "direct solve".to_owned()
    } else {
        let (iterations, products) = (report.iterations, report.products);
        format!("{iterations} iterations {how} a residual of {residual:.1e}, {products} products")
    };
    let points = report.points.map(|points| format!(", {points} points"));
    let points = points.unwrap_or_default();
    writeln!(out, "{} unknowns{points}, {solve}", report.unknowns)?;
    let t = &report.timings;
    writeln!(
        out,
        "seconds: assemble {:.3}, factor {:.3}, solve {:.3}, evaluate {:.3}, error estimate and the rest {:.3}",
        t.assemble, t.factor, t.iterate, t.evaluate, t.estimate
    )
}

/// How an estimated error stands to the tolerance of the case.
pub(super) fn error_line(case: &Case, estimate: f64) -> String {
    let how = match case.promised_tolerance() {
        Some(tolerance) if estimate > tolerance => format!("MISSES the tolerance {tolerance:e}"),
        Some(tolerance) => format!("within the tolerance {tolerance:e}"),
        None => "discretisation chosen by hand".to_owned(),
    };
    format!("estimated error {estimate:.1e}, {how}")
}

fn write_error(out: &mut String, case: &Case, report: &Report) -> fmt::Result {
    writeln!(out, "{}", error_line(case, report.error_estimate))?;
    let relative = if case.bodies.len() == 1 {
        "(relative: velocities at probes to the largest speed, force and torque to the larger of them, the motion to itself)"
    } else {
        "(relative: velocities to the largest speed; forces, and torques over sizes, to the largest of them)"
    };
    writeln!(out, "  {relative}")
}

fn write_known_flow(out: &mut String, test: &KnownFlowReport) -> fmt::Result {
    writeln!(
        out,
        "true error at the probes, against the known flow: {:.2e} absolute, {:.2e} relative",
        test.absolute_error, test.relative_error
    )
}

fn write_bodies(out: &mut String, case: &Case, report: &Report) -> fmt::Result {
    let widest = case.bodies.iter().map(|body| body.shape.chars().count());
    let width = widest.max().unwrap_or(0).max("shape".len());
    writeln!(
        out,
        "\nbodies; force and torque (about the centre) are exerted by the body on the fluid, the stresslet is that of the traction on the body (Batchelor)"
    )?;
    writeln!(
        out,
        "{:>6}  {:width$}  {:16}  {:>20}  {:>20}  {:>20}",
        "body", "shape", "quantity", "x", "y", "z"
    )?;
    let scales = Scales::new(report);
    for (i, (body, answer)) in case.bodies.iter().zip(&report.bodies).enumerate() {
        let rows = rows_of(case, body, answer, &scales);
        for (row, (quantity, numbers)) in rows.into_iter().enumerate() {
            let (number, shape) = match row {
                0 => ((i + 1).to_string(), body.shape.as_str()),
                _ => (String::new(), ""),
            };
            writeln!(out, "{number:>6}  {shape:width$}  {quantity:16}  {numbers}")?;
        }
        let mut errors = format!("stresslet {:.1e}", answer.stresslet_error_estimate);
        if let Some(error) = answer.power_error_estimate {
            errors += &format!(", power {error:.1e}");
        } else if answer.power.is_some() {
            errors += ", power not known";
        }
        writeln!(
            out,
            "{:>6}  {:width$}  (estimated errors: {errors})",
            "", ""
        )?;
    }
    Ok(())
}

/// The numbers of one body, line by line.
fn rows_of(
    case: &Case,
    body: &Body,
    answer: &BodyReport,
    scales: &Scales<'_>,
) -> Vec<(&'static str, String)> {
    // A known flow takes the place of what is imposed: the bodies are still.
    let known_flow = case.test.is_some();
    let imposed =
        (body.components).map(|component| matches!(component, Component::Imposed(_)) || known_flow);
    let loads = imposed.map(|imposed| !imposed);
    let mut rows = vec![
        (
            "velocity",
            (scales.velocity()).row(&answer.velocity, &imposed[..3]),
        ),
        (
            "angular velocity",
            (scales.angular_velocity(answer)).row(&answer.angular_velocity, &imposed[3..]),
        ),
        (
            "force",
            scales.force(answer).row(&answer.force, &loads[..3]),
        ),
        (
            "torque",
            scales.torque(answer).row(&answer.torque, &loads[3..]),
        ),
    ];
    let stresslet = (scales.stresslet(answer)).cells(answer.stresslet.as_flattened(), &[]);
    let names = ["stresslet x", "stresslet y", "stresslet z"];
    let tensor = names.into_iter().zip(stresslet.chunks(3));
    rows.extend(tensor.map(|(name, cells)| (name, cells.join("  "))));
    if let Some(power) = answer.power {
        rows.push(("power", scales.power(answer).number(power)));
    }
    rows
}

/// The slowest, the fastest and the mean, and so on.
fn write_summary(out: &mut String, report: &Report) -> fmt::Result {
    let bodies = &report.bodies;
    writeln!(
        out,
        "\n{} bodies (--all shows each, --json all numbers); magnitudes, with the number of the body",
        bodies.len()
    )?;
    writeln!(
        out,
        "{:16}  {:>20}  {:>6}  {:>20}  {:>6}  {:>20}",
        "quantity", "smallest", "body", "largest", "body", "mean"
    )?;
    let scales = Scales::new(report);
    type Magnitude<'m> = &'m dyn Fn(&BodyReport) -> (f64, Known);
    let rows: [(&str, Magnitude<'_>); 4] = [
        ("velocity", &|body| {
            (norm(&body.velocity), scales.velocity())
        }),
        ("angular velocity", &|body| {
            let known = scales.angular_velocity(body);
            (norm(&body.angular_velocity), known)
        }),
        ("force", &|body| (norm(&body.force), scales.force(body))),
        ("torque", &|body| (norm(&body.torque), scales.torque(body))),
    ];
    for (quantity, magnitude) in rows {
        let (values, known): (Vec<f64>, Vec<Known>) = bodies.iter().map(magnitude).unzip();
        let order = |&i: &usize, &j: &usize| values[i].total_cmp(&values[j]).then(j.cmp(&i));
        let [least, most] = [
            (0..values.len()).min_by(order),
            (0..values.len()).max_by(order),
        ]
        .map(Option::unwrap_or_default);
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        writeln!(
            out,
            "{quantity:16}  {}  {:>6}  {}  {:>6}  {}",
            known[least].number(values[least]),
            least + 1,
            known[most].number(values[most]),
            most + 1,
            known[most].number(mean)
        )?;
    }
    let mean = |vector: &dyn Fn(&BodyReport) -> [f64; 3]| {
        let part = |j: usize| bodies.iter().map(|body| vector(body)[j]).sum::<f64>();
        [0, 1, 2].map(|j| part(j) / bodies.len() as f64)
    };
    let Some(first) = bodies.first() else {
        return Ok(());
    };
    let velocity = scales.velocity().row(&mean(&|body| body.velocity), &[]);
    let force = scales.force(first).row(&mean(&|body| body.force), &[]);
    writeln!(out, "mean velocity     {velocity}")?;
    writeln!(out, "mean force        {force}")
}

fn write_probes(out: &mut String, report: &Report) -> fmt::Result {
    writeln!(
        out,
        "\nprobes; total velocity, pressure vanishing at infinity (estimated error of the pressures: {:.1e})",
        report.pressure_error_estimate
    )?;
    let exactly = |x: f64| exact(x).len();
    let coordinates = report.probes.iter().flat_map(|probe| probe.point);
    let width = coordinates.map(exactly).max().unwrap_or(0).max(10);
    writeln!(
        out,
        "{:>6}  {:>width$}  {:>width$}  {:>width$}  {:>20}  {:>20}  {:>20}  {:>20}",
        "probe", "x", "y", "z", "velocity x", "velocity y", "velocity z", "pressure"
    )?;
    let scales = Scales::new(report);
    let (flow, pressure) = (scales.flow(), scales.pressure());
    for (i, probe) in report.probes.iter().enumerate() {
        let [x, y, z] = probe.point.map(exact);
        writeln!(
            out,
            "{:>6}  {x:>width$}  {y:>width$}  {z:>width$}  {}  {}",
            i + 1,
            flow.row(&probe.velocity, &[]),
            pressure.number(probe.pressure)
        )?;
    }
    Ok(())
}

/// All digits of a number, with an exponent if that is shorter.
pub fn exact(x: f64) -> String {
    let [plain, with_exponent] = [x.to_string(), format!("{x:e}")];
    if plain.len() <= with_exponent.len() {
        plain
    } else {
        with_exponent
    }
}

fn write_discretization(out: &mut String, shapes: &[Discretization]) -> fmt::Result {
    let widest = shapes.iter().map(|d| d.shape.chars().count());
    let width = widest.max().unwrap_or(0).max("shape".len());
    // Of one body there is nothing to count.
    let counts = shapes
        .iter()
        .any(|d| d.bodies.is_some_and(|bodies| bodies > 1))
        || shapes.len() > 1;
    let head = if counts { "  bodies" } else { "" };
    writeln!(
        out,
        "\n  {:width$}  {:>6}  {:>5}  {:>5}{head}",
        "shape", "panels", "order", "modes"
    )?;
    for d in shapes {
        let count = d.bodies.filter(|_| counts);
        let count = count.map(|bodies| format!("  {bodies:>6}"));
        writeln!(
            out,
            "  {:width$}  {:>6}  {:>5}  {:>5}{}",
            d.shape,
            d.panels,
            d.order,
            d.modes,
            count.unwrap_or_default()
        )?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned() {
        let text = "[shapes.ball]\nkind = 'sphere'\nradius = 1\n[[bodies]]\nshape = 'ball'";
        let case = Case::parse(text, "ball.toml").unwrap();
        let report = Report {
            bodies: vec![BodyReport {
                force: [-1.5e-300, 0.0, 18.849],
                ..BodyReport::default()
            }],
            probes: vec![super::super::ProbeReport::default(); 2],
            error_estimate: 2e-7,
            ..Report::default()
        };
        let text = table(&case, &report, false);
        assert!(text.contains("MISSES the tolerance 1e-8"));
        let lines: Vec<&str> = text.lines().collect();
        let header = lines.iter().position(|l| l.contains("quantity")).unwrap();
        for line in &lines[header + 1..header + 5] {
            assert_eq!(line.len(), lines[header].len(), "{line}");
        }
        let header = lines.iter().position(|l| l.contains("velocity x")).unwrap();
        assert_eq!(lines[header].len(), lines[header + 1].len());
    }
}
