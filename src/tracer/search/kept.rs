//! Intersectors that earlier frames of this process have built. A measurement renders one scene many times with other
//! samples and seeds, and without this it would spend most of its time on building.

use super::Intersector;
use crate::effects::Effects;
use crate::kit::{Function, RenderJob, StudentFunctions};
use crate::scene::{FilmSettings, Quality, Scene};
use crate::tracer::plan::Plan;
use crate::tracer::plan::written::Written;
use std::any::Any;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// The most primitives of all kept intersectors together, so that they take about a gigabyte at most. A larger
/// scene is built for each frame.
const MOST_PRIMITIVES: usize = 1 << 21;

/// The kept intersectors, the oldest first.
static KEPT: Mutex<VecDeque<Kept>> = Mutex::new(VecDeque::new());

/// A kept intersector, and everything that it was built from.
struct Kept {
    from: From,
    intersector: Arc<dyn Any + Send + Sync>,
    primitives: usize,
    seconds: f64,
}

/// What an intersector is built from.
#[derive(PartialEq)]
struct From {
    scene: Scene,
    effects: Effects,
    left_out: Vec<Function>,
    is_plain: bool,
}

/// An intersector, and the time that it took.
pub struct Built<F> {
    /// The intersector, which later frames may share.
    pub intersector: Arc<Intersector<F>>,
    /// The seconds that an earlier frame took to build it; 0 if it was built now.
    pub earlier_seconds: f64,
}

/// The intersector that `build` makes of the scene of `job`, or, if the job allows it, one that an earlier frame has
/// built from the same. `is_plain` distinguishes [`World::plain`](crate::world::World::plain) from the world of the plan.
pub fn built<F: StudentFunctions>(
    job: &RenderJob,
    plan: &Plan,
    written: &Written<F>,
    is_plain: bool,
    build: impl FnOnce() -> Intersector<F>,
) -> Built<F> {
    if !job.reuse {
        return Built { intersector: Arc::new(build()), earlier_seconds: 0.0 };
    }
    // Search for one that was built from the same.
    let from = From {
        scene: without_sampling(&job.scene),
        effects: plan.effects.clone(),
        left_out: written.left_out().to_vec(),
        is_plain,
    };
    if let Some(found) = lookup(&from) {
        return found;
    }
    // Build it, and keep it if it is small.
    let started = Instant::now();
    let intersector = Arc::new(build());
    let seconds = started.elapsed().as_secs_f64();
    let primitives = intersector.n_primitives();
    if primitives <= MOST_PRIMITIVES {
        keep(Kept { from, intersector: intersector.clone(), primitives, seconds });
    }
    Built { intersector, earlier_seconds: 0.0 }
}

fn lookup<F: StudentFunctions>(from: &From) -> Option<Built<F>> {
    let kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    // Two kits in one process build different types.
    kept.iter().filter(|kept| kept.from == *from).find_map(|kept| {
        let intersector = kept.intersector.clone().downcast::<Intersector<F>>().ok()?;
        Some(Built { intersector, earlier_seconds: kept.seconds })
    })
}

/// Adds `new`, and forgets the oldest ones until all together are small enough.
fn keep(new: Kept) {
    let mut kept = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    kept.push_back(new);
    while kept.iter().map(|one| one.primitives).sum::<usize>() > MOST_PRIMITIVES {
        kept.pop_front();
    }
}

/// The scene without the settings that only say which rays are traced, and how many. A setting that is missing here costs
/// time, because two equal intersectors are built; one too many would give a frame the structure of another scene.
fn without_sampling(scene: &Scene) -> Scene {
    let default = Quality::default();
    Scene {
        film: FilmSettings::default(),
        quality: Quality {
            samples_per_pixel: default.samples_per_pixel,
            sampler: default.sampler,
            light_samples: default.light_samples,
            glossy_samples: default.glossy_samples,
            max_depth: default.max_depth,
            min_contribution: default.min_contribution,
            next_event: default.next_event,
            clamp: default.clamp,
            ray_offset: default.ray_offset,
            lift_shadow_rays: default.lift_shadow_rays,
            ..scene.quality
        },
        ..scene.clone()
    }
}
