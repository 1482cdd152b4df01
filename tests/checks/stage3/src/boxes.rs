//! Boxes: bounds of triangles and spheres, union, centroid, surface area.

use checks::broken::{Broken, CheckResult};
use checks::double::{self};
use checks::generate::{magnitude, point, rough_point, sphere, triangle};
use checks::judge::{compare, known};
use checks::paste::{Paste, call};
use checks::{Trial, tree};
use glam::Vec3;
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::shape::Sphere;

pub(super) fn bounds_of_a_triangle_are_tight(trial: &Trial<'_>) -> CheckResult {
    trial.forall(1000, triangle(), |triangles| {
        compare(triangles, trial.kit.triangle_bounds(triangles), |triangle, yours| {
            let corner = |p: Vec3| Aabb::new(p, p);
            let expected = tree::around(&[corner(triangle.a), corner(triangle.b), corner(triangle.c)]);
            let diagnosis = match () {
                () if yours.contains_box(&expected) => {
                    "you return a padded box: boxes are closed, so even a flat box needs no padding"
                }
                () if expected.contains_box(&yours) => "your box leaves out a corner",
                () => "",
            };
            let input = call("triangle_bounds", &[triangle]);
            if yours == expected {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)))
            }
        })
    })
}

pub(super) fn bounds_of_a_sphere_hold_it(trial: &Trial<'_>) -> CheckResult {
    let spheres =
        (rough_point(100.0), magnitude(-3.0, 3.0)).prop_map(|(center, radius)| Sphere { center, radius });
    let spheres = prop_oneof![sphere(), spheres];
    trial.forall(1000, spheres, |spheres| {
        compare(spheres, trial.kit.sphere_bounds(spheres), |sphere, yours| {
            let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
            // Allow half a float for the rounding and two floats outwards; a float is two roundings at most.
            let slack = (center.abs() + radius) * 5.0 * double::U;
            let near = |yours: Vec3, exact: glam::DVec3| (yours.as_dvec3() - exact).abs().cmple(slack).all();
            let right = near(yours.min, center - radius) && near(yours.max, center + radius);
            let expected = Aabb::new((center - radius).as_vec3(), (center + radius).as_vec3());
            let input = format!(
                "sphere_bounds(&Sphere {{ center: {}, radius: {} }})",
                sphere.center.paste(),
                sphere.radius.paste()
            );
            let diagnosis = match yours.max - yours.min {
                size if (size - 2.0 * sphere.radius).abs().max_element() < 1e-3 * sphere.radius => {
                    "your box has the right size but the wrong place: go one radius from the centre"
                }
                size if size.max_element() < 2.0 * sphere.radius => {
                    "your box is too small: go one whole radius from the centre to each side"
                }
                _ => "",
            };
            if right {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)))
            }
        })
    })
}

/// Boxes; some of them are flat.
pub(super) fn aabb() -> impl Strategy<Value = Aabb> + Clone {
    (point(4), point(4)).prop_map(|(p, q)| Aabb::new(p.min(q), p.max(q)))
}

pub(super) fn union_holds_both_boxes(trial: &Trial<'_>) -> CheckResult {
    let boxes = || prop_oneof![9 => aabb(), 1 => Just(Aabb::EMPTY)];
    trial.forall(1000, (boxes(), boxes()), |pairs| {
        compare(pairs, trial.kit.union(pairs), |(first, second), yours| {
            let expected = tree::around([first, second]);
            let input = call("union", &[first, second]);
            let shared = Aabb::new(first.min.max(second.min), first.max.min(second.max));
            let diagnosis = match () {
                () if first.is_empty() != second.is_empty() => {
                    "the empty box (inf, -inf) must change nothing"
                }
                () if yours == shared => {
                    "you return what both boxes share: take the smaller min and the larger max"
                }
                () => "",
            };
            if yours == expected {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)))
            }
        })
    })
}

pub(super) fn centroid_is_the_middle(trial: &Trial<'_>) -> CheckResult {
    trial.forall(1000, aabb(), |boxes| {
        compare(boxes, trial.kit.centroid(boxes), |bounds, yours| {
            // Exact, because all coordinates are multiples of 1/8.
            let expected = 0.5 * (bounds.min + bounds.max);
            let input = call("centroid", &[bounds]);
            let diagnosis = match () {
                () if yours == bounds.min + bounds.max => "you return min + max, not halved",
                () if yours == 0.5 * (bounds.max - bounds.min) => {
                    "you return half the size of the box, not its middle"
                }
                () => "",
            };
            if yours == expected {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)))
            }
        })
    })
}

pub(super) fn surface_area_counts_six_faces(trial: &Trial<'_>) -> CheckResult {
    let boxes = prop_oneof![9 => aabb(), 1 => Just(Aabb::EMPTY)];
    trial.forall(1000, boxes, |boxes| {
        compare(boxes, trial.kit.surface_area(boxes), |bounds, yours| {
            // Exact, because the products are multiples of 1/64.
            let expected = 2.0 * tree::half_area(bounds) as f32;
            let diagnosis = match yours {
                _ if bounds.is_empty() => "an empty box has no faces: return 0 (its size max - min is -inf)",
                _ if yours == (bounds.max - bounds.min).element_product() => {
                    "you return the volume, not the area"
                }
                _ if 2.0 * yours == expected => "you return half of the area: each face counts twice",
                _ => "",
            };
            let input = call("surface_area", &[bounds]);
            if yours == expected {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)))
            }
        })
    })
}
