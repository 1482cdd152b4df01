//! The whole Phong model: the ambient term, and per light the diffuse and the specular term.

use super::shadows::lowest;
use super::terms::{WHOLE, cos_phi, specular};
use checks::prelude::*;
use raykata::material::Material;

pub(super) fn light() -> impl Strategy<Value = LightSample> + Clone {
    (nasty::unit(), fractions(1..=40, 4.0), point(1)).prop_map(|(direction, distance, color)| LightSample {
        direction,
        distance,
        radiance: 2.0 * color.abs(),
    })
}

/// Surfaces with two normals, and up to four lights on all sides of them.
pub(super) fn shade_query() -> impl Strategy<Value = ShadeQuery> + Clone {
    let colors = (point(1), point(1), point(1), point(1));
    let lights = prop::collection::vec((light(), any::<bool>()), 0..5);
    (nasty::surface(), nasty::unit(), colors, fractions(1..=64, 2.0), lights).prop_map(
        |(surface, to_viewer, (ambient, a, d, s), exponent, lights)| {
            // The viewer is on the side of the geometric normal.
            let behind = to_viewer.dot(surface.geometric_normal) < 0.0;
            let to_viewer = if behind { -to_viewer } else { to_viewer };
            let material = Material {
                ambient: a.abs(),
                diffuse: d.abs(),
                specular: s.abs(),
                exponent,
                ..Material::default()
            };
            let (lights, visible) = lights.into_iter().unzip();
            ShadeQuery { surface, to_viewer, material, ambient: ambient.abs(), lights, visible }
        },
    )
}

fn term(query: &ShadeQuery, index: usize) -> TermQuery {
    TermQuery {
        normal: query.surface.shading_normal,
        to_light: query.lights[index].direction,
        to_viewer: query.to_viewer,
        exponent: query.material.exponent,
    }
}

/// The cosine of light `index` with a normal, in double precision.
fn cosine(query: &ShadeQuery, index: usize, normal: Vec3) -> f64 {
    normal.as_dvec3().dot(query.lights[index].direction.as_dvec3())
}

/// Whether light `index` is in front of both normals.
fn is_in_front(query: &ShadeQuery, index: usize) -> bool {
    let Surface { geometric_normal, shading_normal, .. } = query.surface;
    cosine(query, index, geometric_normal) > 0.0 && cosine(query, index, shading_normal) > 0.0
}

/// The diffuse and the specular contribution of light `index` for these two terms, without shadows.
fn parts(query: &ShadeQuery, index: usize, diffuse: f64, specular: f64) -> [DVec3; 2] {
    let radiance = query.lights[index].radiance.as_dvec3();
    let Material { diffuse: kd, specular: ks, .. } = &query.material;
    [radiance * kd.as_dvec3() * diffuse, radiance * ks.as_dvec3() * specular]
}

/// The contribution of light `index` for these two terms, without shadows: 0 for a light behind the surface.
fn share(query: &ShadeQuery, index: usize, diffuse: f64, specular: f64) -> DVec3 {
    if is_in_front(query, index) { parts(query, index, diffuse, specular).iter().sum() } else { DVec3::ZERO }
}

/// Whether light `index` is at the horizon of a normal. There rounding decides whether it counts.
fn is_on_edge(query: &ShadeQuery, index: usize) -> bool {
    let Surface { geometric_normal, shading_normal, .. } = query.surface;
    [geometric_normal, shading_normal].into_iter().any(|normal| cosine(query, index, normal).abs() < 1e-5)
        || cos_phi(&term(query, index)).abs() < 1e-5
}

/// The greatest allowed difference of a channel from `right`: a few roundings of each factor, and of a power of 32.
fn tolerance(right: DVec3) -> f64 {
    1e-4 * (1.0 + right.abs().max_element())
}

/// A point with the student's own specular term and shadow ray per light.
type WithOwnTerms = (ShadeQuery, Vec<(f32, Option<Ray>)>);

