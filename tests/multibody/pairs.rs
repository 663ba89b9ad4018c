//! Grand matrices of pairs of spheroids and spheres: from end to end to side by side.

use axistokes::{Body, Frame, Options, Silent, Solver, Suspension};
use nalgebra::{DMatrix, Point3, Unit, Vector3};

use super::common::{apart, asymmetry, at, cells, number, spheroid};

/// The tables' matrices by their labels.
fn table(text: &str) -> Vec<(String, DMatrix<f64>)> {
    let rows = cells(text);
    rows.chunk_by(|a, b| a[0] == b[0])
        .map(|rows| {
            assert_eq!(rows.len(), 12);
            let matrix = DMatrix::from_fn(12, 12, |i, j| number(rows[i][3 + j]));
            (rows[0][0].to_string(), matrix)
        })
        .collect()
}

fn pair(label: &str) -> Suspension {
    let rod = spheroid(1.0, 0.5);
    let [first, second] = match label {
        "side-by-side" => [(rod.clone(), at(0.0, 0.0, 0.0)), (rod, at(1.5, 0.0, 0.0))],
        "end-to-end" => [(rod.clone(), at(0.0, 0.0, 0.0)), (rod, at(0.0, 0.0, 2.5))],
        "end-to-end-close" => [(rod.clone(), at(0.0, 0.0, 0.0)), (rod, at(0.0, 0.0, 2.125))],
        "oblate-sphere" => [
            (spheroid(0.5, 1.0), at(0.0, 0.0, 0.0)),
            (spheroid(1.0, 1.0), at(0.0, 0.0, 1.6).scaled(0.7)),
        ],
        "general" => {
            let axis = Unit::new_normalize(Vector3::new(1.0, 0.0, 1.0));
            [
                (rod, Frame::along(Point3::origin(), axis)),
                (spheroid(0.6, 0.6), at(1.2, 0.7, -0.9)),
            ]
        }
        other => panic!("a pair named {other}"),
    };
    Suspension::new(
        [first, second]
            .map(|(curve, frame)| Body::new(curve, frame))
            .to_vec(),
    )
}

#[test]
fn on_one_axis_are_those_of_the_tables() {
    check(&["end-to-end", "end-to-end-close", "oblate-sphere"], 1e-8);
}

#[test]
fn at_any_place_are_those_of_the_tables() {
    check(&["side-by-side", "general"], 1e-8);
}

/// All matrices and their product with each other, relative to the largest entry.
fn check(labels: &[&str], tolerance: f64) {
    let resistances = table(include_str!("../data/spheroid_pairs.csv"));
    let mobilities = table(include_str!("../data/spheroid_pairs_mobility.csv"));
    assert_eq!(resistances.len(), 5);
    for ((label, resistance), (other, mobility)) in resistances.iter().zip(&mobilities) {
        assert_eq!(label, other);
        if !labels.contains(&label.as_str()) {
            continue;
        }
        let pair = pair(label);
        let begin = std::time::Instant::now();
        let mut solver = Solver::new(Options::tolerance(tolerance));
        let r = solver.grand_resistance(&pair, &Silent).expect("a matrix");
        let m = solver.grand_mobility(&pair, &Silent).expect("a matrix");
        let errors = [apart(&r.matrix, resistance), apart(&m.matrix, mobility)];
        let inverse = (&r.matrix * &m.matrix - DMatrix::identity(12, 12)).amax();
        println!(
            "{label}: resistance {:.1e} (estimate {:.1e}), mobility {:.1e} (estimate {:.1e}), R M - 1 {inverse:.1e}, asymmetries {:.1e} and {:.1e}, {:.1} s",
            errors[0],
            r.error_estimate,
            errors[1],
            m.error_estimate,
            asymmetry(&r.matrix),
            asymmetry(&m.matrix),
            begin.elapsed().as_secs_f64()
        );
        let worst = [
            errors[0],
            errors[1],
            inverse,
            asymmetry(&r.matrix),
            asymmetry(&m.matrix),
        ];
        assert!(worst.iter().all(|&error| error <= 0.3 * tolerance));
        assert!(errors[0] <= r.error_estimate && errors[1] <= m.error_estimate);
    }
}
