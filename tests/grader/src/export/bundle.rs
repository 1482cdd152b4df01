//! Packs the whole kit into a zip.

use super::COURSE;
use crate::course::CourseFiles;
use crate::files_below::files_below;
use anyhow::{Context, Result};
use std::fs;
use std::io::{Cursor, Write};
use std::path::Path;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// The parts of the kit that are needed to build it and to grade.
const PARTS: [&str; 11] = [
    ".cargo",
    "Cargo.lock",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "exercises",
    "rustfmt.toml",
    "scenes",
    "solutions",
    "src",
    "tests",
];

/// Folders that are generated or that only authors need.
const LEFT_OUT: [&str; 3] = ["target", "tests/corpus", "tests/grader/target"];

/// Returns a zip of the kit, these executable scripts and the course file. The same kit gives the same bytes.
pub(super) fn zip(root: &Path, scripts: &[(&str, String)], course: Option<&CourseFiles>) -> Result<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in scripts {
        zip.start_file(*name, SimpleFileOptions::default().unix_permissions(0o755))?;
        zip.write_all(text.as_bytes())?;
    }
    for (name, text) in course.iter().flat_map(|files| [&files.course].into_iter().chain(&files.language)) {
        zip.start_file(format!("{COURSE}/{name}"), SimpleFileOptions::default().unix_permissions(0o644))?;
        zip.write_all(text.as_bytes())?;
    }
    for part in PARTS {
        for path in files_below(root, part, &|path| !LEFT_OUT.contains(&path))? {
            zip.start_file(&*path, SimpleFileOptions::default().unix_permissions(0o644))?;
            zip.write_all(&fs::read(root.join(&path)).with_context(|| format!("cannot read {path}"))?)?;
        }
    }
    Ok(zip.finish()?.into_inner())
}