fn shadow_queries(queries: &[ShadeQuery]) -> Vec<ShadowQuery> {
    let of_lights = |query: &ShadeQuery| {
        let surface = query.surface;
        query.lights.iter().map(move |light| ShadowQuery { surface, light: *light }).collect::<Vec<_>>()
    };
    queries.iter().flat_map(of_lights).collect()
}

/// Adds the student's own specular terms and shadow rays. The formula of `shade` is judged with these as well as with the right
/// ones, because other checks judge `specular_term` and `shadow_ray`.
fn with_own_terms(trial: &Trial<'_>, queries: &[ShadeQuery]) -> Vec<WithOwnTerms> {
    let terms: Vec<TermQuery> =
        queries.iter().flat_map(|query| (0..query.lights.len()).map(|light| term(query, light))).collect();
    let rays = trial.kit.shadow_ray(&shadow_queries(queries));
    let mut own = trial.kit.specular_term(&terms).into_iter().zip(rays);
    let mut of_query = |query: &ShadeQuery| own.by_ref().take(query.lights.len()).collect();
    queries.iter().map(|query| (query.clone(), of_query(query))).collect()
}

pub(super) fn judge_shades(trial: &Trial<'_>, queries: &[ShadeQuery]) -> Vec<CheckResult> {
    let judged = with_own_terms(trial, queries);
    let answers = trial.kit.shade(queries);
    proven(judged.iter().zip(answers).map(|(query, answer)| judge_shade(query, &answer)))
}

const FALLOFF: &str = "you divide by the distance to the light: its radiance has the distance in it";
const PER_LIGHT: &str = "you divide by the number of lights: the light of all adds up";
const LIGHT_BEHIND: &str =
    "you add a light behind the surface: skip lights for which shadow_ray returns None";

