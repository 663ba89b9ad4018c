//! Spheroids against the closed forms of Chwang & Wu (1975) and Kim & Karrila (1991).

use std::sync::Arc;

use axistokes::geometry::curve::{GeneratingCurve, Panels, Spheroid};

use super::resistance::{Resistance, error, four, resistance, rows};

/// Semi-axes along and across the axis, and the resistance.
fn table() -> Vec<(f64, f64, Resistance)> {
    rows(include_str!("../data/resistance_spheroid.csv"))
        .iter()
        .map(|row| (row[0], row[1], four(row, 6)))
        .collect()
}

fn spheroid(polar: f64, equatorial: f64) -> Arc<dyn GeneratingCurve> {
    Arc::new(Spheroid::new(polar, equatorial).expect("a spheroid"))
}

#[test]
fn eight_panels_by_hand() {
    for (polar, equatorial, exact) in table() {
        if ![1.0, 2.0].contains(&(polar / equatorial)) {
            continue;
        }
        let curve = spheroid(polar, equatorial);
        let panels = Panels::uniform(&*curve, 8).expect("panels");
        let error = error(resistance(&curve, &panels, 16), exact);
        println!("{polar} : {equatorial}, 8 panels x 16: {error:.1e}");
        assert!(error <= 1e-14);
    }
}

#[test]
fn every_aspect_from_a_tolerance() {
    for (polar, equatorial, exact) in table() {
        let curve = spheroid(polar, equatorial);
        let panels = Panels::resolving(&*curve, 16, 1e-10).expect("panels");
        let coarse = error(resistance(&curve, &panels, 16), exact);
        let fine = error(resistance(&curve, &panels.bisected(|_| true), 16), exact);
        println!(
            "{polar} : {equatorial}, {} panels x 16: {coarse:.1e}, bisected {fine:.1e}",
            panels.len()
        );
        // Rounding grows with the aspect ratio of a disc.
        assert!(coarse <= 1e-12 && fine <= 1e-12);
    }
}

/// Errors fall at the order of the rule once panels resolve the needle's tips, down to rounding.
#[test]
fn order_of_convergence() {
    let (polar, equatorial) = (10.0, 1.0);
    let curve = spheroid(polar, equatorial);
    let (_, _, exact) = table()
        .into_iter()
        .find(|&(p, e, _)| (p, e) == (polar, equatorial))
        .expect("in the table");
    let errors = |order: usize, counts: [usize; 4]| {
        counts.map(|count| {
            let panels = Panels::uniform(&*curve, count).expect("panels");
            let error = error(resistance(&curve, &panels, order), exact);
            println!("{polar} : {equatorial}, {count} uniform panels x {order}: {error:.1e}");
            error
        })
    };
    let ten = errors(10, [4, 8, 16, 24]);
    let sixteen = errors(16, [2, 4, 8, 12]);
    println!(
        "orders {:.1} and {:.1}",
        (ten[1] / ten[2]).log2(),
        (sixteen[1] / sixteen[2]).log2()
    );
    assert!(ten[1] / ten[2] > 500.0 && sixteen[1] / sixteen[2] > 500.0);
    assert!(ten[3] <= 1e-13 && sixteen[3] <= 1e-13);
}
