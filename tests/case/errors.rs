//! Bad input of every kind: exit status 2 within a second, one clear line on stderr, nothing
//! written.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

const SPHERE: &str = "\
[shapes.ball]
kind = \"sphere\"
radius = 1.0

[[bodies]]
shape = \"ball\"
center = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
velocity = [0.0, 0.0, 1.0]

[accuracy]
tolerance = 1e-8

[probes]
points = [[0.0, 0.0, 2.0]]
";

/// Two folders of one test: where the case lies, and where the program runs, which must stay empty.
struct Folders {
    case: PathBuf,
    run: PathBuf,
}

impl Folders {
    fn new(name: &str) -> Self {
        let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("case-errors-{name}"));
        let _ = fs::remove_dir_all(&root);
        let folders = Self {
            case: root.join("case"),
            run: root.join("run"),
        };
        fs::create_dir_all(&folders.case).unwrap();
        fs::create_dir_all(&folders.run).unwrap();
        folders
    }

    fn write(&self, text: impl AsRef<[u8]>) -> PathBuf {
        let path = self.case.join("case.toml");
        fs::write(&path, text).unwrap();
        path
    }
}

fn solve(folders: &Folders, path: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(["solve", "--json"])
        .arg(path)
        .current_dir(&folders.run)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

/// Runs the program on `path` and checks everything a refusal must be; `words` must occur in its
/// one line.
#[track_caller]
fn assert_refused_file(folders: &Folders, path: &Path, words: &[&str]) {
    let before = fs::read_dir(&folders.case).unwrap().count();
    let start = Instant::now();
    let output = solve(folders, path);
    let elapsed = start.elapsed();
    let line = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{line}");
    assert!(elapsed < Duration::from_secs(1), "{elapsed:?}: {line}");
    assert!(output.stdout.is_empty(), "stdout is not empty: {line}");
    assert_eq!(line.lines().count(), 1, "not one line: {line:?}");
    assert!(line.ends_with('\n') && line.len() < 600, "{line:?}");
    for word in words {
        assert!(line.contains(word), "no {word:?} in {line:?}");
    }
    assert_eq!(fs::read_dir(&folders.run).unwrap().count(), 0);
    assert_eq!(fs::read_dir(&folders.case).unwrap().count(), before);
}

#[track_caller]
fn assert_refused(name: &str, text: impl AsRef<[u8]>, words: &[&str]) {
    let folders = Folders::new(name);
    let path = folders.write(text);
    assert_refused_file(&folders, &path, words);
}

/// Refusals of the sphere's case with one piece of its text replaced.
#[track_caller]
fn assert_all_refused(name: &str, changes: &[(&str, &str, &[&str])]) {
    let folders = Folders::new(name);
    for (old, new, words) in changes {
        assert!(SPHERE.contains(old), "{old}");
        let path = folders.write(SPHERE.replacen(old, new, 1));
        assert_refused_file(&folders, &path, words);
    }
}

/// They would act on the terminal, or end a path.
#[test]
fn control_characters() {
    let changes: &[(&str, &str, &[&str])] = &[
        (
            "[shapes.ball]",
            "[shapes.\"a\\u001b[31m\"]",
            &["case.toml:1:", "a\\u{1b}[31m", "control characters"],
        ),
        (
            "[accuracy]",
            "[output]\ndirectory = \"a\\u0000b\"\n[accuracy]",
            &["case.toml:12:", "output.directory", "control characters"],
        ),
    ];
    assert_all_refused("control", changes);
}

#[test]
fn unknown_keys() {
    let changes: &[(&str, &str, &[&str])] = &[
        (
            "radius = 1.0",
            "radius = 1.0\nradios = 1.0",
            &["case.toml:4:", "shapes.ball.radios", "`radius`"],
        ),
        (
            "center =",
            "centre =",
            &["case.toml:7:", "body 1: unknown key centre", "`center`"],
        ),
        ("[probes]", "[probe]", &["case.toml:14:", "`probes`"]),
        (
            "[[bodies]]",
            "[[body]]",
            &["case.toml:5:", "unknown key body", "did you mean `bodies`"],
        ),
        (
            "[shapes.ball]",
            "[shape.ball]",
            &["case.toml:1:", "did you mean `shapes`"],
        ),
        (
            "kind =",
            "kinds =",
            &["case.toml:2:", "unknown key shapes.ball.kinds", "`kind`"],
        ),
        (
            "velocity =",
            "velocities =",
            &[
                "case.toml:9:",
                "body 1: unknown key velocities",
                "`velocity`",
            ],
        ),
        (
            "tolerance = 1e-8",
            "tolerance = 1e-8\ncolour = 3",
            &["case.toml:13:", "accuracy.colour", "known: tolerance"],
        ),
        (
            "[shapes.ball]",
            "mu = 2\n[shapes.ball]",
            &["case.toml:1:", "mu", "`viscosity`"],
        ),
        (
            "radius =",
            "diameter =",
            &["unknown key shapes.ball.diameter, did you mean `radius`?"],
        ),
        ("\"sphere\"", "\"ellipsoid\"", &["did you mean `spheroid`?"]),
        ("center =", "position =", &["did you mean `center`?"]),
        (
            "[probes]",
            "[wall]\nz = 0\n[probes]",
            &["unknown key wall: walls are not supported"],
        ),
    ];
    assert_all_refused("unknown", changes);
}

#[test]
fn wrong_types() {
    let changes: &[(&str, &str, &[&str])] = &[
        (
            "radius = 1.0",
            "radius = \"one\"",
            &["case.toml:3:", "radius", "\"one\"", "number"],
        ),
        (
            "radius = 1.0",
            "radius = [1.0]",
            &["case.toml:3:", "[1.0]", "number"],
        ),
        (
            "radius = 1.0",
            "radius = true",
            &["case.toml:3:", "true", "number"],
        ),
        (
            "radius = 1.0",
            "radius = 1979-05-27",
            &["case.toml:3:", "1979", "number"],
        ),
        (
            "[0.0, 0.0, 1.0]",
            "[0.0, 1.0]",
            &["case.toml:8:", "axis", "three"],
        ),
        (
            "center = [0.0, 0.0, 0.0]",
            "center = 0.0",
            &["case.toml:7:", "three"],
        ),
        (
            "kind = \"sphere\"",
            "kind = 3",
            &["case.toml:2:", "kind", "sphere"],
        ),
        (
            "[[bodies]]",
            "[bodies]",
            &["case.toml:5:", "bodies", "[[bodies]]"],
        ),
        (
            "[accuracy]",
            "[[accuracy]]",
            &["case.toml:11:", "[accuracy]"],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "slip = 3",
            &["case.toml:9: body 1: slip = 3: expected a table"],
        ),
        (
            "[[0.0, 0.0, 2.0]]",
            "[0.0, 0.0, 2.0]",
            &["case.toml:15:", "points[0]", "three"],
        ),
    ];
    assert_all_refused("types", changes);
}

#[test]
fn numbers_out_of_range() {
    let changes: &[(&str, &str, &[&str])] = &[
        (
            "radius = 1.0",
            "radius = nan",
            &["case.toml:3:", "radius", "nan", "finite"],
        ),
        (
            "radius = 1.0",
            "radius = NaN",
            &["case.toml:3:", "radius = NaN", "finite"],
        ),
        (
            "radius = 1.0",
            "radius = -inf",
            &["case.toml:3:", "-inf", "finite"],
        ),
        (
            "radius = 1.0",
            "radius = 1e999",
            &["case.toml:3:", "1e999", "finite"],
        ),
        (
            "radius = 1.0",
            "radius = -1.0",
            &["case.toml:3:", "-1.0", "greater than zero"],
        ),
        (
            "radius = 1.0",
            "radius = 0",
            &["case.toml:3:", "greater than zero"],
        ),
        (
            "axis = [0.0, 0.0, 1.0]",
            "axis = [0, 0, 0]",
            &["case.toml:8:", "axis", "zero"],
        ),
        (
            "axis = [0.0, 0.0, 1.0]",
            "orientation = [0, 0, 0, 0.0]",
            &["case.toml:8:", "orientation", "any length but zero"],
        ),
        (
            "axis = [0.0, 0.0, 1.0]",
            "orientation = [1, nan, 0, 0]",
            &["case.toml:8:", "orientation", "nan", "four finite numbers"],
        ),
        (
            "axis = [0.0, 0.0, 1.0]",
            "orientation = [0, 0, 1]",
            &["case.toml:8:", "four finite numbers", "[w, x, y, z]"],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "velocity = [0, inf, 0]",
            &["case.toml:9:", "velocity"],
        ),
        (
            "[[0.0, 0.0, 2.0]]",
            "[[nan, 0.0, 2.0]]",
            &["case.toml:15:", "points[0]", "nan"],
        ),
        (
            "[shapes.ball]",
            "viscosity = 0.0\n[shapes.ball]",
            &["case.toml:1:", "viscosity"],
        ),
        (
            "kind = \"sphere\"\nradius = 1.0",
            "kind = \"torus\"\nmajor = 1.0\nminor = 1.0",
            &["case.toml:4:", "minor", "less than major"],
        ),
        (
            "kind = \"sphere\"\nradius = 1.0",
            "kind = \"polar\"\ncoefficients = []",
            &["case.toml:3:", "coefficients", "at least one"],
        ),
    ];
    assert_all_refused("range", changes);
}

#[test]
fn accuracy_that_cannot_be_had() {
    let changes: &[(&str, &str, &[&str])] = &[
        ("1e-8", "1e-15", &["case.toml:12:", "tolerance", "1e-14"]),
        ("1e-8", "0", &["case.toml:12:", "1e-14"]),
        ("1e-8", "1.0", &["case.toml:12:", "less than 1"]),
        (
            "tolerance = 1e-8",
            "",
            &["case.toml:11:", "accuracy", "tolerance"],
        ),
        (
            "tolerance = 1e-8",
            "tolerance = 1e-8\npanels = 8",
            &["case.toml:11:", "accuracy.order", "missing", "all three"],
        ),
        (
            "tolerance = 1e-8",
            "tolerance = 1e-15\npanels = 8\norder = 16\nmodes = 4",
            &["case.toml:12:", "tolerance", "1e-14"],
        ),
        (
            "tolerance = 1e-8",
            "panels = 8\norder = 16",
            &["case.toml:11:", "accuracy.modes", "missing"],
        ),
        (
            "tolerance = 1e-8",
            "panels = 8\norder = 12\nmodes = 4",
            &["case.toml:13:", "10 or 16"],
        ),
        (
            "tolerance = 1e-8",
            "panels = 1000000000\norder = 16\nmodes = 4",
            &["case.toml:12:", "panels", "1000"],
        ),
        (
            "tolerance = 1e-8",
            "panels = 8\norder = 16\nmodes = 1_000_000_000",
            &["case.toml:14:", "modes", "1000"],
        ),
        (
            "tolerance = 1e-8",
            "panels = 8\norder = 16\nmodes = -1",
            &["case.toml:14:", "modes"],
        ),
        (
            "tolerance = 1e-8",
            "panels = 8.0\norder = 16\nmodes = 4",
            &["case.toml:12:", "integer"],
        ),
        (
            "tolerance = 1e-8",
            "panels = 1000\norder = 16\nmodes = 1000",
            &["case.toml:12:", "GiB of memory"],
        ),
    ];
    assert_all_refused("accuracy", changes);
}

#[test]
fn bodies_and_shapes_that_do_not_fit() {
    let changes: &[(&str, &str, &[&str])] = &[
        (
            "shape = \"ball\"",
            "shape = \"bal\"",
            &["case.toml:6:", "`ball`"],
        ),
        (
            "kind = \"sphere\"",
            "kind = \"spere\"",
            &["case.toml:2:", "`sphere`"],
        ),
        (
            "radius = 1.0",
            "",
            &["case.toml:1:", "shapes.ball.radius", "missing"],
        ),
        (
            "shape = \"ball\"",
            "",
            &["case.toml:5:", "shape", "missing"],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "velocity = [0.0, 0.0, 1.0]\nforce = [0, 0, 0]",
            &["case.toml:10:", "both", "velocity", "force", "\"free\""],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "torque = [0, 0, 0]\nangular_velocity = [0, 0, 1]",
            &["case.toml:10:", "both", "angular_velocity", "torque"],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "force = [0, 1, 0]\nvelocity = [0, 0, \"free\"]",
            &[
                "case.toml:9:",
                "body 1: force = [0, 1, 0]",
                "zero as its y component",
                "velocity imposes",
            ],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "torque = [0, 0, 2]\nangular_velocity = [\"free\", 0, 0]",
            &["case.toml:9:", "torque", "zero as its z component"],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "velocity = [0, 0, \"fre\"]",
            &["case.toml:9:", "velocity", "or \"free\""],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "velocity = \"free\"",
            &["case.toml:9:", "velocity", "[x, y, z]"],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "force = [0, 0, \"free\"]",
            &["case.toml:9:", "force", "three finite numbers"],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "orientation = [1, 0, 0, 0]",
            &["case.toml:9:", "body 1: both axis and orientation"],
        ),
        (
            "kind = \"sphere\"\nradius = 1.0",
            "kind = \"profile\"\nfile = \"none.csv\"",
            &["case.toml:3:", "none.csv", "no such file"],
        ),
        (
            "kind = \"sphere\"\nradius = 1.0",
            "kind = \"profile\"\nfile = \"/dev/zero\"",
            &["case.toml:3:", "/dev/zero", "not a regular file"],
        ),
        (
            "[probes]\npoints = [[0.0, 0.0, 2.0]]",
            "[test]\nstokeslets = [{ at = [0, 0, 0], force = [0, 0, 1] }]",
            &["case.toml:14:", "[probes]"],
        ),
        (
            "[probes]",
            "[test]\nstokeslets = []\n[probes]",
            &["case.toml:15:", "at least one"],
        ),
    ];
    assert_all_refused("bodies", changes);
}

#[test]
fn planes_and_output() {
    let plane = |line: &'static str| format!("[plane]\n{line}\n[probes]");
    let lines: &[(&str, &[&str])] = &[
        ("centre = [0, 0, 0]", &["plane.centre", "`center`"]),
        ("center = [0, 0]", &["plane.center", "three finite numbers"]),
        (
            "normal = [0, 0, 0]",
            &["plane.normal", "any length but zero"],
        ),
        (
            "across = [1, 0, 0]",
            &["plane.up is missing", "or normal alone"],
        ),
        ("up = [1, 0, 0]", &["plane.across is missing"]),
        (
            "up = [1, 0, 0]\nacross = [1, 1, 0]",
            &["plane.up", "orthogonal to each other"],
        ),
        (
            "up = [1, 0, 0]\nnormal = [0, 1, 0]",
            &["case.toml:16:", "both plane.normal and plane.up"],
        ),
        ("size = 0", &["plane.size", "greater than zero"]),
        ("size = [1, -1]", &["plane.size[1]", "greater than zero"]),
        ("size = [1, 2, 3]", &["plane.size", "[width, height]"]),
        ("size = [1, 21]", &["plane.size", "factor of at most 20"]),
        ("size = \"wide\"", &["plane.size", "a length"]),
        ("points = 1", &["plane.points", "from 2 to 1001"]),
        (
            "points = [100, 1002]",
            &["plane.points[1]", "from 2 to 1001"],
        ),
        ("points = 10.5", &["plane.points", "integer"]),
        ("frame = \"boddy\"", &["plane.frame", "`body`"]),
    ];
    let texts: Vec<String> = lines.iter().map(|(line, _)| plane(line)).collect();
    let changes: Vec<(&str, &str, &[&str])> = texts
        .iter()
        .zip(lines)
        .map(|(text, (_, words))| ("[probes]", text.as_str(), *words))
        .collect();
    assert_all_refused("planes", &changes);
    let changes: &[(&str, &str, &[&str])] = &[
        (
            "[probes]",
            "[output]\nvtk = 1\n[probes]",
            &["case.toml:15:", "output.vtk", "true or false"],
        ),
        (
            "[probes]",
            "[output]\ndirectory = \"case.toml\"\nvtk = true\n[probes]",
            &["case.toml:14:", "output.directory", "not a folder"],
        ),
        // nothing is written, not even a folder, if the case has no answer
        (
            "[probes]\npoints = [[0.0, 0.0, 2.0]]",
            "[output]\ndirectory = \"out\"\nvtk = true\n[probes]\npoints = [[0.0, 0.0, 0.5]]",
            &["inside the body"],
        ),
    ];
    assert_all_refused("output", changes);
}

#[test]
fn what_is_not_built_is_refused_by_name() {
    let changes: &[(&str, &str, &[&str])] = &[
        (
            "[probes]",
            "[time]\nend = 1\nstep = 0.1\n[probes]",
            &["case.toml:14:", "not supported yet: [time]"],
        ),
        (
            "[probes]",
            "[background]\nkind = \"shear\"\nrate = 1\n[test]\nstokeslets = [{ at = [0, 0, 0], force = [0, 0, 1] }]\n[probes]",
            &[
                "case.toml:14:",
                "not supported yet: [background] beside [test]",
            ],
        ),
        (
            "velocity = [0.0, 0.0, 1.0]",
            "force = [0, 0, 1]\n[solver]\nformulation = \"single-layer\"",
            &[
                "case.toml:9:",
                "not supported yet: the single-layer formulation of a free body",
            ],
        ),
        // an error inside a section that is not built comes first
        (
            "[probes]",
            "[time]\nend = 1\nstap = 0.1\n[probes]",
            &["case.toml:16:", "time.stap", "`step`"],
        ),
        (
            "[probes]",
            "[background]\nkind = \"sheer\"\n[probes]",
            &["case.toml:15:", "`shear`"],
        ),
    ];
    assert_all_refused("unsupported", changes);
}

#[test]
fn text_that_is_no_case() {
    assert_refused("empty", "", &["case.toml:", "empty"]);
    assert_refused("comment", "# nothing\n\n", &["empty"]);
    assert_refused(
        "no-bodies",
        "[shapes.a]\nkind = \"sphere\"\nradius = 1",
        &["[[bodies]]"],
    );
    assert_refused(
        "zero-bodies",
        "bodies = []\n[shapes]",
        &["case.toml:1:", "no bodies"],
    );
    assert_refused(
        "number-for-body",
        "bodies = [3]\nshapes.a = { kind = \"sphere\", radius = 1 }",
        &["case.toml:1: body 1: 3: expected a table, [[bodies]]"],
    );
    assert_refused("no-shapes", "[[bodies]]\nshape = \"a\"", &["[shapes"]);
    assert_refused(
        "syntax",
        "[shapes.ball\nkind = 3",
        &["case.toml:1:", "TOML"],
    );
    assert_refused(
        "duplicate",
        "viscosity = 1\nviscosity = 2",
        &["case.toml:2:", "duplicate", "viscosity"],
    );
    assert_refused(
        "binary",
        [b'a', b'\n', 0xff, 0xfe],
        &["case.toml:2:", "UTF-8"],
    );
    assert_refused("zeros", vec![0; 100_000], &["case.toml:1:", "TOML"]);
    assert_refused("control", "a\u{1b}[31m\r = 1", &["case.toml:1:"]);
}

#[test]
fn deep_or_long_input() {
    assert_refused(
        "deep-array",
        format!("a = {}", "[".repeat(100_000)),
        &["case.toml:1:"],
    );
    assert_refused("deep-inline", "a = {a ".repeat(50_000), &["case.toml:1:"]);
    assert_refused(
        "deep-dots",
        format!("{}a = 1", "a.".repeat(100_000)),
        &["case.toml:1:"],
    );
    assert_refused(
        "deep-table",
        format!("[{}a]", "a.".repeat(100_000)),
        &["case.toml:1:"],
    );
    assert_refused(
        "long-key",
        format!("{} = 1", "k".repeat(1_000_000)),
        &["case.toml:1:", "unknown"],
    );
    assert_refused(
        "many-keys",
        (0..20_000)
            .map(|i| format!("k{i} = 1\n"))
            .collect::<String>(),
        &["k0"],
    );
}

#[test]
fn files_that_are_no_text() {
    let folders = Folders::new("files");
    let missing = folders.case.join("missing.toml");
    assert_refused_file(&folders, &missing, &["missing.toml:", "no such file"]);
    assert_refused_file(&folders, &folders.case, &["directory"]);

    let garbage = folders.case.join("garbage.toml");
    File::create(&garbage).unwrap().set_len(1 << 30).unwrap();
    assert_refused_file(&folders, &garbage, &["garbage.toml:", "too large", "4 MiB"]);
}

#[cfg(unix)]
#[test]
fn devices_and_pipes() {
    let folders = Folders::new("devices");
    assert_refused_file(&folders, Path::new("/dev/zero"), &["not a regular file"]);
    assert_refused_file(&folders, Path::new("/dev/null"), &["not a regular file"]);
    let pipe = folders.case.join("pipe.toml");
    let made = Command::new("mkfifo").arg(&pipe).status();
    if made.is_ok_and(|status| status.success()) {
        assert_refused_file(&folders, &pipe, &["not a regular file"]);
    }
}

/// What the program says of a case on its standard input, with `folder` as the current one.
fn solve_stdin(folder: &Path, text: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(["solve", "--json", "-"])
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // the program may refuse the text before it has read all of it
    let _ = child.stdin.take().unwrap().write_all(text);
    child.wait_with_output().unwrap()
}

#[test]
fn a_case_from_standard_input() {
    let folders = Folders::new("stdin");
    let output = solve_stdin(&folders.run, SPHERE.as_bytes());
    assert!(output.status.success(), "{output:?}");
    assert!(output.stdout.starts_with(b"{"));

    fs::write(
        folders.run.join("curve.csv"),
        "0,1\n0.7,0.7\n1,0\n0.7,-0.7\n0,-1\n",
    )
    .unwrap();
    let profile =
        "kind = \"profile\"\nfile = \"curve.csv\"\n[[bodies]]\nshape = \"ball\"\nsize = 1";
    let large = vec![b'#'; (4 << 20) + 1];
    let wrong = [
        (
            format!("[shapes.ball]\n{profile}").into_bytes(),
            "stdin:6: body 1: unknown key size, did you mean `scale`",
        ),
        (
            SPHERE.replace("1e-8", "2").into_bytes(),
            "stdin:12: accuracy.tolerance",
        ),
        (b"a\n\xff".to_vec(), "stdin:2: not UTF-8"),
        (Vec::new(), "stdin: the file is empty"),
        (large, "stdin: too large, expected at most 4 MiB"),
    ];
    for (text, message) in wrong {
        let output = solve_stdin(&folders.run, &text);
        let line = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}");
        assert!(
            line.starts_with(message) && line.lines().count() == 1,
            "{line}"
        );
    }
}

