//! Tori, capsules and the red cell against tables made by independent methods (`data/README.md`),
//! and against themselves.

use std::f64::consts::PI;
use std::sync::Arc;

use axistokes::geometry::curve::{Biconcave, Capsule, GeneratingCurve, Panels, Torus};

use super::resistance::{error, four, resistance, rows};

fn torus(minor: f64) -> Arc<dyn GeneratingCurve> {
    Arc::new(Torus::new(1.0, minor).expect("a torus"))
}

#[test]
fn tori() {
    for row in rows(include_str!("../data/torus_drag.csv")) {
        let (minor, exact) = (row[0], four(&row, 1));
        let curve = torus(minor);
        let panels = Panels::resolving(&*curve, 16, 1e-10).expect("panels");
        let coarse = resistance(&curve, &panels, 16);
        let fine = resistance(&curve, &panels.bisected(|_| true), 16);
        let (of_coarse, of_fine, between) = (
            error(coarse, exact),
            error(fine, exact),
            error(coarse, fine),
        );
        println!(
            "torus 1 + {minor}, {} panels x 16: {of_coarse:.1e}, bisected {of_fine:.1e}, between them {between:.1e}",
            panels.len()
        );
        assert!(of_coarse <= 2e-12 && of_fine <= 1e-14 && between <= 2e-12);
    }
}

#[test]
fn published_drag_of_tori() {
    for row in rows(include_str!("../data/torus_axial_mitchell.csv")) {
        let (minor, published) = (row[0], row[1] * 6.0 * PI * (1.0 + row[0]));
        let curve = torus(minor);
        let panels = Panels::resolving(&*curve, 16, 1e-10).expect("panels");
        let error = (resistance(&curve, &panels, 16)[0] / published - 1.0).abs();
        println!("torus 1 + {minor} along its axis: {error:.1e} from Mitchell et al.");
        assert!(error <= 2e-12);
    }
}

/// The thin torus of Johnson & Wu (J. Fluid Mech. 95, 263, 1979): slender-body theory, with an
/// error of the thickness squared.
#[test]
fn slender_tori() {
    for (minor, bar) in [(0.01f64, 2e-3), (0.001, 5e-5)] {
        let l = (8.0 / minor).ln();
        let slender = [
            8.0 * PI * PI / (l + 0.5),
            2.0 * PI * PI * (3.0 * l - 8.5) / ((l - 0.5) * (l - 2.0) - 2.0),
            4.0 * PI * PI / (l - 2.0),
            4.0 * PI * PI / (l - 1.5),
        ];
        let curve = torus(minor);
        let panels = Panels::resolving(&*curve, 16, 1e-10).expect("panels");
        let error = error(resistance(&curve, &panels, 16), slender);
        println!("torus 1 + {minor}: slender-body theory within {error:.1e}");
        assert!(error <= bar);
    }
}

#[test]
fn capsules() {
    for row in rows(include_str!("../data/capsule.csv")) {
        let (radius, length, exact) = (row[0], row[1], four(&row, 2));
        let curve: Arc<dyn GeneratingCurve> =
            Arc::new(Capsule::new(radius, length).expect("a capsule"));
        let panels = Panels::resolving(&*curve, 16, 1e-10).expect("panels");
        let mut errors = Vec::new();
        let mut last = None;
        for levels in [0, 2, 4, 6, 8] {
            let panels = panels.graded_to_breakpoints(levels);
            let value = resistance(&curve, &panels, 16);
            errors.push(error(value, exact));
            println!(
                "capsule {radius} {length}, {levels} levels, {} panels x 16: {:.1e}",
                panels.len(),
                errors[errors.len() - 1]
            );
            if let Some(last) = last.replace(value)
                && levels == 8
            {
                println!("  from 6 to 8 levels: {:.1e}", error(last, value));
                assert!(error(last, value) <= 1e-11);
            }
        }
        // The singularity at the joint makes the error fall like the cube of the panels there: by a
        // factor of eight for each level of refinement.
        assert!(errors.windows(2).take(2).all(|e| e[1] < e[0] / 30.0));
        assert!(errors[4] <= 5e-14);
    }
}

#[test]
fn red_cell() {
    let row = &rows(include_str!("../data/biconcave.csv"))[0];
    let curve: Arc<dyn GeneratingCurve> = Arc::new(Biconcave::new(1.0).expect("a red cell"));
    let panels = Panels::resolving(&*curve, 16, 1e-10).expect("panels");
    let error = error(resistance(&curve, &panels, 16), four(row, 3));
    println!("red cell, {} panels x 16: {error:.1e}", panels.len());
    assert!(error <= 1e-12);
}
