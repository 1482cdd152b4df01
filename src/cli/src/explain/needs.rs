//! What a hit of each material needs at most, and how many samples a pixel needs.

use super::{Explained, REASON_COLUMN, STEP};
use crate::args::wrapped;
use crate::columns::Columns;
use crate::report::{job, render};
use anyhow::Result;
use raykata::film::Film;
use raykata::kit::{HitsQuery, KitError, MaterialHits, RenderJob, kit_error};

/// Prints, for each material that is shown, the rays that one of its hits needs if all lights are in front of it.
pub fn rays_per_hit(explained: &Explained<'_>) -> Result<()> {
    let Explained { scene, kit, effects, paths } = explained;
    let samples: Vec<u64> = effects.lights.iter().map(|light| u64::from(light.samples)).collect();
    let shown = scene.shown();
    let materials: Vec<usize> = (0..scene.materials.len())
        .filter(|index| shown.iter().any(|shape| shape.materials.contains(index)))
        .collect();
    let query = |&material: &usize| HitsQuery {
        hits: vec![MaterialHits { material, hits: 1, in_front: samples.clone() }],
        effects: effects.clone(),
        quality: scene.quality,
    };
    let queries: Vec<HitsQuery> = materials.iter().map(query).collect();
    let Some(rays) = written(kit_error::catch(|| kit.rays_of_hits(&queries)))? else {
        println!();
        return Ok(());
    };
    const COLUMNS: Columns = Columns("  ", &[-24, 18, 11, 11]);
    println!("{}", COLUMNS.row(&[&"rays per hit", &"to lights, at most", &"reflected", &"refracted"]));
    let mut is_path = false;
    for (material, rays) in materials.into_iter().zip(rays) {
        let name = scene.material_names.get(material).filter(|name| !name.is_empty());
        let name = name.map_or("(without a material)".to_owned(), |name| format!("`{name}`"));
        let diffuse = paths.as_ref().is_some_and(|paths| paths.diffuse.get(material) == Some(&true));
        is_path |= diffuse;
        let diffuse = if diffuse { "  a diffuse ray" } else { "" };
        let name = format!("  {name}");
        let row = COLUMNS.row(&[&name, &rays.shadow, &rays.reflection, &rays.transmission]);
        println!("{row}{diffuse}");
    }
    if is_path {
        println!("  A path of indirect light continues with one of the rays other than those to lights.");
    }
    println!();
    Ok(())
}

/// Measures the noise of the picture, and prints how many samples a pixel needs for an error of one step of brightness.
pub fn samples(explained: &Explained<'_>) -> Result<()> {
    let Explained { scene, kit, .. } = explained;
    // Render the picture twice with different random numbers. The difference of two independent pixels has twice the
    // variance of one.
    let film = |seed| -> Result<Film> {
        Ok(render(*kit, &RenderJob { seed, count: false, ..job((*scene).clone()) })?.film)
    };
    let (one, other) = (film(1)?, film(2)?);
    let pairs = one.pixels.iter().zip(&other.pixels);
    let squares: f64 = pairs.map(|(p, q)| f64::from((*p - *q).length_squared()) / 3.0).sum();
    let variance = 0.5 * squares / one.pixels.len().max(1) as f64;
    // A pixel is the mean of n samples, so one sample has n times its variance.
    let n = scene.quality.samples_per_pixel;
    let deviation = (variance * f64::from(n)).sqrt() as f32;
    let Some(needed) = written(kit_error::catch(|| kit.samples_for_error(&[(deviation, STEP)])))? else {
        println!();
        return Ok(());
    };
    let text = match needed[0] {
        _ if deviation == 0.0 => "none: two pictures with different random numbers are equal.".to_owned(),
        needed => format!(
            "the pixels deviate by {:.4} from their means, with {n} samples each. One sample deviates by {deviation:.4}, so \
             a standard error of {STEP:.4} (1/255, a step of brightness) needs {needed} independent samples per pixel.",
            variance.sqrt()
        ),
    };
    println!("noise             {}\n", wrapped(&text, REASON_COLUMN));
    Ok(())
}

/// The answer, or `None` if the function is not written yet. Then prints its name and its place.
pub fn written<T>(answer: Result<T, KitError>) -> Result<Option<T>> {
    match answer {
        Ok(answer) => Ok(Some(answer)),
        Err(KitError::NotWritten { task, place, .. }) => {
            println!("left out, because a function is not written yet: {place}: {task}");
            Ok(None)
        }
        Err(error) => Err(error.into()),
    }
}
