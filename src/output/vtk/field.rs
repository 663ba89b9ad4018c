//! Field data: numbers that belong to a file as a whole, or to bodies and not to points. vtkio does
//! not write them.

use std::fmt::Write;

/// An array with a name, so many numbers to a tuple.
#[derive(Clone, Debug)]
pub struct Field {
    name: &'static str,
    components: usize,
    numbers: Vec<f64>,
}

impl Field {
    /// The tuples of an array.
    pub fn new<const N: usize>(
        name: &'static str,
        tuples: impl IntoIterator<Item = [f64; N]>,
    ) -> Self {
        Self {
            name,
            components: N,
            numbers: tuples.into_iter().flatten().collect(),
        }
    }

    /// Inserts arrays as text in an XML file, before its first piece.
    pub fn insert(fields: &[Self], file: &mut Vec<u8>) {
        const PIECE: &[u8] = b"<Piece";
        let place = file.windows(PIECE.len()).position(|part| part == PIECE);
        let (false, Some(place)) = (fields.is_empty(), place) else {
            return;
        };
        let mut text = "<FieldData>".to_owned();
        for field in fields {
            field.write(&mut text);
        }
        text += "</FieldData>";
        file.splice(place..place, text.into_bytes());
    }

    fn write(&self, text: &mut String) {
        let tuples = self.numbers.len() / self.components;
        // Writing to a string does not fail.
        let _ = write!(
            text,
            "<DataArray type=\"Float64\" Name=\"{}\" NumberOfComponents=\"{}\" \
             NumberOfTuples=\"{tuples}\" format=\"ascii\">",
            self.name, self.components
        );
        for number in &self.numbers {
            let _ = write!(text, "{number:e} ");
        }
        *text += "</DataArray>";
    }
}
