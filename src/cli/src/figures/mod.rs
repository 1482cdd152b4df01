//! `raykata figures`: makes the figures of the slides, and checks that they are what the kit makes today.
//!
//! `slides/figures.toml` lists them, each with the command that makes it. Diagrams are drawn here from the answers of a kit's own
//! functions, so a figure cannot contradict the code: `intersection`, `optics`, `structures` and `sampling` draw them by
//! name. Other commands of this program make pictures and plots.

mod intersection;
mod list;
mod optics;
mod structures;

use crate::args::{Argument, Given, Misuse, Opt, Spec, did_you_mean};
use crate::kits::{Choice, Need, Source, root};
use crate::report::{bar_of_steps, make_folder_of};
use anyhow::{Context, Result, bail};
use list::{Exact, Figure};
use raykata::film::write_atomically;
use raykata::kit::{Kit, kit_error};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// `raykata figures`.
pub static SPEC: Spec = Spec {
    name: "raykata figures",
    about: "Make the figures of the slides, as slides/figures.toml lists them.",
    arguments: &[Argument::optional("NAME", "The figures to make, without the ending [default: all].").many()],
    options: &[
        &[
            Opt::flag("--check", "Make them again and compare: pixels, counts and drawings, but no times."),
            Opt::value("--deck", "NAME", "Only the figures of this deck, such as stage03."),
        ],
        Choice::OPTIONS,
    ],
};

/// Which figures are made.
pub struct Options {
    names: Vec<String>,
    check: bool,
    deck: Option<String>,
    kit: Choice,
}

impl Options {
    /// Reads the arguments and options.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        Ok(Options {
            names: given.arguments(0).iter().map(|name| name.to_string_lossy().into_owned()).collect(),
            check: given.has("--check"),
            deck: given.path("--deck").map(|deck| deck.to_string_lossy().into_owned()),
            kit: Choice::read(given)?,
        })
    }
}

/// Draws a diagram from the answers of a kit.
type Draw = fn(&dyn Kit) -> Result<String>;

/// All diagrams, by name.
const DIAGRAMS: &[(&str, Draw)] = &[
    ("slab-intervals", intersection::slab_intervals),
    ("snell", optics::snell),
    ("thin-lens", optics::thin_lens),
    ("dda-steps", structures::dda_steps),
    ("kd-traversal", structures::kd_traversal),
    ("sah-cuts", structures::sah_cuts),
];

/// Makes or checks figures. `Ok(false)` if one of them differs.
pub fn run(options: &Options) -> Result<bool> {
    // Choose the figures.
    let root = root()?;
    let all = list::read(&root)?;
    let chosen = choose(&all, options)?;
    // Make each, and write it or compare it.
    let source = Source::prepare(&root, options.kit.or_reference(&root), Need::Frames)?;
    let kit = &*source.fresh();
    let bar = bar_of_steps(chosen.len());
    let mut differences = Vec::new();
    for figure in &chosen {
        bar.set_message(figure.file.clone());
        let made = make(figure, kit, &root).with_context(|| format!("{} cannot be made", figure.file))?;
        let file = root.join("slides/figures").join(&figure.file);
        if options.check {
            differences.extend(difference(figure, &made, &file));
        } else {
            make_folder_of(&file)?;
            write_atomically(&file, |out| out.write_all(&made))
                .with_context(|| format!("cannot write {}", file.display()))?;
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    // Say what differs.
    for line in &differences {
        println!("{line}");
    }
    let n = chosen.len();
    match (options.check, differences.len()) {
        (false, _) => println!("{n} figures in slides/figures"),
        (true, 0) => println!("{n} figures are what the kit makes"),
        (true, different) => {
            println!("{different} of {n} figures differ; `raykata figures` makes them again")
        }
    }
    Ok(differences.is_empty())
}

fn choose<'a>(all: &'a [Figure], options: &Options) -> Result<Vec<&'a Figure>> {
    let known: Vec<&str> = all.iter().map(Figure::name).collect();
    for name in &options.names {
        if !known.contains(&name.as_str()) {
            bail!("there is no figure `{name}` in slides/figures.toml{}", did_you_mean(name, &known));
        }
    }
    let named =
        |figure: &&Figure| options.names.is_empty() || options.names.iter().any(|name| name == figure.name());
    let of_deck = |figure: &&Figure| options.deck.as_ref().is_none_or(|deck| *deck == figure.deck);
    let chosen: Vec<&Figure> = all.iter().filter(named).filter(of_deck).collect();
    if chosen.is_empty() {
        bail!("no figure of slides/figures.toml is of this deck");
    }
    Ok(chosen)
}

/// The bytes of a figure.
fn make(figure: &Figure, kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let words: Vec<&str> = figure.command.split_whitespace().collect();
    match words.as_slice() {
        ["raykata", "figures", name] => {
            let (_, draw) = DIAGRAMS
                .iter()
                .find(|(known, _)| known == name)
                .with_context(|| format!("`raykata figures` draws no diagram `{name}`"))?;
            Ok(kit_error::catch(|| draw(kit))??.into_bytes())
        }
        ["raykata", rest @ ..] => by_command(figure, rest, root),
        _ => bail!("its command does not begin with `raykata`: {}", figure.command),
    }
}

/// Runs another command of this program, and takes the file that it writes.
fn by_command(figure: &Figure, words: &[&str], root: &Path) -> Result<Vec<u8>> {
    let folder = root.join("out/figures");
    let out = match &figure.take {
        Some(_) => folder.join(figure.name()),
        None => folder.join(&figure.file),
    };
    let output = Command::new(std::env::current_exe()?)
        .args(words)
        .arg("--out")
        .arg(&out)
        .current_dir(root)
        .stdin(Stdio::null())
        .output()
        .context("this program cannot be started again")?;
    if !output.status.success() {
        bail!("`{}` failed:\n{}", figure.command, String::from_utf8_lossy(&output.stderr).trim_end());
    }
    let file: PathBuf = figure.take.as_ref().map_or(out.clone(), |name| out.join(name));
    std::fs::read(&file).with_context(|| format!("`{}` wrote no {}", figure.command, file.display()))
}

/// How a figure that was made now differs from the one in `file`; `None` if it does not.
fn difference(figure: &Figure, made: &[u8], file: &Path) -> Option<String> {
    let Ok(kept) = std::fs::read(file) else {
        return Some(format!("{}: there is no such file", figure.file));
    };
    let differs = match figure.exact {
        Exact::All => kept != made,
        Exact::Pixels => pixels(&kept) != pixels(made) || pixels(made).is_none(),
        Exact::Nothing => false,
    };
    differs.then(|| format!("{}: differs from what `{}` makes", figure.file, figure.command))
}

fn pixels(png: &[u8]) -> Option<image::RgbImage> {
    Some(image::load_from_memory(png).ok()?.into_rgb8())
}
