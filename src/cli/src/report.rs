//! Output for people: readable numbers, errors with the line of the file, and the progress of a frame.

use crate::progress::ProgressBar;
use crate::queue::lock;
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use anyhow::{Context, Result, anyhow};
use raykata::film::write_atomically;
use raykata::frame::{Unwatched, Watch};
use raykata::kit::{Kit, RenderJob, Rendering, View, kit_error};
use raykata::scene::Scene;
use raykata::scene::error::{LoadError, printable};
use raykata::scene::load::{self, Limits, Loaded};
use std::fmt;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::sync::{Mutex, OnceLock};

/// Why words that were to be printed are lost, if any are.
static LOST: OnceLock<std::io::Error> = OnceLock::new();

/// Prints to standard output. If the reader has closed the pipe, as `head` does, the rest of the output is
/// lost; that is not an error, and files are still written. [`lost`] knows other errors.
pub fn say(words: fmt::Arguments<'_>) {
    let mut out = std::io::stdout().lock();
    match out.write_fmt(words).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => _ = LOST.set(error),
        _ => {}
    }
}

/// The first error of [`say`], for the end of a program.
pub fn lost() -> Option<&'static std::io::Error> {
    LOST.get()
}

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

/// A number of things, with their name in the singular or in the plural.
pub fn counted(n: impl Into<u64>, name: &str) -> String {
    let n = n.into();
    format!("{n} {name}{}", if n == 1 { "" } else { "s" })
}

/// A size in bytes, shown in a readable unit.
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

/// Reads a scene within these limits; an error shows the line that is wrong, unless the file is another document than a
/// scene. Warnings are printed to standard error.
pub fn load_scene(file: &Path, limits: Limits) -> Result<Scene> {
    /// The most warnings that are shown: a library of many materials may have the same fault in each.
    const MOST: usize = 10;
    let is_toml = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    let Loaded { scene, warnings } = load::load_within(file, limits).map_err(|error| {
        if file.is_file() && !is_toml {
            let name = printable(&file.display().to_string());
            return anyhow!(
                "{name}: this is no scene\nhelp: scenes are TOML files, such as scenes/showcase.toml"
            );
        }
        anyhow!(draw(Level::ERROR, &error))
    })?;
    for warning in warnings.iter().take(MOST) {
        eprintln!("warning: {}", draw(Level::WARNING, warning));
    }
    if warnings.len() > MOST {
        eprintln!("warning: {} more warnings are not shown", warnings.len() - MOST);
    }
    Ok(scene)
}

/// The same without warnings.
pub fn read_scene(file: &Path) -> Result<Scene> {
    load::load(file).map_err(|error| anyhow!(draw(Level::ERROR, &error)))
}

/// A scene of the kit, for tests.
#[cfg(test)]
pub fn scene_of_kit(name: &str) -> Scene {
    let file = format!("../../scenes/{name}.toml");
    load_scene(Path::new(&file), Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// The scene with at most `pixels` pixels, at least 1, in nearly the same shape. Commands that measure render many pictures of
/// this size.
pub fn with_at_most(pixels: f64, scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let (width, height) = (f64::from(scene.film.width), f64::from(scene.film.height));
    let share = (pixels / (width * height)).sqrt().min(1.0);
    scene.film.width = ((width * share) as u32).max(1);
    scene.film.height = ((height * share) as u32).max(1);
    scene
}

/// The error or warning with the line that is wrong, in the style of the compiler.
fn draw(level: Level<'_>, error: &LoadError) -> String {
    let text = std::fs::read_to_string(&error.file).unwrap_or_default();
    if error.place.is_none() || error.span.end > text.len() || error.span.is_empty() {
        return error.to_string();
    }
    let path = printable(&error.file.display().to_string());
    let (message, help) = (printable(&error.message), error.help.as_deref().map(printable));
    let snippet =
        Snippet::source(&text).path(&path).annotation(AnnotationKind::Primary.span(error.span.clone()));
    let mut group = level.primary_title(&message).element(snippet);
    if let Some(help) = &help {
        group = group.element(Level::HELP.message(help));
    }
    let coloured = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let renderer = if coloured { Renderer::styled() } else { Renderer::plain() };
    let drawn = renderer.render(&[group]);
    // The caller says "error: " or "warning: " itself.
    let plain = drawn.strip_prefix("error: ").or_else(|| drawn.strip_prefix("warning: "));
    plain.map_or_else(|| drawn.clone(), str::to_owned)
}

/// Writes a whole file, which is complete or absent.
pub fn write_file(file: &Path, bytes: &[u8]) -> Result<()> {
    write_atomically(file, |out| out.write_all(bytes))
        .with_context(|| format!("cannot write {}", file.display()))
}

/// The name of a scene, which the default names of its pictures and reports begin with.
pub fn name_of(scene: &Path) -> Result<String> {
    Ok(scene.file_stem().context("the scene has no name")?.to_string_lossy().into_owned())
}

/// A picture of a scene with the seed 0, on all processors, with counts. Structures of the picture before are used again.
pub fn job(scene: Scene) -> RenderJob {
    RenderJob { scene, view: View::Shaded, seed: 0, threads: 0, count: true, reuse: true }
}

/// Renders a picture to its end.
pub fn render(kit: &dyn Kit, job: &RenderJob) -> Result<Rendering> {
    kit_error::catch(|| kit.render(job, &Unwatched))?.context("the frame was cancelled")
}

/// Creates a folder and its parent folders.
pub fn make_folder(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).with_context(|| format!("cannot create the folder {}", folder.display()))
}

/// Creates the folder of `file`.
pub fn make_folder_of(file: &Path) -> Result<()> {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).map_or(Ok(()), make_folder)
}

