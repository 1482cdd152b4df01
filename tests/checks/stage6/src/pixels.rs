//! The positions of a pixel's samples, their weights, and the colour of the pixel.

use checks::prelude::*;
use checks::statistics::{SAMPLES, covers_each_part, pairs};
use glam::{DVec2, Vec2Swizzles, uvec2};
use raykata::random::Stratum;
use raykata::scene::Sampler;
use std::f64::consts::FRAC_2_PI;

/// The largest random number, just below 1.
pub(super) const LARGEST: f32 = 1.0 - f32::EPSILON / 2.0;

/// A multiple of 1/64, which is short to print, or the largest random number.
pub(super) fn unit_number() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![8 => fractions(0..=63, 64.0), 1 => Just(LARGEST)]
}

fn stratum() -> impl Strategy<Value = Stratum> + Clone {
    let grid = (1..=16u32, 1..=16u32);
    let shares = (checks::generate::number(0.0..1.0), checks::generate::number(0.0..1.0));
    (grid, shares, unit_number(), unit_number()).prop_map(|((columns, rows), (x, y), u, v)| Stratum {
        cell: uvec2((x * columns as f32) as u32, (y * rows as f32) as u32).min(uvec2(columns - 1, rows - 1)),
        grid: uvec2(columns, rows),
        u: vec2(u, v),
    })
}

/// A cell for which all known mistakes give different positions.
const DRAWN: Stratum = Stratum { cell: uvec2(2, 1), grid: uvec2(4, 3), u: vec2(0.25, 0.625) };

pub(super) fn jittered_samples_stay_in_their_cells(trial: &Trial<'_>) -> CheckResult {
    trial.each_and(&[DRAWN], 2000, stratum(), <dyn Kit>::jittered, |query, yours| {
        let [cell, grid, u] = [query.cell.as_dvec2(), query.grid.as_dvec2(), query.u.as_dvec2()];
        let expected = (cell + u) / grid;
        // The tolerance covers two roundings of a number below 1.
        let near = |place: DVec2| (yours.as_dvec2() - place).abs().max_element() < 2e-7;
        // A mistake may be kept below 1 like the right place.
        let is = |place: DVec2| near(place) || near(place.min(DVec2::ONE));
        let side = (grid.x * grid.y).sqrt();
        let square =
            "your grid has as many columns as rows: divide x by the columns of the grid and y by its rows";
        let rounded =
            "you return 1, which is in the next pixel (3 + 0.99999994 is rounded to 4): stay below 1";
        let broken = || {
            Broken::new(call("jittered", &[query]), yours, expected.as_vec2(), "(cell + u) / grid, below 1")
                .explained_by([(near(expected), rounded)])
        };
        unless(near(expected) && yours.max_element() < 1.0, broken).formulas([
            (near(u), "you return u: add the cell and divide by the grid"),
            (is((cell + u) / side) || is((cell + u) / side.ceil()) || is((cell + u) / side.round()), square),
            (is((cell + u * u) / grid), "you square the random numbers: use them as they are"),
            "you use the middle half of each cell: samples reach its borders"
                .when(is((cell + 0.25 + 0.5 * u) / grid)),
            (near(u / grid), "you leave out the cell: all samples are in the first cell"),
            (near((cell + 0.5) / grid), "you do not use u: the sample is not jittered"),
            (near(cell / grid), "you do not use u: the sample is not jittered"),
            "u is not divided by grid: it is the position in the cell"
                .when(near((cell / grid + u).min(DVec2::ONE))),
            (is((cell + u) / grid.yx()), "divide x by the columns of the grid and y by its rows"),
            (is((cell + u) / grid.x), "divide x by the columns of the grid and y by its rows"),
            (is((cell + u) / grid.y), "divide x by the columns of the grid and y by its rows"),
            (near((cell + u.xx()) / grid), "you use one random number for both axes: use u.x and u.y"),
            (near((cell + u.yy()) / grid), "you use one random number for both axes: use u.x and u.y"),
            (near(((cell.yx() + u) / grid).min(DVec2::ONE)), "you exchange column and row of the cell"),
        ])
    })
}

