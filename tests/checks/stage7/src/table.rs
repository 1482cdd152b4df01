//! The table of stage 7: the effects that scenes need, and the rays that they need at most.

use super::scenes::{BUILT, everything};
use checks::golden::Table;
use checks::prelude::*;
use raykata::effects::Effect;
use raykata::scene::Scene;

fn hyphenated(effect: Effect) -> String {
    effect.to_string().replace(' ', "-")
}

/// The scene with all effects at these settings, and without each one and each two neighbours of them.
fn scenes(width: u32, samples: u32, max_depth: u32, light_samples: u32) -> Vec<(String, Scene)> {
    let mut all = everything();
    all.film.width = width;
    all.film.height = 32;
    all.quality.samples_per_pixel = samples;
    all.quality.max_depth = max_depth;
    all.quality.light_samples = light_samples;
    all.quality.glossy_samples = 2;
    let without = |effects: &[Effect]| {
        let names: Vec<String> = effects.iter().copied().map(hyphenated).collect();
        let scene = effects.iter().fold(all.clone(), |scene, effect| effect.removed_from(&scene));
        (format!("without {}", names.join(" and ")), scene)
    };
    let mut scenes = vec![("everything".to_owned(), all.clone())];
    scenes.extend(BUILT.iter().map(|effect| without(&[*effect])));
    scenes.extend(BUILT.windows(2).map(without));
    scenes
}

fn line(kit: &dyn Kit, (name, scene): &(String, Scene)) -> String {
    let effects = kit.effects(std::slice::from_ref(scene)).remove(0);
    let needed: Vec<String> =
        Effect::ALL.into_iter().filter(|effect| effects.calls_for(*effect)).map(hyphenated).collect();
    let query = BoundQuery { scene: scene.clone(), effects };
    let RayCounts { primary, shadow, reflection, transmission } = kit.most_rays(&[query]).remove(0);
    format!(
        "{name}: {}\n  at most {primary} primary, {shadow} shadow, {reflection} reflection, {transmission} transmission",
        needed.join(" ")
    )
}

pub(super) fn table_of_effects(trial: &Trial<'_>) -> CheckResult {
    let (width, samples, max_depth, light_samples) =
        trial.composed((48, 4, 3, 2), (1..100u32, 1..16u32, 1..5u32, 1..8u32));
    let scenes = scenes(width, samples, max_depth, light_samples);
    let input = "scenes without one or two effects";
    Table { name: "stage7_effects", input }
        .check(trial, |kit| scenes.iter().map(|scene| line(kit, scene)).collect::<Vec<String>>().join("\n"))
}
