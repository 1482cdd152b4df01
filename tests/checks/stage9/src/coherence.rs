//! The laws of the last hit and of packets of rays: the same answers with fewer tests and fewer opened nodes.

use super::scenes::{Scene, rays, scenes, sphere};
use checks::generate::unit;
use checks::prelude::*;
use checks::tree::{self, closest_in_table, closest_of, search_query, sphere_box};
use raykata::bvh::PrimitiveHit;

fn cached(scene: &Scene, ray: &Ray, last: Option<u32>) -> CachedQuery {
    let hits = scene.hits(ray);
    // Round the entry of a box down, so that it is not behind a hit in the box. Some `hits` are two floats off.
    let entry = |one: &Aabb, hit: f32| (checks::double::box_interval(ray, one).0 as f32).next_down().min(hit);
    let entries = scene.boxes().iter().zip(&hits).map(|(one, hit)| entry(one, *hit)).collect();
    CachedQuery { last, ray: *ray, hits, entries }
}

pub(super) fn cached_hit_changes_no_answer(trial: &Trial<'_>) -> CheckResult {
    let inputs = (scenes(), any::<u32>()).prop_map(|((scene, ray), pick)| {
        let n = scene.things.len() as u32;
        (cached(&scene, &ray, (n > 0).then(|| pick % n)), n)
    });
    // Two primitives at the same t, and the larger number is known: the smaller one must still be reported.
    let pair = Scene::new(vec![sphere(5.0, 0.0, 0.0, 1.0); 2]);
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let tie = (CachedQuery { hits: vec![4.0; 2], ..cached(&pair, &ray, Some(1)) }, 2);
    let judge = |queries: &[(CachedQuery, u32)]| {
        let only: Vec<CachedQuery> = queries.iter().map(|(query, _)| query.clone()).collect();
        compare(queries, trial.kit.cached_search(&only), |(query, n), yours| {
            let expected = closest_of(&query.hits, &query.ray);
            let found = yours.hit.map(|hit| (hit.primitive, hit.t));
            if found == expected {
                return Ok(());
            }
            let known = query.last.map(|last| query.hits[last as usize]).filter(|t| query.ray.contains(*t));
            let is_last = |primitive: u32| Some(primitive) == query.last;
            let mistakes = [
                "you return a hit outside the ray's range: test the last primitive with this ray"
                    .when(found.is_some_and(|(_, t)| !query.ray.contains(t))),
                "of two hits at the same t the smaller number wins: end the ray one float above the known hit"
                    .when(found.zip(expected).is_some_and(|((_, t), (_, best))| t == best)),
                "you return the hit with the last primitive, but a nearer one exists: search on"
                    .when(found.is_some_and(|(primitive, _)| is_last(primitive)) && yours.tests.len() == 1),
                "you search nothing if the ray misses the last primitive: search with the whole ray"
                    .when(found.is_none() && known.is_none() && query.last.is_some() && yours.tests.len() == 1),
                "you forget the hit with the last primitive: the search with the shortened ray may find nothing"
                    .when(found.is_none() && known.is_some()),
                "you return the farther of the known hit and the found one: keep the nearer"
                    .when(found.is_some() && expected.is_some()),
            ];
            let input =
                format!("{n} primitives, of which {:?} was the last hit\n{}", query.last, query.ray.paste());
            Err(Broken::new(input, found, expected, "brute force, (primitive, t)").explained_by(mistakes))
        })
    };
    let behind = Scene::new(vec![sphere(2.0, 0.0, 0.0, 0.5), sphere(5.0, 0.0, 0.0, 1.0)]);
    let nearer = (cached(&behind, &ray, Some(1)), 2);
    trial.forall_and(&[nearer, tie], 700, inputs, judge)
}

