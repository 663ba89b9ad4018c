//! Forces, torques and stresslets of two spheres, from four gaps down to a hundredth of a radius.

use axistokes::{Body, Frame, Slip, Suspension};
use nalgebra::{Matrix3, Point3, Unit, Vector3};

use super::common::{answer, ball, cells, direction, moving, number};

/// One line of the table.
struct Row {
    radii: [f64; 2],
    distance: f64,
    motion: String,
    moving: usize,
    /// Force, torque and stresslet of each sphere.
    values: [[f64; 3]; 2],
}

fn table() -> Vec<Row> {
    let rows = cells(include_str!("../data/two_spheres_resistance.csv"));
    rows.iter()
        .map(|row| Row {
            radii: [number(row[0]), number(row[1])],
            distance: number(row[2]),
            motion: row[3].to_string(),
            moving: number(row[4]) as usize - 1,
            values: std::array::from_fn(|k| std::array::from_fn(|l| number(row[5 + 3 * k + l]))),
        })
        .collect()
}

/// What was found, and how well.
struct Found {
    /// The largest error of a force or torque, relative to the value or to a hundredth of the
    /// largest of the motion, whichever is larger.
    of_values: f64,
    /// The largest error of forces and torques relative to the largest of them, and of those that
    /// should vanish.
    of_largest: f64,
    /// The same for stresslets, relative to their largest.
    of_stresslets: f64,
    estimate: f64,
}

/// Axes of spheres are free unless they have a slip, be it none: `kept` keeps them.
fn solved(row: &Row, axes: [Unit<Vector3<f64>>; 2], kept: bool, tolerance: f64) -> Found {
    let curve = ball();
    let frames: [Frame; 2] = std::array::from_fn(|k| {
        Frame::along(Point3::new(0.0, 0.0, k as f64 * row.distance), axes[k]).scaled(row.radii[k])
    });
    let rest = Vector3::zeros();
    let (z, xz) = (Vector3::z(), Vector3::x());
    let strain = match row.motion.as_str() {
        "strain_zz" => Matrix3::from_diagonal(&Vector3::new(-0.5, -0.5, 1.0)),
        "strain_xz" => xz * z.transpose() + z * xz.transpose(),
        _ => Matrix3::zeros(),
    };
    let frame = frames[row.moving];
    let slip = Slip::new(move |x| {
        let from_center = frame.point_to_lab(x.into()) - frame.center();
        frame.vector_to_body(strain * from_center)
    });
    let mut bodies: Vec<Body> = frames
        .iter()
        .map(|&f| Body::new(curve.clone(), f))
        .collect();
    bodies[row.moving].motion = match row.motion.as_str() {
        "along" => moving(Vector3::z(), rest),
        "across" => moving(Vector3::x(), rest),
        "turn_along" => moving(rest, Vector3::z()),
        "turn_across" => moving(rest, Vector3::y()),
        _ => moving(rest, rest),
    };
    let none = Slip::new(|_| Vector3::zeros());
    if kept {
        bodies
            .iter_mut()
            .for_each(|body| body.slip = Some(none.clone()));
    }
    if strain != Matrix3::zeros() {
        bodies[row.moving].slip = Some(slip);
    }
    let answer = answer(&Suspension::new(bodies), tolerance);
    let along = matches!(row.motion.as_str(), "along" | "strain_zz");
    let mut found = Found {
        of_values: 0.0,
        of_largest: 0.0,
        of_stresslets: 0.0,
        estimate: answer.error_estimate,
    };
    let size = |k: usize| [1.0, 1.0 / row.radii[k]];
    let largest = (0..2)
        .flat_map(|k| (0..2).map(move |l| (k, l)))
        .fold(0.0f64, |most, (k, l)| {
            most.max(row.values[k][l].abs() * size(k)[l])
        });
    let largest_stresslet = row.values[0][2].abs().max(row.values[1][2].abs());
    for (k, body) in answer.bodies.iter().enumerate() {
        let [force, torque, stresslet] = row.values[k];
        let force = force * if along { Vector3::z() } else { Vector3::x() };
        let torque = torque
            * if row.motion == "turn_along" {
                Vector3::z()
            } else {
                Vector3::y()
            };
        for (error, value, unit) in [
            ((body.wrench.force - force).norm(), force.norm(), size(k)[0]),
            (
                (body.wrench.torque - torque).norm(),
                torque.norm(),
                size(k)[1],
            ),
        ] {
            found.of_largest = found.of_largest.max(error * unit / largest);
            found.of_values = found
                .of_values
                .max(error * unit / (value * unit).max(1e-2 * largest));
        }
        // The table's is that of the force on the fluid, ours Batchelor's.
        let exact = -stresslet
            * if along {
                Matrix3::from_diagonal(&Vector3::new(-0.5, -0.5, 1.0))
            } else {
                xz * z.transpose() + z * xz.transpose()
            };
        if row.motion == "turn_along" {
            found.of_stresslets = found.of_stresslets.max(body.stresslet.amax());
        } else {
            let error = (body.stresslet - exact).amax() / largest_stresslet;
            found.of_stresslets = found.of_stresslets.max(error);
        }
    }
    let resolution = &answer.bodies[row.moving].resolution;
    println!(
        "{:?} {} {:11} {}: values {:.1e}, largest {:.1e}, stresslets {:.1e}, estimate {:.1e} ({:.0} x), {} panels, {} modes, {} iterations, {:.1} s",
        row.radii,
        row.distance,
        row.motion,
        row.moving + 1,
        found.of_values,
        found.of_largest,
        found.of_stresslets,
        found.estimate,
        found.estimate / found.of_largest,
        resolution.panels.len(),
        resolution.modes,
        answer.statistics.iteration.iterations,
        answer.statistics.timings.iterate + answer.statistics.timings.estimate,
    );
    found
}

/// Tolerances, and what is reached with them.
fn bars(row: &Row) -> (f64, f64) {
    match row.distance {
        2.01 => (1e-8, 1e-9),
        _ => (1e-10, 1e-10),
    }
}

/// Bars are relative to the value, or to a hundredth of the largest of the motion if that is more.
fn check(row: &Row, axes: [Unit<Vector3<f64>>; 2]) {
    let (tolerance, bar) = bars(row);
    let found = solved(row, axes, false, tolerance);
    assert!(found.of_values <= bar && found.of_stresslets <= bar);
    assert!(found.of_largest <= found.estimate && found.estimate <= 10.0 * tolerance);
}

#[test]
fn on_one_axis() {
    for row in table() {
        // The narrowest pair is its own mirror image: one of the two tells all.
        if row.distance == 2.01 && row.moving == 1 {
            continue;
        }
        check(&row, [Vector3::z_axis(); 2]);
    }
}

#[test]
fn turned_onto_one_axis() {
    let mut rng = fastrand::Rng::with_seed(5);
    for row in table() {
        let axes = [direction(&mut rng), direction(&mut rng)];
        if row.distance > 2.1 || row.motion.starts_with("strain") || row.moving == 1 {
            continue;
        }
        check(&row, axes);
    }
}

#[test]
fn with_tilted_axes() {
    let mut rng = fastrand::Rng::with_seed(3);
    for row in table() {
        let axes = [direction(&mut rng), direction(&mut rng)];
        if row.distance < 2.5 || row.radii[1] > 1.0 || row.moving == 1 {
            continue;
        }
        if row.motion.starts_with("strain") {
            continue;
        }
        let tolerance = 1e-9;
        let found = solved(&row, axes, true, tolerance);
        assert!(found.of_largest <= found.estimate && found.estimate <= tolerance);
    }
}
