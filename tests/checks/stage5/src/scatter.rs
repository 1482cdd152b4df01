//! Which secondary rays leave a surface, and their weights.

use super::directions::{arrival, snell};
use super::fresnel::{exact, schlick};
use checks::prelude::*;
use raykata::material::{Fresnel, Material};

/// Limits that end no ray of these checks.
pub(super) const FAR: Limits = Limits { max_depth: 100, min_contribution: 0.0 };

/// A ray of weight 1 that enters a surface of this material at an angle, with limits that do not end it.
pub(super) fn arriving(material: Material) -> ScatterQuery {
    ScatterQuery {
        direction: vec3(0.6, -0.8, 0.0),
        normal: Vec3::Y,
        entering: true,
        material,
        weight: Vec3::ONE,
        depth: 0,
        limits: FAR,
    }
}

/// A material without colour.
pub(super) fn grey(mirror: f32, transmission: f32) -> Material {
    let [mirror, transmission] = [mirror, transmission].map(Vec3::splat);
    Material { mirror, transmission, ..Material::default() }
}

pub(super) fn paste(query: &ScatterQuery) -> String {
    let ScatterQuery { entering, depth, material: Material { mirror, transmission, .. }, .. } = query;
    format!("scatter, entering: {entering}, depth {depth}, mirror {mirror}, transmission {transmission}")
}

fn describe(children: &[SecondaryRay]) -> String {
    let one = |child: &SecondaryRay| format!("{:?} of weight {}", child.bounce, child.weight);
    match children {
        [] => "no rays".into(),
        some => some.iter().map(one).collect::<Vec<_>>().join(", "),
    }
}

pub(super) fn find(children: &[SecondaryRay], bounce: Bounce) -> Option<&SecondaryRay> {
    children.iter().find(|child| child.bounce == bounce)
}

/// `(n1, n2)`: the index on the side of the ray, and the index behind the surface.
fn indices(query: &ScatterQuery) -> (f32, f32) {
    let index = query.material.index_of_refraction;
    if query.entering { (1.0, index) } else { (index, 1.0) }
}

fn fresnel_query(query: &ScatterQuery) -> FresnelQuery {
    let (n1, n2) = indices(query);
    let cos_theta = (-query.direction.dot(query.normal)).clamp(0.0, 1.0);
    FresnelQuery { cos_theta, n1, n2 }
}

pub(super) fn refract_query(query: &ScatterQuery) -> RefractQuery {
    let (n1, n2) = indices(query);
    RefractQuery { direction: query.direction, normal: query.normal, n1, n2 }
}

/// The Fresnel reflectance that the material asks for: 0, or one of these two.
fn reflectance(query: &ScatterQuery, schlick: f64, exact: f64) -> f64 {
    match query.material.fresnel {
        Fresnel::None => 0.0,
        Fresnel::Schlick => schlick,
        Fresnel::Exact => exact,
    }
}

/// What the student's own functions return for a query. A secondary ray is judged by these as well as by the right answers,
/// because other checks judge these functions.
#[derive(Clone, Copy)]
struct Own {
    reflectance: f64,
    refracted: Option<Vec3>,
    reflected: Vec3,
}

fn own_functions(trial: &Trial<'_>, queries: &[ScatterQuery]) -> Vec<Own> {
    let fresnel: Vec<FresnelQuery> = queries.iter().map(fresnel_query).collect();
    let refractions: Vec<RefractQuery> = queries.iter().map(refract_query).collect();
    let reflections: Vec<(Vec3, Vec3)> =
        queries.iter().map(|query| (query.direction, query.normal)).collect();
    let (schlick, exact) = (trial.kit.fresnel_schlick(&fresnel), trial.kit.fresnel_exact(&fresnel));
    let (refracted, reflected) = (trial.kit.refract(&refractions), trial.kit.reflect(&reflections));
    let own = |index: usize| Own {
        reflectance: reflectance(&queries[index], schlick[index].into(), exact[index].into()),
        refracted: refracted[index],
        reflected: reflected[index],
    };
    (0..queries.len()).map(own).collect()
}