/// A bar for `n` steps, whose message can name each step; it is drawn on a terminal only.
pub fn bar_of_steps(n: usize) -> ProgressBar {
    ProgressBar::new(n as u64)
}

/// How far the hierarchy of a frame, or another structure, is built.
pub fn words_of_building(placed: u64, total: u64) -> String {
    format!("building the hierarchy: {} of {} primitives", Thousands(placed), Thousands(total))
}

/// The progress of a frame: first its structure, then its pixels. It is drawn on a terminal only.
pub struct FrameBar {
    bar: ProgressBar,
    /// What is being rendered, until its first pixels are finished.
    now: Mutex<Option<String>>,
}

impl FrameBar {
    /// A bar for `what`, which [`FrameBar::begin`] can change.
    pub fn new(what: &str) -> Self {
        let bar = FrameBar { bar: ProgressBar::new(0), now: Mutex::default() };
        bar.begin(what.to_owned());
        bar.bar.tick();
        bar
    }

    /// Starts the progress of something else.
    pub fn begin(&self, what: String) {
        self.bar.begin(what.as_str(), 0);
        *lock(&self.now) = Some(what);
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Watch for FrameBar {
    fn building(&self, placed: u64, total: u64) {
        self.bar.set_message(words_of_building(placed, total));
    }

    fn progress(&self, done: u64, total: u64) {
        // Start the bar again with the first pixels, because the time before them says nothing about that of the others.
        if let Some(what) = lock(&self.now).take() {
            self.bar.begin(what, total);
        }
        self.bar.set(done, total);
    }
}

/// The text in lines of at most `columns` columns. Later lines are indented like the first one, and two columns more.
pub fn wrapped(text: &str, columns: usize) -> Vec<String> {
    let indent = text.len() - text.trim_start().len();
    lines(text, columns.max(indent + 12), indent + 2)
}

/// The text in lines of at most `columns` columns; all but the first begin with `indent` spaces. A word that is longer than a line
/// is cut.
pub fn lines(text: &str, columns: usize, indent: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    let length = |lines: &[String]| lines.last().map_or(0, |line| line.chars().count());
    for word in text.split_inclusive(' ') {
        let is_begun = lines.last().is_some_and(|line| !line.trim().is_empty());
        if is_begun && length(&lines) + word.trim_end().chars().count() > columns {
            lines.push(" ".repeat(indent));
        }
        for sign in word.chars() {
            if length(&lines) == columns && sign != ' ' {
                lines.push(" ".repeat(indent));
            }
            let is_full = length(&lines) == columns;
            lines.last_mut().filter(|_| !is_full).into_iter().for_each(|line| line.push(sign));
        }
    }
    lines.into_iter().map(|line| line.trim_end().to_owned()).collect()
}

/// The lower quartile, the median and the upper quartile; for an even number of values the median is the
/// lower of the two in the middle.
pub fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1);
    [last / 4, last / 2, last - last / 4].map(|index| values.get(index).copied().unwrap_or_default())
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
    #[test]
    fn long_words_are_cut_and_lines_are_indented() {
        assert_eq!(wrapped("  ab cd efgh", 14), ["  ab cd efgh"]);
        assert_eq!(wrapped("aaaa bbbb cccc dddd", 12), ["aaaa bbbb", "  cccc dddd"]);
        assert_eq!(wrapped(&"x".repeat(15), 12), ["x".repeat(12), format!("  {}", "x".repeat(3))]);
    }

    #[test]
    fn quartiles_are_measured_values() {
        assert_eq!(quartiles(vec![]), [0.0; 3]);
        assert_eq!(quartiles(vec![7.0]), [7.0; 3]);
        assert_eq!(quartiles(vec![4.0, 1.0, 3.0, 2.0]), [1.0, 2.0, 4.0]);
        assert_eq!(quartiles(vec![5.0, 4.0, 3.0, 2.0, 1.0]), [2.0, 3.0, 4.0]);
    }
}
