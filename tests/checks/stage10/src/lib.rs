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

use checks::prelude::*;
use oracle::splitmix::Random;

/// Numbers for which formulas often fail.
const SPECIAL: [f32; 10] =
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
    roots::roots_do_not_cancel
    roots::roots_that_touch_are_found
    roots::roots_of_special_numbers_are_finite
    triangles::watertight_errs_only_where_roundings_decide
    triangles::watertight_meshes_do_not_leak
    triangles::watertight_walls_seen_edge_on_do_not_leak
    triangles::watertight_has_a_good_t
    triangles::watertight_sees_size_alike
    triangles::watertight_of_special_numbers_is_finite => finite_hits(triangles::WATERTIGHT)
    boxes::slab_misses_no_box_that_is_met
    boxes::slab_misses_no_box_in_any_range
    boxes::slab_meets_no_box_that_is_passed
    boxes::slab_is_entered_before_what_it_holds
    points::offsets_leave_the_surface_at_any_scale
    points::offsets_are_as_small_as_they_can_be
    points::directions_have_length_one_at_every_length
    points::zero_has_no_direction: turned
    doubles::double_triangle_is_right_at_edges
    doubles::double_triangle_has_the_nearest_t
    rims::double_sphere_is_right_at_rims
    rims::double_sphere_has_the_nearest_t
    triangles::double_triangle_of_special_numbers_is_finite => finite_hits(triangles::IN_DOUBLE)
    table::table_of_seven_scales: composed
    picture::picture_at_three_scales: composed
] }
