//! `raykata tree`: the rays behind the first sample of one pixel, as text, JSON or a graph.

use crate::args::{Argument, Given, Opt, Spec, names};
use crate::kits::Choice;
use crate::quality_options::{MEMORY, limits};
use crate::report::{job, load_scene, say};
use anyhow::{Result, bail};
use raykata::kit::{RayKind, RenderJob, TracedRay, kit_error};
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

/// Writes a tree in a format.
type Write = fn(&[TracedRay]) -> Result<String>;

const FORMATS: [(&str, Write); 3] = [("text", as_text), ("json", as_json), ("dot", as_dot)];

/// `raykata tree`.
pub static SPEC: Spec = Spec {
    name: "raykata tree",
    about: "Show the rays behind one pixel, for the first of its samples.",
    arguments: &[Argument::required("SCENE", "The scene, a TOML file.")],
    options: &[
        &[
            Opt::value("--pixel", "X,Y", "Column and row, from the upper left, such as 320,200."),
            Opt::value(
                "--format",
                "NAME",
                "Format of the tree: indented lines, a list of rays in JSON, or a graph for Graphviz \
                 [default: text].",
            )
            .choices(&names(&FORMATS)),
        ],
        Choice::OPTIONS,
        &[MEMORY],
    ],
};

fn parse_pixel(text: &str) -> Result<(u32, u32), String> {
    let parsed =
        text.split_once(',').and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)));
    parsed.ok_or_else(|| "a pixel is a column and a row with a comma between them, such as 320,200".into())
}

/// Traces the first sample of the pixel and prints its tree.
pub fn run(given: &Given) -> Result<ExitCode> {
    let pixel = given.parsed("--pixel", parse_pixel)?;
    let scene_file = Path::new(given.required(0)?);
    let (x, y) = pixel.ok_or_else(|| given.misuse("`--pixel X,Y` is missing"))?;
    let kit = Choice::read(given)?;
    let format = given.choice("--format", &FORMATS)?.unwrap_or(as_text);
    let scene = load_scene(scene_file, limits(given)?)?;
    let film = scene.film;
    if x >= film.width || y >= film.height {
        bail!(
            "there is no pixel {x},{y}: columns go from 0 to {}, rows from 0 to {}",
            film.width - 1,
            film.height - 1
        );
    }
    let kit = kit.start()?;
    let job = RenderJob { threads: 1, count: false, reuse: false, ..job(scene) };
    let rays = kit_error::catch(|| kit.trace(&job, x, y))?;
    say(format_args!("{}", format(&rays)?));
    Ok(ExitCode::SUCCESS)
}

/// Indented lines.
fn as_text(rays: &[TracedRay]) -> Result<String> {
    let mut text = String::new();
    for (root, _) in rays.iter().enumerate().filter(|(_, ray)| ray.parent.is_none()) {
        write_below(rays, root, 0, &mut text);
    }
    Ok(text)
}

/// A list of rays, each with the index of its parent.
fn as_json(rays: &[TracedRay]) -> Result<String> {
    Ok(serde_json::to_string_pretty(rays)? + "\n")
}

fn write_below(rays: &[TracedRay], index: usize, level: usize, text: &mut String) {
    let _ = writeln!(text, "{:1$}{2}", "", 2 * level, label(&rays[index]));
    for (child, _) in rays.iter().enumerate().filter(|(_, child)| child.parent == Some(index)) {
        write_below(rays, child, level + 1, text);
    }
}

/// The kind, depth, weight and hit of a ray in one line.
pub fn label(ray: &TracedRay) -> String {
    let kind = match ray.kind {
        RayKind::Primary => "primary",
        RayKind::Reflection => "reflection",
        RayKind::Transmission => "transmission",
        RayKind::Indirect => "indirect",
        RayKind::Shadow => return format!("shadow, {}", if ray.hit.is_some() { "occluded" } else { "lit" }),
    };
    let weight = match ray.weight {
        w if w.x == w.y && w.y == w.z => format!("{:.3}", w.x),
        w => format!("({:.3} {:.3} {:.3})", w.x, w.y, w.z),
    };
    let hit = match &ray.hit {
        Some((t, material)) => format!("hits {material} at t = {t:.3}"),
        None => "hits nothing".into(),
    };
    format!("{kind}, depth {}, weight {weight}, {hit}", ray.depth)
}

/// For Graphviz: `raykata tree … --format dot | dot -Tsvg`.
fn as_dot(rays: &[TracedRay]) -> Result<String> {
    let mut dot = String::from("digraph rays {\n  node [shape=box, fontname=\"sans-serif\"];\n");
    for (index, ray) in rays.iter().enumerate() {
        let text = label(ray).replace('\\', "\\\\").replace('"', "\\\"").replace(", ", "\\n");
        let style = if ray.kind == RayKind::Shadow { ", style=dashed" } else { "" };
        let _ = writeln!(dot, "  r{index} [label=\"{text}\"{style}];");
        if let Some(parent) = ray.parent {
            let _ = writeln!(dot, "  r{parent} -> r{index};");
        }
    }
    Ok(dot + "}\n")
}
