//! Scenes of spheres and triangles, with the boxes and hulls around them and the `t` of hits. `t` is computed in double
//! precision, then rounded as if each primitive had its own formula.

use checks::double::sphere_roots;
use checks::prelude::*;
use checks::tree::{closest_of, move_apart};
use raykata::partition::corners;

/// A primitive of a scene.
#[derive(Clone, Copy, Debug)]
pub(super) enum Thing {
    /// A sphere.
    Sphere(Sphere),
    /// A triangle.
    Tile(Triangle),
}

/// The primitives to search, and how `t` is rounded.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    pub things: Vec<Thing>,
    /// Whether every second primitive has a `t` two floats too large and every other one two floats too small, as
    /// different formulas would give.
    pub rough: bool,
}

/// A scale for scenes, and one for the directions of rays. Both are powers of two, so they change no rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scales {
    pub size: f32,
    pub speed: f32,
}

/// Any scales for which a volume in a scene, and the square of a length times that of a direction, are normal numbers in
/// single precision.
pub(super) fn scales() -> impl Strategy<Value = Scales> + Clone {
    let scaled = (nasty::scale(-30..=30), nasty::scale(-24..=24));
    prop_oneof![1 => Just((1.0f32, 1.0f32)), 1 => scaled].prop_map(|(size, speed)| Scales { size, speed })
}

impl Scales {
    /// The ray at this scale. Each `t` is that of the plain ray times `size / speed`.
    pub(super) fn of_ray(self, ray: &Ray) -> Ray {
        let t = self.size / self.speed;
        Ray::new(self.size * ray.origin, self.speed * ray.direction).with_range(t * ray.t_min, t * ray.t_max)
    }

    fn of_thing(self, thing: Thing) -> Thing {
        match thing.moved(|point| self.size * point) {
            Thing::Sphere(Sphere { center, radius }) => {
                Thing::Sphere(Sphere { center, radius: self.size * radius })
            }
            tile => tile,
        }
    }
}

impl Thing {
    /// The same primitive with its centre or its corners moved.
    pub(super) fn moved(self, to: impl Fn(Vec3) -> Vec3) -> Thing {
        match self {
            Thing::Sphere(Sphere { center, radius }) => Thing::Sphere(Sphere { center: to(center), radius }),
            Thing::Tile(Triangle { a, b, c }) => Thing::Tile(Triangle { a: to(a), b: to(b), c: to(c) }),
        }
    }
}

impl Scene {
    pub(super) fn new(things: Vec<Thing>) -> Self {
        Scene { things, rough: false }
    }

    pub(super) fn boxes(&self) -> Vec<Aabb> {
        self.things.iter().map(bounds).collect()
    }

    pub(super) fn hulls(&self) -> Vec<Vec<Vec3>> {
        let hull = |thing: &Thing| match thing {
            Thing::Sphere(_) => corners(&bounds(thing)),
            Thing::Tile(Triangle { a, b, c }) => vec![*a, *b, *c],
        };
        self.things.iter().map(hull).collect()
    }

    /// The `t` of the nearest hit in front of the ray per primitive; `inf` if there is none. No two are equal.
    pub(super) fn hits(&self, ray: &Ray) -> Vec<f32> {
        let hit = |(index, thing): (usize, &Thing)| {
            let t = match thing {
                Thing::Sphere(sphere) => {
                    let roots = sphere_roots(ray, sphere).ok();
                    roots.and_then(|roots| [roots.near, roots.far].into_iter().find(|t| *t > 0.0))
                }
                Thing::Tile(tile) => tile_t(ray, tile),
            };
            match t {
                None => f32::INFINITY,
                Some(t) if self.rough && index % 2 == 0 => (t as f32).next_up().next_up(),
                Some(t) if self.rough => (t as f32).next_down().next_down(),
                Some(t) => t as f32,
            }
        };
        let mut hits: Vec<f32> = self.things.iter().enumerate().map(hit).collect();
        move_apart(&mut hits, 0.0);
        hits
    }
}

fn bounds(thing: &Thing) -> Aabb {
    match thing {
        Thing::Sphere(sphere) => checks::tree::sphere_box(sphere),
        Thing::Tile(Triangle { a, b, c }) => Aabb::new(a.min(*b).min(*c), a.max(*b).max(*c)),
    }
}

