//! VTK files, read back: closed meshes, areas, volumes, forces, and the flow in a plane.

use std::collections::HashMap;
use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use axistokes::case::Case;
use axistokes::nalgebra::{Point3, Vector3};
use axistokes::output::vtk::Mesh as Surface;
use axistokes::progress::Silent;
use axistokes::solve::{Solved, solve};
use vtkio::Vtk;
use vtkio::model::{Attribute, Attributes, DataSet, IOBuffer, Piece, VertexNumbers};

const SPHERE: &str = "kind = 'sphere'\nradius = 1.0";
const SPHEROID: &str = "kind = 'spheroid'\npolar = 1.0\nequatorial = 0.5";
const TORUS: &str = "kind = 'torus'\nmajor = 1.0\nminor = 0.4";

/// A case of one tilted body that moves and turns in a fluid of viscosity 2.
fn case(shape: &str, rest: &str) -> String {
    format!(
        "viscosity = 2.0\n[shapes.body]\n{shape}\n[[bodies]]\nshape = 'body'\ncenter = [0.3, -0.2, 0.5]\naxis = [1, 2, 2]\n\
         velocity = [1, 0, -0.5]\nangular_velocity = [0.2, 0.3, 0.1]\n{rest}"
    )
}

fn solved(shape: &str, panels: usize) -> Solved {
    let accuracy = format!("[accuracy]\npanels = {panels}\norder = 10\nmodes = 1");
    let case = Case::parse(&case(shape, &accuracy), "body.toml").expect("a case");
    solve(&case, &Silent).expect("an answer")
}

/// A mesh as read from a file.
struct Mesh {
    points: Vec<Vector3<f64>>,
    cells: Vec<Vec<usize>>,
    data: HashMap<String, Vec<f64>>,
}

fn doubles(buffer: &IOBuffer) -> Vec<f64> {
    assert!(matches!(buffer, IOBuffer::F64(_)), "doubles");
    buffer.cast_into().expect("numbers")
}

fn triples(numbers: &[f64]) -> Vec<Vector3<f64>> {
    let (triples, rest) = numbers.as_chunks::<3>();
    assert!(rest.is_empty());
    triples.iter().map(|v| Vector3::from(*v)).collect()
}

fn point_data(data: &Attributes) -> HashMap<String, Vec<f64>> {
    let arrays = data.point.iter().map(|attribute| match attribute {
        Attribute::DataArray(array) => {
            (array.name.clone(), array.data.cast_into().expect("numbers"))
        }
        Attribute::Field { .. } => panic!("a field"),
    });
    arrays.collect()
}

fn read_surface(bytes: &[u8]) -> Mesh {
    let DataSet::UnstructuredGrid { pieces, .. } = Vtk::parse_xml(bytes).expect("VTK").data else {
        panic!("no unstructured grid");
    };
    let [Piece::Inline(piece)] = &pieces[..] else {
        panic!("not one piece");
    };
    let VertexNumbers::XML {
        connectivity,
        offsets,
    } = &piece.cells.cell_verts
    else {
        panic!("not XML");
    };
    let mut start = 0;
    let cells: Vec<Vec<usize>> = offsets
        .iter()
        .map(|&end| {
            let cell = connectivity[start..end as usize].iter();
            start = end as usize;
            cell.map(|&vertex| vertex as usize).collect()
        })
        .collect();
    assert_eq!(cells.len(), piece.cells.types.len());
    Mesh {
        points: triples(&doubles(&piece.points)),
        cells,
        data: point_data(&piece.data),
    }
}

fn mesh(solved: &Solved, azimuths: usize) -> Mesh {
    let surface = Surface::of(&solved.answer, |_| azimuths, &Silent).expect("a surface");
    read_surface(&surface.file().expect("a file"))
}

impl Mesh {
    fn vectors(&self, name: &str) -> Vec<Vector3<f64>> {
        let vectors = triples(&self.data[name]);
        assert_eq!(vectors.len(), self.points.len(), "{name}");
        vectors
    }

