//! The checks of stage 10: stability.
//!
//! `roots` · `triangles` · `boxes` (slabs) · `points` (offsets, directions) · `doubles` (triangles in double precision)
//! · `rims` (spheres in double precision) · `next_to_faces` (rays that start next to a triangle) · `table` · `picture`
//!
//! [`oracle::exact`] gives the exact answers. An answer may differ from the exact one only if at most
//! [`oracle::STABLE`] roundings decide, and a closed mesh must not leak at all.

mod boxes;
mod doubles;
mod next_to_faces;
mod picture;
mod points;
mod rims;
mod roots;
mod table;
mod triangles;

use boxes::{
    slab_is_entered_before_what_it_holds, slab_meets_no_box_that_is_passed, slab_misses_no_box_in_any_range,
    slab_misses_no_box_that_is_met, slab_of_special_numbers_is_finite,
};
use checks::Trial;
use doubles::{
    double_of_special_numbers_is_finite, double_triangle_has_the_nearest_t, double_triangle_is_right_at_edges,
};
use glam::Vec3;
use oracle::splitmix::Random;
use picture::picture_at_three_scales;
use points::{
    directions_have_length_one_at_every_length, offsets_are_as_small_as_they_can_be,
    offsets_leave_the_surface_at_any_scale, zero_has_no_direction,
};
use raykata::kit::TriangleQuery;
use raykata::ray::Ray;
use raykata::shape::Triangle;
use rims::{double_sphere_has_the_nearest_t, double_sphere_is_right_at_rims};
use roots::{roots_do_not_cancel, roots_of_special_numbers_are_finite, roots_that_touch_are_found};
use table::table_of_seven_scales;
use triangles::{
    watertight_errs_only_where_roundings_decide, watertight_has_a_good_t, watertight_meshes_do_not_leak,
    watertight_of_special_numbers_is_finite, watertight_sees_size_alike,
    watertight_walls_seen_edge_on_do_not_leak,
};

/// Numbers for which formulas often fail.
pub const SPECIAL: [f32; 10] =
    [0.0, -0.0, 1.0, -1.0, 1e-40, f32::MIN_POSITIVE, f32::MAX, f32::INFINITY, f32::NEG_INFINITY, f32::NAN];

/// Inputs made of [`SPECIAL`] numbers.
struct Odd(Random);

impl Odd {
    fn new(trial: &Trial<'_>, case: u64) -> Odd {
        Odd(Random::new(trial.seed, case))
    }

    fn number(&mut self) -> f32 {
        SPECIAL[self.0.below(SPECIAL.len() as u64) as usize]
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number())
    }

    fn ray(&mut self) -> Ray {
        Ray::new(self.vector(), self.vector())
    }

    fn triangles(&mut self) -> Vec<TriangleQuery> {
        let mut one = || TriangleQuery {
            ray: self.ray(),
            triangle: Triangle { a: self.vector(), b: self.vector(), c: self.vector() },
        };
        (0..3000).map(|_| one()).collect()
    }
}

checks::stage! { ($ crate) 10 [
    roots_do_not_cancel
    roots_that_touch_are_found
    roots_of_special_numbers_are_finite
    watertight_errs_only_where_roundings_decide
    watertight_meshes_do_not_leak
    watertight_walls_seen_edge_on_do_not_leak
    watertight_has_a_good_t
    watertight_sees_size_alike
    watertight_of_special_numbers_is_finite
    slab_misses_no_box_that_is_met
    slab_misses_no_box_in_any_range
    slab_meets_no_box_that_is_passed
    slab_is_entered_before_what_it_holds
    slab_of_special_numbers_is_finite
    offsets_leave_the_surface_at_any_scale
    offsets_are_as_small_as_they_can_be
    directions_have_length_one_at_every_length
    zero_has_no_direction: turned
    double_triangle_is_right_at_edges
    double_triangle_has_the_nearest_t
    double_sphere_is_right_at_rims
    double_sphere_has_the_nearest_t
    double_of_special_numbers_is_finite
    table_of_seven_scales: composed
    picture_at_three_scales: composed
] }