fn judge_shade((query, own): &WithOwnTerms, yours: &ShadeAnswer) -> Judged {
    let lights: Vec<usize> = (0..query.lights.len()).collect();
    if lights.iter().any(|&light| is_on_edge(query, light)) {
        return Ok(().into());
    }
    let color = yours.color.as_dvec3();
    let ambient = query.ambient.as_dvec3() * query.material.ambient.as_dvec3();
    let seen = |light: &usize| query.visible[*light];
    // The right terms, and the student's own specular term.
    let diffuse = |light: usize| cosine(query, light, query.surface.shading_normal);
    let right = |light: usize| specular(&term(query, light));
    let same = |other: DVec3| {
        let near = (color - other).abs().cmplt(DVec3::splat(tolerance(other)));
        (0..3).all(|channel| near.test(channel) || (color[channel].is_nan() && other[channel].is_nan()))
    };
    // The colour that the lights of a list give.
    let sum = |lights: &[usize]| {
        ambient + lights.iter().map(|&light| share(query, light, diffuse(light), right(light))).sum::<DVec3>()
    };
    // The same with the student's own specular terms, and the lights to which the student's own `shadow_ray` returns a ray.
    let own_sum = |lights: &[usize]| {
        let of = |&light: &usize| match own[light] {
            (term, Some(_)) => parts(query, light, diffuse(light).max(0.0), term.into()).iter().sum(),
            (_, None) => DVec3::ZERO,
        };
        ambient + lights.iter().map(of).sum::<DVec3>()
    };
    // Whether they give the student's colour, and whether with the student's own functions.
    let gives = |lights: &[usize]| [same(sum(lights)), same(own_sum(lights))];
    let (visible, occluded): (Vec<usize>, Vec<usize>) = lights.iter().partition(|light| seen(light));
    let expected = sum(&visible);
    let of_visible = |share: &dyn Fn(usize) -> DVec3| {
        visible.iter().filter(|&&light| is_in_front(query, light)).map(|&light| share(light)).sum::<DVec3>()
    };
    let (kd, ks) = (query.material.diffuse.as_dvec3(), query.material.specular.as_dvec3());
    let radiance = |light: usize| query.lights[light].radiance.as_dvec3();
    let distance = |light: usize| f64::from(query.lights[light].distance);
    let of_kd = |light: usize| radiance(light) * kd * diffuse(light);
    let of_ks = |light: usize| radiance(light) * ks * right(light);
    let unlit = |light: usize| kd * diffuse(light) + ks * right(light);
    let mean = |color: DVec3| DVec3::splat(color.element_sum() / 3.0);
    let geometric = |light: usize| {
        let normal = query.surface.geometric_normal;
        let term = TermQuery { normal, ..term(query, light) };
        parts(query, light, cosine(query, light, normal), specular(&term)).iter().sum::<DVec3>()
    };
    let whole = |round: fn(f32) -> f32| {
        let of = |light: usize| {
            let exponent = round(query.material.exponent);
            of_kd(light) + radiance(light) * ks * specular(&TermQuery { exponent, ..term(query, light) })
        };
        same(ambient + of_visible(&of))
    };
    // What each visible light adds by mistake.
    let shares: [(&dyn Fn(usize) -> DVec3, &str); 14] = named![
        &|light| (of_kd(light) + of_ks(light)) / distance(light) => FALLOFF,
        &|light| (of_kd(light) + of_ks(light)) / distance(light).powi(2) => FALLOFF,
        &|light| unlit(light) * radiance(light) * radiance(light) =>
            "the radiance is squared: it is a factor of the sum once",
        &|light| unlit(light) * mean(radiance(light)) =>
            "the light is grey: multiply by its radiance channel by channel",
        &|light| of_kd(light) + ks * right(light) => "the highlight is not multiplied by the radiance",
        &|light| of_ks(light) + kd * diffuse(light) => "the diffuse term is not multiplied by the radiance",
        &|light| of_kd(light) + of_ks(light) * diffuse(light) =>
            "the highlight is multiplied by cos θ: it is I·ks·cosⁿφ",
        &|light| radiance(light) * (ks * diffuse(light) + kd * right(light)) => "kd and ks are exchanged",
        &|light| of_kd(light) + radiance(light) * right(light) => "ks is left out",
        &of_ks => "the diffuse term is missing",
        &of_kd => "the specular term is missing",
        &|light| if radiance(light) == DVec3::ZERO { DVec3::ZERO } else { unlit(light) } =>
            "you leave out the radiance of the light",
        &geometric => "you use the geometric normal: use surface.shading_normal",
        &|light| radiance(light) * kd + of_ks(light) => "you leave out the cosine of the diffuse term",
    ];
    // The lights that add something: they are asked for a shadow ray, in order. Those that count if the number of the ray is passed.
    let adds = |light: &usize| share(query, *light, diffuse(*light), right(*light)) != DVec3::ZERO;
    let counted: Vec<usize> = visible.iter().copied().filter(adds).collect();
    let asked = lights.iter().copied().filter(adds);
    let by_number: Vec<usize> =
        asked.enumerate().filter(|(n, _)| query.visible[*n]).map(|(_, light)| light).collect();
    // A sum over all visible lights, also over those behind the surface.
    let unclamped = |least: f64| {
        let of = |light: &usize| radiance(*light) * kd * diffuse(*light).max(least) + of_ks(*light);
        ambient + visible.iter().map(of).sum::<DVec3>()
    };
    let n_lights = query.lights.len().max(1) as f64;
    let of_lights = |lights: &[usize], text: &'static str| gives(lights).map(|gives| (gives, text));
    let mut mistakes = vec![(same(expected - ambient), "the ambient term A·ka is missing")];
    mistakes.extend(shares.map(|(of, text)| (same(ambient + of_visible(of)), text)));
    let text = "you pass the number of the shadow ray to visible: pass the index of the light";
    mistakes.extend(of_lights(&by_number, text));
    let shining = lights.iter().filter(|&&light| radiance(light) != DVec3::ZERO);
    let by_shining: Vec<usize> =
        shining.enumerate().filter(|(n, _)| query.visible[*n]).map(|(_, &light)| light).collect();
    mistakes.extend(of_lights(&by_shining, text));
    if !occluded.is_empty() {
        mistakes.extend(of_lights(&lights, "you add lights that are occluded: multiply by V_i"));
        mistakes.extend(of_lights(&occluded, "you add the occluded lights and leave out the visible ones"));
    }
    for lights in [&visible, &counted] {
        let (first, last) = (&lights[..lights.len().min(1)], &lights[lights.len().max(1) - 1..]);
        mistakes
            .extend(of_lights(first, "you count one light, the first that is visible: add up all lights"));
        mistakes.extend(of_lights(last, "you count one light, the last that is visible: add up all lights"));
    }
    let or_black = if query.lights.is_empty() { DVec3::ZERO } else { expected };
    mistakes.extend([
        (same(expected.min(DVec3::ONE)), "you clamp the colour to 1: return it without a clamp"),
        (same(ambient + (expected - ambient) * kd), "you multiply the light by kd twice"),
        (same(expected + (n_lights - 1.0) * ambient), "you add the ambient term once per light: add it once"),
        (same(ambient + (expected - ambient) / n_lights), PER_LIGHT),
        (same(expected / n_lights), PER_LIGHT),
        (same(or_black), "without lights you return black: the ambient term remains"),
        (same(expected - ambient + ambient * kd), "the ambient term has kd: it is A·ka"),
        (same(expected - ambient + query.ambient.as_dvec3() * kd), "the ambient term has kd: it is A·ka"),
        (whole(f32::floor) || whole(f32::round) || whole(f32::ceil), WHOLE),
        (same(unclamped(0.0)), LIGHT_BEHIND),
        (same(unclamped(-1.0)), LIGHT_BEHIND),
    ]);
    let source = "the formula in double precision";
    let broken = || Broken::new(query.call("shade"), yours.color, expected.as_vec3(), source);
    unless(gives(&visible).contains(&true), broken).formulas(mistakes)
}

