//! `author gaps`: shows, for each function of the exercises, what pictures lack while that function is not written yet.
//!
//! The renderer must make a picture from the functions that are written, and name what is left out and why. The reference
//! has no unwritten functions, so this command removes each function in turn. It also removes all functions from each stage
//! on, as in the exercises of a course that has begun: a picture must be made, and it must say what it lacks.
//!
//! `switch` (one build for all sets of functions) · `begun` (all functions from each stage on)

mod begun;
mod switch;

use crate::corpus::build_folder::{BuildFolder, Product};
use crate::corpus::program::stage_files;
use crate::corpus::verdict::without_lines;
use crate::pictures::{Scenes, Shown};
use anyhow::{Context, Result};
use grader::exercises::{self, Block};
use grader::kits::{Need, Source, Which, root};
use grader::queue;
use grader::report::bar_of_steps;
use grader::worker::{CALL_PATIENCE, Worker};
use raykata::kit::Door;
use raykata_cli::args::{Given, Opt, Spec};
use std::path::{Path, PathBuf};
use switch::Switchable;

/// `author gaps`.
pub static SPEC: Spec = Spec {
    name: "author gaps",
    about: "Show for each function what pictures lack while it is not written.",
    arguments: &[],
    options: &[&[
        Opt::flag("--check", "Compare with tests/corpus/gaps.txt."),
        Opt::flag("--bless", "Write tests/corpus/gaps.txt."),
    ]],
};

/// The file with the expected results.
const RECORD: &str = "tests/corpus/gaps.txt";

/// The text for a gap that no picture shows.
const NOTHING: &str = "no picture lacks anything";

/// Functions without which no picture of the reference lacks anything, and a command that shows each.
const SHOWN_BY: [(&str, &str); 13] = [
    // The functions of stages 3 and 4 are as good in pictures, and those of stage 10 replace them.
    ("slab", "cargo run -- gauntlet"),
    ("conservative_slab", "cargo run -- gauntlet"),
    ("offset_origin", "cargo run -- gauntlet"),
    // A picture that is compared is not encoded yet.
    ("encode_gamma", "cargo run -- render scenes/gamma.toml --kit exercises"),
    ("most_rays", "cargo run -- explain scenes/effects.toml --kit exercises"),
    ("rays_of_hits", "cargo run -- explain scenes/effects.toml --kit exercises"),
    ("samples_for_error", "cargo run -- explain scenes/effects.toml --kit exercises"),
    ("cut_off", "cargo run -- explain scenes/cornell.toml --kit exercises"),
    ("bounces_for_error", "cargo run -- explain scenes/cornell.toml --kit exercises"),
    // Without it the picture is the same and takes more random numbers.
    ("paths_called_for", "cargo run -- explain scenes/cornell.toml --kit exercises"),
    // Both build the same tree, `build_parallel` on all threads.
    ("build_binned", "cargo run -- render scenes/stage3.toml --accelerator wide-bvh --kit exercises"),
    ("build_parallel", "cargo run -- render scenes/stage3.toml --accelerator wide-bvh --kit exercises"),
    // Without it every triangle of a leaf is tested: the same hits and counts, in more time.
    ("may_hit", "cargo run -- compare scenes/stage3.toml --only bvh,wide-bvh --kit exercises"),
];

/// The command that shows a function. There is none without effect.
fn shown_by(gap: &Gap) -> Result<String> {
    let function = &gap.function;
    let known = SHOWN_BY.iter().find(|(name, _)| name == function);
    let (_, command) = known.with_context(|| {
        format!("`{function}` changes no picture: use it in a picture, or name in SHOWN_BY a command that shows it")
    })?;
    Ok((*command).to_owned())
}

/// The stage to which a function belongs.
fn stage_of(gap: &Gap) -> u8 {
    let name = Path::new(&gap.file).file_name().unwrap_or_default().to_string_lossy().into_owned();
    exercises::stage_of(&name).unwrap_or_default()
}

/// A function that is not written.
pub struct Gap {
    /// The file, from the root of the kit.
    pub file: String,
    /// The name of the function.
    pub function: String,
}

impl Gap {
    fn title(&self) -> String {
        format!("{} without {}", self.file.trim_start_matches("solutions/src/"), self.function)
    }
}