fn tile_t(ray: &Ray, tile: &Triangle) -> Option<f64> {
    let [a, b, c] = [tile.a, tile.b, tile.c].map(|p| p.as_dvec3() - ray.origin.as_dvec3());
    let direction = ray.direction.as_dvec3();
    // The sign of the volume that the direction spans with each side; points on an edge belong to both neighbours.
    let [u, v, w] = [direction.dot(c.cross(b)), direction.dot(a.cross(c)), direction.dot(b.cross(a))];
    let inside = [u, v, w].iter().all(|x| *x >= 0.0) || [u, v, w].iter().all(|x| *x <= 0.0);
    let normal = (b - a).cross(c - a);
    let t = a.dot(normal) / direction.dot(normal);
    (inside && u + v + w != 0.0 && t > 0.0).then_some(t)
}

/// The two triangles of a square wall across `axis` at `at`, from `-size` to `size`.
pub(super) fn wall(axis: usize, at: f32, size: f32) -> [Thing; 2] {
    let corner = |u: f32, v: f32| along(axis, vec3(at, u * size, v * size));
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    [Thing::Tile(Triangle { a, b, c }), Thing::Tile(Triangle { a, b: c, c: d })]
}

/// The vector with its x along `axis`, and its y and z along the next axes.
pub(super) fn along(axis: usize, v: Vec3) -> Vec3 {
    let mut turned = Vec3::ZERO;
    (0..3).for_each(|k| turned[(axis + k) % 3] = v[k]);
    turned
}

/// 27 spheres in a cube, with centres at this distance from each other.
pub(super) fn lattice(distance: f32) -> Vec<Thing> {
    let place = |i: i32| distance * vec3((i % 3) as f32, (i / 3 % 3) as f32, (i / 9) as f32);
    (0..27).map(|i| Thing::Sphere(Sphere { center: place(i), radius: 0.5 })).collect()
}

/// The twelve triangles of a room whose walls are at -1 and 1 across each axis, and 64 rays from inside it.
pub(super) fn room() -> (Scene, Vec<Ray>) {
    let walls = (0..3).flat_map(|axis| [wall(axis, -1.0, 1.0), wall(axis, 1.0, 1.0)]).flatten();
    let spread = |i: i32, k: i32| ((i * k) % 17) as f32 / 8.5 - 1.0;
    let direction = |i: i32| vec3(spread(i, 3), spread(i, 5), spread(i, 7) + 0.01);
    let rays = (0..64).map(|i| Ray::new(vec3(0.1, -0.2, 0.3), direction(i)));
    (Scene::new(walls.collect()), rays.collect())
}

/// The directions along axes and diagonals, with zeros of both signs.
pub(super) fn straight() -> impl Iterator<Item = Vec3> {
    const STEPS: [f32; 4] = [-1.0, 0.0, -0.0, 1.0];
    let all =
        STEPS.into_iter().flat_map(|x| STEPS.into_iter().flat_map(move |y| STEPS.map(|z| vec3(x, y, z))));
    all.filter(|direction| *direction != Vec3::ZERO)
}

/// A sphere with centre `(x, y, z)`.
pub(super) fn sphere(x: f32, y: f32, z: f32, radius: f32) -> Thing {
    Thing::Sphere(Sphere { center: vec3(x, y, z), radius })
}

/// Scenes of spheres and walls on a coarse grid, where many primitives touch or coincide, with a ray that is parallel to no face,
/// at any scale. The range of some rays begins or ends at the closest
/// hit, or one float before or after it.
pub(super) fn scenes() -> impl Strategy<Value = (Scene, Ray)> + Clone {
    let spheres = prop::collection::vec((point(6), fractions(1..=12, 8.0)), 0..16);
    let walls = prop::collection::vec((0..3usize, -4..=4i32, 1..=4i32), 0..5);
    let kinds = (any::<bool>(), any::<bool>(), scales(), 0..24usize);
    (spheres, walls, rays(), kinds).prop_map(|(spheres, walls, ray, (rough, twice, scales, range))| {
        let spheres = spheres.into_iter().map(|(p, r)| sphere(p.x, p.y, p.z, r));
        let walls = walls.into_iter().flat_map(|(axis, at, size)| wall(axis, at as f32, size as f32));
        let mut things: Vec<Thing> = spheres.chain(walls).map(|thing| scales.of_thing(thing)).collect();
        if twice && !rough {
            things.extend(things.clone());
        }
        let ray = Ray { direction: nasty::slanted(ray.direction), ..ray };
        let (scene, ray) = (Scene { things, rough }, scales.of_ray(&ray));
        // A quarter of these numbers choose a range.
        let at_hit =
            closest_of(&scene.hits(&ray), &ray).and_then(|(_, t)| nasty::ranges(t).get(range).copied());
        let ray = at_hit.map_or(ray, |((t_min, t_max), _)| ray.with_range(t_min, t_max));
        (scene, ray)
    })
}

