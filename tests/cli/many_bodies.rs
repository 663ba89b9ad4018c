//! Cases of many bodies through the command line and the library: known answers, consistency,
//! messages, files.

use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use axistokes::case::Case;
use axistokes::nalgebra::{Matrix3, Vector3};
use axistokes::output::Report;
use axistokes::output::vtk::Mesh as Surface;
use axistokes::progress::Silent;
use axistokes::solve::{Solved, solve};

fn text(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/cases");
    fs::read_to_string(folder.join(name)).expect("a case")
}

fn solved(text: &str) -> Solved {
    let case = Case::parse(text, "many.toml").expect("a case");
    solve(&case, &Silent).expect("an answer")
}

fn report(text: &str) -> Report {
    solved(text).report
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("many-{name}"));
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).expect("a folder");
    path
}

fn run(folder: &Path, text: &str, arguments: &[&str]) -> Output {
    fs::write(folder.join("case.toml"), text).expect("a case");
    Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(["solve", "case.toml"])
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .expect("the program runs")
}

fn refused(name: &str, text: &str) -> String {
    let folder = folder(name);
    let output = run(&folder, text, &[]);
    let line = String::from_utf8(output.stderr).expect("text");
    assert_eq!(output.status.code(), Some(2), "{line}");
    assert!(output.stdout.is_empty());
    assert_eq!(line.lines().count(), 1, "{line}");
    assert_eq!(fs::read_dir(&folder).expect("the folder").count(), 1);
    line
}

/// The bispherical solution of Stimson and Jeffery (1926) for spheres that approach; the value is
/// that of the case.
#[test]
fn two_spheres_feel_the_known_force() {
    for (viscosity, scale) in [(1.0, 1.0), (3.0, 2.0)] {
        // The same spheres as halves made larger.
        let text = text("two-spheres.toml")
            .replace("radius = 1.0", &format!("radius = {}", 1.0 / scale))
            .replace(
                "shape = \"ball\"",
                &format!("shape = \"ball\"\nscale = {scale}"),
            );
        let report = report(&format!("viscosity = {viscosity}\n{text}"));
        assert!(report.error_estimate <= 1e-8, "{}", report.error_estimate);
        let exact = viscosity * 6.0 * PI * 7.413297606556766;
        for (body, sign) in report.bodies.iter().zip([1.0, -1.0]) {
            let error = (body.force[2] * sign / exact - 1.0).abs();
            assert!(error < 1e-10, "{error:e}");
            let power = body.power.expect("a power");
            let off = (power - exact).abs();
            assert!(off <= body.power_error_estimate.expect("an estimate") && off < 1e-9 * exact);
        }
        assert_eq!(
            report
                .discretization
                .iter()
                .filter_map(|d| d.bodies)
                .sum::<usize>(),
            2
        );
        assert!(report.iterations > 0 && report.products >= report.iterations);
        assert!(report.residual.is_some_and(|residual| residual < 1e-8));
    }
}

/// Solutions to two tolerances agree to the larger one, and what is free exerts what acts on it.
#[test]
fn finer_answers_agree_with_coarser_ones() {
    for (name, coarse, fine) in [
        ("eight-sinking.toml", "tolerance = 1e-6", "tolerance = 1e-7"),
        ("held-and-free.toml", "tolerance = 1e-7", "tolerance = 1e-8"),
    ] {
        let text = text(name);
        assert!(text.contains(coarse));
        let [coarse, fine] = [text.clone(), text.replace(coarse, fine)].map(|text| report(&text));
        let vector = |v: [f64; 3]| Vector3::from(v);
        let largest = |of: fn(&axistokes::output::BodyReport) -> [f64; 3]| {
            let norms = fine.bodies.iter().map(|body| vector(of(body)).norm());
            norms.fold(0.0, f64::max)
        };
        let (speed, force) = (largest(|b| b.velocity), largest(|b| b.force));
        for (a, b) in coarse.bodies.iter().zip(&fine.bodies) {
            let velocity = (vector(a.velocity) - vector(b.velocity)).norm() / speed;
            assert!(velocity <= coarse.error_estimate, "{name}: {velocity:e}");
            let force = (vector(a.force) - vector(b.force)).norm() / force;
            assert!(force <= coarse.error_estimate, "{name}: {force:e}");
            let [s, t] = [a.stresslet, b.stresslet].map(|s| Matrix3::from_fn(|i, j| s[i][j]));
            let off = (s - t).norm();
            assert!(off <= a.stresslet_error_estimate, "{name}: {off:e}");
            let power = (a.power.expect("one") - b.power.expect("one")).abs();
            assert!(
                power <= a.power_error_estimate.expect("one"),
                "{name}: {power:e}"
            );
        }
        for (a, b) in coarse.probes.iter().zip(&fine.probes) {
            assert!((vector(a.velocity) - vector(b.velocity)).norm() <= 1e-6 * speed);
            assert!((a.pressure - b.pressure).abs() <= coarse.pressure_error_estimate);
        }
        if name == "eight-sinking.toml" {
            for body in &coarse.bodies {
                assert_eq!((body.force, body.torque), ([0.0, 0.0, -1.0], [0.0; 3]));
            }
        }
    }
}