    /// Vertices less edges plus faces, after a check that every edge has two faces, in opposite
    /// directions.
    fn euler_characteristic(&self) -> i64 {
        let mut edges: HashMap<(usize, usize), i32> = HashMap::new();
        for cell in &self.cells {
            for (&a, &b) in cell.iter().zip(cell.iter().cycle().skip(1)) {
                let count = edges.entry((a, b)).or_default();
                *count += 1;
                assert_eq!(*count, 1, "an edge twice in one direction");
            }
        }
        assert!(
            edges.keys().all(|&(a, b)| edges.contains_key(&(b, a))),
            "not closed"
        );
        let count = |n: usize| n as i64;
        count(self.points.len()) - count(edges.len() / 2) + count(self.cells.len())
    }

    /// Triangles of all cells.
    fn triangles(&self) -> impl Iterator<Item = [usize; 3]> {
        self.cells
            .iter()
            .flat_map(|cell| (2..cell.len()).map(move |k| [cell[0], cell[k - 1], cell[k]]))
    }

    fn area_vector(&self, [a, b, c]: [usize; 3]) -> Vector3<f64> {
        0.5 * (self.points[b] - self.points[a]).cross(&(self.points[c] - self.points[a]))
    }

    fn area(&self) -> f64 {
        self.triangles().map(|t| self.area_vector(t).norm()).sum()
    }

    fn volume(&self) -> f64 {
        let cone = |t: [usize; 3]| self.area_vector(t).dot(&self.points[t[0]]) / 3.0;
        self.triangles().map(cone).sum()
    }

    /// The integral of the traction: force of the fluid on the body.
    fn force(&self) -> Vector3<f64> {
        let traction = self.vectors("traction");
        let on = |t: [usize; 3]| {
            self.area_vector(t).norm() / 3.0 * t.iter().map(|&v| traction[v]).sum::<Vector3<f64>>()
        };
        self.triangles().map(on).sum()
    }
}

#[test]
fn surfaces_are_closed_and_converge_at_second_order() {
    // The spheroid's area: 2 pi a^2 (1 + c / (a e) arcsin e), e^2 = 1 - a^2 / c^2.
    let e = 0.75f64.sqrt();
    let area = 2.0 * PI * 0.25 * (1.0 + 2.0 / e * e.asin());
    for (shape, euler, area, volume) in [
        (SPHERE, 2, 4.0 * PI, 4.0 * PI / 3.0),
        (SPHEROID, 2, area, PI / 3.0),
        (TORUS, 0, 4.0 * PI * PI * 0.4, 2.0 * PI * PI * 0.16),
    ] {
        let mut last: Option<[f64; 3]> = None;
        for level in [1, 2, 4] {
            let solved = solved(shape, 4 * level);
            let mesh = mesh(&solved, 32 * level);
            assert_eq!(mesh.euler_characteristic(), euler);
            let poles = usize::from(euler == 2) * 2;
            assert_eq!(mesh.points.len(), 40 * level * 32 * level + poles);
            let force = Vector3::from(solved.report.bodies[0].force);
            let errors = [
                1.0 - mesh.area() / area,
                1.0 - mesh.volume() / volume,
                (mesh.force() + force).norm() / force.norm(),
            ];
            assert!(errors.iter().all(|&e| e > 0.0 && e < 2e-2), "{errors:?}");
            for (coarse, fine) in last.into_iter().flatten().zip(errors) {
                let ratio = coarse / fine;
                assert!(
                    (3.6..4.4).contains(&ratio),
                    "{shape}: {coarse:e} / {fine:e} = {ratio}"
                );
            }
            last = Some(errors);
        }
    }
}

#[test]
fn sums_by_weights_are_areas_and_forces_to_the_estimate() {
    let e = 0.75f64.sqrt();
    let spheroid = 2.0 * PI * 0.25 * (1.0 + 2.0 / e * e.asin());
    for (shape, area) in [
        (SPHERE, 4.0 * PI),
        (SPHEROID, spheroid),
        (TORUS, 4.0 * PI * PI * 0.4),
    ] {
        let scaled = case(shape, "scale = 1.5\n[accuracy]\ntolerance = 1e-9");
        let case = Case::parse(&scaled, "body.toml").expect("a case");
        let solved = solve(&case, &Silent).expect("an answer");
        let mesh = mesh(&solved, 64);
        let weights = &mesh.data["weight"];
        let sum: f64 = weights.iter().sum();
        assert!((sum / (2.25 * area) - 1.0).abs() < 1e-9, "{shape}: {sum}");
        let traction = mesh.vectors("traction");
        let force: Vector3<f64> = traction.iter().zip(weights).map(|(t, w)| *w * t).sum();
        let known = Vector3::from(solved.report.bodies[0].force);
        let off = (force + known).norm() / known.norm();
        assert!(off < 1e-8, "{shape}: {off:e}");
    }
}

