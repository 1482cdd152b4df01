//! A plain textbook solution of stages 4 to 6 earns at least three quarters of the points of each stage. It heeds the doc
//! comments, but not their numerical pitfalls, so it fails hard cases only: checks with titles of their own, which together
//! have at most a quarter of the points.
//!
//! The same functions with the code of the third hints pass those checks, too: a hint leads to code that passes.

use all_checks::of_stage;
use checks::{Check, Verdict, rubric};
use glam::{Vec2, Vec3, vec2};
use raykata::aabb::Aabb;
use raykata::frame::Watch;
use raykata::kit::{
    Answer, Bounce, Door, FILTER_RADIUS, Kit, LightSample, Request, SecondaryRay, ShadeAnswer, Surface,
    Transport,
};
use raykata::material::Fresnel;
use raykata::ray::Ray;
use raykata::scene::Sampler;
use std::f32::consts::TAU;
use std::sync::Arc;

/// The hard cases: the checks that a plain textbook solution may fail.
const HARD: [(u8, &[&str]); 3] = [
    (
        4,
        &[
            "shading_normal_falls_back_to_flat",
            "shadow_ray_leaves_its_own_surface_at_any_scale",
            "shadow_ray_sees_what_is_close",
            "gamma_survives_invalid_numbers",
        ],
    ),
    (
        5,
        &[
            "reflect_stays_of_unit_length_in_a_corridor",
            "refract_goes_straight_where_it_must",
            "refract_survives_rounded_directions",
            "secondary_rays_leave_their_surface",
            "scatter_refracts_nothing_in_total_reflection",
        ],
    ),
    (
        6,
        &[
            "places_on_the_disk_are_places",
            "lens_is_as_sharp_a_million_units_away",
            "a_far_sphere_is_still_a_sphere",
            "from_inside_a_sphere_it_is_everywhere",
            "slightly_rough_is_not_a_few_angles",
            "lerp_is_exact_where_it_must",
            "filter_pixel_of_no_samples_is_black",
        ],
    ),
];

/// Code in the third hint of a check, which the functions below contain if [`Textbook::with_hints`] is true.
const HINTS: [(u8, &str, &str); 26] = [
    (4, "shading_normal_falls_back_to_flat", "`try_normalize` returns None for 0 and NaN"),
    (4, "diffuse_term_is_the_cosine", "max(n·l, 0)"),
    (4, "specular_term_is_the_mirrored_cosine", "if both n·l and cos φ are above 0, and 0 otherwise"),
    (4, "shadow_ray_reaches_just_short_of_the_light", "t_max = 0.9999 * light.distance"),
    (4, "shadow_ray_leaves_its_own_surface_at_any_scale", "with `next_up` or `next_down`"),
    (4, "gamma_is_two", "Add 0.5 before `as u8`"),
    (4, "gamma_survives_invalid_numbers", "Clamp to 0..=1 before you take the root"),
    (5, "reflect_keeps_the_angle", "d - n (d·n) removes the part along n. Subtract it twice"),
    (5, "reflect_stays_of_unit_length_in_a_corridor", "Normalize the direction that you return"),
    (
        5,
        "refract_obeys_snell",
        "along = (n1 / n2) (d + n cos θ1), with cos θ1 = -d·n. The result is along - n √(1 - |along|²)",
    ),
    (5, "refract_beyond_the_critical_angle_is_none", "Return None unless 1 - |along|² >= 0"),
    (5, "fresnel_schlick_agrees_with_double_precision", "If n1 > n2, use the cosine of the refracted ray"),
    (5, "fresnel_exact_agrees_with_double_precision", "cos θ2 = √(1 - (n1 / n2)² (1 - cos² θ1))"),
    (
        5,
        "secondary_rays_leave_their_surface",
        "point + error·|n| n, then move each coordinate one float further",
    ),
    (5, "tree_ends_at_its_depth", "if depth >= limits.max_depth"),
    (6, "jittered_samples_stay_in_their_cells", "1 - f32::EPSILON / 2"),
    (6, "each_sampler_has_its_places", "0.5 + FILTER_RADIUS * (2 * jittered - 1)"),
    (6, "gaussian_weight_is_a_bell_that_ends", "bell(x) = max(0, e^(-2x²) - e^(-2R²))"),
    (6, "lens_rays_start_on_the_lens", "position + aperture / 2 * (x * right + y * up)"),
    (6, "focal_plane_is_sharp", "focal_distance / (pinhole.direction · camera.towards) * pinhole.direction"),
    (6, "places_on_a_rectangle_are_even", "corner + u.x * edges.0 + u.y * edges.1"),
    (6, "a_far_sphere_is_still_a_sphere", "1 - cos θ = sin²θ / (1 + cos θ); and sin²θ = x (2 - x)"),
    (6, "slightly_rough_is_not_a_few_angles", "x = -exp_m1(ln(u.x) / (n + 1))"),
    (6, "temporal_table_has_each_time_once", "TABLE[y % 4][x % 4]"),
    (6, "times_are_even", "open + share * (close - open)"),
    (6, "lerp_is_exact_where_it_must", "(1 - t) start + t end, and clamp each coordinate"),
];