pub(super) fn queries() -> impl Strategy<Value = ScatterQuery> + Clone {
    let fresnel = prop::sample::select(vec![Fresnel::None, Fresnel::Schlick, Fresnel::Exact]);
    (arrival(), any::<bool>(), point(1), point(1), fractions(4..=16, 8.0), fresnel, point(1)).prop_map(
        |((direction, normal), entering, mirror, transmission, index_of_refraction, fresnel, weight)| {
            let [mirror, transmission, weight] = [mirror, transmission, weight].map(Vec3::abs);
            let material =
                Material { mirror, transmission, index_of_refraction, fresnel, ..Material::default() };
            ScatterQuery { direction, normal, entering, weight, ..arriving(material) }
        },
    )
}

pub(super) fn scatter_weighs_rays_by_the_material(trial: &Trial<'_>) -> CheckResult {
    // Another check judges total internal reflection and angles close to it.
    let below =
        queries().prop_filter("below the critical angle", |query| snell(&refract_query(query)).1 > 1e-3);
    trial.forall_and(&drawn(), 1000, below, |queries| judge_with_own(trial, queries, judge_weights))
}

/// Judges rays together with the answers of the student's own functions.
fn judge_with_own(
    trial: &Trial<'_>,
    queries: &[ScatterQuery],
    judge: fn(&ScatterQuery, Own, Vec<SecondaryRay>) -> Judged,
) -> Vec<CheckResult> {
    let own = own_functions(trial, queries);
    let answers = trial.kit.scatter(queries);
    proven(queries.iter().zip(own).zip(answers).map(|((query, own), yours)| judge(query, own, yours)))
}

/// A surface that reflects and transmits; glass that reflects by Fresnel alone; and one channel per secondary ray.
pub(super) fn drawn() -> [ScatterQuery; 3] {
    let query = |mirror: Vec3, transmission: Vec3, fresnel: Fresnel| ScatterQuery {
        direction: vec3(0.96, -0.28, 0.0),
        weight: vec3(0.5, 0.75, 0.25),
        ..arriving(Material {
            mirror,
            transmission,
            index_of_refraction: 1.5,
            fresnel,
            ..Material::default()
        })
    };
    [
        query(vec3(0.25, 0.375, 0.5), vec3(0.5, 0.25, 0.125), Fresnel::Exact),
        query(Vec3::ZERO, Vec3::ONE, Fresnel::Exact),
        query(0.5 * Vec3::X, 0.5 * Vec3::Y, Fresnel::None),
    ]
}

const WEIGHT_TWICE: &str = "you multiply by the weight of the incoming ray twice";

