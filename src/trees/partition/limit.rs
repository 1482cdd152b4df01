//! Ends the builder of a tree that lists primitives again and again, before it runs out of memory.

use super::MOST_REFERENCES;
use std::cell::Cell;

thread_local! {
    /// The primitives and the references so far of the tree that is built on this thread.
    static BUILT: Cell<Option<Built>> = const { Cell::new(None) };
}

#[derive(Clone, Copy)]
struct Built {
    n_primitives: usize,
    n_references: usize,
}

/// Calls `build`, which builds one tree over `n_primitives` primitives on this thread, and returns its result.
/// Meanwhile the functions `set_leaf` of trees panic if the leaves list more than [`MOST_REFERENCES`]
/// references per primitive.
///
/// # Panics
///
/// A panic of `build` is passed on.
pub(crate) fn limited<T>(n_primitives: usize, build: impl FnOnce() -> T) -> T {
    /// Ends the limit, also after a panic.
    struct End;
    impl Drop for End {
        fn drop(&mut self) {
            BUILT.set(None);
        }
    }
    BUILT.set(Some(Built { n_primitives, n_references: 0 }));
    let _end = End;
    build()
}

/// Counts the `n` primitives of a new leaf.
///
/// # Panics
///
/// If the leaves of a tree that [`limited`] builds list too many references.
#[track_caller]
pub(super) fn count(n: usize) {
    let Some(mut built) = BUILT.get() else { return };
    built.n_references += n;
    BUILT.set(Some(built));
    assert!(
        built.n_references <= MOST_REFERENCES * built.n_primitives,
        "the leaves list {} references to {} primitives, more than {MOST_REFERENCES} per primitive: make a leaf \
         where `ListGrowth::divide` returns `None`",
        built.n_references,
        built.n_primitives
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aabb::Aabb;
    use crate::partition::{Bsp, KdTree, Octree};

    fn panics(build: impl FnOnce()) -> bool {
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| limited(2, build))).is_err()
    }

    #[test]
    fn trees_that_list_more_than_sixteen_references_per_primitive_end() {
        for (n_leaves, too_many) in [(16, false), (17, true)] {
            let octree = || (0..n_leaves).for_each(|_| Octree::new(Aabb::EMPTY).set_leaf(0, &[0, 1]));
            assert_eq!(panics(octree), too_many);
            let kd_tree = || {
                let mut tree = KdTree::new(Aabb::EMPTY);
                tree.add_node(0, 0);
                (0..n_leaves).for_each(|_| tree.set_leaf(0, &[0, 1]));
            };
            assert_eq!(panics(kd_tree), too_many);
            let bsp = || {
                let mut bsp = Bsp::default();
                bsp.add_node(0, 0);
                (0..n_leaves).for_each(|_| bsp.set_leaf(0, &[0, 1]));
            };
            assert_eq!(panics(bsp), too_many);
        }
    }

    #[test]
    fn the_limit_ends_with_the_build() {
        limited(0, || {});
        assert!(panics(|| panic!("a builder that gives up")));
        Octree::new(Aabb::EMPTY).set_leaf(0, &[0; 1000]);
    }
}
