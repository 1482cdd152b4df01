//! Wrong distributions: the reference, except for the answers of one function.

use glam::{Vec2, Vec3, vec2, vec3};
use raykata::emitter::{EmitterSample, EmitterShape};
use raykata::kit::{
    Answer, BsdfQuery, EmitterQuery, PhongLobeQuery, Request, RouletteQuery, SphereSampleQuery, StepQuery,
};
use raykata::light_path::{BsdfSample, Lobe, PathStep};
use std::f32::consts::{PI, TAU};

/// A unit vector at the angle with cosine `cosine` to `axis`, turned around it by the fraction `turn` of a circle.
fn around(axis: Vec3, cosine: f32, turn: f32) -> Vec3 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let (x, y) = axis.any_orthonormal_pair();
    let (sin, cos) = (TAU * turn).sin_cos();
    (cosine * axis + sine * (cos * x + sin * y)).normalize()
}

fn polar(radius: f32, turn: f32) -> Vec2 {
    radius * Vec2::from_angle(TAU * turn)
}

fn each<Q, A>(queries: &[Q], answer: impl Fn(&Q) -> A) -> Vec<A> {
    queries.iter().map(answer).collect()
}

fn disk(request: &Request, place: fn(Vec2) -> Vec2) -> Option<Answer> {
    match request {
        Request::SampleDisk(queries) => Some(Answer::SampleDisk(each(queries, |u| place(*u)))),
        _ => None,
    }
}

fn round_light(request: &Request, place: fn(Vec2) -> Vec2) -> Option<Answer> {
    let Request::SampleLightDisk(queries) = request else { return None };
    let point = |(disk, u): &(raykata::shape::Disk, Vec2)| {
        let (x, y) = disk.normal.normalize().any_orthonormal_pair();
        let place = disk.radius * place(*u);
        disk.center + place.x * x + place.y * y
    };
    Some(Answer::SampleLightDisk(each(queries, point)))
}

fn rectangle(request: &Request, place: fn(Vec2) -> Vec2) -> Option<Answer> {
    let Request::SampleRectangle(queries) = request else { return None };
    Some(Answer::SampleRectangle(each(queries, |query| {
        let shares = place(query.u);
        query.corner + shares.x * query.edges.0 + shares.y * query.edges.1
    })))
}

/// Directions to a sphere from its rim's sine and cosine and two random numbers.
fn sphere(request: &Request, cosine: fn(sin_rim: f32, u: f32) -> f32) -> Option<Answer> {
    let Request::SampleSphere(queries) = request else { return None };
    Some(Answer::SampleSphere(each(queries, |SphereSampleQuery { sphere, from, u }| {
        let to_center = sphere.center - *from;
        let sin_rim = sphere.radius / to_center.length();
        around(to_center.normalize_or(Vec3::Y), cosine(sin_rim, u.x), u.y)
    })))
}

/// Directions of glossy reflection from the roughness and a random number.
fn lobe(request: &Request, cosine: fn(roughness: f32, u: f32) -> f32) -> Option<Answer> {
    let Request::SamplePhongLobe(queries) = request else { return None };
    Some(Answer::SamplePhongLobe(each(queries, |PhongLobeQuery { ideal, roughness, u, .. }| {
        around(*ideal, cosine(*roughness, u.x), u.y)
    })))
}

fn cells(request: &Request, place: fn(Vec2) -> Vec2) -> Option<Answer> {
    let Request::Jittered(strata) = request else { return None };
    Some(Answer::Jittered(each(strata, |stratum| {
        (stratum.cell.as_vec2() + place(stratum.u)) / stratum.grid.as_vec2()
    })))
}

fn times(request: &Request, place: fn(f32) -> f32) -> Option<Answer> {
    let Request::TimeInShutter(queries) = request else { return None };
    Some(Answer::TimeInShutter(each(queries, |query| {
        let share = ((query.slot - 1) as f32 + place(query.u)) / query.slots as f32;
        query.shutter.open + share * (query.shutter.close - query.shutter.open)
    })))
}

/// Directions on the side of a normal, from a function that gives the cosine and may give too few turns.
fn hemisphere(request: &Request, place: fn(Vec2) -> (f32, f32)) -> Option<Answer> {
    let Request::CosineDirection(queries) = request else { return None };
    Some(Answer::CosineDirection(each(queries, |(normal, u)| {
        let (cosine, turn) = place(*u);
        around(*normal, cosine, turn)
    })))
}

