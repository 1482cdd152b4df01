//! The program that makes the figures of the slides, and checks that they are what the kit makes today: `figures ROOT WORKER
//! RAYKATA make|check DECK NAME…`. `raykata figures` starts it.
//!
//! `slides/figures.toml` lists them, each with the command that makes it. Diagrams are drawn here from the answers of a kit's own
//! functions, so a figure cannot contradict the code. [`DIAGRAMS`] and [`FROM_SCENES`] list them by name. Other commands of
//! `raykata` make pictures and plots.

mod acne;
mod camera_frame;
mod curves;
mod intersection;
mod leaks;
mod lens;
mod lighting;
mod list;
mod optics;
mod partitions;
mod pictures;
mod pipeline;
mod rays;
mod rounding;
mod sampling;
mod sketch;
mod solids;
mod speed;
mod spheres;
mod splits;
mod structures;
mod surfaces;
mod transport;
mod triangles;

use anyhow::{Context, Result, bail};
use list::{Exact, Figure};
use raykata::film::write_atomically;
use raykata::kit::{Kit, kit_error};
use raykata_cli::args::did_you_mean;
use raykata_cli::kits::{Source, Which};
use raykata_cli::report::{bar_of_steps, make_folder_of, say};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// Draws a diagram from the answers of a kit.
type Draw = fn(&dyn Kit) -> Result<String>;

/// All diagrams, by name.
const DIAGRAMS: &[(&str, Draw)] = &[
    ("slab-intervals", intersection::slab_intervals),
    ("camera-frame", camera_frame::camera_frame),
    ("sphere-roots", spheres::sphere_roots),
    ("sphere-geometry", spheres::sphere_geometry),
    ("sphere-cancellation", spheres::sphere_cancellation),
    ("barycentric", triangles::barycentric),
    ("traversal-order", triangles::traversal_order),
    ("judge-and-worker", pipeline::judge_and_worker),
    ("face-forward", lighting::face_forward),
    ("phong-vectors", lighting::phong_vectors),
    ("lambert", lighting::lambert),
    ("phong-exponents", lighting::phong_exponents),
    ("tone-curves", lighting::tone_curves),
    ("reflection", optics::reflection),
    ("snell", optics::snell),
    ("critical-angle", optics::critical_angle),
    ("fresnel", optics::fresnel),
    ("ray-tree-bound", rays::ray_tree_bound),
    ("gaussian-weight", sampling::gaussian_weight),
    ("disk-samples", sampling::disk_samples),
    ("penumbra", sampling::penumbra),
    ("motion-bounds", sampling::motion_bounds),
    ("thin-lens", lens::thin_lens),
    ("sah-cuts", splits::sah_cuts),
    ("object-median-problem", splits::object_median_problem),
    ("spatial-median-corner", splits::spatial_median_corner),
    ("grid-steps", structures::grid_steps),
    ("kd-traversal", structures::kd_traversal),
    ("ray-to-object", curves::ray_to_object),
    ("normal-transform", curves::normal_transform),
    ("de-casteljau", curves::de_casteljau),
    ("bspline-basis", curves::bspline_basis),
    ("inside-tests", surfaces::inside_tests),
    ("vertex-normals", surfaces::vertex_normals),
    ("texture-coordinates", surfaces::texture_coordinates),
    ("bilinear", surfaces::bilinear),
    ("silhouette-normal", rounding::silhouette_normal),
    ("rounded-point", rounding::rounded_point),
    ("edge-gap", rounding::edge_gap),
    ("offset-bound", rounding::offset_bound),
    ("solid-intervals", solids::solid_intervals),
    ("double-cone", solids::double_cone),
    ("octree-searches", partitions::octree_searches),
    ("bsp-sheets", partitions::bsp_sheets),
    ("malley", transport::malley),
    ("light-solid-angle", transport::light_solid_angle),
    ("corner", transport::corner),
    ("bins-and-cuts", speed::bins_and_cuts),
    ("blocks-that-pay", speed::blocks_that_pay),
    ("wide-node", speed::wide_node),
    ("work-and-span", speed::work_and_span),
];

/// Makes the bytes of a figure from the scenes of the kit at a path.
type FromScenes = fn(&dyn Kit, &Path) -> Result<Vec<u8>>;

/// All figures that are made from scenes, by name.
const FROM_SCENES: &[(&str, FromScenes)] = &[
    ("circle-of-confusion", lens::circle_of_confusion),
    ("ray-tree", rays::ray_tree),
    ("grid-resolution", rays::grid_resolution),
    ("antialias-crops", pictures::antialias_crops),
    ("sampler-strip", pictures::sampler_strip),
    ("sampling-101", pictures::sampling_101),
    ("hierarchy-levels", pictures::hierarchy_levels),
    ("four-partitions", pictures::four_partitions),
    ("kd-easy-and-five", pictures::kd_easy_and_five),
    ("split-heatmaps", pictures::split_heatmaps),
    ("cramer-determinant", pictures::cramer_determinant),
    ("tiles", pictures::tiles),
    ("heckbert", pictures::heckbert),
    ("gamma-steps", pictures::gamma_steps),
    ("three-scales", pictures::three_scales),
    ("scene-graph", solids::scene_graph),
    ("loop-subdivision", solids::loop_subdivision),
    ("furnace-bias", transport::furnace_bias),
    ("shadow-acne", acne::shadow_acne),
    ("offset-strip", acne::offset_strip),
    ("leaks", leaks::leaks),
    ("shadow-ray-map", leaks::shadow_ray_map),
    ("cornell-next-event", leaks::cornell_next_event),
    ("wide-heatmaps", speed::wide_heatmaps),
];

fn main() -> ExitCode {
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(1),
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::from(1)
        }
    }
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
            write_atomically(&file, |out| out.write_all(&made))
                .with_context(|| format!("cannot write {}", file.display()))?;
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
    // Figures that are not drawn yet, or that hold times, are made only by their names.
    let named = |figure: &&Figure| match names {
        [] => !figure.planned && figure.exact != Exact::Nothing,
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
            if let Some((_, make)) = FROM_SCENES.iter().find(|(known, _)| known == name) {
                return kit_error::catch(|| make(kit, root))?;
            }
            let (_, draw) = DIAGRAMS
                .iter()
                .find(|(known, _)| known == name)
                .with_context(|| format!("`raykata figures` draws no diagram `{name}`"))?;
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
    fn every_drawing_is_listed() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("slides/ is in a folder");
        let listed = list::read(root).unwrap();
        let drawn = DIAGRAMS.iter().map(|one| one.0).chain(FROM_SCENES.iter().map(|one| one.0));
        for name in drawn {
            let command = format!("raykata figures {name}");
            assert!(listed.iter().any(|figure| figure.command == command), "{name} is not listed");
        }
    }

    #[test]
    fn every_figure_that_is_not_planned_can_be_made() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("slides/ is in a folder");
        for figure in list::read(root).unwrap().iter().filter(|figure| !figure.planned) {
            let Some(name) = figure.command.strip_prefix("raykata figures ") else { continue };
            let names = DIAGRAMS.iter().map(|one| one.0).chain(FROM_SCENES.iter().map(|one| one.0));
            assert!(names.into_iter().any(|known| known == name), "there is no drawing {name}");
        }
    }
}
