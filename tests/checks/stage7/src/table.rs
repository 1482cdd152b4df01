//! The table of stage 7: the effects that scenes need, and the rays that they need at most.

use super::scenes::{BUILT, everything};
use checks::Trial;
use checks::broken::CheckResult;
use checks::golden::Table;
use raykata::effects::Effect;
use raykata::kit::{BoundQuery, Kit};
use raykata::scene::Scene;

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
        let names: Vec<String> = effects.iter().map(|effect| effect.to_string().replace(' ', "-")).collect();
        let scene = effects.iter().fold(all.clone(), |scene, effect| effect.removed_from(&scene));
        (format!("without {}", names.join(" and ")), scene)
    };
    let mut scenes = vec![("everything".to_owned(), all.clone())];
    scenes.extend(BUILT.iter().map(|effect| without(&[*effect])));
    scenes.extend(BUILT.windows(2).map(without));
    scenes
}

fn lines(kit: &dyn Kit, scenes: &[(String, Scene)]) -> String {
    let effects = kit.effects(&scenes.iter().map(|(_, scene)| scene.clone()).collect::<Vec<_>>());
    let queries: Vec<BoundQuery> = scenes
        .iter()
        .zip(&effects)
        .map(|((_, scene), effects)| BoundQuery { scene: scene.clone(), effects: effects.clone() })
        .collect();
    let bounds = kit.most_rays(&queries);
    let line = |(((name, _), effects), most): ((&(String, Scene), _), &raykata::kit::RayCounts)| {
        let effects: &raykata::effects::Effects = effects;
        let needed = Effect::ALL.iter().filter(|effect| effects.calls_for(**effect));
        let needed: Vec<String> = needed.map(|effect| effect.to_string().replace(' ', "-")).collect();
        format!(
            "{name}: {}\n  at most {} primary, {} shadow, {} reflection, {} transmission",
            needed.join(" "),
            most.primary,
            most.shadow,
            most.reflection,
            most.transmission
        )
    };
    scenes.iter().zip(&effects).zip(&bounds).map(line).collect::<Vec<String>>().join("\n")
}

pub(super) fn table_of_effects(trial: &Trial<'_>) -> CheckResult {
    let (width, samples, max_depth, light_samples) =
        trial.composed((48, 4, 3, 2), (1..100u32, 1..16u32, 1..5u32, 1..8u32));
    let scenes = scenes(width, samples, max_depth, light_samples);
    let input = "scenes without one or two effects";
    Table { name: "stage7_effects", input }.check(trial, |kit| lines(kit, &scenes))
}
