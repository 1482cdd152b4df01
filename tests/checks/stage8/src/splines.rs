//! Checks of `bspline_basis` and `nurbs_point`.

use super::bounding_spheres::reach;
use checks::prelude::*;
use raykata::shape::NurbsPatch;

/// A degree, knots and a parameter of their domain.
#[derive(Clone, Debug)]
struct Spline {
    degree: usize,
    knots: Vec<f32>,
    u: f32,
}

impl Spline {
    /// The number of basis functions.
    fn count(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    fn query(&self, index: usize) -> BasisQuery {
        BasisQuery { knots: self.knots.clone(), degree: self.degree, index, u: self.u }
    }
}

/// Splines of a degree up to `most_degree` with up to `most_groups` different knots. Knots inside repeat up to as many times
/// as the degree. Half of the splines are clamped: both end knots repeat once more. A third of the parameters are knots.
fn spline(most_degree: usize, most_groups: usize) -> impl Strategy<Value = Spline> + Clone {
    let groups = prop::collection::vec((1..=4u8, 1..=most_degree), 2..=most_groups);
    (1..=most_degree, groups, any::<bool>(), nasty::any_scale(), -3..=3i32, 0..64usize, 0..=8u8).prop_map(
        |(degree, groups, clamped, scale, start, span, eighths)| {
            let knots = |clamped: bool| -> Vec<f32> {
                let mut at = start as f32;
                let mut knots = Vec::new();
                for (index, &(step, times)) in groups.iter().enumerate() {
                    let is_end = index == 0 || index + 1 == groups.len();
                    let times = if is_end && clamped { degree + 1 } else { times.min(degree) };
                    knots.extend(std::iter::repeat_n(scale * at, times));
                    at += f32::from(step);
                }
                knots
            };
            // Clamped ends always leave a domain.
            let has_domain = |knots: &[f32]| {
                knots.len() >= 2 * degree + 2 && knots[degree] < knots[knots.len() - degree - 1]
            };
            let knots = Some(knots(clamped)).filter(|knots| has_domain(knots)).unwrap_or_else(|| knots(true));
            let domain = &knots[degree..knots.len() - degree];
            let spans: Vec<&[f32]> = domain.windows(2).filter(|ends| ends[0] < ends[1]).collect();
            let ends = spans[span % spans.len()];
            // The knots are small integers times a power of two, so this is exact.
            let u = ends[0] + f32::from(eighths) / 8.0 * (ends[1] - ends[0]);
            Spline { degree, knots, u }
        },
    )
}

/// The recursion of Cox and de Boor, and wrong ones.
#[derive(Clone, Copy, PartialEq)]
enum Rule {
    Right,
    HalfOpenAtTheEnd,
    ClosedSpans,
    ZeroOverZero,
    FirstTermOnly,
    OneDenominator,
    FactorsExchanged,
    SameFunctionTwice,
    OneDegreeLess,
}

const HALF_OPEN: &str =
    "all your spans are half open: the last span that is not empty contains its right end, too";
const CLOSED: &str = "your spans contain both ends: at a knot inside, two functions of degree 0 are 1";
const NOT_A_NUMBER: &str = "you divide 0 by 0 where knots are equal: leave out a term whose denominator is 0";

/// The wrong recursions with what to say about them.
const WRONG: [(Rule, &str); 8] = named![
    Rule::HalfOpenAtTheEnd => HALF_OPEN,
    Rule::ClosedSpans => CLOSED,
    Rule::ZeroOverZero => NOT_A_NUMBER,
    Rule::FirstTermOnly => "you leave out the second term, with N(i+1, p-1)",
    Rule::OneDenominator => "you divide both terms by k_{i+p} - k_i: the second denominator is k_{i+p+1} - k_{i+1}",
    Rule::FactorsExchanged => "you exchange the two factors: that of N(i, p-1) rises, and that of N(i+1, p-1) falls",
    Rule::SameFunctionTwice => "you use N(i, p-1) in both terms: the second one has N(i+1, p-1)",
    Rule::OneDegreeLess => "you return the function of one degree less",
];

impl Rule {
    /// The value of a basis function in double precision.
    fn basis(self, knots: &[f32], degree: usize, index: usize, u: f64) -> f64 {
        let degree = if self == Rule::OneDegreeLess { degree.saturating_sub(1) } else { degree };
        self.value(&knots.iter().map(|&knot| f64::from(knot)).collect::<Vec<f64>>(), degree, index, u)
    }

    /// The same for a query.
    fn of(self, query: &BasisQuery) -> f64 {
        self.basis(&query.knots, query.degree, query.index, f64::from(query.u))
    }

