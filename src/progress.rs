//! The progress of a frame: who waits for it, its finished tiles, and the progress of building its structure.
//! [`Bvh::set_leaf`](crate::bvh::Bvh::set_leaf) counts the primitives that are in leaves, so a builder need not report
//! anything itself.

use crate::film::Film;
use crate::message;
use glam::Vec3;
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

/// Receives the progress of a frame, and can cancel it.
pub trait Watch: Sync {
    /// `done` of `total` pixels are finished, `0 < done <= total`. Called after each tile, from any thread.
    fn progress(&self, done: u64, total: u64);

    /// Before the first pixel: `placed` of `total` primitives are in leaves. Called from any thread.
    fn building(&self, _placed: u64, _total: u64) {}

    /// Whether [`tile`](Watch::tile) uses the pixels. If they have to come from another process, they are sent only then.
    fn wants_tiles(&self) -> bool {
        false
    }

    /// Receives the pixels of a finished tile. A frame that [wants](Watch::wants_tiles) no tiles may omit the call. If a frame
    /// starts again without an unfinished function, its tiles come again. Called from any thread.
    fn tile(&self, _tile: &Tile) {}

    /// Whether the frame is no longer wanted. Called before each tile, from any thread; the default is
    /// `false`.
    fn cancelled(&self) -> bool {
        false
    }
}

/// A finished rectangle of a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// The column of its upper left pixel.
    pub x: u32,
    /// The row of its upper left pixel.
    pub y: u32,
    /// The number of pixels per row.
    pub width: u32,
    /// The colours row by row from the top, in linear radiance.
    pub pixels: Vec<Vec3>,
}

message! { Tile { x, y, width, pixels } }

impl Tile {
    /// Whether the tile is a rectangle within a film of `width` by `height` pixels.
    pub fn fits(&self, width: u32, height: u32) -> bool {
        let (columns, n_pixels) = (u64::from(self.width), self.pixels.len() as u64);
        columns > 0
            && n_pixels.is_multiple_of(columns)
            && u64::from(self.x) + columns <= u64::from(width)
            && u64::from(self.y) + n_pixels / columns <= u64::from(height)
    }

    /// Copies the pixels of the tile to their place in `film`.
    ///
    /// # Panics
    ///
    /// If the tile does not [fit](Tile::fits) into the film.
    pub fn copy_to(&self, film: &mut Film) {
        for (row, colors) in self.pixels.chunks(self.width as usize).enumerate() {
            let start = (self.y as usize + row) * film.width as usize + self.x as usize;
            film.pixels[start..start + colors.len()].copy_from_slice(colors);
        }
    }
}

/// A [`Watch`] that ignores progress and never cancels.
pub struct Unwatched;

impl Watch for Unwatched {
    fn progress(&self, _: u64, _: u64) {}
}

thread_local! {
    static PLACED: RefCell<Option<Arc<AtomicU64>>> = const { RefCell::new(None) };
}

/// Structures over fewer primitives are built without reports.
const FEWEST_REPORTED: u64 = 100_000;

/// The time between two reports.
const PAUSE: Duration = Duration::from_millis(200);

/// Adds `count` to the number of primitives in leaves, if a build is watched on this thread.
pub(crate) fn placed(count: usize) {
    PLACED.with_borrow(|placed| {
        if let Some(placed) = placed {
            placed.fetch_add(count as u64, Ordering::Relaxed);
        }
    });
}

/// Calls `build` on this thread and returns its result. If `total` is at least 100,000 primitives, another
/// thread calls `watch.building(placed, total)` every 0.2 s meanwhile, with the number of primitives that
/// [`Bvh::set_leaf`](crate::bvh::Bvh::set_leaf) has put into leaves on this thread, `0 <= placed <= total`.
/// Where no thread can be started, nothing is reported.
///
/// # Panics
///
/// A panic of `build` is passed on; the reports end all the same.
pub fn watched<T>(watch: &dyn Watch, total: u64, build: impl FnOnce() -> T) -> T {
    if total < FEWEST_REPORTED {
        return build();
    }
    let counter = Arc::new(AtomicU64::new(0));
    let built = AtomicBool::new(false);
    thread::scope(|scope| {
        let reporter = thread::Builder::new().name("reporter".into()).spawn_scoped(scope, || {
            while !built.load(Ordering::Relaxed) {
                watch.building(counter.load(Ordering::Relaxed).min(total), total);
                thread::park_timeout(PAUSE);
            }
        });
        // Without a thread there are no reports. If the build panics, `EndOfReports` still ends the reporting thread.
        let _ended =
            EndOfReports { built: &built, reporter: reporter.ok().map(|reporter| reporter.thread().clone()) };
        PLACED.set(Some(counter.clone()));
        build()
    })
}

/// Ends the reports when it is dropped.
struct EndOfReports<'a> {
    built: &'a AtomicBool,
    reporter: Option<thread::Thread>,
}

impl Drop for EndOfReports<'_> {
    fn drop(&mut self) {
        PLACED.set(None);
        self.built.store(true, Ordering::Relaxed);
        if let Some(reporter) = &self.reporter {
            reporter.unpark();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aabb::Aabb;
    use crate::bvh::{Bvh, PrimitiveRef};
    use glam::Vec3;
    use std::sync::Mutex;

    #[derive(Default)]
    struct RecordedProgress(Mutex<Vec<(u64, u64)>>);

    impl Watch for RecordedProgress {
        fn progress(&self, _: u64, _: u64) {}

        fn building(&self, placed: u64, total: u64) {
            self.0.lock().unwrap().push((placed, total));
        }
    }

    impl RecordedProgress {
        fn wait_for(&self, placed: u64) {
            while !self.0.lock().unwrap().iter().any(|heard| heard.0 == placed) {
                thread::yield_now();
            }
        }
    }

    fn leaf_of(count: usize) -> Bvh {
        let mut bvh = Bvh::for_primitives(count);
        let node = bvh.add_node(Aabb::EMPTY);
        let one = PrimitiveRef { id: 0, bounds: Aabb::EMPTY, centroid: Vec3::ZERO };
        bvh.set_leaf(node, &vec![one; count]);
        bvh
    }

    #[test]
    fn leaves_are_reported_while_the_rest_is_built() {
        let heard = RecordedProgress::default();
        let total = 2 * FEWEST_REPORTED;
        watched(&heard, total, || {
            heard.wait_for(0);
            leaf_of(150_000);
            heard.wait_for(150_000);
        });
        leaf_of(10);
        assert!(PLACED.with_borrow(Option::is_none), "counting has ended");
        assert!(heard.0.into_inner().unwrap().iter().all(|(_, of)| *of == total));
    }

    #[test]
    fn what_is_small_is_not_worth_a_word_and_a_panic_passes() {
        let heard = RecordedProgress::default();
        watched(&heard, FEWEST_REPORTED - 1, || leaf_of(5));
        assert!(heard.0.lock().unwrap().is_empty());
        let panicked = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            watched(&heard, FEWEST_REPORTED, || panic!("a builder that gives up"));
        }));
        assert!(panicked.is_err() && PLACED.with_borrow(Option::is_none));
    }
}
