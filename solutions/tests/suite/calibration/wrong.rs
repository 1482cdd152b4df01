//! Wrong distributions: the reference, except for the answers of one function.

use glam::{Vec2, Vec3, vec2, vec3};
use raykata::emitter::EmitterSample;
use raykata::kit::{Answer, PhongLobeQuery, Request, RouletteQuery, SphereSampleQuery, StepQuery};
use raykata::light_path::{Lobe, PathStep};
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

/// The answer to a request of this kind by a function of each query; `None` for other requests.
macro_rules! answers {
    ($request:expr, $Message:ident, $answer:expr) => {
        match $request {
            Request::$Message(queries) => Some(Answer::$Message(queries.iter().map($answer).collect())),
            _ => None,
        }
    };
}

fn disk(request: &Request, place: fn(Vec2) -> Vec2) -> Option<Answer> {
    answers!(request, SampleDisk, |u| place(*u))
}

fn round_light(request: &Request, place: fn(Vec2) -> Vec2) -> Option<Answer> {
    answers!(request, SampleLightDisk, |(disk, u)| {
        let (x, y) = disk.normal.normalize().any_orthonormal_pair();
        let place = disk.radius * place(*u);
        disk.center + place.x * x + place.y * y
    })
}

fn rectangle(request: &Request, place: fn(Vec2) -> Vec2) -> Option<Answer> {
    answers!(request, SampleRectangle, |query| {
        let shares = place(query.u);
        query.corner + shares.x * query.edges.0 + shares.y * query.edges.1
    })
}

/// Directions to a sphere from its rim's sine and cosine and two random numbers.
fn sphere(request: &Request, cosine: fn(sin_rim: f32, u: f32) -> f32) -> Option<Answer> {
    answers!(request, SampleSphere, |SphereSampleQuery { sphere, from, u }| {
        let to_center = sphere.center - *from;
        let sin_rim = sphere.radius / to_center.length();
        around(to_center.normalize_or(Vec3::Y), cosine(sin_rim, u.x), u.y)
    })
}

/// Directions of glossy reflection from the roughness and a random number.
fn lobe(request: &Request, cosine: fn(roughness: f32, u: f32) -> f32) -> Option<Answer> {
    answers!(request, SamplePhongLobe, |PhongLobeQuery { ideal, roughness, u, .. }| {
        around(*ideal, cosine(*roughness, u.x), u.y)
    })
}

fn cells(request: &Request, place: fn(Vec2) -> Vec2) -> Option<Answer> {
    answers!(request, Jittered, |stratum| {
        (stratum.cell.as_vec2() + place(stratum.u)) / stratum.grid.as_vec2()
    })
}

fn times(request: &Request, place: fn(f32) -> f32) -> Option<Answer> {
    answers!(request, TimeInShutter, |query| {
        let share = ((query.slot - 1) as f32 + place(query.u)) / query.slots as f32;
        query.shutter.open + share * (query.shutter.close - query.shutter.open)
    })
}

/// Directions on the side of a normal, from a function that gives the cosine and may give too few turns.
fn hemisphere(request: &Request, place: fn(Vec2) -> (f32, f32)) -> Option<Answer> {
    answers!(request, CosineDirection, |(normal, u)| {
        let (cosine, turn) = place(*u);
        around(*normal, cosine, turn)
    })
}

/// The reference's samples of light with other random numbers, and with a density that is changed.
fn light(request: &Request, place: fn(Vec2) -> Vec2, pdf: fn(&EmitterSample) -> f32) -> Option<Answer> {
    answers!(request, SampleLight, |query| {
        let u = place(query.u).clamp(Vec2::ZERO, Vec2::splat(1.0 - f32::EPSILON / 2.0));
        let sample = solutions::stage11_light_transport::sample_light(&query.emitter, query.from, u)?;
        Some(EmitterSample { pdf: pdf(&sample), ..sample })
    })
}

