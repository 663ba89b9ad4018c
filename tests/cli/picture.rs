//! `axistokes solve --picture`: what is in the file, and what is refused.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use roxmltree::{Document, Node};

const SPHERE: &str = "[shapes.ball]\nkind = 'sphere'\nradius = 1.0\n[[bodies]]\nshape = 'ball'\nvelocity = [0, 0, 1]\n\
                      [plane]\nsize = 5.2\npoints = 53\n";

/// A folder for one test, with the sphere's case in it.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("picture-{name}"));
    let _ = fs::remove_dir_all(&path);
    fs::create_dir_all(&path).expect("a folder");
    fs::write(path.join("ball.toml"), SPHERE).expect("a case");
    path
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_axistokes"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::null())
        .output()
        .expect("the program runs")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder");
    let mut names: Vec<String> = entries
        .map(|entry| {
            entry
                .expect("an entry")
                .file_name()
                .into_string()
                .expect("UTF-8")
        })
        .collect();
    names.sort();
    names
}

fn draw(folder: &Path, arguments: &[&str]) -> String {
    let mut all = vec!["solve", "ball.toml", "--picture", "flow.svg"];
    all.extend(arguments);
    let output = run(folder, &all);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    assert!(output.stderr.is_empty(), "{stderr}");
    fs::read_to_string(folder.join("flow.svg")).expect("the picture")
}

fn by_id<'a>(document: &'a Document<'_>, id: &str) -> Node<'a, 'a> {
    let mut found = document
        .descendants()
        .filter(|node| node.attribute("id") == Some(id));
    let node = found.next().unwrap_or_else(|| panic!("no {id}"));
    assert!(found.next().is_none(), "{id} twice");
    node
}

/// The points of a path.
fn places(path: Node<'_, '_>) -> Vec<[f64; 2]> {
    let data = path.attribute("d").expect("data");
    let numbers: Vec<f64> = data
        .split(|c: char| c.is_ascii_alphabetic() || c == ',' || c == ' ')
        .filter(|word| !word.is_empty())
        .map(|word| word.parse().expect("a number"))
        .collect();
    let (places, rest) = numbers.as_chunks::<2>();
    assert!(rest.is_empty());
    places.to_vec()
}

/// Columns and rows of the embedded image, and its indices into the colours.
fn image(document: &Document<'_>) -> (usize, usize, Vec<u8>) {
    let node = document
        .descendants()
        .find(|node| node.has_tag_name("image"));
    let image = node
        .and_then(|node| node.attribute("href"))
        .expect("an image");
    let text = image.strip_prefix("data:image/png;base64,").expect("a PNG");
    let file = BASE64_STANDARD.decode(text).expect("base64");
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    (info.width as usize, info.height as usize, pixels)
}

fn texts(document: &Document<'_>) -> Vec<String> {
    let texts = document
        .descendants()
        .filter(|node| node.has_tag_name("text"));
    texts
        .filter_map(|node| node.text())
        .map(|text| text.trim().to_owned())
        .collect()
}

