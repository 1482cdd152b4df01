//! Material libraries of OBJ files: files with the extension `.mtl`.

use super::ObjMaterial;
use crate::scene::error::LoadError;
use crate::scene::ply::text::{Word, quote, read_bytes, readable, words};
use glam::Vec3;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The paths of the libraries that an `mtllib` line names at the bytes `span` of the OBJ file; fails if one
/// of them does not exist. Names are relative to the folder of the OBJ file.
pub(super) fn find(file: &Path, text: &str, span: &Range<usize>) -> Result<Vec<PathBuf>, LoadError> {
    let directory = file.parent().unwrap_or(Path::new(""));
    let names = &text[span.clone()];
    // The format separates names by blanks, but many tools write one name that contains blanks.
    let whole = directory.join(names.replace('\\', "/"));
    if whole.is_file() {
        return Ok(vec![whole]);
    }
    words(names, span.start)
        .into_iter()
        .map(|name| {
            let path = directory.join(name.text.replace('\\', "/"));
            if path.is_file() {
                return Ok(path);
            }
            let message = format!("there is no material library {}", quote(name.text));
            Err(LoadError::at(file, text, name.span, message).help(format!(
                "looked for {}: put the library there, or remove the `mtllib` line",
                path.display()
            )))
        })
        .collect()
}

/// Reads all materials of the library `file`, in the order of the file; fails if it cannot be read or is
/// malformed.
pub(super) fn read(file: &Path) -> Result<Vec<ObjMaterial>, LoadError> {
    parse(file, &read_bytes(file)?)
}

/// Reads all materials from the bytes of a library; fails at the first malformed line, and at a value above
/// the first `newmtl`.
///
/// As in the OBJ file, `tobj` gets only lines that have been checked, because a colour with two numbers makes
/// it panic.
pub(super) fn parse(file: &Path, bytes: &[u8]) -> Result<Vec<ObjMaterial>, LoadError> {
    let text = readable(bytes);
    let mut reader = Reader { file, text: &text, clean: String::new(), named: false };
    let mut start = if text.starts_with('\u{feff}') { 3 } else { 0 };
    for line in text[start..].split('\n') {
        reader.line(line, start)?;
        start += line.len() + 1;
    }

    let directory = file.parent().unwrap_or(Path::new(""));
    let (materials, _) = tobj::load_mtl_buf(&mut reader.clean.as_bytes()).map_err(|error| {
        LoadError::new(file, format!("the library cannot be read: {error}")).help("export it again")
    })?;
    Ok(materials.into_iter().map(|material| convert(material, directory)).collect())
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
}

impl Reader<'_> {
    fn trouble(&self, span: Range<usize>, message: impl Into<String>) -> LoadError {
        LoadError::at(self.file, self.text, span, message)
    }

    fn line(&mut self, line: &str, start: usize) -> Result<(), LoadError> {
        let words = words(line, start);
        let Some((keyword, rest)) = words.split_first() else { return Ok(()) };
        let comment = rest.iter().position(|word| word.text.starts_with('#')).unwrap_or(rest.len());
        let clean = match keyword.text {
            "newmtl" => {
                self.named = true;
                self.name(keyword, rest, "give it one, as in `newmtl red`")?
            }
            "Ka" | "Kd" | "Ks" | "Ke" => self.colour(keyword, &rest[..comment])?,
            "Ns" | "Ni" | "d" => {
                // `d -halo 0.5` makes the opacity depend on the angle; only its number is used.
                let halo = rest.first().is_some_and(|word| word.text == "-halo");
                self.numbers(keyword, &rest[usize::from(halo)..comment], 1)?
            }
            "map_Kd" => {
                let name =
                    self.name(keyword, after_options(rest), "name an image, as in `map_Kd wood.png`")?;
                name.replace('\\', "/")
            }
            _ => return Ok(()),
        };
        if !self.named {
            let message = format!("`{}` before the first `newmtl`", keyword.text);
            return Err(self
                .trouble(keyword.span.clone(), message)
                .help("put `newmtl` and a name above the values of each material"));
        }
        self.clean.push_str(&format!("{} {clean}\n", keyword.text));
        Ok(())
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

    /// Three numbers, or one for a grey, as text for `tobj`.
    fn colour(&self, keyword: &Word, values: &[Word]) -> Result<String, LoadError> {
        if let [word, ..] = values
            && ["spectral", "xyz"].contains(&word.text)
        {
            return Err(self
                .trouble(word.span.clone(), format!("a colour as {} is not supported", quote(word.text)))
                .help("write red, green and blue, as in `Kd 0.8 0.2 0.2`"));
        }
        if values.len() != 1 {
            return self.numbers(keyword, values, 3);
        }
        let grey = self.numbers(keyword, values, 1)?;
        Ok(format!("{grey} {grey} {grey}"))
    }

    fn numbers(&self, keyword: &Word, values: &[Word], count: usize) -> Result<String, LoadError> {
        if values.len() < count {
            let noun = if count == 1 { "number" } else { "numbers" };
            let message = format!("`{}` needs {count} {noun}, but has {}", keyword.text, values.len());
            return Err(self.trouble(keyword.span.clone(), message).help("write them on the same line"));
        }
        for word in &values[..count] {
            if !word.text.parse().is_ok_and(f32::is_finite) {
                return Err(self
                    .trouble(word.span.clone(), format!("{} is not a number", quote(word.text)))
                    .help("replace it by a number, with a decimal point and not a comma"));
            }
        }
        let texts: Vec<&str> = values[..count].iter().map(|word| word.text).collect();
        Ok(texts.join(" "))
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