/// Rays from a coarse grid. Half of the directions lead through edges and corners of cells.
pub(super) fn rays() -> impl Strategy<Value = Ray> + Clone {
    let plain = prop::sample::select(vec![
        vec3(1.0, 0.0, 0.0),
        vec3(-1.0, -0.0, 0.0),
        vec3(0.0, 1.0, -0.0),
        vec3(-0.0, -1.0, -0.0),
        vec3(0.0, 0.0, -2.0),
        vec3(1.0, 1.0, 1.0),
        vec3(-1.0, 1.0, -1.0),
        vec3(1.0, -1.0, 0.0),
        vec3(-0.0, 0.5, 0.5),
    ]);
    let direction = prop_oneof![1 => plain, 1 => nasty::unit()];
    let origin = prop_oneof![2 => point(10), 1 => point(5).prop_map(Vec3::round)];
    (origin, direction, 0..=6i32, 0..=9i32).prop_map(|(origin, direction, t_min, t_max)| {
        let t_max = if t_max < 6 { f32::INFINITY } else { 2.0 * (t_max - 5) as f32 };
        Ray::new(origin, direction).with_range((t_min - 4).max(0) as f32 / 2.0, t_max)
    })
}

/// Named scenes for which builders and searches often fail: far away, tiny, huge, flat, or all primitives in one place.
pub(super) fn odd_scenes() -> Vec<(&'static str, Scene, Vec<Ray>)> {
    let cluster = |scale: f32, offset: Vec3| -> Vec<Thing> {
        let place = |i: i32| vec3((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32);
        let thing =
            |i: i32| Thing::Sphere(Sphere { center: scale * place(i) + offset, radius: 0.375 * scale });
        (0..48).map(thing).collect()
    };
    let looks = |scale: f32, offset: Vec3| -> Vec<Ray> {
        let eyes = [vec3(-3.0, 0.25, 0.5), vec3(9.0, 8.0, 7.0), vec3(1.5, 1.5, 1.5), vec3(1.05, 0.95, -5.0)];
        let targets = (0..24).map(|i| vec3((i % 4) as f32, (i / 4 % 3) as f32 * 1.1, (i / 12) as f32 + 0.2));
        let ray = |eye: Vec3, target: Vec3| Ray::new(scale * eye + offset, (target - eye).normalize());
        targets.flat_map(|target| eyes.map(|eye| ray(eye, target))).collect()
    };
    let far = vec3(1e5, -1e5, 2e5);
    let line = (0..20).map(|i| sphere(i as f32, 0.0, 0.0, 0.25)).collect();
    let flat: Vec<Thing> = (0..6).flat_map(|i| wall(2, 0.0, 1.0 + 0.5 * i as f32)).collect();
    let teapot = cluster(1e-3, Vec3::ZERO).into_iter();
    let stadium = (0..3).flat_map(|axis| [-1.0, 1.0].map(|side| wall(axis, side * 1e5, 1e5))).flatten();
    [
        ("nothing", Vec::new(), looks(1.0, Vec3::ZERO)),
        ("one sphere", vec![sphere(1.0, 1.0, 1.0, 1.0)], looks(1.0, Vec3::ZERO)),
        ("sixty spheres in one place", vec![sphere(1.0, 1.0, 1.0, 1.0); 60], looks(1.0, Vec3::ZERO)),
        ("twelve tiles in one plane", flat, looks(1.0, Vec3::ZERO)),
        ("twenty spheres in a line", line, looks(1.0, Vec3::ZERO)),
        ("48 spheres", cluster(1.0, Vec3::ZERO), looks(1.0, Vec3::ZERO)),
        ("48 spheres at (1e5, -1e5, 2e5)", cluster(1.0, far), looks(1.0, far)),
        ("48 spheres of 1e-6", cluster(1e-6, Vec3::ZERO), looks(1e-6, Vec3::ZERO)),
        ("48 spheres of 1e30", cluster(1e30, Vec3::ZERO), looks(1e30, Vec3::ZERO)),
        ("a teapot of 1e-3 in a stadium of 1e5", teapot.chain(stadium).collect(), looks(1e-3, Vec3::ZERO)),
    ]
    .map(|(name, things, rays)| (name, Scene::new(things), rays))
    .into()
}
