//! Searches against brute force over exact predicates: a search is right if what it finds is among the triangles that the
//! ray exactly meets first.

use super::traversal::{Packet, Triangles, hierarchy};
use glam::{UVec3, Vec3};
use oracle::exact::{Body, meet, triangle};
use oracle::gauntlet::scenes::{HardScene, hard_scenes};
use oracle::splitmix::Random;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, PrimitiveHit};
use raykata::partition::{KdHeuristics, KdTree};
use raykata::ray::Ray;
use raykata::scene::Split;
use raykata::shape::Triangle;
use solutions::{
    stage2_triangles, stage3_bvh, stage9_bsp, stage9_coherence, stage9_grid, stage9_kd_tree, stage9_octree,
};

/// What came of one way to search one scene.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// The scene.
    pub scene: &'static str,
    /// How it was searched.
    pub search: String,
    /// Rays that were asked.
    pub rays: u64,
    /// Of these, rays that exactly meet something.
    pub hits: u64,
    /// Of these, rays that meet several triangles at one `t` first.
    pub ties: u64,
    /// Answers for rays through an edge, to a rounding of double precision, in which that rounding decided.
    pub roundings: u64,
    /// Wrong answers: not exact, or not those of brute force.
    pub mismatches: u64,
}

/// A ray and what may be found.
struct Asked {
    ray: Ray,
    /// The triangles that are exactly met first; several for a tie.
    ties: Vec<usize>,
    /// The first `t` at which a triangle is met through its inside, and not within a rounding of an edge.
    sure: Option<f32>,
    /// What asking all triangles finds.
    brute: Option<PrimitiveHit>,
}

/// In double an edge is known to a few roundings of 2⁻⁵³: to less than a millionth of a rounding of single precision.
const ON_AN_EDGE: f64 = 1e-6;

impl Asked {
    fn new(scene: &HardScene, random: &mut Random) -> Asked {
        let ray = scene.ray(random);
        let ties = triangle::tie_set(&ray, &scene.triangles);
        let sure = scene.triangles.iter().filter(|triangle| !is_on_an_edge(&ray, triangle));
        let sure = sure.filter_map(|triangle| exact_t(&ray, triangle)).min_by(f32::total_cmp);
        let no_tree = Bvh::default();
        let mut probe = Triangles::new(&no_tree, &scene.triangles, &ray);
        let brute = stage2_triangles::brute_force(scene.triangles.len() as u32, &mut probe, &ray);
        Asked { ray, ties, sure, brute }
    }

    fn judge(&self, triangles: &[Triangle], found: Option<PrimitiveHit>) -> Judgement {
        if found != self.brute {
            return Judgement::Wrong;
        }
        let Some(found) = found else {
            return match (self.ties.is_empty(), self.sure) {
                (true, _) => Judgement::Right,
                (false, None) => Judgement::Rounding,
                (false, Some(_)) => Judgement::Wrong,
            };
        };
        let (index, triangle) = (found.primitive as usize, &triangles[found.primitive as usize]);
        let first = self.ties.first().and_then(|&first| exact_t(&self.ray, &triangles[first]));
        // Two different `t` may round to the same number, and then the smaller index wins.
        if self.ties.contains(&index) || (first.is_some() && exact_t(&self.ray, triangle) == first) {
            return Judgement::Right;
        }
        let no_later = self.sure.is_none_or(|sure| found.t <= sure);
        let hit = exact_t(&self.ray, triangle) == Some(found.t) || is_on_an_edge(&self.ray, triangle);
        if no_later && hit { Judgement::Rounding } else { Judgement::Wrong }
    }

    fn judge_any(&self, found: bool) -> Judgement {
        match (found == self.brute.is_some(), found != self.ties.is_empty()) {
            (false, _) => Judgement::Wrong,
            (true, true) => Judgement::Right,
            (true, false) if self.sure.is_none() => Judgement::Rounding,
            (true, false) => Judgement::Wrong,
        }
    }
}

fn is_on_an_edge(ray: &Ray, triangle: &Triangle) -> bool {
    triangle::margin(ray, triangle).is_none_or(|margin| margin < ON_AN_EDGE)
}

/// How an answer compares with the exact one, and with brute force.
enum Judgement {
    Right,
    /// The ray passes through an edge to a rounding of double precision, and that rounding decided.
    Rounding,
    Wrong,
}

fn exact_t(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    meet(ray, Body::Triangle(*triangle)).and_then(|meeting| meeting.t)
}

