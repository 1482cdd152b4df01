//! Rooms for paths, in double precision: the judge holds the geometry, and `step` gets one surface at a time.

use checks::prelude::*;
use checks::statistics::pairs;
use raykata::emitter::{AreaEmitter, EmitterShape};
use raykata::light_path::{
    ChosenEmitter, LightCandidate, PathState, PathStep, PathVertex, Scattering, StepNumbers,
};

/// The shape of a surface.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// An infinite plane through a point, with this unit normal.
    Plane(DVec3, DVec3),
    /// All points `corner + s first + t second` with s and t in `0..=1`.
    Parallelogram(DVec3, DVec3, DVec3),
    /// A sphere by its centre and radius.
    Sphere(DVec3, f64),
}

/// What a surface does with light, on both sides.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Paint {
    pub diffuse: Vec3,
    /// The reflectance of a perfect mirror.
    pub mirror: Vec3,
    pub emission: Vec3,
}

/// A surface of a room.
#[derive(Clone, Debug)]
pub(super) struct Wall {
    pub form: Form,
    pub paint: Paint,
    /// Other paints of a sphere: each of the points at a height above this one along an axis, for the unit sphere.
    pub caps: Vec<(DVec3, f64, Paint)>,
    /// The emitter as which the wall is sampled, with its probability.
    pub emitter: Option<ChosenEmitter>,
}

impl Wall {
    pub fn new(form: Form, paint: Paint) -> Wall {
        Wall { form, paint, caps: Vec::new(), emitter: None }
    }

    /// A wall that emits `emission` on both sides, is black, and is sampled with this probability.
    pub fn light(form: Form, emission: Vec3, probability: f32) -> Wall {
        Wall::new(form, Paint { emission, ..Paint::default() }).sampled(probability)
    }

    /// The same wall, sampled with this probability. A plane cannot be sampled.
    pub fn sampled(mut self, probability: f32) -> Wall {
        let shape = match self.form {
            Form::Plane(..) => return self,
            Form::Parallelogram(corner, first, second) => EmitterShape::Parallelogram {
                corner: corner.as_vec3(),
                edges: (first.as_vec3(), second.as_vec3()),
            },
            Form::Sphere(center, radius) => {
                EmitterShape::Sphere(Sphere { center: center.as_vec3(), radius: radius as f32 })
            }
        };
        let emitter = AreaEmitter { shape, radiance: self.paint.emission, two_sided: true };
        self.emitter = Some(ChosenEmitter { emitter, probability });
        self
    }

    /// The distances at which a ray hits the wall, in any order.
    fn distances(&self, origin: DVec3, direction: DVec3) -> [f64; 2] {
        match self.form {
            Form::Plane(point, normal) => {
                [(point - origin).dot(normal) / direction.dot(normal), f64::INFINITY]
            }
            Form::Parallelogram(corner, first, second) => {
                let normal = first.cross(second);
                let distance = (corner - origin).dot(normal) / direction.dot(normal);
                let offset = origin + distance * direction - corner;
                let s = offset.cross(second).dot(normal) / normal.length_squared();
                let t = first.cross(offset).dot(normal) / normal.length_squared();
                // The edges of walls that meet overlap a little, so that no ray leaves a closed room.
                let reach = -1e-9..=1.0 + 1e-9;
                [
                    if reach.contains(&s) && reach.contains(&t) { distance } else { f64::INFINITY },
                    f64::INFINITY,
                ]
            }
            Form::Sphere(center, radius) => {
                let to_center = center - origin;
                let middle = to_center.dot(direction);
                let beside = (to_center - middle * direction).length_squared();
                let half = (radius * radius - beside).sqrt();
                [middle - half, middle + half]
            }
        }
    }