/// The textbook functions. With hints they contain the code of the third hints.
#[derive(Clone, Copy)]
struct Textbook {
    with_hints: bool,
}

impl Textbook {
    fn shading_normal(self, geometric: Vec3, interpolated: Option<Vec3>, direction: Vec3) -> Vec3 {
        let facing = if geometric.dot(direction) > 0.0 { -geometric } else { geometric };
        let smooth = if self.with_hints {
            interpolated.and_then(Vec3::try_normalize).unwrap_or(facing)
        } else {
            interpolated.map_or(facing, Vec3::normalize)
        };
        if smooth.dot(facing) < 0.0 { -smooth } else { smooth }
    }

    fn specular(normal: Vec3, to_light: Vec3, to_viewer: Vec3, exponent: f32) -> f32 {
        let reflected = 2.0 * normal.dot(to_light) * normal - to_light;
        if normal.dot(to_light) > 0.0 && reflected.dot(to_viewer) > 0.0 {
            reflected.dot(to_viewer).powf(exponent)
        } else {
            0.0
        }
    }

    /// The start of a ray on a side of a surface: an epsilon from a book, or the code of the hint.
    fn off(self, surface: &Surface, side: Vec3) -> Vec3 {
        if !self.with_hints {
            return surface.point + 1e-3 * side;
        }
        let moved = surface.point + surface.error.dot(side.abs()) * side;
        let further = |axis: usize| match side[axis] {
            along if along > 0.0 => moved[axis].next_up(),
            along if along < 0.0 => moved[axis].next_down(),
            _ => moved[axis],
        };
        Vec3::new(further(0), further(1), further(2))
    }

    fn shadow_ray(self, surface: &Surface, light: &LightSample) -> Option<Ray> {
        let lit = surface.geometric_normal.dot(light.direction) > 0.0
            && surface.shading_normal.dot(light.direction) > 0.0
            && light.radiance != Vec3::ZERO;
        let origin = self.off(surface, surface.geometric_normal);
        lit.then(|| Ray::new(origin, light.direction).with_range(0.0, 0.9999 * light.distance))
    }

    fn encode(self, linear: f32) -> u8 {
        match self.with_hints {
            true => (linear.clamp(0.0, 1.0).sqrt() * 255.0 + 0.5) as u8,
            // A negative number has the root of its size, a mistake that only invalid numbers show.
            false => (linear.abs().sqrt() * 255.0 + 0.5) as u8,
        }
    }

    fn reflect(self, direction: Vec3, normal: Vec3) -> Vec3 {
        let reflected = direction - 2.0 * direction.dot(normal) * normal;
        if self.with_hints { reflected.normalize() } else { reflected }
    }

    fn refract(self, direction: Vec3, normal: Vec3, n1: f32, n2: f32) -> Option<Vec3> {
        let cos_1 = -direction.dot(normal);
        if self.with_hints {
            let along = n1 / n2 * (direction + cos_1 * normal);
            let squared = 1.0 - along.length_squared();
            return (squared >= 0.0).then(|| along - squared.sqrt() * normal);
        }
        // The formulas of the slide.
        let sin_1 = (1.0 - cos_1 * cos_1).sqrt();
        let sin_2 = n1 / n2 * sin_1;
        let m = (direction + cos_1 * normal) / sin_1;
        (sin_2 <= 1.0).then(|| sin_2 * m - (1.0 - sin_2 * sin_2).sqrt() * normal)
    }

    fn cos_2(cos_1: f32, n1: f32, n2: f32) -> Option<f32> {
        let squared = 1.0 - (n1 / n2).powi(2) * (1.0 - cos_1 * cos_1);
        (squared >= 0.0).then(|| squared.sqrt())
    }

    fn schlick(cos_theta: f32, n1: f32, n2: f32) -> f32 {
        let cosine = if n1 > n2 { Self::cos_2(cos_theta, n1, n2) } else { Some(cos_theta) };
        let r0 = ((n1 - n2) / (n1 + n2)).powi(2);
        cosine.map_or(1.0, |cosine| r0 + (1.0 - r0) * (1.0 - cosine).powi(5))
    }

