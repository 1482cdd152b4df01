//! Whole ray trees, counted in scenes so simple that the number of rays is known.

use super::scatter::{FAR, paste};
use checks::broken::{Broken, CheckResult};
use checks::{Trial, golden};
use glam::{Vec3, vec3};
use raykata::kit::{Bounce, Limits, ScatterQuery};
use raykata::material::{Fresnel, Material};

/// A tree with more rays than this is reported as infinite.
const TOO_MANY: usize = 20_000;

/// The number of rays in a closed room in which every ray meets the same surface at the same angle.
fn rays_in_a_room(trial: &Trial<'_>, material: &Material, limits: Limits) -> (usize, ScatterQuery) {
    let first = ScatterQuery {
        direction: vec3(0.6, -0.8, 0.0),
        normal: Vec3::Y,
        entering: true,
        material: material.clone(),
        weight: Vec3::ONE,
        depth: 0,
        limits,
    };
    let mut level = vec![first.clone()];
    let mut rays = 0;
    while !level.is_empty() && rays < TOO_MANY {
        rays += level.len();
        let children = trial.kit.scatter(&level);
        let next = |(parent, children): (&ScatterQuery, Vec<raykata::kit::SecondaryRay>)| {
            let depth = parent.depth + 1;
            let parent = parent.clone();
            children
                .into_iter()
                .map(move |child| ScatterQuery { weight: child.weight, depth, ..parent.clone() })
                .collect::<Vec<_>>()
        };
        level = level.iter().zip(children).flat_map(next).collect();
    }
    (rays, first)
}

fn judge(
    trial: &Trial<'_>,
    mirror: f32,
    transmission: f32,
    limits: Limits,
    expected: usize,
    diagnosis: &str,
) -> CheckResult {
    let material = Material {
        mirror: Vec3::splat(mirror),
        transmission: Vec3::splat(transmission),
        ..Material::default()
    };
    let (rays, first) = rays_in_a_room(trial, &material, limits);
    if rays == expected {
        return Ok(());
    }
    let describe =
        |rays: usize| if rays < TOO_MANY { format!("{rays} rays") } else { "an infinite tree".into() };
    let input = format!("a closed room, with every secondary ray traced, from\n{}", paste(&first));
    Err(Broken::with_texts(input, describe(rays), describe(expected), "counted").looks_like(Some(diagnosis)))
}

pub(super) fn tree_ends_at_its_depth(trial: &Trial<'_>) -> CheckResult {
    let depth = "a ray of depth max_depth has no secondary rays: compare depth with limits.max_depth";
    for (max_depth, expected) in [(0, 1), (1, 3), (2, 7), (5, 63), (10, 2047)] {
        judge(trial, 0.5, 0.5, Limits { max_depth, ..FAR }, expected, depth)?;
    }
    // R8: surfaces that neither reflect nor transmit, depth 10: 1 ray instead of 2047.
    judge(trial, 0.0, 0.0, Limits { max_depth: 10, ..FAR }, 1, "you trace rays of weight 0")
}

pub(super) fn tree_ends_below_min_contribution(trial: &Trial<'_>) -> CheckResult {
    // R9: weights halve down to 0.01: 1/64 is traced and 1/128 is not. Testing the incoming ray gives 255 rays.
    let parent = "you test the weight of the incoming ray: test the secondary ray's own weight";
    let limits = |min_contribution: f32| Limits { max_depth: 100, min_contribution };
    // Without the limit on the weight there are 1 + 20 rays.
    let left_out = "you leave out limits.min_contribution: only the depth ends the tree";
    let halving = judge(trial, 0.5, 0.0, Limits { max_depth: 20, min_contribution: 0.01 }, 7, parent);
    halving.map_err(|broken| match broken.yours.as_str() {
        "21 rays" => broken.looks_like(Some(left_out)),
        _ => broken,
    })?;
    judge(trial, 0.5, 0.5, limits(0.01), 127, parent)?;
    judge(trial, 0.5, 0.0, limits(0.01), 7, parent)?;
    judge(
        trial,
        0.25,
        0.5,
        limits(0.5),
        2,
        "a weight equal to min_contribution is traced, and a smaller one is not",
    )?;
    // Both limits hold: the tree ends at the one that is reached first.
    judge(
        trial,
        0.5,
        0.5,
        Limits { max_depth: 3, min_contribution: 0.01 },
        15,
        "test both limits: depth and weight",
    )
}

pub(super) fn facing_mirrors_end(trial: &Trial<'_>) -> CheckResult {
    // A perfect mirror keeps the whole weight, so only the depth ends the tree.
    judge(
        trial,
        1.0,
        0.0,
        Limits { max_depth: 50, min_contribution: 0.001 },
        51,
        "the weight stays 1 here: max_depth must end the tree",
    )
}

/// The tree of a ray through a glass sphere, each ray with its weight. Every correct solution gives this tree.
pub(super) fn tree_of_a_glass_sphere(trial: &Trial<'_>) -> CheckResult {
    let glass = Material {
        transmission: Vec3::ONE,
        index_of_refraction: 1.5,
        fresnel: Fresnel::Exact,
        ..Material::default()
    };
    let mut text = String::new();
    let start = vec3(-1.0, 0.0, 0.0);
    let (sine, cosine) = (0.5f32, 0.75f32.sqrt());
    follow(trial, &glass, start, vec3(cosine, sine, 0.0), true, Vec3::ONE, 0, &mut text);
    golden::compare(
        "stage5_tree_of_a_glass_sphere",
        "a ray into a sphere of glass (index 1.5, Fresnel::Exact) at 30°, depth 4",
        &text,
    )
}

/// Writes the secondary rays of a ray that meets the unit sphere at `point`, and theirs, recursively.
#[allow(clippy::too_many_arguments, reason = "a recursion over plain data")]
fn follow(
    trial: &Trial<'_>,
    glass: &Material,
    point: Vec3,
    direction: Vec3,
    entering: bool,
    weight: Vec3,
    depth: u32,
    text: &mut String,
) {
    let normal = if entering { point } else { -point };
    let limits = Limits { max_depth: 4, min_contribution: 0.001 };
    // Stop where a solution ignores the depth limit, because another check reports that mistake.
    if depth > 2 * limits.max_depth || text.len() > 10_000 {
        text.push_str("…\n");
        return;
    }
    let query = ScatterQuery { direction, normal, entering, material: glass.clone(), weight, depth, limits };
    let mut children = trial.kit.scatter(&[query]).remove(0);
    children.sort_by_key(|child| child.bounce == Bounce::Transmission);
    for child in children {
        let indent = "  ".repeat(depth as usize);
        let goes_in = (child.bounce == Bounce::Transmission) == entering;
        let fate = if goes_in { "to the sphere" } else { "away" };
        text.push_str(&format!("{indent}{:?} {:.3} {fate}\n", child.bounce, child.weight.x));
        if goes_in {
            // Inside the sphere, the next hit is the other end of the chord.
            let next = point - 2.0 * point.dot(child.direction) * child.direction;
            follow(trial, glass, next.normalize(), child.direction, false, child.weight, depth + 1, text);
        }
    }
}