const KNOWN: &str = "
viscosity = 2.0
[shapes.rod]
kind = 'spheroid'
polar = 1.0
equatorial = 0.5
[shapes.ring]
kind = 'torus'
major = 1.0
minor = 0.4
[[bodies]]
shape = 'rod'
axis = [1.0, 0.0, 1.0]
[[bodies]]
shape = 'ring'
center = [0.0, 0.0, 2.0]
axis = [0.0, 0.3, 1.0]
scale = 0.8
[[bodies]]
shape = 'rod'
center = [2.0, 0.5, 0.0]
scale = 1.3
[probes]
points = [[0.0, 0.0, 2.0], [1.0, 0.5, 0.2], [0.0, 4.0, 1.0]]
[test]
stokeslets = [
    { at = [0.05, 0.1, 0.1], force = [1.0, 0.5, -0.3] },
    { at = [2.1, 0.5, 0.4], force = [-0.4, 0.2, 1.0] },
    { at = [0.8, 0.05, 2.02], force = [0.3, -1.0, 0.2] },
]
[accuracy]
tolerance = 1e-7
";

/// The flow of Stokeslets inside the bodies: each body's layers make the flow of the Stokeslets
/// inside it, so that its force, torque and stresslet are known, and so are the velocities and
/// pressures outside.
#[test]
fn known_stokeslets_come_out_again() {
    for formulation in ["combined", "single-layer"] {
        let text = format!("{KNOWN}[solver]\nformulation = '{formulation}'\n");
        let case = Case::parse(&text, "known.toml").expect("a case");
        let report = solve(&case, &Silent).expect("an answer").report;
        let stokeslets = &case.test.as_ref().expect("a test").stokeslets;
        let test = report.test.expect("a test");
        println!(
            "{formulation}: {test:?}, estimated {:e}",
            report.error_estimate
        );
        assert!(test.relative_error <= report.error_estimate, "{test:?}");
        for (body, stokeslet) in [(0, 0), (2, 1), (1, 2)] {
            let (found, s) = (&report.bodies[body], &stokeslets[stokeslet]);
            let force = Vector3::from(s.force);
            let arm = Vector3::from(s.at) - Vector3::from(case.bodies[body].center);
            assert!((Vector3::from(found.force) - force).norm() < 1e-6);
            assert!((Vector3::from(found.torque) - arm.cross(&force)).norm() < 1e-6);
            let moment = force * arm.transpose();
            let symmetric = 0.5 * (moment + moment.transpose());
            let exact = Matrix3::from_diagonal_element(symmetric.trace() / 3.0) - symmetric;
            let off = (Matrix3::from_fn(|i, j| found.stresslet[i][j]) - exact).norm();
            println!(
                "stresslet {off:e}, estimated {:e}",
                found.stresslet_error_estimate
            );
            assert!(off <= found.stresslet_error_estimate, "{off:e}");
            assert!(off >= 1e-5 * found.stresslet_error_estimate, "{off:e}");
            assert_eq!((found.power, found.power_error_estimate), (None, None));
        }
        let mut worst = 0.0f64;
        for probe in &report.probes {
            let pressure: f64 = stokeslets
                .iter()
                .map(|s| {
                    let x = Vector3::from(probe.point) - Vector3::from(s.at);
                    x.dot(&Vector3::from(s.force)) / (4.0 * PI * x.norm().powi(3))
                })
                .sum();
            worst = worst.max((probe.pressure - pressure).abs());
        }
        println!(
            "pressure {worst:e}, estimated {:e}",
            report.pressure_error_estimate
        );
        assert!(worst <= report.pressure_error_estimate, "{worst:e}");
        assert!(worst >= 1e-5 * report.pressure_error_estimate, "{worst:e}");
    }
}