pub(super) fn shade_adds_up_the_lights(trial: &Trial<'_>) -> CheckResult {
    let all_visible =
        shade_query().prop_map(|query| ShadeQuery { visible: vec![true; query.lights.len()], ..query });
    trial.forall(1000, all_visible, |queries| judge_shades(trial, queries))
}

pub(super) fn shade_leaves_out_what_is_hidden(trial: &Trial<'_>) -> CheckResult {
    // Some lights are occluded, and those that are visible count.
    let some_occluded =
        shade_query().prop_filter("an occluded light", |query| query.visible.contains(&false));
    trial.forall(1000, some_occluded, |queries| judge_shades(trial, queries))
}

pub(super) fn shade_traces_at_most_one_ray_per_light(trial: &Trial<'_>) -> CheckResult {
    // Every fourth surface is black.
    let queries = (shade_query(), 0..4i32).prop_map(|(mut query, which)| {
        if which == 3 {
            (query.material.diffuse, query.material.specular) = (Vec3::ZERO, Vec3::ZERO);
        }
        query
    });
    trial.forall(1000, queries, |queries| {
        // The rays that must be traced are those of the student's own `shadow_ray`, which other checks judge.
        let judged = with_own_terms(trial, queries);
        let answers = trial.kit.shade(queries);
        let judge = |(judged, yours): (&WithOwnTerms, ShadeAnswer)| {
            let (query, own) = judged;
            let astray = yours.traced.iter().zip(&yours.rays).find(|(light, ray)| {
                // A student may compute the ray in `shade` again, with other roundings.
                own[**light].1.is_some_and(|own| own != **ray && !is_like(&own, ray))
            });
            if let Some((light, ray)) = astray {
                let (yours, own) = (format!("visible({light}, &{ray:?})"), own[*light].1);
                let expected = format!("the ray {own:?}");
                return Err(Broken::with_texts(query.call("shade"), yours, expected, "shadow_ray")
                    .because("you ask about another ray: pass the ray of shadow_ray to visible"));
            }
            judge_traced(judged, &yours.traced)
        };
        judged.iter().zip(answers).map(judge).collect()
    })
}

