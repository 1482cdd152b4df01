//! The counts of the reference, by which the counts of students are judged.
//!
//! The test `the_bars_are_those_of_the_reference` of the solutions measures them again. Run it after a change of the
//! reference, of a scene or of a count: it prints the new values.

/// For each of the scenes the cost of the tree that a full sweep gives: at each node it tries every split of the primitives,
/// sorted along each axis, by the costs of this stage.
pub const SWEEP_COSTS: [(&str, f64); 6] = [
    ("an even cloud", 10.499),
    ("a soup of large boxes", 22.603),
    ("a small object in a stadium", 4.402),
    ("hair", 10.375),
    ("a landscape", 4.274),
    ("boxes of all sizes", 7.672),
];

/// For each of the scenes the cost of the tree in Morton order after the reference's `reinsert`, with as many moves as the tree has
/// nodes.
pub const REINSERTED_COSTS: [(&str, f64); 6] = [
    ("an even cloud", 17.466),
    ("a soup of large boxes", 33.083),
    ("a small object in a stadium", 6.671),
    ("hair", 17.029),
    ("a landscape", 6.262),
    ("boxes of all sizes", 12.716),
];

/// The nodes that the reference's `cheapest_place` opens for all [`places_in_scenes`](super::places::places_in_scenes).
pub const NODES_OPENED: usize = 1950;

/// The calls of the reference's `stream_closest_hits` for all [`streams_through_a_cloud`](super::streams::streams_through_a_cloud).
pub const CALLS_OF_STREAMS: u64 = 14_552;

/// The calls of the reference's `wide_closest_hit` for all
/// [`rays_through_a_cloud`](super::visits::rays_through_a_cloud): nodes, blocks and exact tests together.
pub const CALLS_OF_SEARCH: usize = 2162;