#[test]
fn field_data_say_what_belongs_to_bodies() {
    let solved = solved(SPHEROID, 4);
    let surface = Surface::of(&solved.answer, |_| 16, &Silent).expect("a surface");
    let file = String::from_utf8(surface.file().expect("a file")).expect("text");
    let document = roxmltree::Document::parse(&file).expect("XML");
    let fields = document
        .descendants()
        .find(|node| node.has_tag_name("FieldData"));
    let fields = fields.expect("field data");
    let numbers = |name: &str| -> Vec<f64> {
        let array = fields
            .children()
            .find(|a| a.attribute("Name") == Some(name));
        let text = array
            .and_then(|a| a.text())
            .unwrap_or_else(|| panic!("no {name}"));
        text.split_whitespace()
            .map(|word| word.parse().expect("a number"))
            .collect()
    };
    assert_eq!(numbers("viscosity"), [2.0]);
    assert_eq!(numbers("estimated_error"), [solved.answer.error_estimate]);
    assert_eq!(numbers("center"), [0.3, -0.2, 0.5]);
    let axis = Vector3::from_vec(numbers("axis"));
    assert!((axis - Vector3::new(1.0, 2.0, 2.0) / 3.0).norm() < 1e-15);
    let q = numbers("orientation_wxyz");
    let q = axistokes::nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]);
    let turned = axistokes::nalgebra::UnitQuaternion::new_unchecked(q) * Vector3::z();
    assert!((turned - axis).norm() < 1e-15);
    let body = &solved.answer.bodies[0];
    for (name, vector) in [
        ("body_velocity", body.motion.velocity),
        ("body_angular_velocity", body.motion.angular_velocity),
        ("force_on_fluid", body.wrench.force),
        ("torque_on_fluid", body.wrench.torque),
    ] {
        assert_eq!(numbers(name), vector.as_slice(), "{name}");
    }
}

#[test]
fn surface_data_of_a_sphere_are_exact() {
    // Traction -3 mu U / 2a - 3 mu Omega x n, velocity U + a Omega x n.
    let mesh = mesh(&solved(SPHERE, 4), 16);
    let (u, omega) = (Vector3::new(1.0, 0.0, -0.5), Vector3::new(0.2, 0.3, 0.1));
    let center = Vector3::new(0.3, -0.2, 0.5);
    let [traction, velocity, normals] =
        ["traction", "velocity", "normal"].map(|name| mesh.vectors(name));
    for (k, &point) in mesh.points.iter().enumerate() {
        let n = point - center;
        assert!((normals[k] - n).norm() < 1e-14);
        assert!((velocity[k] - u - omega.cross(&n)).norm() < 1e-13);
        let exact = -2.0 * (1.5 * u + 3.0 * omega.cross(&n));
        assert!(
            (traction[k] - exact).norm() < 1e-9,
            "{k}: {} {exact}",
            traction[k]
        );
    }
}

/// The velocity and pressure at `x` around a unit sphere with velocity `u`, viscosity 1 (Kim and
/// Karrila 1991, section 3.3.1).
fn stokes(u: Vector3<f64>, x: Vector3<f64>) -> (Vector3<f64>, f64) {
    let r = x.norm();
    let n = x / r;
    let radial = n * n.dot(&u);
    let velocity = 0.75 / r * (u + radial) + 0.25 / r.powi(3) * (u - 3.0 * radial);
    (velocity, 1.5 * n.dot(&u) / (r * r))
}