    fn exact(cos_1: f32, n1: f32, n2: f32) -> f32 {
        let Some(cos_2) = Self::cos_2(cos_1, n1, n2) else { return 1.0 };
        let squared = |p: f32, q: f32| if p + q == 0.0 { 1.0 } else { ((p - q) / (p + q)).powi(2) };
        0.5 * (squared(n1 * cos_1, n2 * cos_2) + squared(n1 * cos_2, n2 * cos_1))
    }

    fn scatter(self, query: &raykata::kit::ScatterQuery) -> Vec<SecondaryRay> {
        let raykata::kit::ScatterQuery { direction, normal, entering, ref material, weight, depth, limits } =
            *query;
        if depth >= limits.max_depth {
            return Vec::new();
        }
        let index = material.index_of_refraction;
        let (n1, n2) = if entering { (1.0, index) } else { (index, 1.0) };
        let cos_theta = -direction.dot(normal);
        let share = match material.fresnel {
            Fresnel::None => 0.0,
            Fresnel::Schlick => Self::schlick(cos_theta, n1, n2),
            Fresnel::Exact => Self::exact(cos_theta, n1, n2),
        };
        let reflected = SecondaryRay {
            bounce: Bounce::Reflection,
            direction: self.reflect(direction, normal),
            weight: weight * (material.mirror + share * material.transmission),
        };
        let refracted = self.refract(direction, normal, n1, n2).map(|direction| SecondaryRay {
            bounce: Bounce::Transmission,
            direction,
            weight: weight * (1.0 - share) * material.transmission,
        });
        let counts = |ray: &SecondaryRay| {
            let largest = ray.weight.max_element();
            largest > 0.0 && largest >= limits.min_contribution
        };
        [Some(reflected), refracted].into_iter().flatten().filter(counts).collect()
    }

    fn jittered(stratum: &raykata::random::Stratum) -> Vec2 {
        let place = (stratum.cell.as_vec2() + stratum.u) / stratum.grid.as_vec2();
        place.min(Vec2::splat(1.0 - f32::EPSILON / 2.0))
    }

    fn lens_ray(self, query: &raykata::kit::LensQuery) -> Ray {
        let raykata::kit::LensQuery { camera, pinhole, lens, on_lens } = query;
        let offset = lens.aperture / 2.0 * (on_lens.x * camera.right + on_lens.y * camera.up);
        if offset == Vec3::ZERO {
            return *pinhole;
        }
        let origin = camera.position + offset;
        let focus = lens.focal_distance / pinhole.direction.dot(camera.towards) * pinhole.direction;
        let aim = if self.with_hints { focus - offset } else { camera.position + focus - origin };
        Ray { origin, direction: aim.normalize(), ..*pinhole }
    }

    /// The direction at the angle θ to `axis`, by the cosine alone, or by the code of the hint.
    fn around(self, axis: Vec3, below_one: f32, turn: f32) -> Vec3 {
        let cosine = 1.0 - below_one;
        let squared = if self.with_hints { below_one * (2.0 - below_one) } else { 1.0 - cosine * cosine };
        let (x, y) = axis.any_orthonormal_pair();
        let (sin, cos) = (TAU * turn).sin_cos();
        cosine * axis + squared.max(0.0).sqrt() * (cos * x + sin * y)
    }

    fn sample_sphere(self, query: &raykata::kit::SphereSampleQuery) -> Vec3 {
        let to_center = query.sphere.center - query.from;
        let sine_squared = query.sphere.radius.powi(2) / to_center.length_squared();
        let cosine = (1.0 - sine_squared).sqrt();
        let below_one = match self.with_hints {
            true if sine_squared >= 1.0 => 2.0,
            true => sine_squared / (1.0 + cosine),
            false => 1.0 - cosine,
        };
        let axis = if self.with_hints { to_center.normalize_or(Vec3::Y) } else { to_center.normalize() };
        self.around(axis, query.u.x * below_one, query.u.y)
    }

    fn sample_phong_lobe(self, query: &raykata::kit::PhongLobeQuery) -> Vec3 {
        if query.roughness == 0.0 {
            return query.ideal;
        }
        let n = 2.0 / query.roughness.powi(2) - 2.0;
        let below_one = match self.with_hints {
            true => -(query.u.x.ln() / (n + 1.0)).exp_m1(),
            false => 1.0 - query.u.x.powf(1.0 / (n + 1.0)),
        };
        let direction = self.around(query.ideal, below_one, query.u.y);
        let above = direction.dot(query.normal);
        if above < 0.0 { direction - 2.0 * above * query.normal } else { direction }
    }

