//! An effect costs and changes nothing where the scene does not need it: proved for all 2⁹ sets of the nine
//! effects of `scenes/effects.toml`. `raykata explain scenes/effects.toml --subsets` prints what each set
//! costs.
//!
//! Indirect light is the tenth effect. It changes most pixels, so it is judged by other laws, for a set of sets in which every
//! two effects are present together, absent together, and each without the other.

use crate::scene::{assert_counted, job, path, rendered, scene, traced};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::count::Counts;
use raykata::effects::Effect;
use raykata::film::Film;
use raykata::kit::{RayKind, Rendering, TracedRay};
use raykata::mesh::Mesh;
use raykata::scene::Scene;
use std::sync::Arc;

/// All effects but indirect light, which is the last.
const EFFECTS: [Effect; 9] = *Effect::ALL.first_chunk().expect("ten effects");

/// A set of effects, one bit each.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Set(usize);

impl Set {
    fn all() -> impl Iterator<Item = Set> {
        (0..1 << EFFECTS.len()).map(Set)
    }
    fn has(self, effect: Effect) -> bool {
        EFFECTS.iter().position(|&other| other == effect).is_some_and(|bit| self.0 & 1 << bit != 0)
    }
    fn without(self, effect: Effect) -> Set {
        Set(EFFECTS.iter().position(|&other| other == effect).map_or(self.0, |bit| self.0 & !(1 << bit)))
    }
    fn absent(self) -> Vec<Effect> {
        EFFECTS.into_iter().filter(|&effect| !self.has(effect)).collect()
    }
}

fn text() -> String {
    std::fs::read_to_string(path("effects")).expect("a scene of this kit")
}