/// Whether two rays differ only by roundings of the start. It is measured by the error of the point, which the offset of
/// the start exceeds, so a ray from the point itself is not like one from a start off the surface.
fn is_like(own: &Ray, ray: &Ray) -> bool {
    let step = 1e-6 * own.origin.abs().max_element();
    let near_range = (own.t_max - ray.t_max).abs() <= 0.01 * own.t_max || own.t_max == ray.t_max;
    (own.origin - ray.origin).abs().max_element() <= step && own.direction == ray.direction && near_range
}

fn judge_traced((query, own): &WithOwnTerms, traced: &[usize]) -> CheckResult {
    let count = query.lights.len();
    let has_ray: Vec<bool> = own.iter().map(|(_, ray)| ray.is_some()).collect();
    let right = |light: usize| {
        share(query, light, cosine(query, light, query.surface.shading_normal), specular(&term(query, light)))
    };
    // A light needs a ray if its contribution is above the tolerance of colours, because a cosine to the power of 32 may be 0
    // in single precision.
    let needs =
        |light: &usize| !is_on_edge(query, *light) && right(*light).max_element() > tolerance(DVec3::ZERO);
    let needed: Vec<usize> = (0..count).filter(needs).collect();
    // A light adds nothing if it is behind the surface, or if all products of its radiance with the material are 0. The
    // highlight is also 0 for a negative cosine.
    let behind =
        |light: usize| !has_ray[light] && lowest(&query.surface, query.lights[light].direction) < -1e-5;
    let dark = |light: usize| !has_ray[light] && query.lights[light].radiance == Vec3::ZERO;
    let black = |light: usize| {
        let Material { diffuse, specular, .. } = &query.material;
        let radiance = query.lights[light].radiance;
        let glossy = radiance * *specular != Vec3::ZERO && cos_phi(&term(query, light)) > -1e-5;
        radiance * *diffuse == Vec3::ZERO && !glossy
    };
    let mut sorted = traced.to_vec();
    sorted.sort_unstable();
    let twice = sorted.windows(2).any(|pair| pair[0] == pair[1]);
    let vain = |of: &dyn Fn(usize) -> bool| traced.iter().any(|&light| of(light));
    let is_missed = |light: &&usize| !traced.contains(light);
    let missed = needed.iter().any(|light| is_missed(&light));
    // The student's own `shadow_ray` and specular term may be wrong, which other checks judge.
    let adds = |light: usize| {
        let (specular, ray) = own[light];
        let cosine = cosine(query, light, query.surface.shading_normal);
        let shares = parts(query, light, cosine, specular.into());
        ray.is_some() && shares.iter().sum::<DVec3>().max_element() > tolerance(DVec3::ZERO)
    };
    let is_not_asked = needed.iter().filter(is_missed).all(|&light| adds(light));
    if !(twice || missed || vain(&behind) || vain(&dark) || vain(&black)) {
        return Ok(());
    }
    let describe = |lights: &[usize]| format!("shadow rays to lights {lights:?}");
    Err(Broken::with_texts(query.call("shade"), describe(&sorted), describe(&needed), "counted")
        .explained_by(named![
            twice => "you trace two rays to one light: trace one and keep the answer",
            vain(&dark) => "you trace a ray to a light that is switched off",
            vain(&behind) => "you trace a ray to a light that is behind the surface",
            vain(&black) => "you trace a ray to a light that adds 0 to the surface, for example to a black surface",
            vain(&behind) || vain(&dark) || vain(&black) =>
                "you trace rays to lights that add nothing: behind the surface, switched off, or on a black surface",
            missed && is_not_asked => "a light that adds to the surface gets no shadow ray",
        ]))
}