    fn lerp(self, start: Vec3, end: Vec3, time: f32) -> Vec3 {
        // The clamp of the hint is part of the contract; without it the formula misses the end.
        let place = match self.with_hints {
            true => (1.0 - time) * start + time * end,
            false => start + time * (end - start),
        };
        place.max(start.min(end)).min(start.max(end))
    }
}

fn each<Q, A>(queries: &[Q], answer: impl Fn(&Q) -> A) -> Vec<A> {
    queries.iter().map(answer).collect()
}

fn bell(x: f32) -> f32 {
    ((-2.0 * x * x).exp() - (-2.0 * FILTER_RADIUS * FILTER_RADIUS).exp()).max(0.0)
}

fn shade(book: Textbook, query: &raykata::kit::ShadeQuery) -> ShadeAnswer {
    let (normal, material) = (query.surface.shading_normal, &query.material);
    let mut answer =
        ShadeAnswer { color: query.ambient * material.ambient, traced: Vec::new(), rays: Vec::new() };
    for (index, light) in query.lights.iter().enumerate() {
        let Some(ray) = book.shadow_ray(&query.surface, light) else { continue };
        let specular = Textbook::specular(normal, light.direction, query.to_viewer, material.exponent);
        let diffuse = normal.dot(light.direction).max(0.0);
        let added = light.radiance * (material.diffuse * diffuse + material.specular * specular);
        if added != Vec3::ZERO {
            answer.traced.push(index);
            answer.rays.push(ray);
            answer.color += if query.visible[index] { added } else { Vec3::ZERO };
        }
    }
    answer
}

impl Transport for Textbook {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        let book = *self;
        match &request {
            Request::ShadingNormal(q) => Answer::ShadingNormal(each(q, |(geometric, smooth, direction)| {
                book.shading_normal(*geometric, *smooth, *direction)
            })),
            Request::DiffuseTerm(q) => Answer::DiffuseTerm(each(q, |q| q.normal.dot(q.to_light).max(0.0))),
            Request::SpecularTerm(q) => Answer::SpecularTerm(each(q, |q| {
                Textbook::specular(q.normal, q.to_light, q.to_viewer, q.exponent)
            })),
            Request::ShadowRay(q) => Answer::ShadowRay(each(q, |q| book.shadow_ray(&q.surface, &q.light))),
            Request::Shade(q) => Answer::Shade(each(q, |q| shade(book, q))),
            Request::EncodeGamma(q) => Answer::EncodeGamma(each(q, |linear| book.encode(*linear))),
            Request::DecodeGamma(q) => {
                Answer::DecodeGamma(each(q, |byte| (f32::from(*byte) / 255.0) * (f32::from(*byte) / 255.0)))
            }
            Request::Reflect(q) => Answer::Reflect(each(q, |(d, n)| book.reflect(*d, *n))),
            Request::Refract(q) => {
                Answer::Refract(each(q, |q| book.refract(q.direction, q.normal, q.n1, q.n2)))
            }
            Request::FresnelSchlick(q) => {
                Answer::FresnelSchlick(each(q, |q| Textbook::schlick(q.cos_theta, q.n1, q.n2)))
            }
            Request::FresnelExact(q) => {
                Answer::FresnelExact(each(q, |q| Textbook::exact(q.cos_theta, q.n1, q.n2)))
            }
            Request::Scatter(q) => Answer::Scatter(each(q, |q| book.scatter(q))),
            Request::SpawnRay(q) => Answer::SpawnRay(each(q, |(surface, ray)| {
                let normal = surface.geometric_normal;
                let side = if ray.bounce == Bounce::Reflection { normal } else { -normal };
                Ray::new(book.off(surface, side), ray.direction)
            })),
            Request::Jittered(q) => Answer::Jittered(each(q, Textbook::jittered)),
            Request::PixelPosition(q) => Answer::PixelPosition(each(q, |(sampler, stratum)| match sampler {
                Sampler::Center => Vec2::splat(0.5),
                Sampler::Random | Sampler::LowDiscrepancy => stratum.u,
                Sampler::Jittered => Textbook::jittered(stratum),
                Sampler::Gaussian => 0.5 + FILTER_RADIUS * (2.0 * Textbook::jittered(stratum) - 1.0),
            })),
            Request::GaussianWeight(q) => Answer::GaussianWeight(each(q, |v| bell(v.x) * bell(v.y))),
            Request::FilterPixel(q) => Answer::FilterPixel(each(q, |samples| {
                let color: Vec3 = samples.iter().map(|one| one.weight * one.color).sum();
                let weight: f32 = samples.iter().map(|one| one.weight).sum();
                if book.with_hints && weight <= 0.0 { Vec3::ZERO } else { color / weight }
            })),
            Request::SampleDisk(q) => {
                Answer::SampleDisk(each(q, |u| u.x.sqrt() * vec2((TAU * u.y).cos(), (TAU * u.y).sin())))
            }
            Request::LensRay(q) => Answer::LensRay(each(q, |q| book.lens_ray(q))),
            Request::SampleRectangle(q) => {
                Answer::SampleRectangle(each(q, |q| q.corner + q.u.x * q.edges.0 + q.u.y * q.edges.1))
            }
            Request::SampleLightDisk(q) => Answer::SampleLightDisk(each(q, |(disk, u)| {
                let (first, second) = disk.normal.normalize().any_orthonormal_pair();
                let (x, y) = (u.x.sqrt() * (TAU * u.y).cos(), u.x.sqrt() * (TAU * u.y).sin());
                disk.center + disk.radius * (x * first + y * second)
            })),
            Request::SampleSphere(q) => Answer::SampleSphere(each(q, |q| book.sample_sphere(q))),
            Request::SamplePhongLobe(q) => Answer::SamplePhongLobe(each(q, |q| book.sample_phong_lobe(q))),
            Request::TemporalSlot(q) => Answer::TemporalSlot(each(q, |(x, y)| {
                const TABLE: [[u32; 4]; 4] = [[7, 11, 3, 14], [4, 15, 13, 9], [16, 1, 8, 12], [6, 10, 5, 2]];
                TABLE[*y as usize % 4][*x as usize % 4]
            })),
            Request::TimeInShutter(q) => Answer::TimeInShutter(each(q, |q| {
                let share = ((q.slot - 1) as f32 + q.u) / q.slots as f32;
                let time = q.shutter.open + share * (q.shutter.close - q.shutter.open);
                time.clamp(q.shutter.open, q.shutter.close)
            })),
            Request::Lerp(q) => Answer::Lerp(each(q, |(start, end, time)| book.lerp(*start, *end, *time))),
            Request::MotionBounds(q) => Answer::MotionBounds(each(q, |(start, end)| {
                Aabb::new(start.min.min(end.min), start.max.max(end.max))
            })),
            _ => request.answer(&*solutions::kit(), watch),
        }
    }
}