fn judge_weights(query: &ScatterQuery, own: Own, yours: Vec<SecondaryRay>) -> Judged {
    let [weight, mirror, transmission] =
        [query.weight, query.material.mirror, query.material.transmission].map(Vec3::as_dvec3);
    let weights = |f: f64| [weight * (mirror + f * transmission), weight * (1.0 - f) * transmission];
    let asked = fresnel_query(query);
    let (by_schlick, by_exact) = (schlick(&asked), exact(&asked));
    let share = reflectance(query, by_schlick, by_exact);
    let expected = weights(share);
    let found = [Bounce::Reflection, Bounce::Transmission]
        .map(|bounce| find(&yours, bounce).map(|child| child.weight.as_dvec3()));
    let found_or_zero = found.map(Option::unwrap_or_default);
    let same = |other: [DVec3; 2], limit: f64| {
        (0..2).all(|i| (found_or_zero[i] - other[i]).abs().max_element() <= limit)
    };
    // The reflectance is off by 1e-5, and by more close to the critical angle.
    let mine = weights(own.reflectance);
    let lost = own.refracted.is_none() && found[1].is_none();
    let mine_lost = [mine[0], DVec3::ZERO];
    let right = same(expected, 2e-4)
        || same(mine, 2e-4)
        || (lost && (same(mine_lost, 2e-4) || same([expected[0], DVec3::ZERO], 2e-4)));
    // An answer that is right by the student's own functions only says nothing about a formula.
    let is = |other: [DVec3; 2]| same(other, 2e-4) || (right && !same(expected, 2e-4));
    let (reflected, through) = (expected[0], expected[1]);
    // Schlick's approximation always, the exact formula always, and each in place of the other.
    let other_fresnel = match query.material.fresnel {
        Fresnel::None => [0.0; 3],
        Fresnel::Schlick => [share, by_exact, by_exact],
        Fresnel::Exact => [by_schlick, share, by_schlick],
    };
    let of_fresnel = other_fresnel.map(|share| {
        (is(weights(share)), "you use the other Fresnel formula: Schlick for Schlick, Exact for Exact")
    });
    let turned = FresnelQuery { n1: asked.n2, n2: asked.n1, ..asked };
    let exchanged = reflectance(query, schlick(&turned), exact(&turned));
    // The rays of which no channel is 0.
    let coloured = expected.map(|weight| if weight.min_element() <= 0.0 { DVec3::ZERO } else { weight });
    let broken = || {
        let [first, second] = expected.map(|weight| weight.as_vec3());
        let expected = format!("Reflection of weight {first}, Transmission of weight {second}");
        let text = "you leave out a ray with one channel of 0: test the largest channel";
        Broken::with_texts(paste(query), describe(&yours), expected, "the formula in double precision")
            .explained_by([(is(coloured), text)])
    };
    let rest = named![
        is([mirror + share * transmission, (1.0 - share) * transmission]) =>
            "you leave out the weight of the incoming ray: multiply by `weight`",
        is([weight * reflected, weight * through]) => WEIGHT_TWICE,
        is([weight * reflected, through]) => WEIGHT_TWICE,
        is([reflected, weight * through]) => WEIGHT_TWICE,
        is([if mirror == DVec3::ZERO { mirror } else { reflected }, through]) =>
            "clear glass reflects by Fresnel: test the reflected weight, not material.mirror",
        is([weight * (transmission + share * mirror), weight * (1.0 - share) * mirror]) =>
            "you exchange material.mirror and material.transmission",
        is([weight * mirror, weight * transmission]) => "you leave out material.fresnel",
        is([reflected, weight * transmission]) =>
            "you add F transmission to the reflected ray, but do not take it off the refracted one: (1 - F) transmission",
        is([weight * mirror, through]) => "you take F off the refracted ray, but do not add F transmission to the reflected one",
        is([weight * share * mirror, through]) => "you multiply the mirror by F: the reflected ray has mirror + F transmission",
        is([weight * share * (mirror + transmission), through]) =>
            "you multiply the mirror by F: the reflected ray has mirror + F transmission",
        is([weight * (mirror + (1.0 - share) * transmission), weight * share * transmission]) => "you exchange F and 1 - F",
        is(weights(exchanged)) => "you exchange n1 and n2 in the Fresnel reflectance",
    ];
    unless(right, broken).formulas(rest.into_iter().chain(of_fresnel))
}

/// On the way out of glass the indices change places, and both rays have the directions of `reflect` and `refract`.
pub(super) fn scatter_swaps_indices_when_leaving_glass(trial: &Trial<'_>) -> CheckResult {
    let both = |query: ScatterQuery| ScatterQuery {
        material: Material {
            mirror: Vec3::ONE,
            transmission: Vec3::ONE,
            fresnel: Fresnel::None,
            ..query.material
        },
        weight: Vec3::ONE,
        ..query
    };
    // Rays that are refracted even if the indices are exchanged, so that a mistake shows as another direction.
    let inputs = queries().prop_map(both).prop_filter("clear of both critical angles", |query| {
        let (n1, n2) = indices(query);
        let sine = query.direction.cross(query.normal).length();
        sine * (n1 / n2).max(n2 / n1) < 0.99 && sine > 0.05 && (n1 - n2).abs() > 0.1
    });
    let slanted = both(drawn()[0].clone());
    let chosen = [true, false].map(|entering| {
        let direction = vec3(0.6, -0.8, 0.0);
        ScatterQuery { direction, entering, ..slanted.clone() }
    });
    trial.forall_and(&chosen, 300, inputs, |queries| judge_with_own(trial, queries, judge_directions))
}