/// The factor of Russian roulette by another rule.
fn roulette(request: &Request, factor: fn(&RouletteQuery) -> f32) -> Option<Answer> {
    answers!(request, Survives, factor)
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
    answers!(request, Step, |query| {
        let mut asked = query.clone();
        before(&mut asked);
        let StepQuery { path, vertex, max_depth, numbers } = &asked;
        let mut step = solutions::stage11_paths::step(path, vertex, *max_depth, numbers);
        after(query, &mut step);
        step
    })
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

/// The reference's samples of lobes, with other random numbers.
fn lobes(request: &Request, numbers: fn(Vec3) -> Vec3) -> Option<Answer> {
    answers!(request, SampleBsdf, |query| {
        solutions::stage11_paths::sample_bsdf(&query.scattering, numbers(query.u))
    })
}

/// The mistake, the check that must reject it, and the wrong answers.
type Wrong = (&'static str, &'static str, fn(&Request) -> Option<Answer>);

/// Small deviations, which each check just finds, and mistakes that no other entry of a check has. The corpus has larger ones.
pub(super) const WRONG: &[Wrong] = &[
    ("disk: radius u^0.49", "places_on_the_disk_are_even", |r| disk(r, |u| polar(u.x.powf(0.49), u.y))),
    ("round light: radius u^0.49", "places_on_a_round_light_are_even", |r| {
        round_light(r, |u| polar(u.x.powf(0.49), u.y))
    }),
    ("rectangle: u^1.02", "places_on_a_rectangle_are_even", |r| rectangle(r, |u| vec2(u.x.powf(1.02), u.y))),
    ("sphere: the last thousandth is left out", "directions_to_a_sphere_are_even", |r| {
        sphere(r, |rim, u| 1.0 - 0.999 * u * (1.0 - (1.0 - rim * rim).sqrt()))
    }),
    ("sphere: far, 1 - cos θ rounded", "a_far_sphere_is_still_a_sphere", |r| {
        sphere(r, |rim, u| 1.0 - u * (1.0 - (1.0 - rim * rim).sqrt()))
    }),
    ("sphere: inside, u^1.02", "from_inside_a_sphere_it_is_everywhere", |r| {
        sphere(r, |_, u| 1.0 - 2.0 * u.powf(1.02))
    }),
    ("sphere: half of the rim", "half_a_sphere_makes_half_a_shadow", |r| {
        answers!(r, SampleSphere, |SphereSampleQuery { sphere, from, u }| {
            solutions::stage6_distribution::sample_sphere(sphere, *from, vec2(u.x, 0.5 * u.y))
        })
    }),
    ("glossy: n + 1 is 2 % too large", "phong_lobe_falls_with_the_power_of_the_cosine", |r| {
        lobe(r, |rough, u| u.powf(1.0 / (1.02 * (2.0 / (rough * rough) - 1.0))))
    }),
    ("glossy: little, 1 - cos θ rounded", "slightly_rough_is_not_a_few_angles", |r| {
        lobe(r, |rough, u| u.powf(1.0 / (2.0 / (rough * rough) - 1.0)))
    }),
    ("jitter: u²", "jittered_samples_cover_the_pixel_evenly", |r| cells(r, |u| u * u)),
    ("disk: half of it, in the picture", "picture_of_soft_edges", |r| {
        disk(r, |u| polar(u.x.sqrt(), 0.5 * u.y))
    }),
    ("time: u² in each slot", "times_are_even", |r| times(r, |u| u * u)),
    ("hemisphere: cos^1.02 in place of cos", "cosine_directions_have_their_density", |r| {
        hemisphere(r, |u| (u.x.powf(1.0 / 2.02), u.y))
    }),
    ("hemisphere: cos θ above 0.02", "cosine_directions_have_their_density", |r| {
        hemisphere(r, |u| (u.x.sqrt().max(0.02), u.y))
    }),
    ("integrating sphere: θ even", "paths_in_an_integrating_sphere_find_its_light", |r| {
        hemisphere(r, |u| ((0.5 * PI * u.x).cos(), u.y))
    }),
    ("integrating sphere: stops after 5 bounces", "paths_in_an_integrating_sphere_find_its_light", |r| {
        roulette(r, |query| if query.bounce > 5 { 0.0 } else { right_roulette(query) })
    }),
    ("light: u^1.02 along an edge", "light_samples_have_their_density", |r| {
        light(r, |u| vec2(u.x.powf(1.02), u.y), |sample| sample.pdf)
    }),
    ("polygon light: 3 % too bright", "polygon_lights_give_lamberts_irradiance", |r| {
        light(r, |u| u, |sample| sample.pdf / 1.03)
    }),
    ("sphere light: 1 % too bright", "sphere_lights_give_their_irradiance", |r| {
        light(r, |u| u, |sample| sample.pdf / 1.01)
    }),
    ("lobes: the number that chose the lobe gives the height", "diffuse_samples_use_fresh_numbers", |r| {
        lobes(r, |u| vec3(u.x, u.x, u.z))
    }),
    ("lobes: the height of u^1.02", "diffuse_samples_use_fresh_numbers", |r| {
        lobes(r, |u| u.with_y(u.y.powf(1.02)))
    }),
    ("furnace: sampled light counts in full", "paths_in_a_furnace_find_all_light", |r| {
        stepped(r, |_| (), |_, step| brighter(step, 2.0))
    }),
    // After 5 bounces 3 % of the light are missing; 16 of 20 seeds notice that.
    ("furnace: ends after 4 bounces", "paths_in_a_furnace_find_all_light", |r| {
        stepped(r, |query| query.max_depth = 4, |_, _| ())
    }),
    ("corner: θ even", "paths_in_a_corner_find_its_sky", |r| {
        stepped(r, |_| (), |query, step| turned(query, step, |u| ((0.5 * PI * u.x).cos(), u.y)))
    }),
    ("sphere of steps: ends after 4 bounces", "steps_in_an_integrating_sphere_find_its_light", |r| {
        stepped(r, |query| query.max_depth = 4, |_, _| ())
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
    ("Cornell box: ends after 3 bounces", "steps_in_an_empty_cornell_box_agree_with_radiosity", |r| {
        stepped(r, |query| query.max_depth = 3, |_, _| ())
    }),
    (
        "Cornell box: sampled light 5 % too bright",
        "steps_in_an_empty_cornell_box_agree_with_radiosity",
        |r| stepped(r, |_| (), |_, step| brighter(step, 1.05)),
    ),
];