pub(super) fn each_sampler_has_its_places(trial: &Trial<'_>) -> CheckResult {
    let samplers = prop::sample::select(ALL.to_vec());
    trial.forall_and(&ALL.map(|sampler| (sampler, DRAWN)), 2000, (samplers, stratum()), |queries| {
        // Positions are judged by the student's own `jittered` as well, because another check judges that.
        let strata: Vec<Stratum> = queries.iter().map(|(_, stratum)| *stratum).collect();
        let own = trial.kit.jittered(&strata);
        let answers = trial.kit.pixel_position(queries);
        let judge = |((query, own), yours)| judge_position(query, own, yours);
        proven(queries.iter().zip(own).zip(answers).map(judge))
    })
}

use Sampler::{Center, Gaussian, Jittered, LowDiscrepancy, Random};

const ALL: [Sampler; 5] = [Center, Random, LowDiscrepancy, Jittered, Gaussian];

fn judge_position((sampler, stratum): &(Sampler, Stratum), own: Vec2, yours: Vec2) -> Judged {
    let (u, radius) = (stratum.u.as_dvec2(), f64::from(FILTER_RADIUS));
    let jittered = (stratum.cell.as_dvec2() + u) / stratum.grid.as_dvec2();
    let position = |jittered: DVec2| match sampler {
        Sampler::Center => DVec2::splat(0.5),
        Sampler::Random | Sampler::LowDiscrepancy => u,
        Sampler::Jittered => jittered,
        Sampler::Gaussian => 0.5 + radius * (2.0 * jittered - 1.0),
    };
    let expected = position(jittered);
    // The tolerance covers a few roundings of numbers up to 3.
    let near = |place: DVec2| (yours.as_dvec2() - place).abs().max_element() < 1e-6;
    let right = near(expected) || near(position(own.as_dvec2()));
    let input = || format!("pixel_position(Sampler::{sampler:?}, {})", stratum.paste());
    // A mistake of these samplers gives the right answers of the others.
    let of = |sets: &[&[Sampler]], gives: bool, text: &'static str| {
        let given = sets.iter().map(|set| (if set.contains(sampler) { gives } else { right }, text));
        given.collect::<Vec<_>>()
    };
    let formulas = [
        of(
            &[&[Center], &[Random], &[Jittered], &[Gaussian], &[LowDiscrepancy], &[Center, Gaussian], &ALL],
            near(expected - 0.5),
            "your position is relative to the centre of the pixel: add 0.5",
        ),
        of(
            &[&[Gaussian]],
            near(jittered),
            "you cover only the pixel: cover FILTER_RADIUS from the centre on all sides",
        ),
        of(
            &[&[Gaussian]],
            near(0.5 + radius * (jittered - 0.5)),
            "half as wide: the square is 2 * FILTER_RADIUS wide",
        ),
        of(
            &[&[Gaussian]],
            near(0.5 + radius * jittered),
            "you cover only the right and lower part: cover FILTER_RADIUS on all sides",
        ),
        of(
            &[&[Gaussian]],
            near(0.5 + radius * (2.0 * u - 1.0)),
            "you scale u to the square of the filter: scale the result of jittered",
        ),
        of(
            &[&[Jittered], &[Gaussian], &[Jittered, Gaussian]],
            near(u),
            "you return u: use jittered(stratum)",
        ),
        of(
            &[&[Random], &[LowDiscrepancy], &[Random, LowDiscrepancy]],
            near(jittered),
            "this sampler must return `u` unchanged; your result is jittered",
        ),
        of(&[&ALL], near(DVec2::splat(0.5)), "you return the centre of the pixel for every sampler"),
    ];
    unless(right, || Broken::new(input(), yours, expected.as_vec2(), "the definition"))
        .formulas(formulas.into_iter().flatten())
}

/// The filter's weight along one axis, in double precision.
fn bell(x: f64) -> f64 {
    let radius = f64::from(FILTER_RADIUS);
    ((-2.0 * x * x).exp() - (-2.0 * radius * radius).exp()).max(0.0)
}

pub(super) fn gaussian_weight_is_a_bell_that_ends(trial: &Trial<'_>) -> CheckResult {
    // Offsets on a grid, on the border of the filter and one float to either side, and far away.
    let coordinate = prop_oneof![
        6 => fractions(-16..=16, 8.0),
        1 => prop::sample::select(vec![
            FILTER_RADIUS,
            FILTER_RADIUS.next_up(),
            FILTER_RADIUS.next_down(),
            -FILTER_RADIUS.next_down(),
            -0.0,
            -30.0,
        ]),
    ];
    let offsets = (coordinate.clone(), coordinate).prop_map(|(x, y)| vec2(x, y));
    trial.each(1000, offsets, <dyn Kit>::gaussian_weight, |offset, yours| judge_weight(*offset, yours))
}