const TURNED: &str = "you turn the normal: it is already on the side that the ray comes from";

fn judge_directions(query: &ScatterQuery, own: Own, yours: Vec<SecondaryRay>) -> Judged {
    let forward = refract_query(query);
    let right = |query: &RefractQuery| snell(query).0.map(|v| v.as_vec3());
    // The tolerance covers a few roundings.
    let near = |found: Option<Vec3>, v: Option<Vec3>| {
        matches!((found, v), (Some(found), Some(v)) if (found - v).length() < 1e-5)
            || (found.is_none() && v.is_none())
    };
    let found = |bounce: Bounce| find(&yours, bounce).map(|child| child.direction);
    let refracted = found(Bounce::Transmission);
    let refracts = near(refracted, right(&forward)) || near(refracted, own.refracted);
    let of_refracted = {
        let backward = RefractQuery { n1: forward.n2, n2: forward.n1, ..forward };
        let turned = RefractQuery { normal: -forward.normal, ..forward };
        let expected = right(&forward);
        let broken = || Broken::new(paste(query), refracted, expected, "Snell's law in double precision");
        let is = |v: Option<Vec3>| refracted.is_some() && near(refracted, v);
        unless(refracts, broken).formulas([
            "entering: n1 = 1 (air), n2 = index_of_refraction (glass); you exchange them"
                .when(if query.entering { is(right(&backward)) } else { refracts }),
            "leaving: n1 = index_of_refraction (glass), n2 = 1 (air); you exchange them"
                .when(if query.entering { refracts } else { is(right(&backward)) }),
            (is(right(&backward)), "you exchange n1 and n2, on the way in and on the way out"),
            (is(right(&turned)), TURNED),
            (if query.entering { refracts } else { is(right(&turned)) }, TURNED),
            (is(Some(query.direction)), "you do not refract the ray: its direction is that of refract"),
        ])?
    };
    let (reflected, (d, n)) =
        (found(Bounce::Reflection), (query.direction.as_dvec3(), query.normal.as_dvec3()));
    let expected = (d - 2.0 * d.dot(n) * n).as_vec3();
    if near(reflected, Some(expected)) || near(reflected, Some(own.reflected)) {
        return Ok(of_refracted);
    }
    let is = |v: Vec3| near(reflected, Some(v));
    Err(Broken::new(paste(query), reflected, Some(expected), "the direction of reflect").explained_by([
        (is(query.direction), "your reflected ray goes straight on: its direction is that of reflect"),
        (is(-query.direction), "your reflected ray goes straight back: its direction is that of reflect"),
        (is(query.normal), "your reflected ray goes along the normal: its direction is that of reflect"),
    ]))
}

pub(super) fn scatter_refracts_nothing_in_total_reflection(trial: &Trial<'_>) -> CheckResult {
    // 60° inside glass. No ray is refracted, and 0 · NaN makes no NaN.
    let chosen = [Fresnel::None, Fresnel::Schlick, Fresnel::Exact].map(|fresnel| ScatterQuery {
        direction: vec3(0.866_025_4, -0.5, 0.0),
        entering: false,
        ..arriving(Material { index_of_refraction: 1.5, fresnel, ..grey(0.25, 0.75) })
    });
    let beyond =
        queries().prop_filter("beyond the critical angle", |query| snell(&refract_query(query)).1 < -1e-3);
    trial.forall_and(&chosen, 150, beyond, |queries| judge_with_own(trial, queries, judge_total_reflection))
}