#[test]
fn arguments_that_make_no_sense() {
    let folders = Folders::new("arguments");
    for arguments in [
        &["solve"][..],
        &["slove", "case.toml"],
        &["solve", "case.toml", "--jsn"],
        &["solve", "case.toml", "--csv"],
        &["--threads", "many", "solve", "case.toml"],
        &["--threads", "1000000000", "solve", "case.toml"],
        &["simulate", "case.toml", "--resume"],
        &[],
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_axistokes"))
            .args(arguments)
            .current_dir(&folders.run)
            .output()
            .unwrap();
        let line = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {line}");
        assert_eq!(line.lines().count(), 1, "{arguments:?}: {line}");
        assert!(output.stdout.is_empty() && !line.contains("to pass"));
    }
    let output = Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .arg("case.toml")
        .output()
        .unwrap();
    let line = String::from_utf8_lossy(&output.stderr);
    assert!(
        line.contains("expected axistokes solve case.toml"),
        "{line}"
    );
}

#[test]
fn a_closed_pipe_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .arg("--help")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success());
    assert!(output.stderr.is_empty());
}

#[test]
fn help_and_version() {
    for (arguments, word) in [
        (&["--help"][..], "Examples:"),
        (&["--version"], env!("CARGO_PKG_VERSION")),
        (&["solve", "--help"], "[shapes.ball]"),
        (&["converge", "--help"], "--quick"),
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_axistokes"))
            .args(arguments)
            .output()
            .unwrap();
        assert!(output.status.success());
        let text = String::from_utf8_lossy(&output.stdout);
        assert!(text.contains(word), "{text}");
        assert!(output.stderr.is_empty());
    }
}