/// The reference's samples of light with other random numbers, and with a density that is changed.
fn light(
    request: &Request,
    place: fn(Vec2) -> Vec2,
    pdf: fn(&EmitterQuery, &EmitterSample) -> f32,
) -> Option<Answer> {
    let Request::SampleLight(queries) = request else { return None };
    Some(Answer::SampleLight(each(queries, |query| {
        let u = place(query.u).clamp(Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON / 2.0));
        let sample = solutions::stage11_light_transport::sample_light(&query.emitter, query.from, u)?;
        Some(EmitterSample { pdf: pdf(query, &sample), ..sample })
    })))
}

/// The factor of Russian roulette by another rule.
fn roulette(request: &Request, factor: fn(&RouletteQuery) -> f32) -> Option<Answer> {
    let Request::Survives(queries) = request else { return None };
    Some(Answer::Survives(each(queries, factor)))
}

fn right_roulette(query: &RouletteQuery) -> f32 {
    solutions::stage11_light_transport::survives(query.weight, query.bounce, query.u)
}

/// The reference's steps of other queries, and with other answers.
fn stepped(
    request: &Request,
    before: fn(&mut StepQuery),
    after: fn(&StepQuery, &mut PathStep),
) -> Option<Answer> {
    let Request::Step(queries) = request else { return None };
    Some(Answer::Step(each(queries, |query| {
        let mut asked = query.clone();
        before(&mut asked);
        let StepQuery { path, vertex, max_depth, numbers } = &asked;
        let mut step = solutions::stage11_paths::step(path, vertex, *max_depth, numbers);
        after(query, &mut step);
        step
    })))
}

/// A diffuse step in another direction, from a function that gives the cosine and the turn.
fn turned(query: &StepQuery, step: &mut PathStep, place: fn(Vec2) -> (f32, f32)) {
    if let Some(next) = step.next.as_mut().filter(|next| next.lobe == Lobe::Diffuse) {
        let (cosine, turn) = place(vec2(query.numbers.bsdf.y, query.numbers.bsdf.z));
        next.direction = around(query.vertex.surface.shading_normal, cosine, turn);
    }
}

/// Scales the light of a shadow ray.
fn brighter(step: &mut PathStep, factor: f32) {
    if let Some(shadow) = &mut step.shadow {
        shadow.light *= factor;
    }
}

/// The reference's samples of lobes, with other random numbers, and changed.
fn lobes(
    request: &Request,
    numbers: fn(Vec3) -> Vec3,
    change: fn(&BsdfQuery, &mut BsdfSample),
) -> Option<Answer> {
    let Request::SampleBsdf(queries) = request else { return None };
    Some(Answer::SampleBsdf(each(queries, |query| {
        let mut sample = solutions::stage11_paths::sample_bsdf(&query.scattering, numbers(query.u))?;
        change(query, &mut sample);
        Some(sample)
    })))
}

/// The area of a flat emitter; 1 for a sphere.
fn area(shape: &EmitterShape) -> f32 {
    match shape {
        EmitterShape::Parallelogram { edges, .. } => edges.0.cross(edges.1).length(),
        EmitterShape::Triangle(triangle) => {
            0.5 * (triangle.b - triangle.a).cross(triangle.c - triangle.a).length()
        }
        EmitterShape::Sphere(_) => 1.0,
    }
}

/// The mistake, the check that must reject it, and the wrong answers.
type Wrong = (&'static str, &'static str, fn(&Request) -> Option<Answer>);