pub(super) fn cached_hit_saves_tests(trial: &Trial<'_>) -> CheckResult {
    // A row of spheres one behind the other, numbered from the far end: without a known hit the search tests all.
    let row = Scene::new((0..32).rev().map(|i| sphere(3.0 * i as f32, 0.0, 0.0, 1.0)).collect());
    let [first, again] =
        [vec3(-5.0, 0.1, 0.0), vec3(-5.0, 0.11, 0.0)].map(|origin| Ray::new(origin, Vec3::X));
    let answers = trial.kit.cached_search(&[cached(&row, &first, None), cached(&row, &again, Some(31))]);
    let counts = [answers[0].tests.len(), answers[1].tests.len()];
    // With the known hit it tests that sphere, and again as the only one whose box begins before the hit.
    if counts == [32, 2] {
        return Ok(());
    }
    let describe = |[first, again]: [usize; 2]| format!("{first} tests without a known hit, {again} with it");
    let mistakes = [
        (counts[1] > 32, "the ray is not shortened: end it at the known hit"),
        (counts[0] > 32, "you test a primitive before the search although there is no known hit"),
        (counts[1] == 1, "you leave out the search: this ray may hit a nearer primitive"),
    ];
    let input = "a ray along 32 spheres in a row, and the next ray, which hits the same one";
    Err(Broken::with_texts(input, describe(counts), describe([32, 2]), "counted").explained_by(mistakes))
}

fn packet(spheres: &[Sphere], rays: &[Ray]) -> (PacketQuery, Vec<SearchQuery>) {
    let boxes: Vec<Aabb> = spheres.iter().map(sphere_box).collect();
    let bvh = tree::joined(&boxes, 2);
    let queries: Vec<SearchQuery> = rays.iter().map(|ray| search_query(&bvh, spheres, ray)).collect();
    let tables = queries.iter().map(|query| query.table.clone()).collect();
    (PacketQuery { bvh, rays: rays.to_vec(), tables }, queries)
}

/// Packets of up to 20 rays, side by side or in any direction.
fn packets() -> impl Strategy<Value = (Vec<Sphere>, Vec<Ray>)> + Clone {
    let sphere = (point(6), fractions(1..=8, 4.0)).prop_map(|(center, radius)| Sphere { center, radius });
    let beam = (rays(), prop::collection::vec(unit(), 1..20)).prop_map(|(ray, spread)| {
        spread.iter().map(|off| Ray { direction: ray.direction + 0.1 * *off, ..ray }).collect::<Vec<Ray>>()
    });
    let any_way = prop::collection::vec(rays(), 0..12);
    (prop::collection::vec(sphere, 0..30), prop_oneof![3 => beam, 1 => any_way], any::<bool>()).prop_map(
        |(spheres, rays, twice)| {
            let times = if twice { 2 } else { 1 };
            let spheres = spheres.into_iter().flat_map(|sphere| std::iter::repeat_n(sphere, times)).collect();
            (spheres, rays)
        },
    )
}

