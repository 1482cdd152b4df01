//! What indirect light needs: which materials send diffuse rays on, which lights are sampled, how many rays that takes at
//! most, and how much light is missing beyond the largest depth.

use super::needs::written;
use super::why::{list, material};
use super::{Explained, REASON_COLUMN, STEP, about_hits, bounds_table};
use crate::args::wrapped;
use crate::report::{Thousands, job, render};
use anyhow::Result;
use glam::Vec3;
use raykata::kit::kit_error;
use raykata::scene::{Background, NextEvent};

/// Prints which surfaces send diffuse rays on and which lights are sampled, and what is not computed for that reason.
pub fn asked(explained: &Explained<'_>) {
    let Explained { scene, paths, .. } = explained;
    if let Some(paths) = paths {
        let materials = |wants: &[bool]| -> Vec<String> {
            let wanted = (0..scene.materials.len()).filter(|&index| wants.get(index) == Some(&true));
            wanted.map(|index| material(scene, index)).collect()
        };
        let diffuse = materials(&paths.diffuse);
        let mut sampled =
            if scene.quality.next_event != NextEvent::Off { materials(&paths.sampled) } else { Vec::new() };
        let samples_map = scene.quality.next_event != NextEvent::Off && paths.environment;
        if samples_map && matches!(scene.background, Background::Map(_)) {
            sampled.push("environment map (a shadow ray per diffuse hit, also where walls hide it)".into());
        }
        let line = |what: &str, parts: &[String], none: &str| {
            let parts = if parts.is_empty() { none.to_owned() } else { list(parts) };
            println!("  {what:<14}  {}", wrapped(&parts, REASON_COLUMN));
        };
        line("diffuse rays", &diffuse, "none: no diffuse surface can receive light");
        line("sampled lights", &sampled, "none");
    }
    if scene.ambient != Vec3::ZERO {
        let text = "not added, because indirect light takes its place";
        println!("  {:<14}  {}", "ambient light", wrapped(text, REASON_COLUMN));
    }
}

/// Prints the predicted and the counted numbers of rays. A path has one ray per bounce, diffuse, reflected or refracted.
pub fn bounds(explained: &Explained<'_>) -> Result<()> {
    let Explained { scene, kit, effects, paths } = explained;
    let counted = render(*kit, &job((*scene).clone()))?.counts;
    let (film, quality) = (&scene.film, &scene.quality);
    let camera = u64::from(film.width) * u64::from(film.height) * u64::from(quality.samples_per_pixel);
    let bounces = u64::from(quality.max_depth);
    // Without the analysis every material may need everything.
    let has = |wants: Option<bool>| wants.unwrap_or(true);
    let diffuse = has(paths.as_ref().map(|paths| paths.bounces()));
    let sampled = has(paths.as_ref().map(|paths| paths.environment || paths.sampled.contains(&true)));
    let any = |wants: bool| if wants { camera.saturating_mul(bounces) } else { 0 };
    // Each hit asks for the light of all lights, and each but the last one for that of one emitter.
    let of_lights = effects.materials.iter().map(|material| {
        let casting =
            material.lights.iter().map(|&light| &effects.lights[light]).filter(|light| light.shadows);
        casting.map(|light| u64::from(light.samples)).sum::<u64>()
    });
    let of_lights = of_lights.max().unwrap_or(0);
    let of_emitters = any(diffuse && sampled && quality.next_event != NextEvent::Off);
    let shadow = camera.saturating_mul(1 + bounces).saturating_mul(of_lights).saturating_add(of_emitters);
    bounds_table(&[
        ("from the camera", camera, counted.primary),
        ("to lights", shadow, counted.shadow),
        ("diffuse", any(diffuse), counted.indirect),
        ("reflected", any(effects.materials.iter().any(|material| material.mirror)), counted.reflection),
        (
            "refracted",
            any(effects.materials.iter().any(|material| material.transmission)),
            counted.transmission,
        ),
        ("of all paths", camera.saturating_mul(1 + bounces), counted.rays() - counted.shadow),
    ]);
    let note = format!(
        "A path has one ray per bounce, so all rays of paths are at most the rays from the camera times (1 + {bounces}). \
         Russian roulette ended {} paths. {}",
        Thousands(counted.absorbed),
        about_hits(&counted)
    );
    println!("  {}", wrapped(&note, 2));
    Ok(())
}

/// Prints how much light the largest depth leaves out at most, by `cut_off` and `bounces_for_error` of stage 11.
pub fn depth(explained: &Explained<'_>) -> Result<()> {
    let Explained { scene, kit, paths, .. } = explained;
    let Some(paths) = paths.as_ref().filter(|paths| paths.bounces()) else { return Ok(()) };
    let diffuse = scene.materials.iter().zip(&paths.diffuse).filter(|(_, diffuse)| **diffuse);
    let albedo = diffuse.map(|(material, _)| material.diffuse.max_element()).fold(0.0f32, f32::max);
    let depth = scene.quality.max_depth;
    let answers = kit_error::catch(|| {
        let missing = kit.cut_off(&[(albedo.min(1.0), depth)]).remove(0);
        (missing, kit.bounces_for_error(&[(albedo.min(1.0), STEP)]).remove(0))
    });
    println!();
    let Some((missing, needed)) = written(answers)? else { return Ok(()) };
    let needed = match needed {
        u32::MAX => "no number of bounces is enough for".to_owned(),
        n => format!("{n} bounces leave out less than"),
    };
    let text = format!(
        "the largest diffuse reflectance is {albedo:.2}. In a closed room with this reflectance everywhere, paths with at \
         most {depth} bounces leave out {:.1} % of the light, and {needed} {STEP:.4} of it (1/255, a step of brightness).",
        100.0 * missing
    );
    println!("depth             {}", wrapped(&text, REASON_COLUMN));
    Ok(())
}
