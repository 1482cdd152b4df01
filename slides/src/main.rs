//! The program that makes the figures of the slides, and checks that they are what the kit makes today: `figures ROOT WORKER
//! RAYKATA make|check DECK NAME…`. `raykata figures` starts it.
//!
//! `slides/figures.toml` lists them, each with the command that makes it. Diagrams are drawn here from the answers of a kit's own
//! functions, so a figure cannot contradict the code. [`DIAGRAMS`], [`FROM_SCENES`] and [`touch::FIGURES`] list them by name. Other
//! commands of `raykata` make pictures and plots.

mod acne;
mod camera;
mod curves;
mod leaks;
mod lighting;
mod list;
mod optics;
mod partitions;
mod pictures;
mod pipeline;
mod rays;
mod rounding;
mod sampling;
mod searches;
mod solids;
mod speed;
mod spheres;
mod splits;
mod surfaces;
mod transport;

use anyhow::{Context, Result, bail};
use list::{Exact, Figure};
use raykata::kit::{Kit, kit_error};
use raykata_cli::args::did_you_mean;
use raykata_cli::kits::{Source, Which};
use raykata_cli::program::ended;
use raykata_cli::report::{bar_of_steps, make_folder_of, say, write_file};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// Draws a diagram from the answers of a kit.
type Draw = fn(&dyn Kit) -> Result<String>;

/// Makes the bytes of a figure from the scenes of the kit at a path.
type FromScenes = fn(&dyn Kit, &Path) -> Result<Vec<u8>>;

/// The drawings with their names: those of their functions, with dashes.
macro_rules! drawings {
    ($($module:ident: $($function:ident),+;)*) => {
        &[$($((stringify!($function), $module::$function)),+),*]
    };
}

/// All diagrams.
const DIAGRAMS: &[(&str, Draw)] = drawings! {
    camera: camera_frame;
    spheres: sphere_roots, sphere_geometry, sphere_cancellation;
    pipeline: judge_and_worker;
    lighting: face_forward, phong_vectors, lambert, phong_exponents, tone_curves;
    optics: reflection, critical_angle, fresnel;
    rays: ray_tree_bound;
    sampling: gaussian_weight, disk_samples, penumbra, motion_bounds;
    splits: sah_cuts, object_median_problem, spatial_median_corner;
    searches: traversal_order, wide_search;
    curves: ray_to_object, normal_transform, de_casteljau, bspline_basis;
    surfaces: inside_tests, vertex_normals, texture_coordinates, bilinear;
    rounding: silhouette_normal, rounded_point, edge_gap, offset_bound;
    solids: solid_intervals, double_cone;
    partitions: octree_searches, bsp_sheets;
    transport: malley, light_solid_angle, mis_weights, corner;
    speed: bins_and_cuts, blocks_that_pay, wide_node, work_and_span;
};

/// All figures that are made from scenes.
const FROM_SCENES: &[(&str, FromScenes)] = drawings! {
    camera: circle_of_confusion;
    rays: ray_tree, grid_resolution;
    pictures: antialias_crops, sampler_strip, sampling_101, hierarchy_levels, four_partitions, kd_easy_and_five;
    pictures: split_heatmaps, cramer_determinant, tiles, heckbert, gamma_steps, three_scales;
    solids: scene_graph, loop_subdivision;
    transport: furnace_bias;
    acne: shadow_acne, offset_strip;
    leaks: leaks, leak_room, shadow_ray_map, cornell_next_event;
    speed: wide_heatmaps;
};

fn main() -> ExitCode {
    ended(run(&std::env::args().skip(1).collect::<Vec<_>>()))
}