    /// The unit normal and the paint at a point.
    fn at(&self, point: DVec3) -> (DVec3, Paint) {
        match self.form {
            Form::Plane(_, normal) => (normal, self.paint),
            Form::Parallelogram(_, first, second) => (first.cross(second).normalize(), self.paint),
            Form::Sphere(center, _) => {
                let normal = (point - center).normalize();
                let cap = self.caps.iter().find(|(axis, height, _)| normal.dot(*axis) > *height);
                (normal, cap.map_or(self.paint, |(_, _, paint)| *paint))
            }
        }
    }
}

/// A room: its walls, and the radiance of rays that hit none.
#[derive(Clone, Debug, Default)]
pub(super) struct Room {
    pub walls: Vec<Wall>,
    pub sky: Vec3,
}

/// Hits nearer than this are the surface that the ray leaves. Rooms have a size of about 1.
const NEAREST: f64 = 1e-7;

impl Room {
    /// The first wall that a ray hits, and the distance.
    pub fn hit(&self, origin: DVec3, direction: DVec3) -> Option<(usize, f64)> {
        let mut first = (usize::MAX, f64::INFINITY);
        for (index, wall) in self.walls.iter().enumerate() {
            for distance in wall.distances(origin, direction) {
                if distance > NEAREST && distance < first.1 {
                    first = (index, distance);
                }
            }
        }
        (first.0 != usize::MAX).then_some(first)
    }

    /// Whether no wall is nearer than this distance, up to the rounding of the distance.
    fn is_visible(&self, origin: DVec3, direction: DVec3, distance: f64) -> bool {
        self.hit(origin, direction).is_none_or(|(_, nearest)| nearest > distance * (1.0 - 1e-4))
    }

    /// The emitter that a number in 0..1 chooses.
    fn choose(&self, u: f32) -> Option<LightCandidate> {
        let mut rest = u;
        let mut chosen = None;
        for emitter in self.walls.iter().filter_map(|wall| wall.emitter) {
            chosen = Some(LightCandidate::Emitter(emitter));
            if rest < emitter.probability {
                break;
            }
            rest -= emitter.probability;
        }
        chosen
    }

    /// The surface that a ray along `direction` meets at `point` of a wall.
    fn vertex(&self, wall: usize, point: DVec3, direction: DVec3, u: f32) -> PathVertex {
        let (normal, paint) = self.walls[wall].at(point);
        let normal = if normal.dot(direction) > 0.0 { -normal } else { normal };
        let reflected = direction - 2.0 * direction.dot(normal) * normal;
        let mirror = SecondaryRay {
            bounce: Bounce::Reflection,
            direction: reflected.as_vec3().normalize(),
            weight: paint.mirror,
        };
        let secondary = if paint.mirror == Vec3::ZERO { Vec::new() } else { vec![mirror] };
        let normal = normal.as_vec3();
        let point = point.as_vec3();
        let error = 1e-6 * point.abs();
        PathVertex {
            surface: Surface { point, error, geometric_normal: normal, shading_normal: normal },
            scattering: Scattering { diffuse: paint.diffuse, normal, secondary },
            emission: paint.emission,
            emitter: self.walls[wall].emitter,
            light: self.choose(u),
        }
    }
}

/// A path that is not finished.
struct Path {
    index: usize,
    origin: DVec3,
    direction: DVec3,
    state: PathState,
}

/// Whether so many steps show that paths do not end: more than 40 per path, on average, and some more for a few long paths. In a
/// room that does not end paths by their depth, light is lost at each bounce, and the slowest roulette that passes takes fewer
/// than 20 steps per path.
pub(super) fn are_endless(paths: usize, steps: usize) -> bool {
    steps > 40 * paths + 200_000
}

/// Whether Russian roulette is played in a room.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Roulette {
    Played,
    /// As if it were not, in a room with a channel that loses no light: a path whose weight is 1 survives the number 1/2 by
    /// every rule that is allowed, and the factor is taken out of its weight.
    LeftOut,
}