fn kit(with_hints: bool) -> Arc<dyn Kit + Send + Sync> {
    Arc::new(Door(Textbook { with_hints }))
}

fn points(stage: u8, name: &str) -> u32 {
    rubric::entry(stage, name).points
}

#[test]
fn hard_cases_have_at_most_a_quarter_of_the_points() {
    for (stage, hard) in HARD {
        let of: u32 = of_stage(stage).iter().map(|check| points(stage, check.name)).sum();
        let of_hard: u32 = hard.iter().map(|name| points(stage, name)).sum();
        println!("stage {stage}: {of_hard} of {of} points for hard cases");
        assert!(4 * of_hard <= of, "stage {stage}: {of_hard} of {of}");
    }
}

#[test]
fn a_plain_textbook_solution_fails_hard_cases_only() {
    for (stage, hard) in HARD {
        let mut earned = 0;
        for check in of_stage(stage) {
            match checks::run(check, &kit(false), 0) {
                Verdict::Passed => earned += points(stage, check.name),
                verdict => assert!(hard.contains(&check.name), "{}: {verdict:?}", check.name),
            }
        }
        let of: u32 = of_stage(stage).iter().map(|check| points(stage, check.name)).sum();
        println!("stage {stage}: a textbook solution earns {earned} of {of} points");
        assert!(4 * earned >= 3 * of, "stage {stage}: {earned} of {of}");
    }
}

#[test]
fn the_code_of_the_third_hints_passes() {
    for (stage, name, code) in HINTS {
        let hint = &rubric::entry(stage, name).hints[2];
        assert!(hint.contains(code), "the third hint of `{name}` changed: apply it in this test\n{hint}");
    }
    for (stage, _) in HARD {
        let fails = |check: &&Check| checks::run(check, &kit(true), 0) != Verdict::Passed;
        let failed: Vec<&str> = of_stage(stage).iter().filter(fails).map(|check| check.name).collect();
        assert!(failed.is_empty(), "stage {stage}: the code of the hints fails {failed:?}");
    }
}
