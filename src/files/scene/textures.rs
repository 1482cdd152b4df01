//! Reads `[textures.NAME]`: images, decoded to linear light.

use super::files;
use super::names::Names;
use super::radiance;
use super::reader::Value;
use crate::files::error::LoadError;
use crate::files::words::{one_line, quoted};
use crate::film::decode_srgb;
use crate::material::{Texture, Wrap};
use glam::Vec3;
use image::{DynamicImage, ImageReader};
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::Arc;

const WRAPS: [(&str, Wrap); 3] = [("repeat", Wrap::Repeat), ("clamp", Wrap::Clamp), ("mirror", Wrap::Mirror)];

/// The curve that decodes the numbers of an image, which are in `0..=1`.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Curve {
    /// The inverse of the sRGB curve.
    Srgb,
    /// This power: 1 for numbers that are linear light.
    Power(f32),
}

/// The values of `encoding`. A frame decodes gamma 2, see [`Gamma2`](crate::scene::Gamma2), so the loader has no curve for it.
const CURVES: [(&str, Option<Curve>); 3] =
    [("srgb", Some(Curve::Srgb)), ("linear", Some(Curve::Power(1.0))), ("gamma2", None)];

/// The images of a scene. An image is read when [`Images::read`] is asked for it; until then it is one black pixel.
#[derive(Default)]
pub(super) struct Images<'a> {
    /// All images by index.
    pub list: Vec<Texture>,
    /// Where each image that is not read yet is found.
    unread: Vec<Option<Unread<'a>>>,
    /// The images that cannot be used and that the scene can do without.
    left_out: Vec<usize>,
}

struct Unread<'a> {
    path: PathBuf,
    /// The value of the scene that leads to the file.
    named_by: Value<'a>,
    /// The value of the scene that says how its bytes are encoded.
    encoding: Option<(Value<'a>, Option<Curve>)>,
    /// Whether the scene can do without the image, if it cannot be used.
    optional: bool,
}

impl<'a> Images<'a> {
    /// Adds the image in the file `path`, to which `named_by` leads, and returns its index.
    pub fn add(&mut self, path: PathBuf, wrap: Wrap, named_by: Value<'a>) -> usize {
        self.list.push(Texture { width: 1, height: 1, pixels: Arc::new(vec![Vec3::ZERO]), wrap });
        self.unread.push(Some(Unread { path, named_by, encoding: None, optional: false }));
        self.list.len() - 1
    }

    /// Adds an image, as [`Images::add`] does, that adds a warning if it cannot be used.
    pub fn add_optional(&mut self, path: PathBuf, named_by: Value<'a>) -> usize {
        let index = self.add(path, Wrap::Repeat, named_by);
        self.unread[index].iter_mut().for_each(|unread| unread.optional = true);
        index
    }

    /// Reads the image with this index, unless that was done before, and returns whether it can be used. Fails as
    /// [`read`] does, and if the encoding of bytes is given for an image without bytes.
    pub fn read(&mut self, index: usize) -> Result<bool, LoadError> {
        let Some(Unread { path, named_by, encoding, optional }) = self.unread[index].take() else {
            return Ok(!self.left_out.contains(&index));
        };
        let curve = encoding.and_then(|(_, curve)| curve);
        let (texture, has_bytes) = match read(&path, self.list[index].wrap, curve, named_by) {
            Err(warning) if optional => {
                let message = format!("{}; it is left out", warning.message);
                named_by.warn(LoadError { message, ..warning });
                self.left_out.push(index);
                return Ok(false);
            }
            read => read?,
        };
        self.list[index] = texture;
        if let Some((encoding, None)) = encoding {
            if !has_bytes {
                let message = "only images with 8 bits per component are encoded with gamma 2";
                return Err(encoding.error(message).help("delete the key, or convert the image to 8 bits"));
            }
            named_by.source.gamma2.borrow_mut().textures.push(index);
        }
        Ok(true)
    }
}

/// All `[textures.NAME]` in the order of the file, with their names. Fails if a file is missing.
pub(super) fn textures<'a>(value: Option<Value<'a>>) -> Result<(Images<'a>, Names<'a>), LoadError> {
    let (mut images, mut names) = (Images::default(), Names::new("texture"));
    let Some(value) = value else { return Ok((images, names)) };
    for entry in value.any_table()?.values() {
        let table = entry.table(&["file", "wrap", "encoding"])?;
        let wrap = table.get("wrap").map_or(Ok(Wrap::Repeat), |wrap| wrap.choice(&WRAPS))?;
        let file = table.need("file", "\"wood.png\"")?;
        let index = images.add(files::find(file)?, wrap, file);
        names.insert(entry.key, index);
        if let Some(encoding) = table.get("encoding") {
            let curve = encoding.choice(&CURVES)?;
            images.unread[index].iter_mut().for_each(|unread| unread.encoding = Some((encoding, curve)));
        }
    }
    Ok((images, names))
}

