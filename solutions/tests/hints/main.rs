//! The third hints of stages 1 to 6 lead to code that passes: functions that contain the code of the hints, and otherwise what
//! a textbook prints, pass every check. A function of the reference stands here if it is the code of the hint and no more. The code
//! in the third hints of the bonus of stage 12 is that of the reference.

#![allow(clippy::manual_range_contains)] // books write both comparisons

/// Spheres in single precision.
mod stage1_shapes {
    pub use crate::textbook_shapes::*;
    use glam::Vec3;
    use raykata::ray::Ray;
    pub use solutions::stage1_shapes::{nearest_root, plane_by_coefficients};

    pub fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
        let d = ray.direction;
        let f = ray.origin - center;
        let a = d.dot(d);
        let b = -f.dot(d);
        let c = f.dot(f) - radius * radius;
        let f_perpendicular = f + (b / a) * d;
        let discriminant = a * (radius * radius - f_perpendicular.length_squared());
        if !(discriminant >= 0.0 && radius > 0.0) {
            return None;
        }
        let q = b + b.signum() * discriminant.sqrt();
        nearest_root([q / a, c / q], ray)
    }

    pub fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
        let d = ray.direction;
        let l = center - ray.origin;
        let t_ca = l.dot(d) / d.dot(d);
        let n = l - t_ca * d;
        let discriminant = (radius * radius - n.length_squared()) / d.dot(d);
        if !(discriminant >= 0.0 && radius > 0.0) {
            return None;
        }
        let t_hc = discriminant.sqrt();
        let larger = if t_ca > 0.0 { t_ca + t_hc } else { t_ca - t_hc };
        let product = (l.length_squared() - radius * radius) / d.dot(d);
        nearest_root([product / larger, larger], ray)
    }
}
mod stage2_triangles {
    pub use crate::textbook_triangles::*;
    pub use solutions::stage2_triangles::{
        backfacing, face_normal, gram_scalars, inside_by_areas, inside_by_direction, inside_by_planes,
        triangle_cramer, triangle_gram, vertex_normals,
    };
}
mod stage3_boxes {
    pub use crate::textbook_boxes::*;
    use glam::Vec3;
    use raykata::aabb::Aabb;
    use raykata::ray::Ray;

    pub fn slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
        let u = 2f32.powi(-24);
        let gamma_3 = 3.0 * u / (1.0 - 3.0 * u);
        let (mut near, mut far) = (ray.t_min, ray.t_max);
        for axis in 0..3 {
            let [min, max] =
                [bounds.min, bounds.max].map(|corner| (corner - ray.origin)[axis] * inverse_direction[axis]);
            let (enter, exit) =
                if inverse_direction[axis].is_sign_negative() { (max, min) } else { (min, max) };
            let exit = exit * (1.0 + 2.0 * gamma_3);
            if enter > near {
                near = enter;
            }
            if exit < far {
                far = exit;
            }
        }
        (near <= far).then_some((near, far))
    }
}
mod stage3_build {
    pub use crate::textbook_build::*;
    pub use solutions::stage3_build::build;
}
mod stage4_shading {
    pub use crate::textbook_shading::*;
    pub use solutions::stage4_shading::{encode_gamma, shading_normal, shadow_ray};
}
mod stage5_recursion {
    pub use crate::textbook_recursion::*;
    use glam::Vec3;
    pub use solutions::stage5_recursion::{fresnel_exact, reflect, spawn_ray};

    pub fn refract(direction: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3> {
        let along = n1 / n2 * (direction - direction.dot(normal) * normal);
        let squared = 1.0 - along.length_squared();
        (squared >= 0.0).then(|| along - squared.sqrt() * normal)
    }
}
mod stage6_distribution {
    pub use crate::textbook_distribution::*;
    pub use solutions::stage6_distribution::{
        filter_pixel, gaussian_weight, jittered, lens_ray, lerp, motion_bounds, sample_light_disk,
        sample_phong_lobe, sample_sphere, temporal_slot, time_in_shutter,
    };
}

/// The textbook, parts of which the modules above replace by the code of the third hints.
macro_rules! textbook {
    ($($name:ident $path:literal)*) => {
        $(
            #[allow(dead_code, unused_imports)]
            #[path = $path]
            mod $name;
        )*
    };
}

textbook! {
    textbook_shapes "../textbook/stage1_shapes.rs"
    textbook_triangles "../textbook/stage2_triangles.rs"
    textbook_boxes "../textbook/stage3_boxes.rs"
    textbook_build "../textbook/stage3_build.rs"
    textbook_shading "../textbook/stage4_shading.rs"
    textbook_recursion "../textbook/stage5_recursion.rs"
    textbook_distribution "../textbook/stage6_distribution.rs"
}

use solutions::*;

// Functions with the code of the hints; those of later stages are the reference's.
raykata::student_kit!(None);

/// Checks, and the code in the third hint of each, which the functions of this test contain.
const HINTS: &str = include_str!("third_hints.txt");

#[test]
fn the_code_of_the_third_hints_passes() {
    let entries = checks::rubric::RUBRIC.values().flat_map(|stage| stage.in_order());
    let entries: std::collections::BTreeMap<_, _> = entries.collect();
    for (name, code) in HINTS.lines().filter_map(|line| line.split_once(": ")) {
        let hint = &entries[name].hints[2];
        assert!(hint.contains(code), "the third hint of `{name}` changed: apply it in this test\n{hint}");
    }
    let kit = checks::linked(Kit);
    for stage in 1..=6 {
        let mut failed = Vec::new();
        for check in all_checks::of_stage(stage) {
            if let checks::Verdict::Failed(message) = checks::run(check, &kit, 0) {
                println!("{message}");
                failed.push(check.name);
            }
        }
        assert!(failed.is_empty(), "stage {stage}: the code of the hints fails {failed:?}");
    }
}