const STEP_AT_R: &str = "your weight ends in a step at R: subtract e^(-2R²) along each axis";
const NORMALIZED: &str = "you normalize the weight: leave it, because filter_pixel divides by the sum";

fn judge_weight(offset: Vec2, yours: f32) -> Judged {
    let (x, y) = (f64::from(offset.x), f64::from(offset.y));
    let expected = bell(x) * bell(y);
    // The tolerance covers the rounding of two powers: a few units in the last place of 1.
    let near = |weight: f64| (f64::from(yours) - weight).abs() < 1e-6;
    let outside = offset.abs().max_element() >= FILTER_RADIUS;
    let radius = f64::from(FILTER_RADIUS);
    let with = |power: fn(f64) -> f64| {
        let factor = |x: f64| (power(x).exp() - power(radius).exp()).max(0.0);
        factor(x) * factor(y)
    };
    // A wide bell that ends by the right subtraction, which does not make it 0 at R.
    let wide = |x: f64| ((-x * x).exp() - (-2.0 * radius * radius).exp()).max(0.0);
    // The weight of a bell that does not end.
    let infinite = (-2.0 * (x * x + y * y)).exp();
    // The difference of the two powers without a clamp.
    let raw = |x: f64| (-2.0 * x * x).exp() - (-2.0 * radius * radius).exp();
    unless(near(expected) && yours >= 0.0 && !(outside && yours != 0.0), || {
        Broken::new(call("gaussian_weight", &[&offset]), yours, expected, "double precision")
    })
    .formulas([
        (near(infinite), STEP_AT_R),
        (near(if outside { 0.0 } else { infinite }), STEP_AT_R),
        (near(bell(x.hypot(y))), "your filter is round: multiply a weight along x by a weight along y"),
        (near(with(|x| -3.0 * x * x)), "your bell is too narrow: it is e^(-2x²), not e^(-3x²)"),
        "your filter is a tent: it is a bell, e^(-2x²)"
            .when(near((1.0 - x.abs() / radius).max(0.0) * (1.0 - y.abs() / radius).max(0.0))),
        (near(with(|x| -x * x)), "your bell is too wide: it is e^(-2x²), not e^(-x²)"),
        (near(wide(x) * wide(y)), "your bell is too wide: it is e^(-2x²), not e^(-x²)"),
        (near(with(|x| -2.0 * x.abs())), "you do not square x: e^(-2x²)"),
        (near(bell(x) + bell(y)), "you add the two weights: multiply them"),
        (near(bell(x)), "you do not use y: multiply the weight along x by that along y"),
        (near(bell(y)), "you do not use x: multiply the weight along x by that along y"),
        // The area of e^(-2x²) is √(π / 2), along one axis; students divide by it once or twice.
        (near(expected * FRAC_2_PI), NORMALIZED),
        (near(expected * FRAC_2_PI.sqrt()), NORMALIZED),
        "two negative factors give a positive weight: each is 0 beyond FILTER_RADIUS"
            .when(near((raw(x) * raw(y)).max(0.0))),
        (near(raw(x) * raw(y)), "your weight is negative: each factor is 0 beyond FILTER_RADIUS"),
    ])
}

fn paste_samples(samples: &[WeightedColor]) -> String {
    format!("filter_pixel(&{})", list(samples))
}

pub(super) fn filter_pixel_is_the_weighted_mean(trial: &Trial<'_>) -> CheckResult {
    let share = || fractions(0..=16, 8.0);
    let color = (share(), share(), share()).prop_map(|(r, g, b)| vec3(r, g, b));
    let sample = (color, share()).prop_map(|(color, weight)| WeightedColor { color, weight });
    let samples = prop::collection::vec(sample, 1..8);
    // Another check asks for weights that sum to 0.
    let samples =
        samples.prop_filter("a weight above 0", |samples| samples.iter().any(|one| one.weight > 0.0));
    trial.each(1000, samples, <dyn Kit>::filter_pixel, |samples, yours| judge_pixel(samples, yours))
}

