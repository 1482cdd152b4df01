//! Material libraries of OBJ files: files with the extension `.mtl`.

use super::ObjMaterial;
use crate::files::error::LoadError;
use crate::files::ply::text::{Word, quote, read_bytes, readable, words};
use glam::Vec3;
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};

/// The paths of the libraries that an `mtllib` line names at the bytes `span` of the OBJ file, relative to its
/// folder. A library that does not exist adds a warning.
pub(super) fn find(
    file: &Path,
    text: &str,
    span: &Range<usize>,
    warnings: &mut Vec<LoadError>,
) -> Vec<PathBuf> {
    let directory = file.parent().unwrap_or(Path::new(""));
    let names = &text[span.clone()];
    // The format separates names by blanks, but many tools write one name that contains blanks, and some put it
    // between quotes.
    let whole = directory.join(names.trim_matches('"').replace('\\', "/"));
    if whole.is_file() {
        return vec![whole];
    }
    let mut paths = Vec::new();
    for name in words(names, span.start) {
        let path = directory.join(name.text.replace('\\', "/"));
        if path.is_file() {
            paths.push(path);
            continue;
        }
        let message = format!("there is no material library {}", quote(name.text));
        warnings.push(LoadError::at(file, text, name.span, message).help(format!(
            "looked for {}: put the library there, or remove the `mtllib` line",
            path.display()
        )));
    }
    paths
}

/// Reads all materials of the library `file`, in the order of the file. A library that cannot be read has none, and
/// adds a warning.
pub(super) fn read(file: &Path, warnings: &mut Vec<LoadError>) -> Vec<ObjMaterial> {
    match read_bytes(file) {
        Ok(bytes) => parse(file, &bytes, warnings),
        Err(error) => {
            warnings.push(error);
            Vec::new()
        }
    }
}

/// Reads all materials from the bytes of a library. A mesh can be shown without any line of it, so nothing here is an
/// error: a line that cannot be used is left out, a number out of range is replaced by the nearest one in range, and each
/// adds a warning.
///
/// As in the OBJ file, `tobj` gets only lines that have been checked, because a colour with two numbers makes
/// it panic.
pub(super) fn parse(file: &Path, bytes: &[u8], warnings: &mut Vec<LoadError>) -> Vec<ObjMaterial> {
    let text = readable(bytes);
    let mut reader = Reader {
        file,
        text: &text,
        clean: String::new(),
        named: false,
        opacity_given: false,
        illumination: None,
        highlight: false,
        illumination_warned: false,
        warnings,
    };
    let mut start = if text.starts_with('\u{feff}') { 3 } else { 0 };
    for line in text[start..].split('\n') {
        reader.line(line, start);
        start += line.len() + 1;
    }
    reader.end_material();

    let directory = file.parent().unwrap_or(Path::new(""));
    match tobj::load_mtl_buf(&mut reader.clean.as_bytes()) {
        Ok((materials, _)) => materials.into_iter().map(|material| convert(material, directory)).collect(),
        Err(error) => {
            let message = format!("the library cannot be read: {error}");
            warnings.push(LoadError::new(file, message).help("export it again"));
            Vec::new()
        }
    }
}

fn convert(material: tobj::Material, directory: &Path) -> ObjMaterial {
    ObjMaterial {
        name: material.name,
        ambient: material.ambient.map(Vec3::from),
        diffuse: material.diffuse.map(Vec3::from),
        specular: material.specular.map(Vec3::from),
        shininess: material.shininess,
        index_of_refraction: material.optical_density,
        dissolve: material.dissolve,
        diffuse_texture: material.diffuse_texture.map(|name| directory.join(name)),
        emission: material.emissive.map(Vec3::from),
    }
}

struct Reader<'a> {
    file: &'a Path,
    text: &'a str,
    /// The valid lines that are used.
    clean: String,
    /// Whether a `newmtl` line has been seen.
    named: bool,
    /// Whether the current material has a line `d`, which has precedence over `Tr`.
    opacity_given: bool,
    /// The number after `illum` of the current material, and its place.
    illumination: Option<(u32, Range<usize>)>,
    /// Whether the current material has a specular colour that is not black.
    highlight: bool,
    /// Whether a warning about `illum` was given. One is enough for a library: exporters write the same in all materials.
    illumination_warned: bool,
    warnings: &'a mut Vec<LoadError>,
}