/// A folder for one test, with a case in it, after the command has solved it.
fn run(name: &str, text: &str, options: &[&str]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("a folder");
    fs::write(folder.join("ball.toml"), text).expect("a case");
    let output = Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(["solve", "ball.toml"])
        .args(options)
        .current_dir(&folder)
        .stdin(Stdio::null())
        .output()
        .expect("the program runs");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("\nwritten: "));
    folder
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder");
    let mut names: Vec<_> = entries
        .map(|entry| entry.expect("an entry").file_name())
        .map(|name| name.into_string().expect("UTF-8"))
        .collect();
    names.sort();
    names
}

#[test]
fn the_option_does_what_the_case_may_ask() {
    let plane = "[plane]\npoints = 11\n";
    let asked = case(SPHERE, &format!("{plane}[output]\nvtk = true\n"));
    let asked = run("vtk-asked", &asked, &[]);
    let option = run("vtk-option", &case(SPHERE, plane), &["--vtk"]);
    let both = ["ball-bodies.vtu", "ball-plane.vts", "ball.toml"];
    assert_eq!(names(&option), both);
    for name in &both[..2] {
        let read = |folder: &Path| fs::read(folder.join(name)).expect("a file");
        assert!(read(&asked) == read(&option), "{name}");
    }
    let elsewhere = format!("{plane}[output]\ndirectory = 'out'\n");
    let elsewhere = run(
        "vtk-elsewhere",
        &case(SPHERE, &elsewhere),
        &["--vtk", "--picture", "flow.svg"],
    );
    assert_eq!(names(&elsewhere), ["ball.toml", "flow.svg", "out"]);
    assert_eq!(names(&elsewhere.join("out")), both[..2]);
}

#[test]
fn the_command_writes_surface_and_plane() {
    let rest = "[plane]\nnormal = [0, 1, 0]\nsize = [6, 4]\npoints = [31, 21]\n[output]\ndirectory = 'a/b'\nvtk = true\n";
    let text = case(SPHERE, rest).replace("angular_velocity", "# angular_velocity");
    let folder = run("vtk", &text, &[]);
    assert_eq!(
        names(&folder.join("a/b")),
        ["ball-bodies.vtu", "ball-plane.vts"]
    );

    let bytes = fs::read(folder.join("a/b/ball-bodies.vtu")).expect("the surface");
    assert_eq!(read_surface(&bytes).euler_characteristic(), 2);

    let bytes = fs::read(folder.join("a/b/ball-plane.vts")).expect("the plane");
    let DataSet::StructuredGrid { extent, pieces, .. } =
        Vtk::parse_xml(&bytes[..]).expect("VTK").data
    else {
        panic!("no structured grid");
    };
    assert_eq!(extent.into_ranges(), [0..=30, 0..=20, 0..=0]);
    let [Piece::Inline(piece)] = &pieces[..] else {
        panic!("not one piece");
    };
    let points = triples(&doubles(&piece.points));
    assert_eq!(points.len(), 31 * 21);
    let data = point_data(&piece.data);
    let velocity = triples(&data["velocity"]);
    let (u, center) = (Vector3::new(1.0, 0.0, -0.5), Vector3::new(0.3, -0.2, 0.5));
    for (k, point) in points.iter().enumerate() {
        assert!((point.y + 0.2).abs() < 1e-15);
        let x = point - center;
        // Rounding does not decide what is on the sphere itself.
        let inside = x.norm() < 1.0 - 1e-12;
        let [flag, hidden] = ["inside", "vtkGhostType"].map(|name| data[name][k]);
        assert_eq!(hidden, 2.0 * flag);
        if inside {
            assert_eq!(flag, 1.0, "{point}");
            assert!(velocity[k].x.is_nan() && data["pressure"][k].is_nan());
        } else if flag == 0.0 {
            let (exact, pressure) = stokes(u, x);
            assert!((velocity[k] - exact).norm() < 1e-5, "{point}");
            assert!(
                (data["pressure"][k] - 2.0 * pressure).abs() < 1e-4,
                "{point}"
            );
        } else {
            assert!(x.norm() < 1.05, "{point} is missing");
        }
    }
    assert_eq!(points[0], Point3::new(-2.7, -0.2, -1.5).coords);
}