/// Makes or checks figures. `Ok(false)` if one of them differs.
fn run(words: &[String]) -> Result<bool> {
    let [root, worker, raykata, what, deck, names @ ..] = words else {
        bail!("`raykata figures` starts this program; it is not started by hand");
    };
    let (root, is_check) = (Path::new(root), what == "check");
    // Choose the figures.
    let all = list::read(root)?;
    let chosen = choose(&all, deck, names)?;
    // Make each, and write it or compare it.
    let source = Source { which: Which::Solutions, program: worker.into() };
    let kit = &*source.fresh();
    let bar = bar_of_steps(chosen.len());
    let mut differences = Vec::new();
    for figure in &chosen {
        bar.set_message(figure.file.clone());
        let made =
            make(figure, kit, root, raykata).with_context(|| format!("{} cannot be made", figure.file))?;
        let file = root.join("slides/figures").join(&figure.file);
        if is_check {
            differences.extend(difference(figure, &made, &file));
        } else {
            make_folder_of(&file)?;
            write_file(&file, &made)?;
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    // Say what differs.
    for line in &differences {
        say(format_args!("{line}\n"));
    }
    let n = chosen.len();
    match (is_check, differences.len()) {
        (false, _) => say(format_args!("{n} figures in slides/figures\n")),
        (true, 0) => say(format_args!("{n} figures are what the kit makes\n")),
        (true, different) => {
            say(format_args!("{different} of {n} figures differ; `raykata figures` makes them again\n"))
        }
    }
    Ok(differences.is_empty())
}

/// The figures of a deck, or of all if `deck` is empty, with these names, or all if there are none.
fn choose<'a>(all: &'a [Figure], deck: &str, names: &[String]) -> Result<Vec<&'a Figure>> {
    let known: Vec<&str> = all.iter().map(Figure::name).collect();
    for name in names {
        if !known.contains(&name.as_str()) {
            bail!("there is no figure `{name}` in slides/figures.toml{}", did_you_mean(name, &known));
        }
    }
    // Figures that hold times are made only by their names.
    let named = |figure: &&Figure| match names {
        [] => figure.exact != Exact::Nothing,
        names => names.iter().any(|name| name == figure.name()),
    };
    let of_deck = |figure: &&Figure| deck.is_empty() || *deck == figure.deck;
    let chosen: Vec<&Figure> = all.iter().filter(named).filter(of_deck).collect();
    if chosen.is_empty() {
        bail!("slides/figures.toml has no such figure of the deck `{deck}`");
    }
    Ok(chosen)
}

/// The bytes of a figure.
fn make(figure: &Figure, kit: &dyn Kit, root: &Path, raykata: &str) -> Result<Vec<u8>> {
    let words: Vec<&str> = figure.command.split_whitespace().collect();
    match words.as_slice() {
        ["raykata", "figures", name] => {
            let function = name.replace('-', "_");
            if let Some((_, make)) = FROM_SCENES.iter().find(|(known, _)| *known == function) {
                return kit_error::catch(|| make(kit, root))?;
            }
            if let Some(svg) = kit_error::catch(|| touch::still(kit, name))? {
                return Ok(svg?.into_bytes());
            }
            let draw = DIAGRAMS.iter().find(|(known, _)| *known == function);
            let (_, draw) = draw.with_context(|| format!("`raykata figures` draws no diagram `{name}`"))?;
            Ok(kit_error::catch(|| draw(kit))??.into_bytes())
        }
        ["raykata", rest @ ..] => {
            let made = by_command(figure, rest, root, raykata)?;
            if figure.file.ends_with(".png") { recompressed(&made) } else { Ok(made) }
        }
        _ => bail!("it is made by `cargo run --release -p {}`", figure.command.replacen(' ', " -- ", 1)),
    }
}

/// The same pixels in fewer bytes. The program that renders compresses quickly; a figure is kept for good.
fn recompressed(png: &[u8]) -> Result<Vec<u8>> {
    let picture = pixels(png).context("this is no picture")?;
    pictures::compressed(&picture)
}

/// Runs another command of `raykata`, and takes the file that it writes.
fn by_command(figure: &Figure, words: &[&str], root: &Path, raykata: &str) -> Result<Vec<u8>> {
    let folder = root.join("out/figures");
    let out = match &figure.take {
        Some(_) => folder.join(figure.name()),
        None => folder.join(&figure.file),
    };
    let output = Command::new(raykata)
        .args(words)
        .arg("--out")
        .arg(&out)
        .current_dir(root)
        .stdin(Stdio::null())
        .output()
        .context("raykata cannot be started")?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_listed_can_be_drawn_and_what_can_be_drawn_is_listed() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("slides/ is in a folder");
        let listed = list::read(root).unwrap();
        let name = |figure: &Figure| Some(figure.command.strip_prefix("raykata figures ")?.replace('-', "_"));
        let names: Vec<String> = listed.iter().filter_map(name).collect();
        let drawn = || DIAGRAMS.iter().map(|one| one.0).chain(FROM_SCENES.iter().map(|one| one.0));
        for name in drawn() {
            assert!(names.iter().any(|listed| listed == name), "{name} is not listed");
        }
        let touched = |name: &str| touch::FIGURES.iter().any(|figure| figure.name.replace('-', "_") == name);
        for name in names {
            assert!(drawn().any(|known| known == name) || touched(&name), "there is no drawing {name}");
        }
    }
}
