//! The checks of stage 4: shading and shadows.
//!
//! `normals` (the shading normal), `terms` (the diffuse and the specular term), `shadows` (shadow rays), `shades` (the
//! whole Phong model), `gamma` (bytes), `golden` (a table and a picture).

mod gamma;
mod golden;
mod normals;
mod shades;
mod shadows;
mod terms;

use gamma::{gamma_is_two, gamma_survives_invalid_numbers};
use golden::{picture_of_a_lit_sphere, shading_table};
use normals::{shading_normal_faces_the_viewer, shading_normal_falls_back_to_flat};
use shades::{
    shade_adds_up_the_lights, shade_leaves_out_what_is_hidden, shade_traces_at_most_one_ray_per_light,
};
use shadows::{
    shadow_ray_is_not_traced_without_effect, shadow_ray_leaves_its_own_surface_at_any_scale,
    shadow_ray_reaches_just_short_of_the_light, shadow_ray_sees_what_is_close,
};
use terms::{
    diffuse_term_is_the_cosine, light_from_behind_adds_nothing, specular_term_is_the_mirrored_cosine,
};

checks::stage! { ($ crate) 4 [
    shading_normal_faces_the_viewer
    shading_normal_falls_back_to_flat
    diffuse_term_is_the_cosine
    specular_term_is_the_mirrored_cosine
    light_from_behind_adds_nothing
    shadow_ray_reaches_just_short_of_the_light
    shadow_ray_leaves_its_own_surface_at_any_scale
    shadow_ray_sees_what_is_close
    shadow_ray_is_not_traced_without_effect
    shade_adds_up_the_lights
    shade_leaves_out_what_is_hidden
    shade_traces_at_most_one_ray_per_light
    gamma_is_two
    gamma_survives_invalid_numbers
    shading_table: composed
    picture_of_a_lit_sphere: composed
] }
