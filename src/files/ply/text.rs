//! Text from files that may hold any bytes: words with their places.

use crate::files::error::LoadError;
use std::borrow::Cow;
use std::ops::Range;
use std::path::Path;

/// A word of a file without blanks, and its place.
#[derive(Clone, Debug)]
pub(crate) struct Word<'a> {
    /// The characters of the word.
    pub text: &'a str,
    /// The byte range of the word in its file.
    pub span: Range<usize>,
}

/// The content of `file`; fails with advice if it does not exist or cannot be read.
pub(crate) fn read_bytes(file: &Path) -> Result<Vec<u8>, LoadError> {
    std::fs::read(file).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => LoadError::new(file, "there is no such file")
            .help("check the spelling; paths are relative to the directory in which the command was started"),
        _ => LoadError::new(file, format!("the file cannot be read: {error}"))
            .help("check that it is a file and that you may read it"),
    })
}

/// The bytes as text of the same length: each byte that is not valid UTF-8 becomes one `?`. Comments in older
/// encodings are common, and a place in this text must be the same place in the file.
pub(crate) fn readable(bytes: &[u8]) -> Cow<'_, str> {
    if let Ok(text) = std::str::from_utf8(bytes) {
        return Cow::Borrowed(text);
    }
    let mut text = String::with_capacity(bytes.len());
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(|_| '?'));
    }
    Cow::Owned(text)
}

/// An error at the bytes `span` of `bytes`, the content of `file`; lines may also end with a carriage return
/// alone.
///
/// # Panics
///
/// If `span` ends after `bytes`.
pub(crate) fn trouble_at(
    file: &Path,
    bytes: &[u8],
    span: Range<usize>,
    message: impl Into<String>,
) -> LoadError {
    // Count lines only in the text before the error, because the rest may be megabytes of binary data.
    let text = readable(&bytes[..span.end]);
    // Lines of very old files end with a carriage return alone.
    let text = if text.contains('\n') { text } else { text.replace('\r', "\n").into() };
    LoadError::at(file, &text, span, message)
}

/// The words of `line` between ASCII blanks; `start` is the byte of the file at which the line begins.
pub(crate) fn words(line: &str, start: usize) -> Vec<Word<'_>> {
    line.split_ascii_whitespace()
        .map(|text| {
            let offset = start + text.as_ptr() as usize - line.as_ptr() as usize;
            Word { text, span: offset..offset + text.len() }
        })
        .collect()
}

/// The number that `word` spells, if it spells one. It is NaN for the spellings of C libraries as well: `-nan(ind)`,
/// `1.#QNAN`, and infinities such as `-1.#INF`.
pub(crate) fn number(word: &str) -> Option<f64> {
    word.parse().ok().or_else(|| {
        let word = word.trim_start_matches(['+', '-']).to_ascii_lowercase();
        (word.starts_with("nan(") || word.starts_with("1.#")).then_some(f64::NAN)
    })
}

/// The advice for an OBJ file that has another extension.
pub(crate) const LOOKS_LIKE_OBJ: &str = "it looks like an OBJ file: give it the ending `.obj`";

/// Advice for a file that is not a mesh of the expected format, judged by its first bytes; `None` if they are
/// not recognised. Leading blanks and comments are ignored.
pub(crate) fn guess(bytes: &[u8]) -> Option<&'static str> {
    const SIGNS: [(&[u8], &str); 17] = [
        (b"\xff\xfe", "it is text in UTF-16: save it as UTF-8"),
        (b"\xfe\xff", "it is text in UTF-16: save it as UTF-8"),
        (b"ply", "it looks like a PLY file: give it the ending `.ply`"),
        (b"PLY", "the first line has to be `ply` in small letters"),
        (b"solid", "it looks like an STL file: export the mesh as PLY or OBJ"),
        (b"OFF", "it looks like an OFF file: export the mesh as PLY or OBJ"),
        (b"glTF", "it looks like a glTF file: export the mesh as PLY or OBJ"),
        (b"{", "it looks like JSON, perhaps a glTF file: export the mesh as PLY or OBJ"),
        (
            b"<",
            "it looks like a web page, perhaps an error page saved by a download: download the file again",
        ),
        (b"version https://git-lfs", "it is only a pointer to the real file: run `git lfs pull`"),
        (b"\x1f\x8b", "it is compressed: unpack it with `gunzip` first"),
        (b"PK", "it is a zip archive: unpack it first"),
        (b"\x89PNG", "it is a PNG picture: the mesh is another file"),
        (b"mtllib ", LOOKS_LIKE_OBJ),
        (b"o ", LOOKS_LIKE_OBJ),
        (b"v ", LOOKS_LIKE_OBJ),
        (b"newmtl ", "it looks like a material library: the mesh is the OBJ file that names it"),
    ];
    // Skip the comments with which OBJ files often begin.
    let mut bytes = bytes.trim_ascii_start();
    while bytes.starts_with(b"#") {
        let end = bytes.iter().position(|&byte| byte == b'\n').unwrap_or(bytes.len());
        bytes = bytes[end..].trim_ascii_start();
    }
    SIGNS.iter().find(|(sign, _)| bytes.starts_with(sign)).map(|&(_, advice)| advice)
}

/// Calls `check` with every prefix of `original`, and with 5000 copies in which bytes have been changed,
/// removed or repeated. The copies are the same in each run.
#[cfg(test)]
pub(crate) fn mutations(original: &[u8], mut check: impl FnMut(&[u8])) {
    (0..original.len()).for_each(|length| check(&original[..length]));

    // A linear congruential generator (Knuth's constants); its high bits are good enough here.
    let mut state = 1_u64;
    let mut below = |bound: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % bound
    };
    for _ in 0..5_000 {
        let mut bytes = original.to_vec();
        for _ in 0..=below(4) {
            let (at, byte) = (below(bytes.len()), b"\0\n\r -+.0123456789/#\\eluxvf\xff\xc3"[below(28)]);
            match below(5) {
                0 => bytes[at] = byte,
                1 => bytes[at] = below(256) as u8,
                2 => bytes.insert(at, byte),
                3 => drop(bytes.drain(at..(at + 1 + below(8)).min(bytes.len() - 1).max(at))),
                _ => bytes.extend_from_within(at..),
            }
        }
        check(&bytes);
    }
}