pub(super) fn packet_finds_what_single_rays_find(trial: &Trial<'_>) -> CheckResult {
    trial.forall(500, packets(), |cases| {
        let asked: Vec<(PacketQuery, Vec<SearchQuery>)> =
            cases.iter().map(|(spheres, rays)| packet(spheres, rays)).collect();
        let queries: Vec<PacketQuery> = asked.iter().map(|(query, _)| query.clone()).collect();
        compare(&asked, trial.kit.packet_search(&queries), |(query, singles), yours| {
            let input = format!("{} rays, {} nodes", query.rays.len(), query.bvh.nodes.len());
            let yours_count = yours.hits.len();
            if yours_count != query.rays.len() {
                let (yours, expected) = (format!("{} hits", yours.hits.len()), format!("{}", query.rays.len()));
                let broken = Broken::with_texts(input, yours, expected, "one per ray");
                return Err(broken.explained_by([
                    "an empty tree has no hit: return None for each ray"
                        .when(yours_count == 0 && query.bvh.nodes.is_empty()),
                    "a packet has eight rays at most: put the other rays into further packets"
                        .when(yours_count == query.rays.len().min(8)),
                    "rays that do not fill a packet get no answer: the last packet may be smaller"
                        .when(yours_count == query.rays.len() / 8 * 8),
                ]));
            }
            let right: Vec<_> = singles.iter().map(closest_in_table).collect();
            let found: Vec<_> = yours.hits.iter().map(|hit| hit.map(|hit| (hit.primitive, hit.t))).collect();
            // All in reverse order, or each packet.
            let packets = found.chunks(8).flat_map(|packet| packet.iter().rev());
            let in_reverse = packets.eq(&right) || found.iter().rev().eq(&right);
            let yours_opened = &yours.opened;
            for (index, (single, yours)) in singles.iter().zip(&yours.hits).enumerate() {
                let expected = closest_in_table(single);
                let found = yours.map(|hit| (hit.primitive, hit.t));
                if found != expected {
                    // A node that every right search opens for this ray.
                    let (needed, _) = tree::needed(single);
                    let is_left = needed.iter().any(|node| !yours_opened.contains(&(*node as u32)));
                    let is_lost = found.is_none_or(|(_, t)| expected.is_some_and(|(_, best)| t > best));
                    // Another ray of this packet ends before this hit, or has a nearer one.
                    let packet = (index / 8 * 8..singles.len()).take(8);
                    let ends = packet.map(|i| right[i].map_or(singles[i].ray.t_max, |(_, t)| t));
                    let is_cut = expected.is_some_and(|(_, t)| ends.clone().any(|end| end < t));
                    let mistakes = [
                        "you return a hit outside the range of this ray: each ray has its own range"
                            .when(found.is_some_and(|(_, t)| !single.ray.contains(t))),
                        "you return the hit of another ray: each ray keeps its own"
                            .when(found.is_some_and(|(primitive, t)| single.table.primitives.get(primitive as usize) != Some(&t))),
                        (in_reverse, "the hits are in reverse order: return them in the order of the rays"),
                        "the packet left a node that this ray enters: skip a node only if no ray of the packet enters it"
                            .when(is_left),
                        "each node that this ray needs is opened, but its nearest primitive is not tested with it, or the hit is lost"
                            .when(!is_left && is_lost),
                        (is_cut && is_lost, "a hit of one ray shortens the range of the others: each has its own"),
                    ];
                    let input = format!("{input}; ray {index}: {}", single.ray.paste());
                    let broken = Broken::new(input, found, expected, "brute force, (primitive, t)");
                    return Err(broken.explained_by(mistakes));
                }
            }
            Ok(())
        })
    })
}

pub(super) fn packet_opens_a_node_once(trial: &Trial<'_>) -> CheckResult {
    // A row of spheres of which a ray from either end hits the first. No two boxes overlap, so the order is unique.
    let row: Vec<Sphere> =
        (0..64).map(|i| Sphere { center: vec3(4.0 * i as f32, 0.0, 0.0), radius: 1.0 }).collect();
    let ask = |spheres: &[Sphere], rays: &[Ray]| {
        let (query, singles) = packet(spheres, rays);
        (trial.kit.packet_search(&[query]).remove(0), singles)
    };
    for (x, direction) in [(-9.0, Vec3::X), (300.0, Vec3::NEG_X)] {
        let (yours, singles) = ask(&row, &[Ray::new(vec3(x, 0.0, 0.0), direction); 8]);
        judge_opened("8 equal rays along a row of", &yours, &singles, opened_alone(&singles[0]))?;
        // A ray that misses everything opens nothing more, and has no hit with which to compare an entry.
        let mut rays = [Ray::new(vec3(x, 0.0, 0.0), direction); 8];
        rays[7].direction = Vec3::Y;
        let (yours, singles) = ask(&row, &rays);
        judge_opened("7 equal rays and one that misses", &yours, &singles, opened_alone(&singles[0]))?;
        let opened = ask(&row, &[rays[7]; 8]).0.opened;
        if !opened.is_empty() {
            let input = "8 rays that miss all of 64 spheres and the box around them";
            let yours = format!("{} nodes opened", opened.len());
            let says = "you open a node that no ray enters: ask about the root, too";
            return Err(Broken::with_texts(input, yours, "none", "counted").because(says));
        }
    }
    let spheres: Vec<Sphere> = (0..64)
        .map(|i| Sphere {
            center: vec3((i % 8) as f32, (i / 8) as f32, 0.3 * (i % 3) as f32) * 2.0,
            radius: 0.6,
        })
        .collect();
    let ray = |x: f32, y: f32| Ray::new(vec3(-6.0, 7.0, 9.0), vec3(x + 6.0, y - 7.0, -9.0).normalize());
    for (x, y) in [(1.0, 1.0), (7.0, 9.0), (12.0, 3.0), (14.5, 14.0)] {
        // Eight equal rays open as many nodes as one ray.
        let (yours, singles) = ask(&spheres, &[ray(x, y); 8]);
        // If a ray enters both children at the same t, either may come first.
        let most = opened_alone(&singles[0]) + 2;
        judge_opened("8 equal rays through", &yours, &singles, most)?;
        // Eight rays side by side open fewer nodes together than one after the other.
        let beam: Vec<Ray> = (0..8).map(|i| ray(x + 0.05 * i as f32, y)).collect();
        let (yours, singles) = ask(&spheres, &beam);
        let alone: u64 = singles.iter().map(opened_alone).sum();
        judge_opened("8 rays side by side through", &yours, &singles, alone / 2)?;
        let needless = needless(&yours, &singles);
        // Allow a quarter of needless nodes, because some rays of a packet enter the farther child first.
        if needless > yours.opened.len() / 4 {
            let describe = format!("{needless} of {} opened nodes are needless", yours.opened.len());
            let broken =
                Broken::with_texts("8 rays side by side through 64 spheres", describe, "few", "counted");
            return Err(broken.explained_by([(needless > 0, NEEDLESS)]));
        }
    }
    Ok(())
}

