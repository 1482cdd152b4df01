//! Radiance HDR files with any signature, orientation and exposure. The decoder of `image` reads the pixels; it knows the
//! signature `#?RADIANCE` and rows from the top left only, and ignores the exposure.

use glam::Vec3;
use image::DynamicImage;
use image::codecs::hdr::HdrDecoder;
use std::io::Read;

/// What the header of a file says.
pub(super) struct Header {
    /// The size of the picture.
    pub width: u32,
    pub height: u32,
    /// By how much the radiance was multiplied before it was stored.
    exposure: f32,
    /// Whether the scanlines are columns in place of rows.
    by_columns: bool,
    /// Whether x grows to the left, and y upwards, along the stored numbers.
    from_right: bool,
    from_below: bool,
    /// Where the pixels begin.
    pixels: usize,
}

/// The first bytes of each Radiance file; the name of a program or of the format follows.
pub(super) const SIGNATURE: [u8; 2] = *b"#?";

/// Reads the header of a file.
///
/// # Errors
///
/// If the file stores other colours than red, green and blue, or does not say its size.
pub(super) fn header(bytes: &[u8]) -> Result<Header, String> {
    let mut exposure = 1.0;
    let mut at = 0;
    let mut line = || {
        let length = bytes[at..].iter().position(|byte| *byte == b'\n')?;
        let line = String::from_utf8_lossy(&bytes[at..at + length]).trim().to_owned();
        at += length + 1;
        Some((line, at))
    };
    loop {
        let (attribute, _) = line().ok_or("its header has no end")?;
        match attribute.split_once('=').map(|(key, value)| (key.trim(), value.trim())) {
            _ if attribute.is_empty() => break,
            Some(("FORMAT", format)) if format != "32-bit_rle_rgbe" => {
                return Err(format!("its pixels have the format `{format}`, which is not `32-bit_rle_rgbe`"));
            }
            // Several exposures are multiplied.
            Some(("EXPOSURE", value)) => match value.parse::<f32>() {
                Ok(factor) if factor > 0.0 && factor.is_finite() => exposure *= factor,
                _ => return Err(format!("its exposure `{value}` is no number above 0")),
            },
            _ => {}
        }
    }
    let (size, pixels) = line().ok_or("it lacks the line with its size")?;
    let wrong = || format!("its size `{size}` is not like `-Y 512 +X 1024`");
    let words: Vec<&str> = size.split_whitespace().collect();
    let [first, n_lines, second, n_along] = words[..] else { return Err(wrong()) };
    let (Ok(n_lines), Ok(n_along)) = (n_lines.parse(), n_along.parse()) else { return Err(wrong()) };
    let by_columns = first.ends_with('X');
    let (x, y) = if by_columns { (first, second) } else { (second, first) };
    if !(["-X", "+X"].contains(&x) && ["-Y", "+Y"].contains(&y)) {
        return Err(wrong());
    }
    let (width, height) = if by_columns { (n_lines, n_along) } else { (n_along, n_lines) };
    Ok(Header { width, height, exposure, by_columns, from_right: x == "-X", from_below: y == "+Y", pixels })
}

/// The pixels row by row from the top left, in linear light.
///
/// # Errors
///
/// If the pixels are not those of a picture of this size.
pub(super) fn pixels(header: &Header, bytes: &[u8]) -> Result<Vec<Vec3>, String> {
    // Give the decoder the header that it knows, with scanlines as rows.
    let Header { width, height, .. } = *header;
    let (n_lines, n_along) = if header.by_columns { (width, height) } else { (height, width) };
    let known = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {n_lines} +X {n_along}\n");
    let stored = HdrDecoder::new(known.as_bytes().chain(&bytes[header.pixels..]))
        .and_then(DynamicImage::from_decoder)
        .map_err(|error| error.to_string())?
        .into_rgb32f();
    let at = |x: u32, y: u32| {
        let x = if header.from_right { width - 1 - x } else { x };
        let y = if header.from_below { height - 1 - y } else { y };
        let (column, row) = if header.by_columns { (y, x) } else { (x, y) };
        Vec3::from_array(stored.get_pixel(column, row).0) / header.exposure
    };
    Ok((0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two by three pixels, the first lines of which are 1, 2 and 3.
    fn stored(start: &str) -> Result<(u32, u32, Vec<f32>), String> {
        let mut bytes = start.as_bytes().to_vec();
        // One step of exponent 136 is 1.
        (1..=6).for_each(|number| bytes.extend([number, 0, 0, 136]));
        let header = header(&bytes)?;
        let pixels = pixels(&header, &bytes)?;
        Ok((header.width, header.height, pixels.iter().map(|pixel| pixel.x).collect()))
    }

    #[test]
    fn every_orientation_and_signature_is_the_same_picture() {
        for (size, expected) in [
            ("-Y 2 +X 3", (3, 2, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0])),
            ("-Y 2 -X 3", (3, 2, [3.0, 2.0, 1.0, 6.0, 5.0, 4.0])),
            ("+Y 2 +X 3", (3, 2, [4.0, 5.0, 6.0, 1.0, 2.0, 3.0])),
            ("+Y 2 -X 3", (3, 2, [6.0, 5.0, 4.0, 3.0, 2.0, 1.0])),
            ("+X 2 -Y 3", (2, 3, [1.0, 4.0, 2.0, 5.0, 3.0, 6.0])),
            ("-X 2 -Y 3", (2, 3, [4.0, 1.0, 5.0, 2.0, 6.0, 3.0])),
            ("+X 2 +Y 3", (2, 3, [3.0, 6.0, 2.0, 5.0, 1.0, 4.0])),
            ("-X 2 +Y 3", (2, 3, [6.0, 3.0, 5.0, 2.0, 4.0, 1.0])),
        ] {
            let (width, height, pixels) = expected;
            for signature in ["#?RADIANCE", "#?RGBE", "#?anything"] {
                let file = format!("{signature}\nFORMAT=32-bit_rle_rgbe\n# a comment\n\n{size}\n");
                assert_eq!(stored(&file), Ok((width, height, pixels.to_vec())), "{file}");
            }
        }
    }

    #[test]
    fn exposures_divide_the_stored_numbers() {
        let file = "#?RADIANCE\nEXPOSURE=2\nEXPOSURE= 0.25\n\n-Y 1 +X 6\n";
        assert_eq!(stored(file), Ok((6, 1, vec![2.0, 4.0, 6.0, 8.0, 10.0, 12.0])));
    }

    #[test]
    fn what_cannot_be_read_says_why() {
        let why = |start: &str| stored(start).unwrap_err();
        assert_eq!(
            why("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 6\n"),
            "its pixels have the format `32-bit_rle_xyze`, which is not `32-bit_rle_rgbe`"
        );
        assert_eq!(why("#?RGBE\n\n-Y 1 +Y 6\n"), "its size `-Y 1 +Y 6` is not like `-Y 512 +X 1024`");
        assert_eq!(why("#?RGBE\nEXPOSURE=no\n\n-Y 1 +X 6\n"), "its exposure `no` is no number above 0");
        assert_eq!(why("#?RGBE\nFORMAT"), "its header has no end");
    }
}