impl Reader<'_> {
    fn trouble(&self, span: Range<usize>, message: impl Into<String>) -> LoadError {
        LoadError::at(self.file, self.text, span, message)
    }

    /// Copies a line that can be used, or adds a warning.
    fn line(&mut self, line: &str, start: usize) {
        let words = words(line, start);
        let Some((keyword, rest)) = words.split_first() else { return };
        match self.checked(keyword, rest) {
            Ok(Some(clean)) if self.named => self.clean.push_str(&format!("{clean}\n")),
            Ok(Some(_)) => {
                let message = format!("`{}` before the first `newmtl`; the line is ignored", keyword.text);
                let warning = self
                    .trouble(keyword.span.clone(), message)
                    .help("put `newmtl` and a name above the values of each material");
                self.warnings.push(warning);
            }
            Ok(None) => {}
            Err(error) => {
                let message = format!("{}; the line is ignored", error.message);
                self.warnings.push(LoadError { message, ..error });
            }
        }
    }

    /// The line as `tobj` gets it, or `None` if it is not needed.
    fn checked(&mut self, keyword: &Word, rest: &[Word]) -> Result<Option<String>, LoadError> {
        let comment = rest.iter().position(|word| word.text.starts_with('#')).unwrap_or(rest.len());
        let values = &rest[..comment];
        Ok(Some(match keyword.text {
            "newmtl" => {
                let name = self.name(keyword, rest, "give it one, as in `newmtl red`")?;
                self.end_material();
                self.named = true;
                format!("newmtl {name}")
            }
            "Ka" | "Kd" | "Ks" | "Ke" => {
                let [r, g, b] = self.colour(keyword, values)?;
                self.highlight |= keyword.text == "Ks" && (r, g, b) != (0.0, 0.0, 0.0);
                format!("{} {r:?} {g:?} {b:?}", keyword.text)
            }
            "Ns" => format!("Ns {:?}", self.in_range(keyword, values, 0.0..=f32::MAX)?),
            // No real material has such an index: the bounds only exclude values that cannot be an index of refraction.
            // Exporters write 0 for "none".
            "Ni" => {
                let [index] = self.numbers(keyword, values)?;
                if (0.001..=1000.0).contains(&index) {
                    format!("Ni {index:?}")
                } else {
                    let message = format!("`Ni` is {index}, which is no index of refraction; 1 is used");
                    let help = "write `Ni 1.5` for glass, or `Ni 1` for an opaque material";
                    self.warnings.push(self.trouble(values[0].span.clone(), message).help(help));
                    "Ni 1.0".into()
                }
            }
            "d" => {
                // `d -halo 0.5` makes the opacity depend on the angle; only its number is used.
                let halo = values.first().is_some_and(|word| word.text == "-halo");
                let opacity = self.in_range(keyword, &values[usize::from(halo)..], 0.0..=1.0)?;
                self.opacity_given = true;
                format!("d {opacity:?}")
            }
            "Tr" => {
                let transparency = self.in_range(keyword, values, 0.0..=1.0)?;
                if self.opacity_given {
                    return Ok(None);
                }
                format!("d {:?}", 1.0 - transparency)
            }
            "illum" => {
                // A model that is not a number is ignored: it changes nothing.
                if let Some(word) = values.first()
                    && let Ok(model) = word.text.parse()
                {
                    self.illumination = Some((model, word.span.clone()));
                }
                return Ok(None);
            }
            "map_Kd" => {
                let name =
                    self.name(keyword, after_options(rest), "name an image, as in `map_Kd wood.png`")?;
                format!("map_Kd {}", name.replace('\\', "/"))
            }
            _ => return Ok(None),
        }))
    }

    /// Warns if the material that ends here asks for an illumination model that differs from what is rendered, which is
    /// the Phong model (`illum 2`) with transmission by `d`.
    fn end_material(&mut self) {
        self.opacity_given = false;
        let highlight = std::mem::take(&mut self.highlight);
        let Some((model, span)) = self.illumination.take() else { return };
        let asks = match model {
            0 => "asks for a constant colour, but the material is shaded",
            1 if highlight => "asks for no highlight, but `Ks` gives the material one",
            1 | 2 => return,
            3 | 5 | 8 => "asks for reflections, which MTL files have no value for; none are rendered",
            4 | 6 | 7 | 9 => {
                "asks for glass with reflections, which MTL files have no value for; only `d` is rendered"
            }
            _ => "is not a model that is rendered; the Phong model is used",
        };
        if !std::mem::replace(&mut self.illumination_warned, true) {
            let warning = self
                .trouble(span, format!("`illum {model}` {asks}"))
                .help("define a material of the same name in the scene, for example with `mirror`");
            self.warnings.push(warning);
        }
    }

    /// A name, which may contain blanks.
    fn name(&self, keyword: &Word, rest: &[Word], help: &str) -> Result<String, LoadError> {
        match rest {
            [first, .., last] => Ok(self.text[first.span.start..last.span.end].into()),
            [only] => Ok(only.text.into()),
            [] => {
                let message = format!("`{}` without a name", keyword.text);
                Err(self.trouble(keyword.span.clone(), message).help(help))
            }
        }
    }

    /// Three numbers, or one for a grey; each is at least 0.
    fn colour(&mut self, keyword: &Word, values: &[Word]) -> Result<[f32; 3], LoadError> {
        if let [word, ..] = values
            && ["spectral", "xyz"].contains(&word.text)
        {
            return Err(self
                .trouble(word.span.clone(), format!("a colour as {} is not supported", quote(word.text)))
                .help("write red, green and blue, as in `Kd 0.8 0.2 0.2`"));
        }
        let colour = match values.len() {
            1 => [self.numbers::<1>(keyword, values)?[0]; 3],
            _ => self.numbers::<3>(keyword, values)?,
        };
        if let Some(below) = colour.iter().position(|&component| component < 0.0) {
            let span = values[below.min(values.len() - 1)].span.clone();
            let message = format!("`{}` has the component {}; 0 is used", keyword.text, colour[below]);
            self.warnings.push(self.trouble(span, message).help("write a number of at least 0"));
        }
        Ok(colour.map(|component| component.max(0.0)))
    }

    /// One number; the nearest number in `range` if it is outside.
    fn in_range(
        &mut self,
        keyword: &Word,
        values: &[Word],
        range: RangeInclusive<f32>,
    ) -> Result<f32, LoadError> {
        let [number] = self.numbers(keyword, values)?;
        let nearest = number.clamp(*range.start(), *range.end());
        if nearest != number {
            let message = format!("`{}` is {number}; {nearest} is used", keyword.text);
            let help = match *range.end() {
                f32::MAX => format!("write a number of at least {}", range.start()),
                end => format!("write a number from {} to {end}", range.start()),
            };
            self.warnings.push(self.trouble(values[0].span.clone(), message).help(help));
        }
        Ok(nearest)
    }

    /// The first `N` of the values, each finite.
    fn numbers<const N: usize>(&self, keyword: &Word, values: &[Word]) -> Result<[f32; N], LoadError> {
        if values.len() < N {
            let noun = if N == 1 { "number" } else { "numbers" };
            let message = format!("`{}` needs {N} {noun}, but has {}", keyword.text, values.len());
            return Err(self.trouble(keyword.span.clone(), message).help("write them on the same line"));
        }
        let mut numbers = [0.0; N];
        for (number, word) in numbers.iter_mut().zip(values) {
            *number = word.text.parse().ok().filter(|number: &f32| number.is_finite()).ok_or_else(|| {
                self.trouble(word.span.clone(), format!("{} is not a number", quote(word.text)))
                    .help("replace it by a number, with a decimal point and not a comma")
            })?;
        }
        Ok(numbers)
    }
}

/// The words after the options of an image, as in `map_Kd -clamp on -s 2 2 1 wood.png`.
fn after_options<'a, 'b>(mut rest: &'b [Word<'a>]) -> &'b [Word<'a>] {
    while let [option, values @ ..] = rest {
        let most = match option.text {
            "-o" | "-s" | "-t" => 3,
            "-mm" => 2,
            "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-clamp" | "-imfchan" | "-texres"
            | "-type" => 1,
            _ => return rest,
        };
        // Options of three numbers may have fewer; the name of an image is not a number.
        let numbers = values.iter().take(most).take_while(|word| word.text.parse::<f32>().is_ok()).count();
        rest = &values[if most == 1 { values.len().min(1) } else { numbers }..];
    }
    rest
}
