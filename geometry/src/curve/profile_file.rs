//! Profiles from files of points.

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

use super::error::CurveError;
use super::profile::MOST_POINTS;
use super::{Meridian, Profile};

/// Most bytes of a profile file.
pub const MOST_BYTES: u64 = 16 << 20;
/// Longest line that is read.
const LONGEST_LINE: u64 = 4096;

impl Profile {
    /// The profile through the points of a file, see [`Profile::from_reader`].
    ///
    /// # Errors
    /// If the file cannot be read or is larger than 16 MiB (known before reading it), or as in
    /// [`Profile::from_reader`].
    pub fn from_csv(path: impl AsRef<Path>) -> Result<Self, CurveError> {
        let path = path.as_ref();
        let name = path.display().to_string();
        let unreadable = |e: std::io::Error| CurveError::Unreadable {
            name: name.clone(),
            reason: e.to_string(),
        };
        // Before it is opened: opening a named pipe would wait for a writer.
        let metadata = std::fs::metadata(path).map_err(unreadable)?;
        if !metadata.is_file() {
            return Err(CurveError::Unreadable {
                name,
                reason: "not a regular file".into(),
            });
        }
        if metadata.len() > MOST_BYTES {
            return Err(CurveError::FileTooLarge {
                name,
                limit: MOST_BYTES,
            });
        }
        let file = File::open(path).map_err(unreadable)?;
        Self::from_reader(BufReader::new(file), &name)
    }

    /// The profile through the points that `reader` gives, one `r,z` on each line; empty lines,
    /// what follows a `#`, and one header line before the first point are skipped. `name` is for
    /// messages.
    ///
    /// # Errors
    /// If reading fails, more than 16 MiB come, a line holds anything else, or the points are no
    /// profile: see [`Profile::from_points`].
    pub fn from_reader(reader: impl BufRead, name: &str) -> Result<Self, CurveError> {
        Self::from_points(&points(reader, name)?)
    }
}

fn points(reader: impl BufRead, name: &str) -> Result<Vec<Meridian>, CurveError> {
    let mut reader = reader.take(MOST_BYTES + 1);
    let mut points = Vec::new();
    let mut header_allowed = true;
    let mut bytes = Vec::new();
    for line in 1.. {
        bytes.clear();
        // A line without end must not fill the memory.
        let read = (&mut reader)
            .take(LONGEST_LINE)
            .read_until(b'\n', &mut bytes)
            .map_err(|e| CurveError::Unreadable {
                name: name.into(),
                reason: format!("line {line}: {e}"),
            })?;
        if read == 0 {
            break;
        }
        if reader.limit() == 0 {
            return Err(CurveError::FileTooLarge {
                name: name.into(),
                limit: MOST_BYTES,
            });
        }
        let whole = String::from_utf8_lossy(&bytes);
        let complaint = || {
            let text = whole
                .trim()
                .chars()
                .take(40)
                .map(|c| if c.is_control() { '?' } else { c })
                .collect();
            CurveError::Line {
                name: name.into(),
                line,
                text,
            }
        };
        if bytes.len() as u64 == LONGEST_LINE && bytes.last() != Some(&b'\n') {
            return Err(complaint());
        }
        // A byte order mark is no part of the header.
        let text = whole
            .trim_start_matches('\u{feff}')
            .split('#')
            .next()
            .unwrap_or_default()
            .trim();
        if text.is_empty() {
            continue;
        }
        let fields: Vec<&str> = text.split(',').map(str::trim).collect();
        let numbers: Vec<Option<f64>> = fields.iter().map(|f| f.parse().ok()).collect();
        match numbers[..] {
            [Some(r), Some(z)] => points.push(Meridian { r, z }),
            [None, None] if header_allowed => {}
            _ => return Err(complaint()),
        }
        header_allowed = false;
        if points.len() > MOST_POINTS {
            return Err(CurveError::TooManyPoints { limit: MOST_POINTS });
        }
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    fn read(text: &str) -> Result<Profile, CurveError> {
        Profile::from_reader(text.as_bytes(), "curve.csv")
    }

    fn circle() -> String {
        (0..=20)
            .map(|k| PI * f64::from(k) / 20.0)
            .map(|s| format!("{},{}\n", s.sin(), s.cos()))
            .collect()
    }

    #[test]
    fn headers_and_comments_are_skipped() {
        let plain = read(&circle()).unwrap();
        assert_eq!(plain.points().len(), 21);
        assert_eq!(
            read(&format!(
                "\u{feff}r,z\r\n{}",
                circle().replace('\n', "\r\n")
            ))
            .unwrap(),
            plain
        );
        assert_eq!(
            read(&format!(
                "# a circle\n\n r , z # names\n{}\n# end",
                circle()
            ))
            .unwrap(),
            plain
        );
    }

    #[test]
    fn bad_lines_are_named() {
        let line = |text: &str| match read(text).unwrap_err() {
            CurveError::Line { line, .. } => line,
            other => panic!("{other}"),
        };
        assert_eq!(line("r,z\n0,1\n0.5;0.3\n"), 3);
        assert_eq!(line("0,1\nr,z\n"), 2);
        assert_eq!(line("r,z\nr,z\n"), 2);
        assert_eq!(line("0,1,2\n"), 1);
        assert_eq!(line("0,1\n0.1\n"), 2);
        assert_eq!(line(&"7".repeat(10_000)), 1);
        assert_eq!(
            read("0,1\nx\u{7}y,0\n").unwrap_err().to_string(),
            "curve.csv, line 2: expected two numbers \"r,z\", got \"x?y,0\""
        );
        assert!(matches!(
            read("0,1\nNaN,0\n0,-1"),
            Err(CurveError::PointNotFinite { index: 2, .. })
        ));
        assert!(matches!(
            read(""),
            Err(CurveError::TooFewPoints { count: 0, .. })
        ));
    }

    #[test]
    fn files_are_read_or_refused_by_size() {
        let path =
            std::env::temp_dir().join(format!("axistokes-profile-{}.csv", std::process::id()));
        std::fs::write(&path, circle()).unwrap();
        let good = Profile::from_csv(&path);
        File::create(&path).unwrap().set_len(1 << 30).unwrap();
        let large = Profile::from_csv(&path);
        std::fs::remove_file(&path).unwrap();
        assert_eq!(good, read(&circle()));
        assert!(matches!(large, Err(CurveError::FileTooLarge { .. })));
    }

    #[test]
    fn too_much_is_refused_early() {
        let endless = std::io::BufReader::new(std::io::repeat(b'\n'));
        assert!(matches!(
            Profile::from_reader(endless, "x"),
            Err(CurveError::FileTooLarge { .. })
        ));
        let endless = std::io::BufReader::new(std::io::repeat(b'1'));
        assert!(matches!(
            Profile::from_reader(endless, "x"),
            Err(CurveError::Line { line: 1, .. })
        ));
        let many = "1,2\n".repeat(MOST_POINTS + 1);
        assert!(matches!(read(&many), Err(CurveError::TooManyPoints { .. })));
        assert!(matches!(
            Profile::from_csv("/no/such/file.csv"),
            Err(CurveError::Unreadable { .. })
        ));
        assert!(matches!(
            Profile::from_csv("/"),
            Err(CurveError::Unreadable { .. })
        ));
    }
}
