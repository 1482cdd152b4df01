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

checks::stage! { ($ crate) 4 [
    normals::shading_normal_faces_the_viewer
    normals::shading_normal_falls_back_to_flat
    terms::diffuse_term_is_the_cosine
    terms::specular_term_is_the_mirrored_cosine
    terms::light_from_behind_adds_nothing
    shadows::shadow_ray_reaches_just_short_of_the_light
    shadows::shadow_ray_leaves_its_own_surface_at_any_scale
    shadows::shadow_ray_sees_what_is_close
    shadows::shadow_ray_is_not_traced_without_effect
    shades::shade_adds_up_the_lights
    shades::shade_leaves_out_what_is_hidden
    shades::shade_traces_at_most_one_ray_per_light
    gamma::gamma_is_two
    gamma::gamma_survives_invalid_numbers
    golden::shading_table: composed
    golden::picture_of_a_lit_sphere: composed
] }