/// The integrals of the tractions are the forces, of bodies that are held, free, scaled, and swim.
#[test]
fn tractions_integrate_to_forces_and_powers() {
    let text = "
viscosity = 1.5
[shapes.ball]
kind = 'sphere'
radius = 1.0
[shapes.rod]
kind = 'spheroid'
polar = 1.0
equatorial = 0.4
[[bodies]]
shape = 'ball'
center = [40.0, 0.0, 0.0]
force = [0.0, 0.0, 0.0]
slip = { kind = 'squirmer', b = [1.5, 3.0] }
[[bodies]]
shape = 'rod'
center = [42.5, 0.0, 0.3]
axis = [0.2, 1.0, 0.0]
scale = 1.5
velocity = [0.0, 1.0, 0.3]
[background]
kind = 'uniform'
velocity = [0.1, 0.0, 0.2]
[accuracy]
panels = 4
order = 16
modes = 12
";
    let solved = solved(text);
    let surface = Surface::of(&solved.answer, |_| 128, &Silent).expect("surfaces");
    let area = |[a, b, c]: [usize; 3]| {
        let [a, b, c] = [a, b, c].map(|v| surface.points[v]);
        0.5 * (b - a).cross(&(c - a)).norm()
    };
    let mut force = [Vector3::zeros(); 2];
    let mut power = [0.0; 2];
    for cell in &surface.cells {
        let body = surface.body[cell[0] as usize] as usize - 1;
        for k in 2..cell.len() {
            let triangle = [cell[0], cell[k - 1], cell[k]].map(|v| v as usize);
            let share = area(triangle) / 3.0;
            for v in triangle {
                force[body] -= share * surface.traction[v];
                power[body] -= share * surface.traction[v].dot(&surface.velocity[v]);
            }
        }
    }
    for (i, body) in solved.report.bodies.iter().enumerate() {
        let off = (force[i] - Vector3::from(body.force)).norm();
        println!("force {off:e}, power {} of {:?}", power[i], body.power);
        // Flat triangles.
        assert!(off < 3e-2, "{off}");
        let exact = body.power.expect("a power");
        assert!(
            (power[i] / exact - 1.0).abs() < 5e-3,
            "{} and {exact}",
            power[i]
        );
    }
    assert_eq!(solved.report.bodies[0].power_error_estimate, None);
    assert!(solved.report.bodies[1].power_error_estimate.is_some());
}

#[test]
fn bodies_that_touch_are_named() {
    let two = |center: &str, shape: &str| {
        format!(
            "[shapes.ball]\nkind = 'sphere'\nradius = 1\n[shapes.small]\nkind = 'sphere'\nradius = 0.2\n\
             [[bodies]]\nshape = 'ball'\n[[bodies]]\nshape = '{shape}'\ncenter = {center}\nvelocity = [0, 0, 1]\n"
        )
    };
    for (name, center, shape, words) in [
        (
            "overlap",
            "[1.5, 0, 0]",
            "ball",
            "body 1 (`ball`) and body 2 (`ball`) overlap by",
        ),
        (
            "touch",
            "[2, 0, 0]",
            "ball",
            "body 1 (`ball`) and body 2 (`ball`) touch",
        ),
        (
            "inside",
            "[0.1, 0, 0]",
            "small",
            "body 2 (`small`) is inside body 1 (`ball`)",
        ),
    ] {
        let line = refused(name, &two(center, shape));
        assert!(
            line.starts_with("case.toml:9:") && line.contains(words),
            "{line}"
        );
        assert!(line.contains("expected bodies that are apart"), "{line}");
    }
    let apart = two("[3, 0, 0]", "ball");
    let line = refused(
        "probe",
        &format!("{apart}[probes]\npoints = [[3.5, 0, 0]]\n"),
    );
    assert!(
        line.contains("case.toml:14:") && line.contains("inside body 2 (`ball`)"),
        "{line}"
    );
    let stokeslet = "[probes]\npoints = [[0, 0, 4]]\n[test]\nstokeslets = [{ at = [1.5, 0, 0], force = [1, 0, 0] }]\n";
    let line = refused("stokeslet", &format!("{apart}{stokeslet}"));
    assert!(line.contains("outside all bodies"), "{line}");
    let line = refused("memory", &format!("{apart}[solver]\nmemory = 1e-6\n"));
    assert!(
        line.contains("GiB") && line.contains("solver.memory"),
        "{line}"
    );
    let line = refused("scale", &apart.replace("velocity", "scale = 0\nvelocity"));
    assert!(
        line.contains("scale = 0") && line.contains("greater than zero"),
        "{line}"
    );
}