fn judge_pixel(samples: &[WeightedColor], yours: Vec3) -> Judged {
    let weight: f64 = samples.iter().map(|sample| f64::from(sample.weight)).sum();
    let sum: DVec3 = samples.iter().map(|sample| f64::from(sample.weight) * sample.color.as_dvec3()).sum();
    let expected = sum / weight;
    // The tolerance covers eight additions and a division, relative to the largest sum. Weights may be tiny or huge.
    let near = |v: DVec3| (yours.as_dvec3() - v).abs().max_element() <= 1e-5 * v.abs().max_element().max(1.0);
    let n = samples.len() as f64;
    let plain = samples.iter().map(|sample| sample.color.as_dvec3()).sum::<DVec3>();
    unless(near(expected), || {
        Broken::new(paste_samples(samples), yours, expected.as_vec3(), "double precision")
    })
    .formulas([
        (near(plain / n), "you do not use the weights"),
        (near(sum / n), "you divide by the number of samples: divide by the sum of their weights"),
        (near(sum / weight.max(1.0)), "you divide by 1 if the weights sum to less: divide by their sum"),
        (near(sum), "you return the sum: divide it by the sum of the weights"),
        (near(plain / weight), "you do not weight the colours: multiply each colour by its weight"),
        (near(expected.min(DVec3::ONE)), "you clamp the colour to 1: return it without a clamp"),
    ])
}

pub(super) fn filter_pixel_of_no_samples_is_black(trial: &Trial<'_>) -> CheckResult {
    let sample = |color: Vec3, weight: f32| WeightedColor { color, weight };
    let color = trial.varied(vec3(0.5, 0.25, 2.0), rough_point(2.0).prop_map(Vec3::abs));
    // The last two are not black: their weights sum to little, or to 1.
    let queries =
        [vec![], vec![sample(Vec3::ONE, 0.0); 3], vec![sample(color, 1e-6)], vec![sample(Vec3::ONE, 0.5); 2]];
    let judge = |(samples, yours): (&Vec<WeightedColor>, Vec3)| {
        let weight: f32 = samples.iter().map(|sample| sample.weight).sum();
        if weight > 0.0 {
            return judge_pixel(samples, yours);
        }
        let broken = || {
            Broken::new(paste_samples(samples), yours, Vec3::ZERO, "the definition")
                .explained_by([(yours.is_nan(), "you divide 0 by 0: the weights sum to 0 here")])
        };
        unless(yours == Vec3::ZERO, broken).formulas([])
    };
    all_hold(proven(queries.iter().zip(trial.kit.filter_pixel(&queries)).map(judge)))
}

pub(super) fn jittered_samples_cover_the_pixel_evenly(trial: &Trial<'_>) -> CheckResult {
    // Use sixteen cells in turn, each with its own random numbers.
    let strata: Vec<Stratum> = pairs(trial.seed, SAMPLES)
        .into_iter()
        .enumerate()
        .map(|(index, u)| {
            let cell = index as u32 % 16;
            Stratum { cell: uvec2(cell % 4, cell / 4), grid: uvec2(4, 4), u }
        })
        .collect();
    let in_cell = |place: &Vec2| (4.0 * place.as_dvec2() - strata[6].cell.as_dvec2()).into();
    let places = |u: &[Vec2]| {
        let strata: Vec<Stratum> = u.iter().map(|u| Stratum { u: *u, ..strata[6] }).collect();
        Ok(trial.kit.jittered(&strata).iter().map(in_cell).collect())
    };
    let what = "jittered in the cell (2, 1) of 4 × 4";
    covers_each_part(what, ["x in its cell", "y in its cell"], trial.seed, None, places, |_| Vec::new())?;
    // Each sample must lie in its own cell, whatever the random numbers. Two roundings of a number below 1 may move it
    // onto the border with the next cell.
    for (stratum, place) in strata.iter().zip(trial.kit.jittered(&strata)) {
        let (place, corner) = (4.0 * place.as_dvec2(), stratum.cell.as_dvec2());
        let slack = 4.0 * 2e-7;
        if place.cmplt(corner - slack).any() || place.cmpgt(corner + 1.0 + slack).any() {
            let cell = place.as_uvec2();
            let input = call("jittered", &[stratum]);
            return Err(Broken::new(input, cell, stratum.cell, "the cell of the stratum"));
        }
    }
    Ok(())
}