#[test]
fn the_speed_around_a_sphere() {
    let folder = folder("speed");
    let svg = draw(&folder, &[]);
    assert_eq!(names(&folder), ["ball.toml", "flow.svg"]);
    assert!(
        svg.len() < 100_000 && !svg.contains("NaN") && !svg.contains("inf"),
        "{}",
        svg.len()
    );
    let document = Document::parse(&svg).expect("XML");
    let texts = texts(&document);
    for text in ["ball", "speed", "x", "z", "0", "−2", "0.2"] {
        assert!(
            texts.iter().any(|found| found == text),
            "no {text} in {texts:?}"
        );
    }

    // 520 pixels for a width of 5.2: the sphere is a disc of radius 100 about the middle.
    let body = places(by_id(&document, "bodies"));
    let frame = by_id(&document, "frame")
        .first_element_child()
        .expect("a rectangle");
    let number = |name: &str| -> f64 { frame.attribute(name).expect("a number").parse().unwrap() };
    let middle = [number("x") + 260.0, number("y") + 260.0];
    let radius = |[x, y]: [f64; 2]| (x - middle[0]).hypot(y - middle[1]);
    assert!(body.len() > 100);
    assert!(
        body.iter()
            .all(|&place| (radius(place) - 100.0).abs() < 0.1)
    );
    let lines = places(by_id(&document, "streamlines"));
    assert!(lines.len() > 500);
    assert!(lines.iter().all(|&place| radius(place) > 99.8));
    assert!(!places(by_id(&document, "arrows")).is_empty());

    // Colours are the speed of Stokes' solution, up to that of the sphere.
    let (columns, rows, pixels) = image(&document);
    assert_eq!((columns, rows), (53, 53));
    for (k, &index) in pixels.iter().enumerate() {
        let (x, z) = (0.1 * (k % 53) as f64 - 2.6, 2.6 - 0.1 * (k / 53) as f64);
        let r = x.hypot(z);
        if r < 1.05 {
            continue;
        }
        let (along, across) = (z / r, x / r);
        let radial = along * (1.5 / r - 0.5 / r.powi(3));
        let polar = across * (0.75 / r + 0.25 / r.powi(3));
        let speed = radial.hypot(polar);
        let shown = f64::from(index) / 255.0;
        assert!(
            (shown - speed).abs() < 0.03 * speed + 0.004,
            "{x} {z}: {shown} {speed}"
        );
    }
}

#[test]
fn the_same_bytes_whatever_the_threads() {
    let folder = folder("threads");
    let [one, two] = ["1", "2"].map(|threads| draw(&folder, &["--threads", threads]));
    assert!(one == two);
    let moved = SPHERE.to_owned() + "frame = 'body'\n";
    fs::write(folder.join("ball.toml"), moved).expect("a case");
    assert!(draw(&folder, &[]) != one);
}

#[test]
fn the_pressure() {
    let folder = folder("pressure");
    let svg = draw(&folder, &["--picture-of", "pressure", "--json"]);
    let document = Document::parse(&svg).expect("XML");
    assert!(texts(&document).iter().any(|text| text == "pressure"));
    // Opposite above and below, zero between.
    let (columns, rows, pixels) = image(&document);
    for k in 0..columns * rows {
        let (x, z) = (
            0.1 * (k % columns) as f64 - 2.6,
            2.6 - 0.1 * (k / columns) as f64,
        );
        // Grid points on the sphere may count as inside on one side only.
        if x.hypot(z) < 1.05 {
            continue;
        }
        let mirrored = (rows - 1 - k / columns) * columns + k % columns;
        let sum = u16::from(pixels[k]) + u16::from(pixels[mirrored]);
        assert!(sum.abs_diff(255) <= 1, "{k}");
    }
    assert!(
        pixels[10] > 127,
        "above, where the sphere moves, it is positive"
    );
}

/// The ends of the bar of the colours that are pointed.
fn pointed(document: &Document<'_>) -> usize {
    let beyond = |node: &Node<'_, '_>| node.attribute("class") == Some("beyond");
    document.descendants().filter(beyond).count()
}

#[test]
fn the_disturbance_is_the_flow_without_its_background() {
    let folder = folder("disturbance");
    let moving = draw(&folder, &[]);
    let held = SPHERE.replace("velocity = [0, 0, 1]\n", "")
        + "[background]\nkind = 'uniform'\nvelocity = [0, 0, -1]\n";
    for frame in ["lab", "body"] {
        let held = held.replace("points = 53", &format!("points = 53\nframe = '{frame}'"));
        fs::write(folder.join("ball.toml"), held).expect("a case");
        let svg = draw(&folder, &["--picture-of", "disturbance"]);
        let [one, other] = [&moving, &svg].map(|svg| Document::parse(svg).expect("XML"));
        assert!(texts(&other).iter().any(|text| text == "disturbance"));
        let [(_, _, one), (_, _, other)] = [image(&one), image(&other)];
        // On the sphere itself inside and outside may differ by rounding.
        let differ = one.iter().zip(&other).filter(|(a, b)| a.abs_diff(**b) > 1);
        assert!(differ.count() < 20);
    }
    assert_eq!(pointed(&Document::parse(&moving).expect("XML")), 0);
}

