//! Wrong hits and leaks of knobs that decide only how hits are found, on the scene itself, against the oracle.
//!
//! The scene is made of triangles, spheres and planes ([`World::plain`]), whose first hits are known exactly. Rays start at
//! the eye and go through the picture; and where such a ray meets a triangle first, one more is aimed at an edge of that
//! triangle, and one at a corner, if neighbours close the surface there.

mod search;
mod surface;

use super::measure::{Bench, Measured};
use super::setting::Setting;
use crate::queue;
use crate::report::bar_of_steps;
use anyhow::Result;
use oracle::exact::{Body, meet};
use oracle::splitmix::Random;
use raykata::bvh::PrimitiveHit;
use raykata::kit::{RenderJob, View, mishap};
use raykata::ray::Ray;
use raykata::scene::Scene;
use raykata::world::{World, camera_for};
use search::Search;
use serde::Serialize;
use surface::Surface;

/// What the oracle says of one way to find hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Verdicts {
    /// Rays that were asked.
    pub rays: u64,
    /// Of these, those that found something else than what they exactly meet first, or nothing, or something for nothing.
    pub wrong: u64,
    /// Of these, those that went through a closed surface.
    pub leaks: u64,
}

/// Rays through the picture: columns and rows. With those at edges and corners they are three times as many at most.
const THROUGH: (u32, u32) = (64, 36);

/// For more bodies it takes minutes.
const MOST_BODIES: usize = 3_000_000;

/// Judges all settings of knobs that decide only how hits are found. A scene of too much, or of nothing, is not judged.
pub fn judge(bench: &Bench<'_>, scene: &Scene, measured: &mut Measured) -> Result<()> {
    let geometric = measured.series.iter().filter(|series| series.knob.is_geometric());
    let mut places: Vec<usize> =
        geometric.flat_map(|series| &series.rungs).map(|(_, index)| *index).collect();
    places.sort_unstable();
    places.dedup();
    if places.is_empty() || bench.stopped() {
        return Ok(());
    }
    let bar = bar_of_steps(places.len() + 1);
    bar.set_message("first hits, exactly");
    let Some(jury) = Jury::new(scene)? else { return Ok(()) };
    for index in places {
        bar.inc(1);
        if bench.stopped() {
            break;
        }
        let point = &mut measured.points[index];
        point.hits = Some(jury.ask(bench, scene, &point.setting)?);
    }
    bar.finish_and_clear();
    Ok(())
}

/// A ray, and what it exactly meets.
struct Asked {
    ray: Ray,
    /// The first `t`, correctly rounded.
    first: Option<f32>,
    /// Whether it is met in a surface that is closed around there, so that no rounding lets a ray through.
    closed: bool,
}

/// All that rays can meet, and rays.
struct Jury {
    bodies: Vec<Body>,
    asked: Vec<Asked>,
}

impl Jury {
    fn new(scene: &Scene) -> Result<Option<Jury>> {
        let world = World::plain(scene);
        if world.primitives.len() > MOST_BODIES || world.primitives.is_empty() {
            return Ok(None);
        }
        let bodies = search::bodies(&world);
        let search = Search::over(&bodies, world.primitives.len());
        let surface = Surface::of(&bodies);
        let camera = camera_for(scene);
        let rows: Vec<u32> = (0..THROUGH.1).collect();
        let of_row = |_: &(), &row: &u32| {
            let mut random = Random::new(u64::from(row), 31);
            let mut asked = Vec::new();
            for column in 0..THROUGH.0 {
                let (x, y) = (column as f32 + random.unit(), row as f32 + random.unit());
                let ray = camera.ray(x / THROUGH.0 as f32, y / THROUGH.1 as f32);
                let (index, one) = search.asked(ray);
                asked.push(one);
                let Some(Body::Triangle(_)) = index.map(|index| bodies[index as usize]) else { continue };
                for aim in surface.aims(ray.origin, index.unwrap_or_default(), &mut random) {
                    let (index, one) = search.asked(Ray::new(ray.origin, aim.target - ray.origin));
                    // Something else may stand before it.
                    let closed = index.is_some_and(|index| aim.around.contains(&index));
                    asked.push(Asked { closed, ..one });
                }
            }
            Ok(asked)
        };
        let asked = queue::run(&queue::one_a_core(), &rows, of_row)?.into_iter().flatten().collect();
        Ok(Some(Jury { bodies, asked }))
    }

    fn ask(&self, bench: &Bench<'_>, scene: &Scene, setting: &Setting) -> Result<Verdicts> {
        let scene = setting.apply(scene);
        let job = RenderJob { scene, view: View::Shaded, seed: 0, threads: bench.threads, count: false };
        let rays: Vec<Ray> = self.asked.iter().map(|one| one.ray).collect();
        let hits = mishap::catch(|| bench.kit.first_hits(&job, &rays))?;
        let mut verdicts = Verdicts { rays: rays.len() as u64, ..Verdicts::default() };
        for (asked, found) in self.asked.iter().zip(hits) {
            verdicts.wrong += u64::from(self.is_wrong(asked, found));
            verdicts.leaks += u64::from(asked.closed && is_beyond(asked.first, found));
        }
        Ok(verdicts)
    }

    fn is_wrong(&self, asked: &Asked, found: Option<PrimitiveHit>) -> bool {
        let met = |hit: PrimitiveHit| meet(&asked.ray, *self.bodies.get(hit.primitive as usize)?)?.t;
        match (found, asked.first) {
            (None, first) => first.is_some(),
            (Some(hit), first) => !met(hit).zip(first).is_some_and(|(t, first)| is_same(t, first)),
        }
    }
}

/// Single precision cannot tell the order of what is nearer to each other than its own few roundings of `t`.
fn is_same(t: f32, first: f32) -> bool {
    (t - first).abs() <= 4.0 * f32::EPSILON * first.abs()
}

/// Whether a ray has gone through what it meets first. A thousandth of the way is more than any test rounds that is not
/// broken, and less than from one side of a thing to the other.
fn is_beyond(first: Option<f32>, found: Option<PrimitiveHit>) -> bool {
    first.is_some_and(|first| found.is_none_or(|hit| hit.t > first + 1e-3 * first.abs()))
}