pub(super) const WRONG: &[Wrong] = &[
    ("disk: radius even", "places_on_the_disk_are_even", |r| disk(r, |u| polar(u.x, u.y))),
    ("disk: radius as in a sphere, ∛u", "places_on_the_disk_are_even", |r| {
        disk(r, |u| polar(u.x.cbrt(), u.y))
    }),
    ("disk: radius u^0.45", "places_on_the_disk_are_even", |r| disk(r, |u| polar(u.x.powf(0.45), u.y))),
    ("disk: one u for radius and angle", "places_on_the_disk_are_even", |r| {
        disk(r, |u| polar(u.x.sqrt(), u.x))
    }),
    ("disk: half of it, angle to π", "places_on_the_disk_are_even", |r| {
        disk(r, |u| polar(u.x.sqrt(), 0.5 * u.y))
    }),
    ("disk: angle in radians to 6", "places_on_the_disk_are_even", |r| {
        disk(r, |u| polar(u.x.sqrt(), 6.0 / TAU * u.y))
    }),
    ("disk: the square squeezed, x √(1 - y²)", "places_on_the_disk_are_even", |r| {
        disk(r, |u| {
            let square = 2.0 * u - 1.0;
            vec2(square.x * (1.0 - square.y * square.y).sqrt(), square.y)
        })
    }),
    ("round light: radius even", "places_on_a_round_light_are_even", |r| round_light(r, |u| polar(u.x, u.y))),
    ("round light: a quarter, u not centred", "places_on_a_round_light_are_even", |r| {
        round_light(r, |u| polar(u.x.sqrt(), 0.25 * u.y))
    }),
    ("rectangle: one u for both edges", "places_on_a_rectangle_are_even", |r| {
        rectangle(r, |u| vec2(u.x, u.x))
    }),
    ("rectangle: folded to a triangle", "places_on_a_rectangle_are_even", |r| {
        rectangle(r, |u| if u.x + u.y > 1.0 { 1.0 - u } else { u })
    }),
    ("rectangle: u²", "places_on_a_rectangle_are_even", |r| rectangle(r, |u| vec2(u.x * u.x, u.y))),
    ("rectangle: u^1.1", "places_on_a_rectangle_are_even", |r| rectangle(r, |u| vec2(u.x.powf(1.1), u.y))),
    ("sphere: θ even", "directions_to_a_sphere_are_even", |r| {
        sphere(r, |rim, u| (u * rim.min(1.0).asin()).cos())
    }),
    ("sphere: a flat disk in its middle", "directions_to_a_sphere_are_even", |r| {
        sphere(r, |rim, u| (1.0 / (1.0 + u * rim * rim)).sqrt())
    }),
    ("sphere: sin² even", "directions_to_a_sphere_are_even", |r| {
        sphere(r, |rim, u| (1.0 - u * rim * rim).sqrt())
    }),
    ("sphere: far, 1 - cos θ rounded", "a_far_sphere_is_still_a_sphere", |r| {
        sphere(r, |rim, u| 1.0 - u * (1.0 - (1.0 - rim * rim).sqrt()))
    }),
    ("sphere: inside, θ even", "from_inside_a_sphere_it_is_everywhere", |r| {
        sphere(r, |_, u| (PI * u).cos())
    }),
    ("sphere: inside, half of it", "from_inside_a_sphere_it_is_everywhere", |r| sphere(r, |_, u| u)),
    ("sphere: half of the rim", "half_a_sphere_makes_half_a_shadow", |r| {
        let Request::SampleSphere(queries) = r else { return None };
        let halved =
            |query: &SphereSampleQuery| SphereSampleQuery { u: vec2(query.u.x, 0.5 * query.u.y), ..*query };
        Some(
            Request::SampleSphere(each(queries, halved))
                .answer(&*solutions::kit(), &raykata::frame::Unwatched),
        )
    }),
    ("glossy: exponent 1 / n", "phong_lobe_falls_with_the_power_of_the_cosine", |r| {
        lobe(r, |rough, u| u.powf(1.0 / (2.0 / (rough * rough) - 2.0)))
    }),
    ("glossy: roughness not squared", "phong_lobe_falls_with_the_power_of_the_cosine", |r| {
        lobe(r, |rough, u| u.powf(1.0 / (2.0 / rough - 1.0)))
    }),
    ("glossy: n = 2 / roughness²", "phong_lobe_falls_with_the_power_of_the_cosine", |r| {
        lobe(r, |rough, u| u.powf(1.0 / (2.0 / (rough * rough) + 1.0)))
    }),
    ("glossy: an even cone", "phong_lobe_falls_with_the_power_of_the_cosine", |r| {
        lobe(r, |rough, u| 1.0 - u * 0.5 * rough * rough)
    }),
    ("glossy: little, 1 - cos θ rounded", "slightly_rough_is_not_a_few_angles", |r| {
        lobe(r, |rough, u| u.powf(1.0 / (2.0 / (rough * rough) - 1.0)))
    }),
    ("glossy: always diffuse, √u", "phong_lobe_falls_with_the_power_of_the_cosine", |r| {
        lobe(r, |_, u| u.sqrt())
    }),
    ("jitter: u²", "jittered_samples_cover_the_pixel_evenly", |r| cells(r, |u| u * u)),
    ("jitter: always the middle of the cell", "jittered_samples_cover_the_pixel_evenly", |r| {
        cells(r, |_| Vec2::splat(0.5))
    }),
    ("jitter: one u for x and y", "jittered_samples_cover_the_pixel_evenly", |r| {
        cells(r, |u| vec2(u.x, u.x))
    }),
    ("disk: half of it, in the picture", "picture_of_soft_edges", |r| {
        disk(r, |u| polar(u.x.sqrt(), 0.5 * u.y))
    }),
    ("time: u² in each slot", "times_are_even", |r| times(r, |u| u * u)),
    ("time: always the middle of the slot", "times_are_even", |r| times(r, |_| 0.5)),
    ("hemisphere: uniform", "cosine_directions_have_their_density", |r| hemisphere(r, |u| (u.x, u.y))),
    ("hemisphere: θ even", "cosine_directions_have_their_density", |r| {
        hemisphere(r, |u| ((0.5 * PI * u.x).cos(), u.y))
    }),
    ("hemisphere: cos^1.2 in place of cos", "cosine_directions_have_their_density", |r| {
        hemisphere(r, |u| (u.x.powf(1.0 / 2.2), u.y))
    }),
    ("hemisphere: half a turn", "cosine_directions_have_their_density", |r| {
        hemisphere(r, |u| (u.x.sqrt(), 0.5 * u.y))
    }),
    ("hemisphere: one u for both", "cosine_directions_have_their_density", |r| {
        hemisphere(r, |u| (u.x.sqrt(), u.x))
    }),
    ("integrating sphere: uniform directions", "paths_in_an_integrating_sphere_find_its_light", |r| {
        hemisphere(r, |u| (u.x, u.y))
    }),
    ("integrating sphere: θ even", "paths_in_an_integrating_sphere_find_its_light", |r| {
        hemisphere(r, |u| ((0.5 * PI * u.x).cos(), u.y))
    }),
    ("integrating sphere: roulette without division", "paths_in_an_integrating_sphere_find_its_light", |r| {
        roulette(r, |query| right_roulette(query).min(1.0))
    }),
    ("integrating sphere: stops after 5 bounces", "paths_in_an_integrating_sphere_find_its_light", |r| {
        roulette(r, |query| if query.bounce > 5 { 0.0 } else { right_roulette(query) })
    }),
    ("light: u² along an edge", "light_samples_have_their_density", |r| {
        light(r, |u| vec2(u.x * u.x, u.y), |_, sample| sample.pdf)
    }),
    ("light: u^1.1 along an edge", "light_samples_have_their_density", |r| {
        light(r, |u| vec2(u.x.powf(1.1), u.y), |_, sample| sample.pdf)
    }),
    ("light: one u for both", "light_samples_have_their_density", |r| {
        light(r, |u| vec2(u.x, u.x), |_, sample| sample.pdf)
    }),
    ("light: half of it", "light_samples_have_their_density", |r| {
        light(r, |u| vec2(u.x, 0.5 * u.y), |_, sample| sample.pdf)
    }),
    ("polygon light: density per area", "polygon_lights_give_lamberts_irradiance", |r| {
        light(r, |u| u, |query, _| 1.0 / area(&query.emitter.shape))
    }),
    ("polygon light: distance not squared", "polygon_lights_give_lamberts_irradiance", |r| {
        light(r, |u| u, |_, sample| sample.pdf / sample.distance)
    }),
    ("polygon light: 3 % too bright", "polygon_lights_give_lamberts_irradiance", |r| {
        light(r, |u| u, |_, sample| sample.pdf / 1.03)
    }),
    ("sphere light: twice too bright", "sphere_lights_give_their_irradiance", |r| {
        light(r, |u| u, |_, sample| 0.5 * sample.pdf)
    }),
    ("sphere light: 1 % too bright", "sphere_lights_give_their_irradiance", |r| {
        light(r, |u| u, |_, sample| sample.pdf / 1.01)
    }),
    ("lobes: weights not divided", "bsdf_samples_keep_the_light", |r| {
        lobes(
            r,
            |u| u,
            |query, sample| {
                if sample.lobe == Lobe::Diffuse {
                    sample.weight = query.scattering.diffuse;
                }
            },
        )
    }),
    ("lobes: chosen by a squared number", "bsdf_samples_keep_the_light", |r| {
        lobes(r, |u| u.with_x(u.x * u.x), |_, _| ())
    }),
    ("lobes: chosen by u^1.1", "bsdf_samples_keep_the_light", |r| {
        lobes(r, |u| u.with_x(u.x.powf(1.1)), |_, _| ())
    }),
    ("lobes: the number that chose the lobe gives the height", "diffuse_samples_use_fresh_numbers", |r| {
        lobes(r, |u| vec3(u.x, u.x, u.z), |_, _| ())
    }),
    ("lobes: the number that chose the lobe gives the turn", "diffuse_samples_use_fresh_numbers", |r| {
        lobes(r, |u| vec3(u.x, u.y, u.x), |_, _| ())
    }),
    ("furnace: found light counts in full", "paths_in_a_furnace_find_all_light", |r| {
        stepped(r, |query| query.vertex.emitter = None, |_, _| ())
    }),
    ("furnace: sampled light counts in full", "paths_in_a_furnace_find_all_light", |r| {
        stepped(r, |_| (), |_, step| brighter(step, 2.0))
    }),
    // After 5 bounces 3 % of the light are missing; 16 of 20 seeds notice that.
    ("furnace: ends after 4 bounces", "paths_in_a_furnace_find_all_light", |r| {
        stepped(r, |query| query.max_depth = 4, |_, _| ())
    }),
    ("corner: uniform directions", "paths_in_a_corner_find_its_sky", |r| {
        stepped(r, |_| (), |query, step| turned(query, step, |u| (u.x, u.y)))
    }),
    ("corner: θ even", "paths_in_a_corner_find_its_sky", |r| {
        stepped(r, |_| (), |query, step| turned(query, step, |u| ((0.5 * PI * u.x).cos(), u.y)))
    }),
    ("corner: one bounce", "paths_in_a_corner_find_its_sky", |r| {
        stepped(r, |query| query.max_depth = 1, |_, _| ())
    }),
    ("sphere of steps: uniform directions", "steps_in_an_integrating_sphere_find_its_light", |r| {
        stepped(r, |_| (), |query, step| turned(query, step, |u| (u.x, u.y)))
    }),
    ("sphere of steps: θ even", "steps_in_an_integrating_sphere_find_its_light", |r| {
        stepped(r, |_| (), |query, step| turned(query, step, |u| ((0.5 * PI * u.x).cos(), u.y)))
    }),
    ("sphere of steps: ends after 4 bounces", "steps_in_an_integrating_sphere_find_its_light", |r| {
        stepped(r, |query| query.max_depth = 4, |_, _| ())
    }),
    ("sampled lights: found light counts in full", "steps_count_sampled_light_once", |r| {
        stepped(r, |query| query.vertex.emitter = None, |_, _| ())
    }),
    ("sampled lights: found light is left out", "steps_count_sampled_light_once", |r| {
        stepped(
            r,
            |_| (),
            |query, step| {
                if query.path.bounces > 0 {
                    step.light = Vec3::ZERO;
                }
            },
        )
    }),
    ("sampled lights: 5 % too bright", "steps_count_sampled_light_once", |r| {
        stepped(r, |_| (), |_, step| brighter(step, 1.05))
    }),
    ("mirror: its density is a number", "steps_find_light_in_a_mirror", |r| {
        stepped(
            r,
            |query| {
                if query.path.bounces > 0 && query.path.pdf >= 1e18 {
                    query.path.pdf = 1.0;
                }
            },
            |_, _| (),
        )
    }),
    ("mirror: found light is left out", "steps_find_light_in_a_mirror", |r| {
        stepped(
            r,
            |_| (),
            |query, step| {
                if query.path.bounces > 0 {
                    step.light = Vec3::ZERO;
                }
            },
        )
    }),
    ("Cornell box: direct light only", "steps_in_an_empty_cornell_box_agree_with_radiosity", |r| {
        stepped(r, |query| query.max_depth = 1, |_, _| ())
    }),
    ("Cornell box: ends after 3 bounces", "steps_in_an_empty_cornell_box_agree_with_radiosity", |r| {
        stepped(r, |query| query.max_depth = 3, |_, _| ())
    }),
    (
        "Cornell box: sampled light 5 % too bright",
        "steps_in_an_empty_cornell_box_agree_with_radiosity",
        |r| stepped(r, |_| (), |_, step| brighter(step, 1.05)),
    ),
];