const NEEDLESS: &str = "you open nodes that no ray enters before its hit: shorten each ray to its best hit, and search the nearer child first";

/// How many opened nodes no ray enters before its hit.
fn needless(yours: &PacketAnswer, singles: &[SearchQuery]) -> usize {
    let needed = |node: u32| {
        singles.iter().any(|single| {
            let (near, far) = single.table.boxes[node as usize];
            let end = closest_in_table(single).map_or(single.ray.t_max, |(_, t)| t);
            near.max(single.ray.t_min) <= far && near <= end
        })
    };
    yours.opened.iter().filter(|&&node| !needed(node)).count()
}

/// How many nodes a ray has to open.
fn opened_alone(query: &SearchQuery) -> u64 {
    tree::needed(query).0.len() as u64
}

fn judge_opened(what: &str, yours: &PacketAnswer, singles: &[SearchQuery], most: u64) -> CheckResult {
    let mut opened = yours.opened.clone();
    opened.sort_unstable();
    let again = opened.windows(2).find(|pair| pair[0] == pair[1]);
    let describe = |n: u64| format!("{n} nodes opened");
    let input = format!("{what} 64 spheres");
    // A search that opens nothing finds nothing.
    let hits = |found: &[Option<PrimitiveHit>]| found.iter().flatten().count();
    let expected = singles.iter().filter(|single| closest_in_table(single).is_some()).count();
    if hits(&yours.hits) != expected || opened.is_empty() {
        let yours = format!("{} hits, {}", hits(&yours.hits), describe(opened.len() as u64));
        let broken = Broken::with_texts(input, yours, format!("{expected} hits"), "brute force");
        return Err(broken);
    }
    if let Some(pair) = again {
        let yours = format!("node {} is opened again", pair[0]);
        let broken = Broken::with_texts(input, yours, "once per packet", "counted");
        // Of children that are entered at the same t, either may come first.
        let alone: u64 = singles.iter().map(opened_alone).sum();
        let one_by_one = (opened.len() as u64).abs_diff(alone) <= alone / 4;
        return Err(broken
            .explained_by(["you open as many nodes as rays that are searched one after the other: open a node once for all rays that enter it"
                .when(one_by_one)]));
    }
    if yours.opened.len() as u64 > most {
        let (got, right) = (describe(yours.opened.len() as u64), format!("at most {}", describe(most)));
        let broken = Broken::with_texts(input, got, right, "counted");
        return Err(broken.explained_by([(needless(yours, singles) > 0, NEEDLESS)]));
    }
    Ok(())
}
