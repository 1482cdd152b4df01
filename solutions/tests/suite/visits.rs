//! What the searches for the rays of a pixel visit is what a frame counts.

use crate::scene::{job, rendered, small};

#[test]
fn the_visits_of_a_pixel_are_those_that_its_frame_counts() {
    let kit = solutions::kit();
    for name in ["stage1", "stage5", "graph", "shapes", "cornell", "veach"] {
        let job = job(&small(name, 1, 1));
        let (rays, visits): (Vec<_>, Vec<_>) = kit.visits(&job, 0, 0).into_iter().unzip();
        assert_eq!(rays, kit.trace(&job, 0, 0), "{name}: one search per ray");
        let counts = rendered(&job).counts;
        assert_eq!(counts.rays(), rays.len() as u64, "{name}");
        let sum = |of: fn(&raykata::kit::RayVisits) -> u64| visits.iter().map(of).sum::<u64>();
        assert_eq!(counts.node_visits, sum(|one| one.node_visits), "{name}");
        assert_eq!(counts.box_tests, sum(|one| one.box_tests), "{name}");
        assert_eq!(counts.primitive_tests, sum(|one| one.primitive_tests), "{name}");
        // Without shared meshes, each box that was tested is known. A search enters the box of each ray that hits something.
        for (ray, visits) in rays.iter().zip(&visits) {
            assert_eq!(visits.boxes.len() as u64, visits.box_tests, "{name}");
            assert!(visits.node_visits == 0 || visits.boxes.iter().any(|one| one.hit), "{name}: {ray:?}");
        }
    }
}