#[test]
fn swimmers_have_heads_and_others_have_none() {
    let folder = folder("heads");
    let svg = draw(&folder, &[]);
    let document = Document::parse(&svg).expect("XML");
    assert!(places(by_id(&document, "heads")).is_empty());
    let slip = "axis = [1, 0, 0]\nforce = [0, 0, 0]\nslip = { kind = 'squirmer', b = [1.0] }\n";
    let swimmer = SPHERE.replace("velocity = [0, 0, 1]\n", slip);
    fs::write(folder.join("ball.toml"), &swimmer).expect("a case");
    let svg = draw(&folder, &[]);
    let document = Document::parse(&svg).expect("XML");
    let ([tail, ..], [.., tip, _, _, _]) = (
        &places(by_id(&document, "heads"))[..],
        &places(by_id(&document, "heads"))[..],
    ) else {
        panic!("no arrow");
    };
    // 100 pixels to the radius, to the right.
    assert!(
        tip[0] - tail[0] > 90.0 && (tip[1] - tail[1]).abs() < 0.2,
        "{tail:?} {tip:?}"
    );
    // Seen from above there is none.
    let above = swimmer.replace("[plane]\n", "[plane]\nnormal = [1, 0, 0]\n");
    fs::write(folder.join("ball.toml"), above).expect("a case");
    let svg = draw(&folder, &[]);
    let document = Document::parse(&svg).expect("XML");
    assert!(places(by_id(&document, "heads")).is_empty());
}

#[test]
fn pressures_that_have_no_colour_are_marked() {
    let folder = folder("beyond");
    // Near the rim of a disc.
    let disc = SPHERE
        .replace(
            "kind = 'sphere'\nradius = 1.0",
            "kind = 'spheroid'\npolar = 0.02\nequatorial = 1.0",
        )
        .replace("points = 53", "points = 131")
        + "[accuracy]\ntolerance = 1e-3\n";
    fs::write(folder.join("ball.toml"), disc).expect("a case");
    let svg = draw(&folder, &["--picture-of", "pressure"]);
    assert_eq!(pointed(&Document::parse(&svg).expect("XML")), 2);
}

#[test]
fn titles_are_text_and_have_room() {
    let folder = folder("titles");
    let name = format!("a <b> & {}", "c".repeat(100));
    fs::write(folder.join(format!("{name}.toml")), SPHERE).expect("a case");
    let output = run(
        &folder,
        &["solve", &format!("{name}.toml"), "--picture", "flow.svg"],
    );
    assert_eq!(output.status.code(), Some(0));
    let svg = fs::read_to_string(folder.join("flow.svg")).expect("the picture");
    let document = Document::parse(&svg).expect("XML");
    let title = by_id(&document, "title").text().expect("text").trim();
    assert!(
        title.starts_with("a <b> & ccc") && title.ends_with('…'),
        "{title}"
    );
    assert!(title.chars().count() < 60);
}

