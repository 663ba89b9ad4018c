//! Colours as an image.

use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use plotters::style::RGBColor;

use super::error::PictureError;

/// A PNG image of shades from 0 to 1, rows of `width` from below, in 256 colours; as base64.
pub fn png(
    shades: &[f64],
    width: usize,
    colour: fn(f64) -> RGBColor,
) -> Result<String, PictureError> {
    let failed = |error: png::EncodingError| PictureError::Image(error.to_string());
    let palette = (0..=255u8).flat_map(|k| {
        let RGBColor(r, g, b) = colour(f64::from(k) / 255.0);
        [r, g, b]
    });
    let rows = shades.chunks(width).rev();
    let pixels: Vec<u8> = rows
        .flatten()
        .map(|shade| (255.0 * shade).round() as u8)
        .collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, (shades.len() / width) as u32);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_palette(palette.collect::<Vec<u8>>());
    encoder.set_compression(png::Compression::High);
    // Neighbours differ little, although they are indices.
    encoder.set_filter(png::Filter::Paeth);
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&pixels).map_err(failed)?;
    writer.finish().map_err(failed)?;
    Ok(BASE64_STANDARD.encode(file))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::plot::colour::viridis;

    #[test]
    fn rows_come_from_below() {
        let file =
            BASE64_STANDARD.decode(png(&[0.0, 0.0, 0.0, 1.0, 1.0, 1.0], 3, viridis).unwrap());
        let file = file.unwrap();
        let mut decoder = png::Decoder::new(std::io::Cursor::new(&file));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert_eq!((info.width, info.height), (3, 2));
        assert_eq!(pixels[..3], [253, 231, 37]);
        assert_eq!(pixels[9..12], [68, 1, 84]);
    }
}