    /// Whether the recursion gives this value.
    fn gives(self, query: &BasisQuery, yours: f32) -> bool {
        let value = self.of(query);
        same(f64::from(yours), value, room(query.degree, value))
    }

    fn value(self, knots: &[f64], degree: usize, index: usize, u: f64) -> f64 {
        let k = |offset: usize| knots[index + offset];
        if degree == 0 {
            let at_end = u == k(1) && knots.last() == Some(&u) && k(0) < k(1);
            return f64::from(match self {
                Rule::HalfOpenAtTheEnd => k(0) <= u && u < k(1),
                Rule::ClosedSpans => k(0) <= u && u <= k(1) && k(0) < k(1),
                _ => k(0) <= u && u < k(1) || at_end,
            });
        }
        let divide = |over: f64, under: f64| match under {
            0.0 if self != Rule::ZeroOverZero => 0.0,
            under => over / under,
        };
        let (first_width, second_width) = (k(degree) - k(0), k(degree + 1) - k(1));
        let second_width = if self == Rule::OneDenominator { first_width } else { second_width };
        let mut factors = [divide(u - k(0), first_width), divide(k(degree + 1) - u, second_width)];
        if self == Rule::FactorsExchanged {
            factors.reverse();
        }
        let second = match self {
            Rule::FirstTermOnly => 0.0,
            Rule::SameFunctionTwice => self.value(knots, degree - 1, index, u),
            _ => self.value(knots, degree - 1, index + 1, u),
        };
        factors[0] * self.value(knots, degree - 1, index, u) + factors[1] * second
    }
}

/// The largest error of a basis function of this value in single precision. All terms of the recursion are at least 0, so
/// errors are relative: each level takes two differences, a quotient, a product and a sum, and other orders of evaluation take
/// up to eight roundings. The constant allows for underflow.
fn room(degree: usize, value: f64) -> f64 {
    (8 * degree + 4) as f64 * U * value.abs() + 1e-37
}

/// Whether two numbers are the same up to this error; two NaN are.
fn same(yours: f64, other: f64, room: f64) -> bool {
    (yours - other).abs() <= room || yours.is_nan() && other.is_nan()
}

pub(super) fn bspline_basis_follows_the_recursion(trial: &Trial<'_>) -> CheckResult {
    let inputs = (spline(4, 5), 0..64usize).prop_map(|(spline, index)| spline.query(index % spline.count()));
    // An empty span at the end.
    let empty = BasisQuery { knots: vec![0.0, 0.0, 1.0, 1.0], degree: 0, index: 2, u: 1.0 };
    trial.each_and(&[empty], 1000, inputs, <dyn Kit>::bspline_basis, |query, yours| {
        let broken = || {
            let (knots, degree, index, u) = (list(&query.knots), query.degree, query.index, query.u.paste());
            let input = format!("bspline_basis(&{knots}, {degree}, {index}, {u})");
            Broken::new(input, yours, Rule::Right.of(query) as f32, "the recursion in double")
        };
        unless(Rule::Right.gives(query, yours), broken)
            .formulas(WRONG.map(|(rule, text)| (rule.gives(query, yours), text)))
    })
}

pub(super) fn bspline_basis_sums_to_one(trial: &Trial<'_>) -> CheckResult {
    trial.forall(400, spline(4, 5), |splines| {
        let of_spline =
            |spline: &Spline| (0..spline.count()).map(|index| spline.query(index)).collect::<Vec<_>>();
        let queries: Vec<Vec<BasisQuery>> = splines.iter().map(of_spline).collect();
        let mut answers = trial.kit.bspline_basis(&queries.concat()).into_iter();
        let judge = |(spline, queries): (&Spline, &Vec<BasisQuery>)| {
            let values: Vec<f32> = answers.by_ref().take(queries.len()).collect();
            let sum: f64 = values.iter().map(|&value| f64::from(value)).sum();
            let is_sum = (sum - 1.0).abs() <= room(spline.degree, 1.0);
            let gives =
                |rule: Rule| queries.iter().zip(&values).all(|(query, value)| rule.gives(query, *value));
            let broken = || {
                let (n, degree, knots) = (spline.count(), spline.degree, list(&spline.knots));
                let u = spline.u.paste();
                let input = format!("(0..{n}).map(|i| bspline_basis(&{knots}, {degree}, i, {u}))");
                let expected = "values of at least 0 with the sum 1";
                Broken::with_texts(input, format!("{values:?}, sum {sum}"), expected, "partition of unity")
            };
            let right = is_sum && values.iter().all(|value| *value >= 0.0);
            unless(right, broken).formulas(WRONG.map(|(rule, text)| (gives(rule), text)))
        };
        proven(splines.iter().zip(&queries).map(judge))
    })
}

/// Surfaces with random nets. Half of them have equal weights.
fn surface() -> impl Strategy<Value = NurbsQuery> + Clone {
    let weight = prop::sample::select(vec![0.25, 0.5, std::f32::consts::FRAC_1_SQRT_2, 1.0, 2.0, 3.0]);
    let points = prop::collection::vec((point(4), weight), 64);
    (spline(3, 3), spline(3, 3), points, nasty::any_scale(), any::<bool>()).prop_map(
        |(across, along, points, scale, weighted)| {
            let (n_columns, n_rows) = (across.count(), along.count());
            let entry = |row: usize, column: usize| points[(row * n_columns + column) % points.len()];
            let net = |row: usize| (0..n_columns).map(|column| scale * entry(row, column).0).collect();
            let weights = |row| {
                (0..n_columns).map(|column| if weighted { entry(row, column).1 } else { 1.0 }).collect()
            };
            let patch = NurbsPatch {
                degrees: [across.degree, along.degree],
                knots: [across.knots, along.knots],
                rows: (0..n_rows).map(net).collect(),
                weights: (0..n_rows).map(weights).collect(),
            };
            NurbsQuery { patch, uv: vec2(across.u, along.u) }
        },
    )
}

fn describe(query: &NurbsQuery) -> String {
    format!("nurbs_point of a patch of degrees {:?} at {}", query.patch.degrees, query.uv.paste())
}

/// How the weights are used.
#[derive(Clone, Copy, PartialEq)]
enum Mean {
    Right,
    WithoutWeights,
    NotDivided,
    DividedByTheNumber,
    WeightsBelowOnly,
    ParametersExchanged,
    OneParameterTwice,
    OneDegree(usize),
    OneListOfKnots(usize),
    WeightsOfFirstRow,
}

const WRONG_MEANS: [(Mean, &str); 11] = named![
    Mean::WithoutWeights => "you leave out the weights",
    Mean::NotDivided =>
        "you do not divide by the sum of the factors: with weights it is not 1, although the basis functions add up to 1",
    Mean::DividedByTheNumber => "you divide by the sum of all weights: weight each by its basis functions, too",
    Mean::WeightsBelowOnly => "you use the weights in the denominator only: the points have the same factors",
    Mean::ParametersExchanged => "you exchange u and v: u runs along the rows, v from row to row",
    Mean::OneParameterTwice => "you use u in both directions: v runs from row to row",
    Mean::OneDegree(0) => "you use one degree in both directions: u has degrees[0], and v has degrees[1]",
    Mean::OneDegree(1) => "you use one degree in both directions: u has degrees[0], and v has degrees[1]",
    Mean::OneListOfKnots(0) => "you use the same knots in both directions: u has knots[0], and v has knots[1]",
    Mean::OneListOfKnots(1) => "you use the same knots in both directions: u has knots[0], and v has knots[1]",
    Mean::WeightsOfFirstRow => "you use the weights of the first row for all rows: each point has its own",
];

impl Mean {
    /// The point of the surface in double precision.
    fn point(self, query: &NurbsQuery) -> DVec3 {
        let patch = &query.patch;
        let [u, v] = match self {
            Mean::ParametersExchanged => [query.uv.y, query.uv.x],
            Mean::OneParameterTwice => [query.uv.x, query.uv.x],
            _ => query.uv.to_array(),
        };
        let basis = |axis: usize, index: usize, u: f32| {
            let degree = patch.degrees[if let Mean::OneDegree(axis) = self { axis } else { axis }];
            let knots = &patch.knots[if let Mean::OneListOfKnots(axis) = self { axis } else { axis }];
            // Code that reads beyond the knots panics.
            let is_there = index + degree + 1 < knots.len();
            if is_there { Rule::Right.basis(knots, degree, index, f64::from(u)) } else { f64::INFINITY }
        };
        let across: Vec<f64> = (0..patch.rows[0].len()).map(|i| basis(0, i, u)).collect();
        let along: Vec<f64> = (0..patch.rows.len()).map(|j| basis(1, j, v)).collect();
        let row_of_weights = |j: usize| if self == Mean::WeightsOfFirstRow { 0 } else { j };
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for (j, row) in patch.rows.iter().enumerate() {
            for (i, point) in row.iter().enumerate() {
                let (factor, weight) = (across[i] * along[j], f64::from(patch.weights[row_of_weights(j)][i]));
                let with = factor * weight;
                let of_point =
                    if matches!(self, Mean::WithoutWeights | Mean::WeightsBelowOnly) { factor } else { with };
                sum += of_point * point.as_dvec3();
                total += match self {
                    Mean::WithoutWeights => factor,
                    Mean::DividedByTheNumber => weight,
                    _ => with,
                };
            }
        }
        if self == Mean::NotDivided { sum } else { sum / total }
    }
}

/// The largest error along an axis of a point in single precision: the rounding errors of both basis functions, of their
/// product with weight and point, and of both sums, relative to the largest coordinate of the net, because a mean with
/// positive factors is no larger.
fn point_room(patch: &NurbsPatch) -> f64 {
    let of_basis: usize = patch.degrees.iter().map(|degree| 8 * degree + 4).sum();
    let n_points = patch.rows.len() * patch.rows[0].len();
    2.0 * (of_basis + n_points + 4) as f64 * U * reach(patch.rows.iter().flatten())
}

pub(super) fn nurbs_point_is_the_weighted_mean_of_its_net(trial: &Trial<'_>) -> CheckResult {
    let near = |query: &NurbsQuery, yours: Vec3, mean: Mean| {
        let (yours, other) = (yours.as_dvec3(), mean.point(query));
        let room = point_room(&query.patch);
        (0..3).all(|axis| same(yours[axis], other[axis], room))
    };
    trial.each(400, surface(), <dyn Kit>::nurbs_point, |query, yours| {
        let broken = || {
            let right = Mean::Right.point(query).as_vec3();
            Broken::new(describe(query), yours, right, "the weighted mean in double")
        };
        unless(near(query, yours, Mean::Right), broken)
            .formulas(WRONG_MEANS.map(|(mean, text)| (near(query, yours, mean), text)))
    })
}

/// Part of a cylinder around an axis of the frame: an arc of this angle and radius, extended to this height.
#[derive(Clone, Debug)]
struct Arc {
    query: NurbsQuery,
    /// The axis of the cylinder.
    axis: usize,
    radius: f64,
}

fn arc() -> impl Strategy<Value = Arc> + Clone {
    let degrees = prop_oneof![2 => Just(90.0f64), 1 => (20..=150i32).prop_map(f64::from)];
    (degrees, 1..=32i32, 0..3usize, any::<bool>(), nasty::any_scale(), 0..=16u8).prop_map(
        |(degrees, eighths, axis, along_v, scale, at)| {
            let (angle, radius) = (degrees.to_radians(), f64::from(scale) * f64::from(eighths) / 8.0);
            // The middle point is where the tangents at the ends meet.
            let in_plane = [(1.0, 0.0), (1.0, (0.5 * angle).tan()), (angle.cos(), angle.sin())]
                .map(|(x, y)| (radius * x, radius * y));
            let at_height = |height: f64| {
                in_plane.map(|(x, y)| {
                    let mut point = DVec3::ZERO;
                    (point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]) = (height, x, y);
                    point.as_vec3()
                })
            };
            let rows = [at_height(0.0), at_height(radius)];
            let weights = [1.0, (0.5 * angle).cos() as f32, 1.0];
            let bent = vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
            let straight = vec![0.0, 0.0, 1.0, 1.0];
            let u = f32::from(at) / 16.0;
            let mut patch = NurbsPatch {
                degrees: [2, 1],
                knots: [bent, straight],
                rows: rows.map(|row| row.to_vec()).to_vec(),
                weights: vec![weights.to_vec(); 2],
            };
            let mut uv = vec2(u, 0.5);
            if along_v {
                uv = vec2(0.5, u);
                patch.degrees.reverse();
                patch.knots.reverse();
                patch.rows = (0..3).map(|i| rows.iter().map(|row| row[i]).collect()).collect();
                patch.weights = weights.map(|weight| vec![weight; 2]).to_vec();
            }
            Arc { query: NurbsQuery { patch, uv }, axis, radius }
        },
    )
}

pub(super) fn nurbs_arcs_are_exact(trial: &Trial<'_>) -> CheckResult {
    trial.forall(400, arc(), |arcs| {
        let queries: Vec<NurbsQuery> = arcs.iter().map(|arc| arc.query.clone()).collect();
        compare(arcs, trial.kit.nurbs_point(&queries), |arc, yours| {
            let from_axis = |mut point: DVec3| {
                point[arc.axis] = 0.0;
                point.length()
            };
            // The control points and the weight are rounded, too: two more roundings.
            let room = point_room(&arc.query.patch) + 2.0 * U * arc.radius;
            let distance = from_axis(yours.as_dvec3());
            let gives = |mean: Mean| same(distance, from_axis(mean.point(&arc.query)), room);
            let broken = || {
                let expected = format!("at the distance {} from the axis", arc.radius);
                let answer = format!("{yours:?}, at the distance {distance}");
                Broken::with_texts(describe(&arc.query), answer, expected, "x² + y² = r²")
            };
            let right = (distance - arc.radius).abs() <= room;
            unless(right, broken).formulas(WRONG_MEANS[..2].iter().map(|&(mean, text)| (gives(mean), text)))
        })
    })
}