#[test]
fn an_iteration_that_does_not_converge_fails_with_its_numbers() {
    let text = format!("{}[solver]\nmax_iterations = 2\n", text("two-spheres.toml"));
    let output = run(&folder("iterations"), &text, &["--json"]);
    let line = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{line}");
    assert!(output.stdout.is_empty());
    assert!(
        line.contains("after 2 iterations") && line.contains("residual"),
        "{line}"
    );
}

#[test]
fn methods_and_resolutions_by_hand_agree() {
    let by_hand = "panels = 8\norder = 16\nmodes = 4";
    let gmres = report(&text("two-spheres.toml").replace("tolerance = 1e-8", by_hand));
    let text = text("two-spheres.toml").replace("tolerance = 1e-8", by_hand);
    let bicgstab = report(&format!(
        "{text}[solver]\nmethod = 'bicgstab'\ntolerance = 1e-11\n"
    ));
    for (a, b) in gmres.bodies.iter().zip(&bicgstab.bodies) {
        assert!((a.force[2] - b.force[2]).abs() < 1e-8 * b.force[2].abs());
    }
    let [entry] = &gmres.discretization[..] else {
        panic!("one shape at one resolution");
    };
    assert_eq!(
        (entry.panels, entry.order, entry.modes, entry.bodies),
        (8, 16, 4, Some(2))
    );
}

#[test]
fn many_bodies_are_summed_up_unless_all_are_wanted() {
    let mut text =
        "[shapes.ball]\nkind = 'sphere'\nradius = 0.5\n[accuracy]\ntolerance = 1e-3\n".to_owned();
    for k in 0..21 {
        let [x, y] = [k % 5, k / 5].map(|i| 2.0 * f64::from(i));
        text +=
            &format!("[[bodies]]\nshape = 'ball'\ncenter = [{x}, {y}, 0]\nforce = [0, 0, -1]\n");
    }
    let folder = folder("summary");
    let output = run(&folder, &text, &[]);
    let short = String::from_utf8(output.stdout).expect("text");
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(short.contains("21 bodies (--all shows each") && !short.contains("stresslet x"));
    let output = run(&folder, &text, &["--all", "--picture", "flow.svg"]);
    let long = String::from_utf8(output.stdout).expect("text");
    assert_eq!(long.matches("stresslet x").count(), 21);
    assert!(
        fs::read_to_string(folder.join("flow.svg"))
            .expect("a picture")
            .contains("<svg")
    );
    assert_eq!(fs::read_dir(&folder).expect("the folder").count(), 2);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_with_130_and_writes_nothing() {
    let folder = folder("interrupt");
    let text = text("eight-sinking.toml").replace("tolerance = 1e-6", "tolerance = 1e-9");
    fs::write(
        folder.join("case.toml"),
        format!("{text}[output]\nvtk = true\n"),
    )
    .expect("a case");
    let child = Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(["solve", "case.toml", "--picture", "flow.svg"])
        .current_dir(&folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    std::thread::sleep(std::time::Duration::from_secs(1));
    let sent = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(sent.is_ok_and(|status| status.success()));
    let output = child.wait_with_output().expect("it ends");
    let line = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{line}");
    assert!(
        output.stdout.is_empty() && line.contains("interrupted"),
        "{line}"
    );
    assert_eq!(fs::read_dir(&folder).expect("the folder").count(), 1);
}