/// The light of paths that start with these rays. All are followed at once: each call of `step` gets the next surface of every
/// path. Random numbers depend on `seed`.
pub(super) fn follow(
    kit: &dyn Kit,
    seed: u64,
    room: &Room,
    starts: &[(DVec3, DVec3)],
    max_depth: u32,
    roulette: Roulette,
) -> Result<Vec<DVec3>, Broken> {
    let start = |(index, (origin, direction)): (usize, &(DVec3, DVec3))| {
        let state = PathState {
            origin: origin.as_vec3(),
            direction: direction.as_vec3(),
            weight: Vec3::ONE,
            bounces: 0,
            pdf: f32::INFINITY,
        };
        Path { index, origin: *origin, direction: *direction, state }
    };
    let mut paths: Vec<Path> = starts.iter().enumerate().map(start).collect();
    let mut light = vec![DVec3::ZERO; starts.len()];
    let mut n_steps = 0;
    let mut generation = 0u64;
    while !paths.is_empty() {
        if are_endless(starts.len(), n_steps) {
            let yours =
                format!("{} of {} paths are alive after {} steps", paths.len(), starts.len(), n_steps);
            let broken =
                Broken::with_texts("step, for paths in a room", yours, "no path", "Russian roulette");
            return Err(broken.looks_like(Some(
                "your paths do not end: their weights never fall, or no roulette ends them",
            )));
        }
        // Find the surface that each path meets. A path that meets none finds the sky, which is not sampled.
        let u = pairs(seed ^ (generation << 40), 4 * paths.len());
        generation += 1;
        let mut met = Vec::with_capacity(paths.len());
        let mut queries = Vec::with_capacity(paths.len());
        for (path, u) in paths.into_iter().zip(u.chunks(4)) {
            let Some((wall, distance)) = room.hit(path.origin, path.direction) else {
                light[path.index] += (path.state.weight * room.sky).as_dvec3();
                continue;
            };
            let point = path.origin + distance * path.direction;
            queries.push(StepQuery {
                path: path.state,
                vertex: room.vertex(wall, point, path.direction, u[3].x),
                max_depth,
                numbers: StepNumbers {
                    light: u[0],
                    bsdf: u[1].extend(u[2].x),
                    roulette: if roulette == Roulette::Played { u[2].y } else { 0.5 },
                },
            });
            met.push((path, point));
        }
        // Take one step with each path.
        let mut steps = kit.step(&queries);
        if roulette == Roulette::LeftOut {
            let weights = |(step, query): (&PathStep, &StepQuery)| {
                let weight = step.next.as_ref().map_or(Vec3::ONE, |next| next.weight);
                RouletteQuery { weight, bounce: query.path.bounces + 1, u: 0.5 }
            };
            let factors = kit.survives(&steps.iter().zip(&queries).map(weights).collect::<Vec<_>>());
            for (step, factor) in steps.iter_mut().zip(factors).filter(|(_, factor)| *factor > 0.0) {
                step.next.iter_mut().for_each(|next| next.weight /= factor);
            }
        }
        n_steps += queries.len();
        paths = Vec::with_capacity(met.len());
        for (((path, point), query), step) in met.into_iter().zip(&queries).zip(steps) {
            light[path.index] += step.light.as_dvec3();
            if let Some(shadow) = step.shadow {
                let direction = shadow.direction.as_dvec3().normalize_or_zero();
                if room.is_visible(point, direction, f64::from(shadow.distance)) {
                    light[path.index] += shadow.light.as_dvec3();
                }
            }
            if let Some(next) = step.next {
                let direction = next.direction.as_dvec3().normalize_or_zero();
                let state = PathState {
                    origin: query.vertex.surface.point,
                    direction: next.direction,
                    weight: next.weight,
                    bounces: path.state.bounces + 1,
                    pdf: next.pdf,
                };
                paths.push(Path { index: path.index, origin: point, direction, state });
            }
        }
    }
    Ok(light)
}