/// Reads an image file and decodes it to linear light, by `curve` or else by what a PNG file says of itself, which is sRGB if it
/// says nothing; formats with floating-point pixels are linear already. Also says whether its components have 8 bits. Fails at `value`, which names the image, if the file cannot be read, has no pixels, or needs more memory
/// than the limit; this is known from its header.
fn read(path: &Path, wrap: Wrap, curve: Option<Curve>, value: Value) -> Result<(Texture, bool), LoadError> {
    let name = quoted(&path.file_name().unwrap_or_default().to_string_lossy());
    let trouble = |message: String| {
        value
            .error(format!("cannot use {name} as a texture: {}", one_line(&message)))
            .help("textures are PNG or Radiance HDR files")
    };
    let budget = |width: u32, height: u32| {
        if width == 0 || height == 0 {
            return Err(trouble("the image has no pixels".into()));
        }
        value.source.budget.texture(|why| value.error(why), width, height)
    };
    let open_file = || File::open(path).map_err(|error| trouble(error.to_string()));
    let mut signature = [0; 2];
    if open_file()?.read_exact(&mut signature).is_ok() && signature == radiance::SIGNATURE {
        let mut bytes = Vec::new();
        open_file()?.read_to_end(&mut bytes).map_err(|error| trouble(error.to_string()))?;
        let trouble =
            |message| trouble(message).help("save it again as a Radiance HDR file in red, green and blue");
        let header = radiance::header(&bytes).map_err(trouble)?;
        let (width, height) = (header.width, header.height);
        budget(width, height)?;
        let pixels = Arc::new(radiance::pixels(&header, &bytes).map_err(trouble)?);
        return Ok((Texture { width, height, pixels, wrap }, false));
    }
    let open = || ImageReader::open(path).and_then(ImageReader::with_guessed_format);
    let reader = open().map_err(|error| trouble(error.to_string()))?;
    if let Some(format) = reader.format().filter(|format| !format.reading_enabled()) {
        let format = format!("{format:?}").to_uppercase();
        let png = path.with_extension("png");
        return Err(value
            .error(format!("{name} is a {format} image, and textures are PNG or Radiance HDR files"))
            .help(format!(
                "convert it, for example with `magick \"{}\" \"{}\"`, and name the new file",
                path.display(),
                png.display()
            )));
    }
    let (width, height) = reader.into_dimensions().map_err(|error| trouble(error.to_string()))?;
    budget(width, height)?;
    let mut reader = open().map_err(|error| trouble(error.to_string()))?;
    // The budget bounds the memory. The limits of the decoder are lower than what a user can allow.
    reader.no_limits();
    let image = reader.decode().map_err(|error| trouble(error.to_string()))?;
    let has_bytes = matches!(
        image,
        DynamicImage::ImageLuma8(_)
            | DynamicImage::ImageLumaA8(_)
            | DynamicImage::ImageRgb8(_)
            | DynamicImage::ImageRgba8(_)
    );
    let curve = match curve {
        Some(curve) => curve,
        None => curve_of_png(BufReader::new(open_file()?)).unwrap_or(Curve::Srgb),
    };
    Ok((Texture { width, height, pixels: Arc::new(linear_pixels(image, curve)), wrap }, has_bytes))
}

/// The curve that a PNG file states before its pixels: the chunk `gAMA` has the exponent with which light was encoded, times
/// 100,000, and a chunk `sRGB` has precedence over it. `None` if there is neither.
fn curve_of_png(mut file: impl Read + Seek) -> Option<Curve> {
    file.seek(SeekFrom::Start(8)).ok()?; // behind the signature
    let mut gamma = None;
    loop {
        let mut head = [0; 12]; // length and name of the chunk, and the first four bytes of its data or checksum
        file.read_exact(&mut head).ok()?;
        let number = |at: usize| u32::from_be_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]);
        match &head[4..8] {
            b"sRGB" => return Some(Curve::Srgb),
            b"gAMA" => gamma = Some(number(8)).filter(|&gamma| gamma > 0),
            b"IDAT" => break,
            _ => {}
        }
        file.seek_relative(i64::from(number(0))).ok()?; // the rest of the data, and the checksum
    }
    // Files for screens state 1/2.2, which stands for sRGB; 1 % is the rounding of common writers.
    gamma.map(|gamma| match (45_000..=46_000).contains(&gamma) {
        true => Curve::Srgb,
        false => Curve::Power(100_000.0 / gamma as f32),
    })
}

/// The pixels row by row from the top, in linear light; transparency is ignored.
fn linear_pixels(image: DynamicImage, curve: Curve) -> Vec<Vec3> {
    let to_linear = |encoded: f32| match curve {
        Curve::Srgb => decode_srgb(encoded),
        Curve::Power(power) => encoded.powf(power),
    };
    match image {
        // High dynamic range files already store linear light.
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            image.to_rgb32f().pixels().map(|pixel| Vec3::from_array(pixel.0)).collect()
        }
        DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => {
            let decode = |code: u16| to_linear(f32::from(code) / 65_535.0);
            image.to_rgb16().pixels().map(|pixel| Vec3::from_array(pixel.0.map(decode))).collect()
        }
        // Compute the power once for each of the 256 codes, instead of three times per pixel.
        _ => {
            let table: [f32; 256] = std::array::from_fn(|code| to_linear(code as f32 / 255.0));
            let decode = |code: u8| table[usize::from(code)];
            image.to_rgb8().pixels().map(|pixel| Vec3::from_array(pixel.0.map(decode))).collect()
        }
    }
}
