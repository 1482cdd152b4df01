//! Material libraries of OBJ files: files with the extension `.mtl`.

use super::{ObjMaterial, lines};
use crate::files::error::{LoadError, Warnings};
use crate::files::ply::text::{Word, read_bytes, readable, words};
use crate::files::words::quoted;
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
    let path_of = |name: &str| directory.join(name.trim_matches('"').replace('\\', "/"));
    // The format separates names by blanks, but many tools write one name that contains blanks, and some put names
    // between quotes.
    let whole = span.start..span.start + text[span.clone()].trim_end().len();
    let Some(names) = lines::name(text, span.clone()) else { return Vec::new() };
    if let Some(path) =
        [whole, names.clone()].map(|place| path_of(&text[place])).into_iter().find(|p| p.is_file())
    {
        return vec![path];
    }
    let mut paths = Vec::new();
    for (index, part) in text[names.clone()].split('"').enumerate() {
        let start = part.as_ptr() as usize - text.as_ptr() as usize;
        let in_quotes = Word { text: part, span: start..start + part.len() };
        for name in if index % 2 == 1 { vec![in_quotes] } else { words(part, start) } {
            let path = path_of(name.text);
            if path.is_file() {
                paths.push(path);
                continue;
            }
            let message = format!("there is no material library {}", quoted(name.text));
            warnings.push(LoadError::at(file, text, name.span, message).help(format!(
                "looked for {}: put the library there, or remove the `mtllib` line",
                path.display()
            )));
        }
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
        current: Current::default(),
        warnings: Warnings::default(),
    };
    let mut start = if text.starts_with('\u{feff}') { 3 } else { 0 };
    for line in text[start..].split('\n') {
        reader.line(line, start);
        start += line.len() + 1;
    }
    reader.end_material();
    warnings.extend(reader.warnings.list());

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
    current: Current,
    warnings: Warnings,
}

/// What is known of the material that is being read, because its values depend on each other.
#[derive(Default)]
struct Current {
    /// Whether it has a line `d`, which has precedence over `Tr`.
    opacity_given: bool,
    /// Whether light passes through it, by `d` or `Tr`.
    transparent: bool,
    /// Whether its index of refraction is not 1.
    refracts: bool,
    /// Whether its specular colour is not black.
    highlight: bool,
    /// The number after `Ns`, and its place.
    exponent: Option<(f32, Range<usize>)>,
    /// The number after `illum`, and its place.
    illumination: Option<(u32, Range<usize>)>,
}

