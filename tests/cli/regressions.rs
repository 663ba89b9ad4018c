//! Cases that once went wrong, each named after what happened.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use axistokes::body::kernel::{Ring, RingKernel};

/// Runs `solve --json` on a case with this text.
fn solve(name: &str, text: &str) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("regressions");
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, text).unwrap();
    Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(["solve", "--json"])
        .arg(&path)
        .output()
        .unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_thousand_modes_of_separated_rings_are_finite() {
    let target = Ring {
        r: 1.0,
        z: 0.0,
        normal: [1.0, 0.0],
    };
    for h in [1e-9, 1e-3, 0.1, 0.8, 1.5, 2.9] {
        let source = Ring {
            z: f64::sqrt(2.0 * h),
            ..target
        };
        for kernel in [RingKernel::SingleLayer, RingKernel::DoubleLayer] {
            let few = kernel.modes(&target, &source, 100);
            let many = kernel.modes(&target, &source, 1000);
            assert!(many.iter().flatten().all(|x| x.is_finite()), "h = {h}");
            let scale = few.iter().flatten().fold(0.0f64, |a, x| a.max(x.abs()));
            for (a, b) in few.iter().flatten().zip(many.iter().flatten()) {
                assert!((a - b).abs() <= 1e-12 * scale, "h = {h}: {a} and {b}");
            }
        }
    }
}

#[test]
fn stokeslets_that_do_nothing_have_no_error() {
    let output = solve(
        "nothing",
        "[shapes.s]\nkind = 'sphere'\nradius = 1\n[[bodies]]\nshape = 's'\n\
         [probes]\npoints = [[0, 0, 3.0]]\n\
         [test]\nstokeslets = [{ at = [0, 0, 0.3], force = [0, 0, 0] }]\n",
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert_eq!(json(&output)["test"]["relative_error"], 0.0);
}

/// It was refused for being too near to the first, coarsest panels.
#[test]
fn a_probe_next_to_the_surface_is_answered() {
    let output = solve(
        "near",
        "[shapes.s]\nkind = 'sphere'\nradius = 1\n[[bodies]]\nshape = 's'\nvelocity = [0, 0, 1]\n\
         [accuracy]\ntolerance = 1e-8\n[probes]\npoints = [[0, 0, 1.001]]\n",
    );
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    // On the axis in front of a sphere: u = 3/2r - 1/2r^3.
    let velocity = json(&output)["probes"][0]["velocity"][2].as_f64();
    let exact = 1.5 / 1.001 - 0.5 / 1.001f64.powi(3);
    assert!((velocity.unwrap() - exact).abs() <= 1e-8, "{velocity:?}");
}

/// The flow near the poles was off by a part that grew with the unit of length.
#[test]
fn a_probe_at_the_pole_of_a_large_sphere_is_right() {
    for (name, imposed) in [("held", "velocity"), ("free", "force")] {
        let output = solve(
            &format!("large-{name}"),
            &format!(
                "[shapes.s]\nkind = 'sphere'\nradius = 1e12\n[[bodies]]\nshape = 's'\n\
                 {imposed} = [0, 0, 1]\n[probes]\npoints = [[0, 0, 1e12], [0, 0, -1e12]]\n"
            ),
        );
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        let report = json(&output);
        let velocity = |of: &serde_json::Value| of["velocity"][2].as_f64().unwrap();
        let body = velocity(&report["bodies"][0]);
        for probe in report["probes"].as_array().unwrap() {
            assert!((velocity(probe) / body - 1.0).abs() <= 1e-13, "{report}");
        }
    }
}

/// The cylinder's first panels were thousands of radii long; refinement then gave up, with an
/// estimate below the error.
#[test]
fn a_capsule_of_length_ten_thousand_meets_its_tolerance() {
    let drag = |tolerance: &str| {
        let text = format!(
            "[shapes.s]\nkind = 'capsule'\nradius = 1\nlength = 1e4\n\
             [[bodies]]\nshape = 's'\nvelocity = [0, 0, 1]\n[accuracy]\ntolerance = {tolerance}\n"
        );
        let output = solve(&format!("capsule-{tolerance}"), &text);
        assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
        json(&output)["bodies"][0]["force"][2].as_f64().unwrap()
    };
    let (coarse, fine) = (drag("1e-4"), drag("1e-9"));
    assert!((coarse / fine - 1.0).abs() <= 1e-4, "{coarse} and {fine}");
}
