//! Stage 3, building, by the third hints. The splits are those of the textbook.

pub use crate::textbook_build::*;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, DEEPEST_SPLIT, PrimitiveRef};
use raykata::scene::Split;

pub fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh {
    let mut primitives: Vec<PrimitiveRef> = bounds
        .iter()
        .enumerate()
        .map(|(id, bounds)| PrimitiveRef {
            id: id as u32,
            bounds: *bounds,
            centroid: (bounds.min + bounds.max) / 2.0,
        })
        .collect();
    let mut bvh = Bvh::for_primitives(bounds.len());
    if !primitives.is_empty() {
        recurse(&mut bvh, &mut primitives, split, leaf_size.max(1), 0);
    }
    bvh
}

fn recurse(
    bvh: &mut Bvh,
    primitives: &mut [PrimitiveRef],
    split: Split,
    leaf_size: usize,
    depth: usize,
) -> u32 {
    let node = bvh.add_node(
        primitives.iter().fold(Aabb::EMPTY, |bounds, one| crate::stage3_boxes::union(&bounds, &one.bounds)),
    );
    let fits = primitives.len() <= leaf_size;
    let middle = match split {
        _ if primitives.len() == 1 => None,
        _ if depth >= DEEPEST_SPLIT => (!fits).then(|| split_object_median(primitives)),
        Split::ObjectMedian => (!fits).then(|| split_object_median(primitives)),
        Split::SpatialMedian => (!fits).then(|| split_spatial_median(primitives)),
        Split::SurfaceArea => match split_surface_area(primitives) {
            None if !fits => Some(split_object_median(primitives)),
            middle => middle,
        },
    };
    match middle {
        None => bvh.set_leaf(node, primitives),
        Some(middle) => {
            let (left, right) = primitives.split_at_mut(middle);
            let left = recurse(bvh, left, split, leaf_size, depth + 1);
            let right = recurse(bvh, right, split, leaf_size, depth + 1);
            bvh.set_children(node, left, right);
        }
    }
    node
}
