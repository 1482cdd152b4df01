//! How things are told: numbers that can be read, and errors in files with the line drawn.

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use anyhow::{Result, anyhow};
use raykata::scene::error::LoadError;
use raykata::scene::{Scene, load};
use std::fmt;
use std::io::IsTerminal;
use std::path::Path;

/// A number with a comma between thousands.
pub struct Thousands(pub u64);

impl fmt::Display for Thousands {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = self.0.to_string();
        let mut grouped = String::new();
        for (i, digit) in digits.chars().enumerate() {
            if i > 0 && (digits.len() - i).is_multiple_of(3) {
                grouped.push(',');
            }
            grouped.push(digit);
        }
        f.pad(&grouped)
    }
}

/// A size in bytes, in the unit that leaves a number of people's size.
pub struct Bytes(pub u64);

impl fmt::Display for Bytes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bytes = self.0 as f64;
        let text = match self.0 {
            0..10_000 => format!("{bytes} B"),
            10_000..1_000_000 => format!("{:.0} kB", bytes / 1e3),
            1_000_000..1_000_000_000 => format!("{:.1} MB", bytes / 1e6),
            _ => format!("{:.1} GB", bytes / 1e9),
        };
        f.pad(&text)
    }
}

/// Reads a scene; an error shows the line that is to blame.
pub fn load_scene(file: &Path) -> Result<Scene> {
    load::load(file).map_err(|error| anyhow!(draw(&error)))
}

/// The error with the line that is to blame, as the compiler would draw it.
pub fn draw(error: &LoadError) -> String {
    let text = std::fs::read_to_string(&error.file).unwrap_or_default();
    if error.place.is_none() || error.span.end > text.len() || error.span.is_empty() {
        return error.to_string();
    }
    let path = error.file.display().to_string();
    let snippet =
        Snippet::source(&text).path(&path).annotation(AnnotationKind::Primary.span(error.span.clone()));
    let mut group = Level::ERROR.primary_title(&error.message).element(snippet);
    if let Some(help) = &error.help {
        group = group.element(Level::HELP.message(help));
    }
    let coloured = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let renderer = if coloured { Renderer::styled() } else { Renderer::plain() };
    let drawn = renderer.render(&[group]);
    // The caller says "error: " itself.
    drawn.strip_prefix("error: ").map_or_else(|| drawn.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thousands_are_set_apart() {
        assert_eq!(Thousands(0).to_string(), "0");
        assert_eq!(Thousands(999).to_string(), "999");
        assert_eq!(Thousands(1_000).to_string(), "1,000");
        assert_eq!(Thousands(99_532_800_000_000).to_string(), "99,532,800,000,000");
    }
}
