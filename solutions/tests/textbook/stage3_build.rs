//! Stage 3, building, as in "Physically Based Rendering": recursion, `partition` and complete sorts.

use crate::stage3_boxes::{surface_area, union};
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, INTERSECTION_COST, PrimitiveRef, TRAVERSAL_COST};
use raykata::scene::Split;

fn bounds_of(primitives: &[PrimitiveRef]) -> Aabb {
    primitives.iter().fold(Aabb::EMPTY, |bounds, primitive| union(&bounds, &primitive.bounds))
}

fn longest_axis(bounds: &Aabb) -> usize {
    let d = bounds.max - bounds.min;
    if d.x > d.y && d.x > d.z {
        0
    } else if d.y > d.z {
        1
    } else {
        2
    }
}

fn sort(primitives: &mut [PrimitiveRef], axis: usize) {
    primitives.sort_by(|a, b| a.centroid[axis].total_cmp(&b.centroid[axis]));
}

pub fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize {
    let axis = longest_axis(&bounds_of(primitives));
    sort(primitives, axis);
    primitives.len() / 2
}

pub fn split_spatial_median(primitives: &mut [PrimitiveRef]) -> usize {
    let bounds = bounds_of(primitives);
    let axis = longest_axis(&bounds);
    let middle = (bounds.min[axis] + bounds.max[axis]) / 2.0;
    sort(primitives, axis);
    let n_left = primitives.iter().filter(|primitive| primitive.centroid[axis] < middle).count();
    if n_left == 0 || n_left == primitives.len() {
        return split_object_median(primitives);
    }
    n_left
}

pub fn split_surface_area(primitives: &mut [PrimitiveRef]) -> Option<usize> {
    let n = primitives.len();
    let area = surface_area(&bounds_of(primitives));
    let mut best = INTERSECTION_COST * area * n as f32;
    let mut cut = None;
    for axis in 0..3 {
        sort(primitives, axis);
        for middle in 1..n {
            let left = surface_area(&bounds_of(&primitives[..middle]));
            let right = surface_area(&bounds_of(&primitives[middle..]));
            let cost = TRAVERSAL_COST * area
                + INTERSECTION_COST * (left * middle as f32 + right * (n - middle) as f32);
            if cost < best {
                best = cost;
                cut = Some((axis, middle));
            }
        }
    }
    let (axis, middle) = cut?;
    sort(primitives, axis);
    Some(middle)
}

pub fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh {
    let primitive = |(id, bounds): (usize, &Aabb)| PrimitiveRef {
        id: id as u32,
        bounds: *bounds,
        centroid: (bounds.min + bounds.max) / 2.0,
    };
    let mut primitives: Vec<PrimitiveRef> = bounds.iter().enumerate().map(primitive).collect();
    let mut bvh = Bvh::for_primitives(bounds.len());
    if !primitives.is_empty() {
        recurse(&mut bvh, &mut primitives, split, leaf_size);
    }
    bvh
}

fn recurse(bvh: &mut Bvh, primitives: &mut [PrimitiveRef], split: Split, leaf_size: usize) -> u32 {
    let node = bvh.add_node(bounds_of(primitives));
    if primitives.len() <= leaf_size {
        bvh.set_leaf(node, primitives);
        return node;
    }
    let middle = match split {
        Split::ObjectMedian => split_object_median(primitives),
        Split::SpatialMedian => split_spatial_median(primitives),
        Split::SurfaceArea => {
            split_surface_area(primitives).unwrap_or_else(|| split_object_median(primitives))
        }
    };
    let (left, right) = primitives.split_at_mut(middle);
    let left = recurse(bvh, left, split, leaf_size);
    let right = recurse(bvh, right, split, leaf_size);
    bvh.set_children(node, left, right);
    node
}