fn judge_total_reflection(query: &ScatterQuery, own: Own, yours: Vec<SecondaryRay>) -> Judged {
    let [weight, mirror, transmission] = [query.weight, query.material.mirror, query.material.transmission];
    let share = if query.material.fresnel == Fresnel::None { 0.0 } else { 1.0 };
    let expected = weight * (mirror + share * transmission);
    let reflected = find(&yours, Bounce::Reflection).map_or(Vec3::ZERO, |child| child.weight);
    // Another check judges a ray that the student's own `refract` returns here, and the reflectance of the student's own
    // functions, which may be NaN.
    let refracted = find(&yours, Bounce::Transmission).filter(|_| own.refracted.is_none());
    let is_own = own.refracted.is_some() || !own.reflectance.is_finite();
    // The direction of refraction with exchanged indices, which is never beyond the critical angle.
    let asked = refract_query(query);
    let exchanged = snell(&RefractQuery { n1: asked.n2, n2: asked.n1, ..asked }).0;
    let is_exchanged = |ray: &SecondaryRay| {
        exchanged.is_some_and(|direction| (ray.direction.as_dvec3() - direction).length() < 1e-3)
    };
    let sound = is_own || yours.iter().all(|child| child.weight.is_finite() && child.direction.is_finite());
    let is = |v: Vec3| (reflected - v).abs().max_element() <= 1e-5;
    let own_share = weight * (mirror + own.reflectance as f32 * transmission);
    let text = format!("Reflection of weight {expected}, and no Transmission");
    let right = refracted.is_none() && sound && (is(expected) || is(own_share) || own_share.is_nan());
    let broken = || {
        Broken::with_texts(paste(query), describe(&yours), text, "total internal reflection").explained_by([
            "beyond the critical angle there is no refracted ray: add it only if refract returns Some"
                .when(refracted.is_some_and(|ray| !is_exchanged(ray))),
            "leaving: n1 = index_of_refraction (glass), n2 = 1 (air); you exchange them"
                .when(refracted.is_some_and(is_exchanged)),
            (!sound, "a weight or direction is NaN: beyond the critical angle the Fresnel reflectance is 1"),
        ])
    };
    unless(right, broken).formulas([
            "beyond the critical angle the Fresnel reflectance is 1: the reflected ray gets mirror + transmission"
                .when(is(weight * mirror)),
            "without Fresnel the reflected weight is weight · mirror, also beyond the critical angle"
                .when(is(weight * (mirror + transmission))),
        ])
}

pub(super) fn scatter_skips_rays_without_weight(trial: &Trial<'_>) -> CheckResult {
    // A secondary ray of weight 0 costs a whole tree of rays that add nothing. Every fourth surface does reflect.
    let dull = (queries(), 0..4i32).prop_map(|(query, which)| match which {
        0 => ScatterQuery { material: Material::default(), ..query },
        1 => ScatterQuery { weight: Vec3::ZERO, ..query },
        _ => {
            // A red ray on a blue mirror, where the product is 0, or on a white one.
            let mirror = if which == 2 { Vec3::Z } else { Vec3::ONE };
            let material = Material { mirror, transmission: Vec3::ZERO, ..query.material };
            ScatterQuery { weight: Vec3::X, material, ..query }
        }
    });
    trial.each(1000, dull, <dyn Kit>::scatter, |query, yours| {
            let shines = query.weight * query.material.mirror != Vec3::ZERO;
            if shines && find(&yours, Bounce::Reflection).is_some() || !shines && yours.is_empty() {
                return Ok(());
            }
            let expected = if shines { "a reflected ray" } else { "no rays" };
            let broken = Broken::with_texts(paste(query), describe(&yours), expected, "weight 0 adds nothing");
            let parent = query.weight != Vec3::ZERO;
            let material = query.material.mirror != Vec3::ZERO || query.material.transmission != Vec3::ZERO;
            let adds_nothing = !shines && yours.iter().all(|ray| ray.weight == Vec3::ZERO);
            Err(broken.explained_by([
                "you trace a ray of weight 0 where a ray of one colour meets a mirror of another: test the product"
                    .when(adds_nothing && parent && material),
                (adds_nothing, "you trace a secondary ray of weight 0: test its own weight"),
            ]))
        })
}