type Search = fn(&Bvh, &mut Triangles<'_>, &Ray) -> Option<PrimitiveHit>;

/// Every search of the reference on every hard scene, with so many rays each.
pub fn all(seed: u64, rays: u64) -> Vec<Agreement> {
    let searches: [(&str, Search); 2] = [
        ("both children", |bvh, probe, ray| stage3_bvh::closest_hit_both(bvh, probe, ray)),
        ("nearer first", |bvh, probe, ray| stage3_bvh::closest_hit(bvh, probe, ray)),
    ];
    let mut agreements = Vec::new();
    for scene in hard_scenes() {
        let mut random = Random::new(seed, 21);
        let asked: Vec<Asked> = (0..rays).map(|_| Asked::new(&scene, &mut random)).collect();
        agreements.push(agreement(&scene, "brute force".into(), &asked, |one| {
            one.judge(&scene.triangles, one.brute)
        }));
        for (split, leaf_size) in Split::ALL.into_iter().flat_map(|split| [(split, 1), (split, 4)]) {
            let bvh = hierarchy(&scene.triangles, split, leaf_size);
            for (name, search) in searches {
                let told = format!("{split:?}, leaves of {leaf_size}, {name}");
                agreements.push(agreement(&scene, told, &asked, |one| {
                    let mut probe = Triangles::new(&bvh, &scene.triangles, &one.ray);
                    one.judge(&scene.triangles, search(&bvh, &mut probe, &one.ray))
                }));
            }
            let told = format!("{split:?}, leaves of {leaf_size}, any hit");
            agreements.push(agreement(&scene, told, &asked, |one| {
                let mut probe = Triangles::new(&bvh, &scene.triangles, &one.ray);
                one.judge_any(stage3_bvh::any_hit(&bvh, &mut probe, &one.ray))
            }));
        }
        for (told, found) in partitions(&scene, &asked) {
            let mut found = found.into_iter();
            agreements.push(agreement(&scene, told, &asked, |one| {
                one.judge(&scene.triangles, found.next().flatten())
            }));
        }
    }
    agreements
}

/// What the structures of stage 9 find, ray by ray.
fn partitions(scene: &HardScene, asked: &[Asked]) -> Vec<(String, Vec<Option<PrimitiveHit>>)> {
    let triangles = &scene.triangles;
    let bounds: Vec<Aabb> = triangles.iter().map(stage3_bvh::triangle_bounds).collect();
    let around =
        bounds.iter().filter(|one| !one.is_empty()).fold(Aabb::EMPTY, |p, q| stage3_bvh::union(&p, q));
    let hulls: Vec<Vec<Vec3>> = triangles.iter().map(|t| vec![t.a, t.b, t.c]).collect();
    let no_tree = Bvh::default();
    let each = |search: &dyn Fn(&mut Triangles<'_>, &Ray) -> Option<PrimitiveHit>| {
        let find = |one: &Asked| search(&mut Triangles::new(&no_tree, triangles, &one.ray), &one.ray);
        asked.iter().map(find).collect::<Vec<_>>()
    };
    let mut found = Vec::new();
    let formula = stage9_grid::resolution(&around, triangles.len(), 4.0);
    for (name, resolution) in [("of 3³ cells", UVec3::splat(3)), ("by the formula", formula)] {
        let grid = stage9_grid::build(&bounds, resolution);
        found.push((format!("grid {name}"), each(&|probe, ray| stage9_grid::closest_hit(&grid, probe, ray))));
    }
    for leaf_size in [1, 8] {
        let tree = stage9_octree::build(&bounds, leaf_size, 12);
        let named = |how: &str| format!("octree, leaves of {leaf_size}, {how}");
        let by_cells = each(&|probe, ray| stage9_octree::closest_hit_by_cells(&tree, probe, ray));
        found.push((named("by cells"), by_cells));
        found.push((
            named("from the root"),
            each(&|probe, ray| stage9_octree::closest_hit(&tree, probe, ray)),
        ));
    }
    for (name, heuristics) in
        [("all heuristics", KdHeuristics::default()), ("no heuristic", KdHeuristics::NONE)]
    {
        let tree = stage9_kd_tree::build(&bounds, &heuristics, 2);
        found.push((
            format!("kd-tree, {name}"),
            each(&|probe, ray| stage9_kd_tree::closest_hit(&tree, probe, ray)),
        ));
    }
    let tree = stage9_bsp::build(&hulls, 2, KdTree::most_depth(hulls.len()));
    found.push(("BSP tree".into(), each(&|probe, ray| stage9_bsp::closest_hit(&tree, probe, ray))));

    let bvh = hierarchy(triangles, Split::SurfaceArea, 2);
    let mut last = None;
    let cached = |one: &Asked| {
        let search = |probe: &mut Triangles<'_>, ray: &Ray| stage3_bvh::closest_hit(&bvh, probe, ray);
        let mut probe = Triangles::new(&bvh, triangles, &one.ray);
        let hit = stage9_coherence::closest_hit_cached(last, &mut probe, &one.ray, search);
        last = hit.map_or(last, |hit| Some(hit.primitive));
        hit
    };
    found.push(("hierarchy, last hit first".into(), asked.iter().map(cached).collect()));
    let rays: Vec<Ray> = asked.iter().map(|one| one.ray).collect();
    let first = rays.first().copied().unwrap_or_else(|| Ray::new(Vec3::ZERO, Vec3::X));
    let mut packet = Packet(Triangles::new(&bvh, triangles, &first));
    found.push(("hierarchy, packets".into(), stage9_coherence::closest_hit_packet(&bvh, &mut packet, &rays)));
    found
}

fn agreement(
    scene: &HardScene,
    search: String,
    asked: &[Asked],
    mut judge: impl FnMut(&Asked) -> Judgement,
) -> Agreement {
    let mut agreement = Agreement {
        scene: scene.name,
        search,
        rays: asked.len() as u64,
        hits: asked.iter().filter(|one| !one.ties.is_empty()).count() as u64,
        ties: asked.iter().filter(|one| one.ties.len() > 1).count() as u64,
        roundings: 0,
        mismatches: 0,
    };
    for one in asked {
        match judge(one) {
            Judgement::Right => {}
            Judgement::Rounding => agreement.roundings += 1,
            Judgement::Wrong => agreement.mismatches += 1,
        }
    }
    agreement
}