/// Prints what pictures lack. Returns whether that equals the stored results, and whether each picture of a kit that is
/// written up to some stage says what it lacks.
pub fn run(given: &Given) -> Result<bool> {
    given.exclude("--bless", "--check")?;
    let root = root()?;
    let gaps = all(&root)?;
    let reference = Source::prepare(&root, Which::Solutions, Need::Frames)?.fresh();
    let scenes = Scenes::read(&root, &*reference)?.of_gaps();
    let whole = scenes.shown_by(&*reference);
    let build_folder = BuildFolder::open(&root, "0", Product::Worker(Need::Frames))?;
    let switchable = Switchable::build(&build_folder, &root, &gaps)?;
    let says_what_it_lacks = begun::run(&switchable, &gaps, &scenes, &whole)?;
    let text = text(&switchable, &gaps, &scenes, &whole)?;
    let text: String =
        gaps.iter().zip(text).map(|(gap, text)| format!("{}\n{text}\n", gap.title())).collect();
    let file = root.join(RECORD);
    if given.has("--bless") {
        std::fs::write(&file, &text).with_context(|| RECORD.to_owned())?;
    }
    let kept = std::fs::read_to_string(&file).unwrap_or_default();
    if !given.has("--check") || kept == text {
        println!("{text}{} functions, each removed in turn", gaps.len());
        return Ok(says_what_it_lacks);
    }
    for (now, before) in text.lines().zip(kept.lines()).filter(|(now, before)| now != before) {
        println!("now     {now}\nbefore  {before}\n");
    }
    println!("{RECORD} differs: look at it, then `cargo run -p author -- gaps --bless`");
    Ok(false)
}

/// Returns for each of these functions what pictures lack without it.
fn text(switchable: &Switchable, gaps: &[Gap], scenes: &Scenes, whole: &[Shown]) -> Result<Vec<String>> {
    let bar = bar_of_steps(gaps.len());
    let numbers: Vec<usize> = (0..gaps.len()).collect();
    let text = queue::run(&queue::one_a_core(), &numbers, |(), &number| {
        bar.set_message(gaps[number].title());
        let worker = switchable.without(&format!("without_{number}"), &[number])?;
        let mut text = differences(worker, scenes, whole);
        if text.contains(NOTHING) {
            text = format!("  {NOTHING}; `{}` shows it\n", shown_by(&gaps[number])?);
        }
        bar.inc(1);
        Ok(text)
    });
    bar.finish_and_clear();
    text
}

/// Returns how the pictures of a worker differ from those of the unchanged solutions.
fn differences(worker: PathBuf, scenes: &Scenes, whole: &[Shown]) -> String {
    // Each note, with the scenes that have it and the hashes of their pictures.
    let mut said: Vec<(String, Vec<String>)> = Vec::new();
    for (one, whole) in
        scenes.shown_by(&Door(Worker::new(worker, CALL_PATIENCE).with_short_frames())).iter().zip(whole)
    {
        let (words, scene) = match &one.pixels {
            _ if one == whole => continue,
            Ok(_) => (without_lines(&one.notes.join("; ")), format!("{} ({})", one.scene, one.hash())),
            Err(error) => (without_lines(error).replace("\n ", ":"), one.scene.clone()),
        };
        match said.iter_mut().find(|(known, _)| *known == words) {
            Some((_, scenes)) => scenes.push(scene),
            None => said.push((words, vec![scene])),
        }
    }
    if said.is_empty() {
        return format!("  {NOTHING}\n");
    }
    let line = |(words, scenes): &(String, Vec<String>)| {
        format!("  {}\n    {}\n", if words.is_empty() { "(no note)" } else { words }, scenes.join(", "))
    };
    said.iter().map(line).collect()
}

/// Returns every function of the exercises as a gap.
pub fn all(root: &Path) -> Result<Vec<Gap>> {
    let mut gaps = Vec::new();
    for file in stage_files(root)? {
        let text = std::fs::read_to_string(root.join(&file)).with_context(|| file.clone())?;
        gaps.extend(in_file(&file, &text)?);
    }
    Ok(gaps)
}

fn in_file(file: &str, text: &str) -> Result<Vec<Gap>> {
    let mut gaps = Vec::new();
    let mut function = "";
    for block in exercises::blocks(text, Path::new(file))? {
        match block {
            Block::Same(lines) => {
                if let Some(head) = lines.iter().rev().find_map(|line| line.strip_prefix("pub fn ")) {
                    function = head.split(['(', '<']).next().unwrap_or_default();
                }
            }
            // A helper or an import belongs to no exercise.
            Block::Answer(_, stub) if !is_function(&stub) => {}
            Block::Answer(..) => gaps.push(Gap { file: file.into(), function: function.into() }),
        }
    }
    Ok(gaps)
}

/// Whether this stub of an answer is that of a function.
fn is_function(stub: &[String]) -> bool {
    stub.iter().any(|line| line.trim_start().starts_with("todo!("))
}

#[cfg(test)]
mod tests {
    use super::in_file;

    #[test]
    fn functions_are_gaps_and_helpers_are_none() {
        let text = "pub fn one(x: f32) -> f32 {\n    // <solution>\n    x\n    // <stub> todo!(\"x\")\n    // </solution>\n}\n\
                    // <solution>\nfn help() {}\n// </solution>\n";
        let gaps = in_file("f", text).unwrap();
        assert_eq!(gaps.iter().map(|gap| gap.function.as_str()).collect::<Vec<_>>(), ["one"]);
    }
}