/// The scene in few pixels, with one sample each, and with a coarse smooth mesh in place of the vase.
fn small(mut scene: Scene) -> Scene {
    (scene.film.width, scene.film.height) = (20, 12);
    scene.quality.samples_per_pixel = 1;
    scene.meshes[0].mesh = Arc::new(Mesh {
        positions: [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z].map(|p| p + Vec3::Y).to_vec(),
        triangles: [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
            .to_vec(),
        ..Mesh::default()
    });
    scene
}

fn only(set: Set) -> Scene {
    set.absent().into_iter().fold(small(scene(&text())), |scene, effect| effect.removed_from(&scene))
}

/// A frame of a set, and the rays behind each of its pixels.
struct Frame {
    film: Film,
    counts: Counts,
    trees: Vec<Vec<TracedRay>>,
}

fn frame(set: Set) -> Frame {
    frame_of(only(set))
}

fn frame_of(scene: Scene) -> Frame {
    let job = job(&scene);
    let Rendering { film, counts, .. } = rendered(&job);
    Frame { film, counts, trees: traced(&job) }
}

/// The tree without rays of this kind and all rays below them.
fn pruned(tree: &[TracedRay], kind: RayKind) -> Vec<TracedRay> {
    let mut kept: Vec<TracedRay> = Vec::new();
    let mut place = Vec::new();
    for ray in tree {
        let parent = ray.parent.map(|parent| place[parent]);
        if ray.kind == kind || parent == Some(None) {
            place.push(None);
            continue;
        }
        place.push(Some(kept.len()));
        kept.push(TracedRay { parent: parent.flatten(), ..ray.clone() });
    }
    kept
}

/// Whether some ray of the tree hit one of these materials.
fn meets(tree: &[TracedRay], materials: &[&str]) -> bool {
    tree.iter().any(|ray| ray.hit.as_ref().is_some_and(|(_, name)| materials.contains(&name.as_str())))
}

/// Whether the line of some ray of the tree passes the region in which the toy sphere moves.
fn passes_the_toy(tree: &[TracedRay]) -> bool {
    let way = Aabb::new(vec3(0.34, 0.0, 1.34), vec3(1.76, 0.92, 2.31));
    tree.iter().any(|ray| {
        let (a, b) = ((way.min - ray.origin) / ray.direction, (way.max - ray.origin) / ray.direction);
        a.min(b).max_element().max(0.0) <= a.max(b).min_element()
    })
}

#[test]
fn each_set_of_effects_is_seen_to_be_what_it_is() {
    for set in Set::all() {
        let effects = &solutions::kit().effects(&[only(set)])[0];
        for effect in EFFECTS {
            // The only rough material is a mirror.
            let expected = set.has(effect) && (effect != Effect::Glossy || set.has(Effect::Mirrors));
            assert_eq!(effects.calls_for(effect), expected, "{effect} in {:?}", set.absent());
        }
    }
}

#[test]
fn what_is_left_out_of_the_file_and_what_is_switched_off_are_the_same() {
    let keys = [
        (Effect::Mirrors, "mirror ="),
        (Effect::Transmission, "transmission ="),
        (Effect::Glossy, "roughness ="),
        (Effect::Lens, "lens ="),
        (Effect::Motion, "transform_end ="),
        (Effect::Textures, "texture ="),
    ];
    let text = text();
    for set in Set::all() {
        let absent =
            |line: &&str| !keys.iter().any(|(effect, key)| !set.has(*effect) && line.starts_with(key));
        let lines: Vec<&str> = text.lines().filter(absent).collect();
        let others = set.absent().into_iter().filter(|effect| keys.iter().all(|(other, _)| other != effect));
        let written =
            others.fold(small(scene(&lines.join("\n"))), |scene, effect| effect.removed_from(&scene));
        // The file of an image that nothing shows is not read.
        let without_images = |scene: Scene| Scene { textures: Vec::new(), ..scene };
        let same = without_images(written) == without_images(only(set));
        assert!(same, "without {:?}", set.absent());
    }
}

#[test]
fn every_effect_adds_its_own_rays_and_changes_only_the_pixels_where_it_acts() {
    let frames: Vec<Frame> = Set::all().map(frame).collect();
    for set in Set::all() {
        let with = &frames[set.0];
        counts_are_what_the_rays_add_up_to(set, with);
        for effect in EFFECTS.into_iter().filter(|&effect| set.has(effect)) {
            let without = &frames[set.without(effect).0];
            let case = || format!("{effect}, without {:?}", set.absent());
            assert_eq!(with.counts.primary, without.counts.primary, "{}", case());
            for (pixel, (tree, old)) in with.trees.iter().zip(&without.trees).enumerate() {
                let (same_rays, acts) = match effect {
                    // These effects add branches to the tree and leave the rest unchanged.
                    Effect::Shadows => (
                        pruned(tree, RayKind::Shadow) == *old,
                        tree.iter().any(|ray| ray.kind == RayKind::Shadow),
                    ),
                    Effect::Mirrors => {
                        (pruned(tree, RayKind::Reflection) == *old, meets(tree, &["mirror", "brushed"]))
                    }
                    Effect::Transmission => {
                        (pruned(tree, RayKind::Transmission) == *old, meets(tree, &["glass"]))
                    }
                    Effect::AreaLights => {
                        let both = [tree, old].map(|tree| pruned(tree, RayKind::Shadow));
                        (both[0] == both[1], tree[0].hit.is_some())
                    }
                    // These effects change no ray.
                    Effect::Textures => (tree == old, meets(tree, &["floor", "toy"])),
                    // These effects change only trees that hit their materials.
                    Effect::Glossy => (tree == old || meets(tree, &["brushed"]), meets(tree, &["brushed"])),
                    Effect::SmoothNormals => (tree == old || meets(tree, &["clay"]), meets(tree, &["clay"])),
                    Effect::Motion => {
                        let near = passes_the_toy(tree) || passes_the_toy(old);
                        (tree == old || near, near)
                    }
                    _ => (true, true),
                };
                assert!(same_rays, "pixel {pixel} has other rays: {}", case());
                let same_color = with.film.pixels[pixel] == without.film.pixels[pixel];
                assert!(same_color || acts, "pixel {pixel} has another colour: {}", case());
            }
        }
    }
}

/// The counts of rays, hits, random numbers and image reads are exactly those that follow from the trees.
fn counts_are_what_the_rays_add_up_to(set: Set, frame: &Frame) {
    let Frame { counts, trees, .. } = frame;
    let rays = |wanted: &dyn Fn(&[TracedRay], &TracedRay) -> bool| {
        trees.iter().map(|tree| tree.iter().filter(|ray| wanted(tree, ray)).count() as u64).sum::<u64>()
    };
    let case = format!("without {:?}", set.absent());
    assert_counted(counts, trees, &case);
    let hits = rays(&|_, ray| ray.kind != RayKind::Shadow && ray.hit.is_some());
    assert_eq!(counts.hits, hits);

    let is_at =
        |ray: &TracedRay, names: &[&str]| ray.hit.as_ref().is_some_and(|hit| names.contains(&hit.1.as_str()));
    let covered = rays(&|_, ray| is_at(ray, &["floor", "toy"]));
    assert_eq!(counts.texture_reads, if set.has(Effect::Textures) { covered } else { 0 });

    // Two random numbers per point on the lens, per point on the light (two points per hit) and per glossy
    // ray, one per time.
    let blurred = rays(&|tree, ray| {
        ray.kind == RayKind::Reflection && ray.parent.is_some_and(|parent| is_at(&tree[parent], &["brushed"]))
    });
    let each = |effect: Effect, numbers: u64| if set.has(effect) { numbers } else { 0 };
    let numbers = each(Effect::Lens, 2 * counts.primary)
        + each(Effect::Motion, counts.primary)
        + each(Effect::AreaLights, 2 * 2 * hits)
        + each(Effect::Glossy, 2 * blurred);
    assert_eq!(counts.random_numbers, numbers, "{case}");
}

/// Sets in which each pair of the nine effects has all four combinations: all sets with at most one effect, and all with at
/// most two effects absent.
fn covering() -> Vec<Set> {
    let present = |set: &Set| set.0.count_ones() as usize;
    Set::all().filter(|set| present(set) <= 1 || present(set) + 2 >= EFFECTS.len()).collect()
}

#[test]
fn the_covering_sets_have_every_combination_of_two_effects() {
    let sets = covering();
    assert_eq!(sets.len(), 1 + 9 + 36 + 9 + 1);
    for one in EFFECTS {
        for other in EFFECTS.into_iter().filter(|&other| other != one) {
            for wanted in [(false, false), (false, true), (true, false), (true, true)] {
                assert!(sets.iter().any(|set| (set.has(one), set.has(other)) == wanted), "{one} {other}");
            }
        }
    }
}

#[test]
fn indirect_light_changes_no_camera_ray_and_traces_only_what_the_set_needs() {
    for set in covering() {
        let scene = Scene { indirect_light: true, ..only(set) };
        let case = || format!("without {:?}", set.absent());
        // Taking indirect light out gives the scene of before, and so its rays, counts and pixels.
        assert_eq!(Effect::IndirectLight.removed_from(&scene), only(set));
        let (with, without) = (frame_of(scene.clone()), frame(set));
        // The camera rays and their hits are the same, because no effect changes the random numbers of another.
        assert_eq!(with.counts.primary, without.counts.primary, "{}", case());
        for (path, tree) in with.trees.iter().zip(&without.trees) {
            assert_eq!(path[0], tree[0], "{}", case());
        }
        // A path has one ray per bounce, and no ray of an effect that the set lacks.
        let depth = scene.quality.max_depth;
        for path in &with.trees {
            let rays = path.iter().filter(|ray| ray.kind != RayKind::Shadow);
            assert!(rays.enumerate().all(|(bounce, ray)| ray.depth == bounce as u32 && ray.depth <= depth));
        }
        let counts = with.counts;
        assert!(counts.indirect > 0, "{}", case());
        assert_counted(&counts, &with.trees, &case());
        assert!(set.has(Effect::Shadows) || counts.shadow == 0, "{}", case());
        assert!(
            set.has(Effect::Mirrors) || set.has(Effect::Transmission) || counts.reflection == 0,
            "{}",
            case()
        );
        assert!(set.has(Effect::Transmission) || counts.transmission == 0, "{}", case());
        random_numbers_are_those_of_the_vertices(set, &scene, &with);
    }
}

/// The counts of random numbers and image reads of paths are exactly those that follow from their vertices.
fn random_numbers_are_those_of_the_vertices(set: Set, scene: &Scene, frame: &Frame) {
    let each = |effect: Effect, numbers: u64| if set.has(effect) { numbers } else { 0 };
    let (mut numbers, mut reads) = (0, 0);
    for path in &frame.trees {
        numbers += each(Effect::Lens, 2) + each(Effect::Motion, 1);
        for (index, ray) in path.iter().enumerate().filter(|(_, ray)| ray.kind != RayKind::Shadow) {
            let Some((_, name)) = &ray.hit else { continue };
            let is = |names: &[&str]| names.contains(&name.as_str());
            // Two samples of the area light, with two numbers each.
            numbers += each(Effect::AreaLights, 2 * 2);
            reads += each(Effect::Textures, u64::from(is(&["floor", "toy"])));
            if ray.depth == scene.quality.max_depth {
                continue;
            }
            // The glass has no diffuse lobe. There are no emitters to sample.
            let is_diffuse = !is(&["glass"]);
            let secondary = (is(&["mirror", "brushed"]) && set.has(Effect::Mirrors))
                || (is(&["glass"]) && set.has(Effect::Transmission));
            let lobes = u64::from(is_diffuse) + u64::from(secondary);
            numbers += 2 * u64::from(is_diffuse) + u64::from(lobes > 1);
            numbers += u64::from(lobes > 0 && ray.depth >= 2);
            // Two numbers for the direction of a rough reflection.
            let next = path.iter().find(|next| next.parent == Some(index) && next.kind != RayKind::Shadow);
            let is_glossy = is(&["brushed"]) && next.is_some_and(|next| next.kind == RayKind::Reflection);
            numbers += each(Effect::Glossy, 2 * u64::from(is_glossy));
        }
    }
    let case = format!("without {:?}", set.absent());
    assert_eq!(frame.counts.random_numbers, numbers, "{case}");
    assert_eq!(frame.counts.texture_reads, reads, "{case}");
}