#[test]
fn refuses_with_one_line_and_writes_nothing() {
    let folder = folder("refusals");
    fs::create_dir(folder.join("folder.svg")).expect("a folder");
    let inside = SPHERE.replace("size = 5.2", "size = 0.2");
    fs::write(folder.join("inside.toml"), inside).expect("a case");
    let before = names(&folder);
    for (arguments, part) in [
        (&["ball.toml", "--picture", "flow"][..], "ends in .svg"),
        (&["ball.toml", "--picture", ""], "--picture"),
        (&["ball.toml", "--picture"], "--picture"),
        (&["ball.toml", "--picture", ".svg"], "ends in .svg"),
        (
            &["ball.toml", "--picture", "folder.svg"],
            "this is a folder",
        ),
        (
            &["ball.toml", "--picture", "ball.toml/flow.svg"],
            "not a folder",
        ),
        (&["ball.toml", "--picture-of", "speed"], "--picture"),
        (
            &[
                "ball.toml",
                "--picture",
                "flow.svg",
                "--picture-of",
                "vorticity",
            ],
            "vorticity",
        ),
        (
            &["inside.toml", "--picture", "new/flow.svg"],
            "inside the body",
        ),
        (&["none.toml", "--picture", "new/flow.svg"], "no such file"),
    ] {
        let mut typed = vec!["solve"];
        typed.extend(arguments);
        let output = run(&folder, &typed);
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {stderr}");
        assert_eq!(stderr.lines().count(), 1, "{arguments:?}: {stderr}");
        assert!(stderr.contains(part), "{arguments:?}: {stderr}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        assert_eq!(names(&folder), before, "{arguments:?}");
    }
}

#[cfg(not(feature = "png"))]
#[test]
fn without_the_feature_png_is_refused_by_name() {
    let folder = folder("no-png");
    let output = run(&folder, &["solve", "ball.toml", "--picture", "flow.png"]);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(
        stderr.contains("--features png") && stderr.contains(".svg"),
        "{stderr}"
    );
    assert_eq!(
        (stderr.lines().count(), names(&folder)),
        (1, vec!["ball.toml".to_owned()])
    );
}

#[cfg(feature = "png")]
#[test]
fn png_is_the_picture_in_pixels() {
    let folder = folder("png");
    draw(&folder, &[]);
    let output = run(&folder, &["solve", "ball.toml", "--picture", "flow.png"]);
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{stderr}");
    let file = fs::File::open(folder.join("flow.png")).expect("the picture");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file))
        .read_info()
        .expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("pixels");
    let svg = fs::read_to_string(folder.join("flow.svg")).expect("the other picture");
    let document = Document::parse(&svg).expect("XML");
    let size = ["width", "height"].map(|name| {
        let size = document.root_element().attribute(name).expect("a size");
        size.parse::<f64>().expect("a number").round() as u32
    });
    assert_eq!([info.width, info.height], size.map(|pixels| 3 * pixels));
    let pixel = |x: u32, y: u32| {
        let at = 4 * (3 * (x + y * info.width)) as usize;
        &pixels[at..at + 3]
    };
    let frame = by_id(&document, "frame")
        .first_element_child()
        .expect("a rectangle");
    let corner = ["x", "y"].map(|name| -> f64 { frame.attribute(name).unwrap().parse().unwrap() });
    let [x, y] = corner.map(|at| at as u32 + 260);
    assert_eq!(pixel(x, y), [0xbd; 3], "the sphere is grey");
    assert_eq!(pixel(2, 2), [255; 3]);
    // The name of the colours is there: something is dark at its place.
    let dark = (0..60).any(|dx| (0..14).any(|dy| pixel(x + 284 + dx, y - 260 + dy)[0] < 80));
    assert!(dark, "no text");
}

#[test]
fn every_shape_and_plane_is_drawn() {
    let folder = folder("shapes");
    for (name, shape, plane) in [
        (
            "torus",
            "kind = 'torus'\nmajor = 1\nminor = 0.3",
            "normal = [0, 0, 1]",
        ),
        (
            "disc",
            "kind = 'spheroid'\npolar = 0.1\nequatorial = 1",
            "normal = [1, 1, 1]",
        ),
        (
            "cell",
            "kind = 'biconcave'\nradius = 1",
            "size = [8, 1]\npoints = [81, 11]",
        ),
        (
            "far",
            "kind = 'sphere'\nradius = 1",
            "center = [1e6, 0, 0]\nsize = 1e-3",
        ),
        (
            "near",
            "kind = 'sphere'\nradius = 1",
            "center = [1.1, 0, 0]\nsize = 1e-9",
        ),
        ("wide", "kind = 'sphere'\nradius = 1", "size = 1e20"),
    ] {
        let text = format!(
            "[shapes.s]\n{shape}\n[[bodies]]\nshape = 's'\naxis = [1, 1, 0]\nvelocity = [0, 0, 1]\nangular_velocity = [1, 0, 0]\n\
             [accuracy]\ntolerance = 1e-4\n[plane]\n{plane}\n{}",
            if plane.contains("points") {
                ""
            } else {
                "points = 31\n"
            }
        );
        fs::write(folder.join("ball.toml"), text).expect("a case");
        let svg = draw(&folder, &[]);
        let document = Document::parse(&svg).expect("XML");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{name}");
        assert!(
            by_id(&document, "streamlines").attribute("d").is_some(),
            "{name}"
        );
    }
}
