//! Whole ray trees, counted in scenes so simple that the number of rays is known.

use super::picture::glass;
use super::scatter::{FAR, arriving, grey, paste};
use checks::golden::Table;
use checks::prelude::*;
use raykata::material::Material;

/// A tree with more rays than this is reported as infinite.
const TOO_MANY: usize = 20_000;

/// The number of rays in a closed room in which every ray meets the same surface at the same angle.
fn rays_in_a_room(trial: &Trial<'_>, (mirror, transmission, limits): &Room) -> (usize, ScatterQuery) {
    let first = ScatterQuery { limits: *limits, ..arriving(grey(*mirror, *transmission)) };
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

/// A closed room: its mirror and transmission, and the limits.
type Room = (f32, f32, Limits);

/// When a secondary ray is traced, by its depth and the weights of the incoming ray and of itself.
type Rule = fn(depth: u32, parent: f32, own: f32, limits: &Limits) -> bool;

/// The rule of the doc comment.
const RIGHT: Rule =
    |depth, _, own, limits| depth <= limits.max_depth && own > 0.0 && own >= limits.min_contribution;
/// Rules with a known mistake each.
const MISTAKES: [(Rule, &str); 8] = named![
    |depth, _, own, limits| depth <= limits.max_depth + 1 && own > 0.0 && own >= limits.min_contribution =>
        "a ray of depth max_depth has no secondary rays: compare depth with limits.max_depth",
    |depth, _, own, limits| depth < limits.max_depth && own > 0.0 && own >= limits.min_contribution =>
        "you end the tree one ray too early: a ray of depth max_depth - 1 has secondary rays",
    |_, _, own, limits| own > 0.0 && own >= limits.min_contribution => "you leave out limits.max_depth",
    |depth, _, own, limits| own > 0.0 && (depth <= limits.max_depth || own >= limits.min_contribution) =>
        "you trace a ray if one limit allows it: both must allow it",
    |depth, _, own, limits| depth <= limits.max_depth && own >= limits.min_contribution =>
        "you trace rays of weight 0",
    |depth, parent, _, limits| {
        depth <= limits.max_depth && parent > 0.0 && parent >= limits.min_contribution
    } => "you test the weight of the incoming ray: test the secondary ray's own weight",
    |depth, parent, own, limits| {
        depth <= limits.max_depth && own > 0.0 && parent >= limits.min_contribution
    } => "you test the weight of the incoming ray: test the secondary ray's own weight",
    |depth, _, own, limits| depth <= limits.max_depth && own > 0.0 =>
        "you leave out limits.min_contribution: only the depth ends the tree",
];

/// The number of rays in a room by a rule, up to [`TOO_MANY`].
fn count((mirror, transmission, limits): &Room, rule: Rule) -> usize {
    let mut level = vec![1.0f32];
    let (mut rays, mut depth) = (0, 0);
    while !level.is_empty() && rays < TOO_MANY {
        rays += level.len();
        depth += 1;
        let children = |parent: f32| [parent * mirror, parent * transmission].map(|own| (parent, own));
        let traced = level.iter().flat_map(|parent| children(*parent));
        level =
            traced.filter(|(parent, own)| rule(depth, *parent, *own, limits)).map(|(_, own)| own).collect();
    }
    rays
}

/// Counts the rays of each room. `allows` says which other numbers pass.
fn judge(trial: &Trial<'_>, rooms: &[Room], allows: impl Fn(&Room, usize) -> bool) -> CheckResult {
    let describe =
        |rays: usize| if rays < TOO_MANY { format!("{rays} rays") } else { "an infinite tree".into() };
    let judge = |room: &Room, (rays, first): (usize, ScatterQuery)| {
        let expected = count(room, RIGHT);
        if rays == expected || allows(room, rays) {
            return Ok(());
        }
        let input = format!("a closed room, with every secondary ray traced, from\n{}", paste(&first));
        Err(Broken::with_texts(input, describe(rays), describe(expected), "counted"))
    };
    let answers = rooms.iter().map(|room| rays_in_a_room(trial, room)).collect();
    all_hold(compare_formulas(rooms, answers, judge, |room, (rays, _)| {
        // A tree that exceeds the limit is infinite by any of the rules that exceed it.
        MISTAKES.map(|(rule, text)| (count(room, rule).min(TOO_MANY) == (*rays).min(TOO_MANY), text)).into()
    }))
}

pub(super) fn tree_ends_at_its_depth(trial: &Trial<'_>) -> CheckResult {
    let deep = |max_depth: u32| (0.5, 0.5, Limits { max_depth, ..FAR });
    let (low, high) = trial.varied((5, 10), (3..=6u32, 7..=10u32));
    // Surfaces that neither reflect nor transmit, depth 10: 1 ray instead of 2047.
    let dull = (0.0, 0.0, Limits { max_depth: 10, ..FAR });
    // Here the weight ends the tree before the depth does.
    let dim = (0.5, 0.5, Limits { max_depth: 4, min_contribution: 0.2 });
    judge(trial, &[deep(0), deep(1), deep(2), deep(low), deep(high), dull, dim], |_, _| false)
}

pub(super) fn tree_ends_below_min_contribution(trial: &Trial<'_>) -> CheckResult {
    // Weights halve down to 0.01: 1/64 is traced and 1/128 is not. Testing the incoming ray gives 255 rays. No weight is
    // equal to the limit, because another check asks about that.
    let min_contribution = trial.varied(0.01, 0.008f32..0.0155);
    let halving = |mirror: f32, transmission: f32, max_depth: u32| {
        (mirror, transmission, Limits { max_depth, min_contribution })
    };
    judge(
        trial,
        &[
            halving(0.5, 0.0, 20),
            halving(0.5, 0.5, 100),
            halving(0.5, 0.0, 100),
            halving(0.25, 0.7, 30),
            // Here the depth ends the tree before the weight does. Another check counts the depth exactly.
            halving(1.0, 0.0, 5),
        ],
        |room, rays| room.0 == 1.0 && (5..=7).contains(&rays),
    )
}

pub(super) fn facing_mirrors_end(trial: &Trial<'_>) -> CheckResult {
    // A perfect mirror keeps the whole weight, so only the depth ends the tree. Another check counts the depth exactly.
    let max_depth = trial.varied(50, 30..=80u32);
    let mirrors = (1.0, 0.0, Limits { max_depth, min_contribution: 0.001 });
    let most = max_depth as usize + 2;
    judge(trial, &[mirrors], |room, rays| (most - 2..=most).contains(&rays) && room.0 == 1.0)
}

/// The tree of a ray through a glass sphere, each ray with its weight. Every correct solution gives this tree.
pub(super) fn tree_of_a_glass_sphere(trial: &Trial<'_>) -> CheckResult {
    // Another index and another angle for a hidden seed.
    let (index_of_refraction, sine) = trial.composed((1.5, 0.5), (1.2..1.8f32, 0.2..0.8f32));
    let glass = glass(index_of_refraction);
    let start = vec3(-1.0, 0.0, 0.0);
    let direction = vec3((1.0 - sine * sine).sqrt(), sine, 0.0);
    let input = "a ray into a sphere of glass (index 1.5, Fresnel::Exact) at 30°, depth 4";
    Table { name: "stage5_tree_of_a_glass_sphere", input }.check(trial, |kit| {
        let mut text = String::new();
        follow(kit, &glass, start, direction, true, Vec3::ONE, 0, &mut text);
        text
    })
}

/// Writes the secondary rays of a ray that meets the unit sphere at `point`, and theirs, recursively.
#[allow(clippy::too_many_arguments, reason = "a recursion over plain data")]
fn follow(
    kit: &dyn Kit,
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
    let mut children = kit.scatter(&[query]).remove(0);
    children.sort_by_key(|child| child.bounce == Bounce::Transmission);
    for child in children {
        let indent = "  ".repeat(depth as usize);
        let goes_in = (child.bounce == Bounce::Transmission) == entering;
        let fate = if goes_in { "to the sphere" } else { "away" };
        text.push_str(&format!("{indent}{:?} {:.3} {fate}\n", child.bounce, child.weight.x));
        if goes_in {
            // Inside the sphere, the next hit is the other end of the chord.
            let next = point - 2.0 * point.dot(child.direction) * child.direction;
            follow(kit, glass, next.normalize(), child.direction, false, child.weight, depth + 1, text);
        }
    }
}