impl Reader<'_> {
    fn trouble(&self, span: Range<usize>, message: impl Into<String>) -> LoadError {
        LoadError::at(self.file, self.text, span, message)
    }

    fn warn(&mut self, span: Range<usize>, message: &str, help: &str) {
        self.warnings.add(help, || LoadError::at(self.file, self.text, span, message));
    }

    /// Copies a line that can be used, or adds a warning.
    fn line(&mut self, line: &str, start: usize) {
        let words = words(line, start);
        let Some((keyword, rest)) = words.split_first() else { return };
        match self.checked(keyword, rest) {
            Ok(Some(clean)) if self.named => self.clean.push_str(&format!("{clean}\n")),
            Ok(Some(_)) => {
                let message = format!("`{}` before the first `newmtl`; the line is ignored", keyword.text);
                let help = "put `newmtl` and a name above the values of each material";
                self.warn(keyword.span.clone(), &message, help);
            }
            Ok(None) => {}
            Err(error) => {
                let help = error.help.clone().unwrap_or_default();
                let message = format!("{}; the line is ignored", error.message);
                self.warnings.add(&help, || LoadError { message, ..error });
            }
        }
    }

    /// The line as `tobj` gets it, or `None` if it is not needed. Some exporters write keywords in small letters.
    fn checked(&mut self, keyword: &Word, rest: &[Word]) -> Result<Option<String>, LoadError> {
        let comment = rest.iter().position(|word| word.text.starts_with('#')).unwrap_or(rest.len());
        let values = &rest[..comment];
        Ok(Some(match &*keyword.text.to_ascii_lowercase() {
            "newmtl" => {
                let name = self.name(keyword, rest, "give it one, as in `newmtl red`")?;
                self.end_material();
                self.named = true;
                format!("newmtl {name}")
            }
            "ka" => self.color("Ka", keyword, values, 1.0)?,
            "kd" => self.color("Kd", keyword, values, 1.0)?,
            "ke" => self.color("Ke", keyword, values, f32::MAX)?,
            "ks" => {
                let clean = self.color("Ks", keyword, values, 1.0)?;
                self.current.highlight = clean != "Ks 0.0 0.0 0.0";
                clean
            }
            "ns" => {
                let exponent = self.in_range(keyword, values, 0.0..=f32::MAX)?;
                self.current.exponent = Some((exponent, values[0].span.clone()));
                format!("Ns {exponent:?}")
            }
            // No real material has such an index: the bounds only exclude values that cannot be an index of refraction.
            // Exporters write 0 for "none".
            "ni" => {
                let [mut index] = self.numbers(keyword, values)?;
                if !(0.001..=1000.0).contains(&index) {
                    let message = format!("`Ni` is {index}, which is no index of refraction; 1 is used");
                    let help = "write `Ni 1.5` for glass, or `Ni 1` for an opaque material";
                    self.warn(values[0].span.clone(), &message, help);
                    index = 1.0;
                }
                self.current.refracts = index != 1.0;
                format!("Ni {index:?}")
            }
            "d" => {
                // `d -halo 0.5` makes the opacity depend on the angle; only its number is used.
                let halo = values.first().is_some_and(|word| word.text == "-halo");
                let opacity = self.in_range(keyword, &values[usize::from(halo)..], 0.0..=1.0)?;
                self.current.opacity_given = true;
                self.current.transparent = opacity < 1.0;
                format!("d {opacity:?}")
            }
            "tr" => {
                let transparency = self.in_range(keyword, values, 0.0..=1.0)?;
                if self.current.opacity_given {
                    return Ok(None);
                }
                self.current.transparent = transparency > 0.0;
                format!("d {:?}", 1.0 - transparency)
            }
            "illum" => {
                // A model that is not a number is ignored: it changes nothing.
                if let Some(word) = values.first()
                    && let Ok(model) = word.text.parse()
                {
                    self.current.illumination = Some((model, word.span.clone()));
                }
                return Ok(None);
            }
            "map_kd" => {
                let image = after_options(rest);
                let name = self.name(keyword, image, "name an image, as in `map_Kd wood.png`")?;
                if image.len() < rest.len() {
                    let help = "scale or move the texture coordinates of the mesh instead";
                    self.warn(rest[0].span.clone(), "the options of `map_Kd` are ignored", help);
                }
                format!("map_Kd {}", name.trim_matches('"').replace('\\', "/"))
            }
            "map_d" => {
                let help = "cut the holes out of the mesh";
                self.warn(keyword.span.clone(), "`map_d` is ignored: an image gives no opacity", help);
                return Ok(None);
            }
            _ => return Ok(None),
        }))
    }

    /// Warns if the material that ends here asks for an illumination model that differs from what is rendered, which is
    /// the Phong model (`illum 2`) with transmission by `d`.
    fn end_material(&mut self) {
        let Current { transparent, refracts, highlight, exponent, illumination, .. } =
            std::mem::take(&mut self.current);
        // With such an exponent the highlight would cover all that is lit. Exporters write it for materials without one.
        if let Some((exponent, span)) = exponent.filter(|(exponent, _)| highlight && *exponent < 1.0) {
            let message =
                format!("`Ns` is {exponent}, so the highlight of `Ks` has no edge; none is rendered");
            self.warn(span, &message, "write an exponent of at least 1, for example `Ns 30`");
            self.clean.push_str("Ks 0 0 0\n");
        }
        let Some((model, span)) = illumination else { return };
        let asks = match model {
            0 => "asks for a constant colour, but the material is shaded",
            1 if highlight => "asks for no highlight, but `Ks` gives the material one",
            1 | 2 => return,
            3 | 5 | 8 => "asks for reflections, which MTL files have no value for; none are rendered",
            4 | 6 | 7 | 9 if transparent && refracts => return,
            4 | 6 | 7 | 9 => "asks for glass, but only `d` below 1 and `Ni` other than 1 give glass",
            _ => "is not a model that is rendered; the Phong model is used",
        };
        let help = "define a material of the same name in the scene, for example with `mirror`";
        self.warn(span, &format!("`illum {model}` {asks}"), help);
    }

    /// A name, which may contain blanks and ends at a comment.
    fn name(&self, keyword: &Word, rest: &[Word], help: &str) -> Result<String, LoadError> {
        let place = rest.first().zip(rest.last()).map(|(first, last)| first.span.start..last.span.end);
        match place.and_then(|place| lines::name(self.text, place)) {
            Some(place) => Ok(self.text[place].into()),
            None => {
                let message = format!("`{}` without a name", keyword.text);
                Err(self.trouble(keyword.span.clone(), message).help(help))
            }
        }
    }

    /// The line of a colour: three numbers, or one for a grey. Each is at least 0 and at most `most`: a surface that
    /// reflects more than all light would make light.
    fn color(&mut self, name: &str, keyword: &Word, values: &[Word], most: f32) -> Result<String, LoadError> {
        if let [word, ..] = values
            && ["spectral", "xyz"].contains(&word.text)
        {
            return Err(self
                .trouble(word.span.clone(), format!("a colour as {} is not supported", quoted(word.text)))
                .help("write red, green and blue, as in `Kd 0.8 0.2 0.2`"));
        }
        let colour = match values.len() {
            1 => [self.numbers::<1>(keyword, values)?[0]; 3],
            _ => self.numbers::<3>(keyword, values)?,
        };
        let [r, g, b] = colour.map(|component| component.clamp(0.0, most));
        if let Some(outside) = colour.iter().position(|component| !(0.0..=most).contains(component)) {
            let span = values[outside.min(values.len() - 1)].span.clone();
            let nearest = [r, g, b][outside];
            let message = format!("`{name}` has the component {}; {nearest} is used", colour[outside]);
            let help = match most {
                f32::MAX => "write a number of at least 0",
                _ => "write a number from 0 to 1: the fraction of light that is reflected",
            };
            self.warn(span, &message, help);
        }
        Ok(format!("{name} {r:?} {g:?} {b:?}"))
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
            self.warn(values[0].span.clone(), &message, &help);
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
                self.trouble(word.span.clone(), format!("{} is not a number", quoted(word.text)))
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
