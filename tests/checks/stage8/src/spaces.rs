//! From space to space.

use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::generate::{direction, point, rough_point};
use checks::judge::{compare, known};
use checks::paste::{call, list};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Vec3};
use proptest::prelude::*;
use raykata::kit::{NormalQuery, ObjectRayQuery};
use raykata::ray::Ray;

/// Turns, shears, stretches and mirrors with small whole numbers: what can be undone well.
fn transform() -> impl Strategy<Value = Affine3A> + Clone {
    let column = || (-2..=2i32, -2..=2i32, -2..=2i32);
    (column(), column(), column(), point(4))
        .prop_map(|(x, y, z, translation)| {
            let vector = |(a, b, c): (i32, i32, i32)| Vec3::new(a as f32, b as f32, c as f32);
            Affine3A::from_mat3_translation(Mat3::from_cols(vector(x), vector(y), vector(z)), translation)
        })
        .prop_filter("it can be undone", |transform| transform.matrix3.determinant().abs() >= 1.0)
}

pub(super) fn rays_pass_the_same_points_in_every_space(trial: &Trial<'_>) -> Outcome {
    // X1: first a quarter turn of a stretched object, where the matrix, its inverse and the transposes of both all differ;
    // scales along the axes cannot tell.
    let to_object = Affine3A::from_mat3(Mat3::from_cols(Vec3::NEG_Y, 2.0 * Vec3::X, Vec3::Z));
    let turned = ObjectRayQuery { ray: Ray::new(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)), to_object };
    judge_points(trial, &[turned]).into_iter().collect::<Outcome>()?;
    let inputs = (point(4), direction(), transform()).prop_map(|(origin, direction, to_object)| {
        ObjectRayQuery { ray: Ray::new(origin, direction), to_object }
    });
    trial.forall(2000, inputs, |queries| judge_points(trial, queries))?;
    // An object that stands far away: what is left of the origin after the subtraction must have its digits.
    let far = (rough_point(4.0), direction()).prop_map(|(offset, direction)| {
        let place = Vec3::new(148_376.0, 1_234.0, -223_423.0);
        ObjectRayQuery {
            ray: Ray::new(place + offset, direction),
            to_object: Affine3A::from_translation(-place),
        }
    });
    trial.forall(500, far, |queries| judge_points(trial, queries))
}

fn judge_points(trial: &Trial<'_>, queries: &[ObjectRayQuery]) -> Vec<Outcome> {
    compare(queries, trial.kit.ray_to_object(queries), |query, yours| {
        let ObjectRayQuery { ray, to_object } = query;
        let exact = to_object.as_daffine3();
        let (origin, direction) = (
            exact.transform_point3(ray.origin.as_dvec3()),
            exact.transform_vector3(ray.direction.as_dvec3()),
        );
        let sizes = |v: Vec3, and: DVec3| {
            let columns = [exact.matrix3.x_axis, exact.matrix3.y_axis, exact.matrix3.z_axis].map(DVec3::abs);
            let v = v.as_dvec3().abs();
            columns[0] * v.x + columns[1] * v.y + columns[2] * v.z + and.abs()
        };
        // Three products and three sums in single precision: six roundings of the sizes of the terms.
        let close = |yours: Vec3, right: DVec3, size: DVec3| {
            ((yours.as_dvec3() - right).abs()).cmple(6.0 * checks::double::U * size).all()
        };
        let right_origin = close(yours.origin, origin, sizes(ray.origin, exact.translation));
        let right_dir = close(yours.direction, direction, sizes(ray.direction, DVec3::ZERO))
            || is_along(yours.direction, direction); // its length is another check's
        if right_origin && right_dir {
            return Ok(());
        }
        let with = |matrix: DMat3| is_along(yours.direction, matrix * ray.direction.as_dvec3());
        let diagnosis = match () {
            () if !right_dir && with(exact.matrix3.transpose()) => {
                "the direction went through the transpose of to_object, which is the inverse transpose of the way to the world, as the slide has it: that is for normals only"
            }
            () if !right_dir && with(exact.matrix3.inverse().transpose()) => {
                "the direction went through the inverse transpose of to_object: that is for normals only"
            }
            () if !right_dir && with(exact.matrix3.inverse()) => {
                "the direction went the other way, to the world"
            }
            () if !right_dir && is_along(yours.direction, direction + exact.translation) => {
                "a direction is not moved: only points are"
            }
            () if !right_origin
                && close(yours.origin, origin - exact.translation, sizes(ray.origin, exact.translation)) =>
            {
                "the origin is a point: it is moved as well"
            }
            () if !right_origin && origin.length() < 10.0 && exact.translation.length() > 1e5 => {
                "far from the origin the digits of the difference are lost: subtract in double"
            }
            () => "",
        };
        let input = call("ray_to_object", &[ray, to_object]);
        let describe = |origin: Vec3, direction: Vec3| format!("origin {origin}, direction {direction}");
        Err(Broken::with_texts(
            input,
            describe(yours.origin, yours.direction),
            describe(origin.as_vec3(), direction.as_vec3()),
            "double precision",
        )
        .looks_like(known(diagnosis)))
    })
}

fn is_along(yours: Vec3, right: DVec3) -> bool {
    // A cross product of two rounded vectors is off by a few roundings of their lengths.
    let (yours, length) = (yours.as_dvec3(), yours.length() as f64 * right.length());
    yours.dot(right) > 0.0 && yours.cross(right).length() <= 16.0 * checks::double::U * length
}

pub(super) fn rays_keep_their_t_in_every_space(trial: &Trial<'_>) -> Outcome {
    // X2: an object ten times as large is met at the same t, which is counted in lengths of the direction.
    let grown = ObjectRayQuery {
        ray: Ray::new(Vec3::new(0.0, 0.0, -5.0), 2.0 * Vec3::Z),
        to_object: Affine3A::from_scale(Vec3::splat(0.125)),
    };
    let mut queries = vec![grown];
    for (t_min, t_max, time) in [(0.5, 8.0, 0.25), (0.0, 2.0, 1.0)] {
        let ray = Ray { time, ..Ray::new(Vec3::X, Vec3::new(3.0, 0.0, 4.0)).with_range(t_min, t_max) };
        for scale in [0.001, 1.0, 64.0] {
            queries.push(ObjectRayQuery { ray, to_object: Affine3A::from_scale(Vec3::splat(scale)) });
        }
    }
    let judge = |query: &ObjectRayQuery, yours: Ray| {
        let ObjectRayQuery { ray, to_object } = query;
        let exact = to_object.as_daffine3().transform_vector3(ray.direction.as_dvec3()).length();
        // A length is off by a rounding of each of its terms.
        let same_length = (f64::from(yours.direction.length()) / exact - 1.0).abs() < 1e-6;
        let same_range = (yours.t_min, yours.t_max, yours.time) == (ray.t_min, ray.t_max, ray.time);
        if same_length && same_range {
            return Ok(());
        }
        let unit = (yours.direction.length() - 1.0).abs() < 1e-6;
        let diagnosis = match () {
            () if !same_length && unit => {
                "the direction was made a unit vector: t counts other lengths than in the world, and cannot be compared"
            }
            () if !same_length && (yours.direction.length() / ray.direction.length() - 1.0).abs() < 1e-6 => {
                "the direction was given the length that it has in the world: then the same t is another point"
            }
            () if !same_length => "the direction has another length than the object's space gives it",
            () if yours.time != ray.time => "the time of the ray was forgotten",
            () => "the range of the ray must stay: t is the same number in both spaces",
        };
        let describe = |length: f64, ray: &Ray| {
            format!("length {length:.6}, t in {:?}..{:?}, time {:?}", ray.t_min, ray.t_max, ray.time)
        };
        Err(Broken::with_texts(
            call("ray_to_object", &[ray, to_object]),
            describe(f64::from(yours.direction.length()), &yours),
            describe(exact, ray),
            "the definition",
        )
        .looks_like(Some(diagnosis)))
    };
    compare(&queries, trial.kit.ray_to_object(&queries), judge).into_iter().collect()
}

/// The normal in the world in double precision.
fn normal(query: &NormalQuery) -> DVec3 {
    (query.to_object.as_daffine3().matrix3.transpose() * query.normal.as_dvec3()).normalize()
}

fn judge_normals(trial: &Trial<'_>, queries: &[NormalQuery]) -> Vec<Outcome> {
    compare(queries, trial.kit.normal_to_world(queries), |query, yours| {
        let (right, exact) = (normal(query), query.to_object.as_daffine3().matrix3);
        // Sums of three products whose terms are at most ten times as large as the sum, made a unit vector.
        if (yours.as_dvec3() - right).length() <= 1e-5 {
            return Ok(());
        }
        let own = query.normal.as_dvec3();
        let like = |other: DVec3| (yours.as_dvec3().normalize_or_zero() - other.normalize()).length() <= 1e-5;
        let diagnosis = match () {
            () if like(-right) => {
                "the normal points inwards: the inverse transpose needs no sign, in a mirror neither"
            }
            () if like(right) => "the normal is not of unit length",
            () if like(exact.inverse() * own) => {
                "the normal went the way of points: it is then no longer at right angles to the surface"
            }
            () if like(exact * own) => {
                "the normal went the way back, as a point of the world would: the transpose is missing"
            }
            () if like(exact.inverse().transpose() * own) => {
                "the transpose of the other matrix: to_object is the inverse already"
            }
            () => "",
        };
        let input = call("normal_to_world", &[&query.normal, &query.to_object]);
        Err(Broken::new(input, yours, right.as_vec3(), "double precision").looks_like(known(diagnosis)))
    })
}

pub(super) fn normals_are_at_right_angles_to_the_surface(trial: &Trial<'_>) -> Outcome {
    // Stretched and sheared, so that the matrix, its inverse and the transposes of both all differ.
    let to_object =
        Affine3A::from_mat3(Mat3::from_cols(Vec3::new(0.5, 0.0, 0.0), Vec3::new(0.5, 1.0, 0.0), Vec3::Z));
    let leaning = NormalQuery { normal: Vec3::new(0.6, 0.8, 0.0), to_object };
    judge_normals(trial, &[leaning]).into_iter().collect::<Outcome>()?;
    let inputs = (direction(), transform())
        .prop_filter("mirrors are another check's", |(_, transform)| transform.matrix3.determinant() > 0.0)
        .prop_map(|(normal, to_object)| NormalQuery { normal: normal.normalize(), to_object });
    trial.forall(2000, inputs, |queries| judge_normals(trial, queries))?;
    // 65: a thousandth along one axis, a thousand along another.
    let extreme = direction().prop_map(|normal| NormalQuery {
        normal: normal.normalize(),
        to_object: Affine3A::from_scale(Vec3::new(1e3, 1.0, 1e-3)),
    });
    trial.forall(200, extreme, |queries| judge_normals(trial, queries))
}

pub(super) fn normals_stay_outside_in_a_mirror(trial: &Trial<'_>) -> Outcome {
    let inputs = (direction(), transform()).prop_map(|(normal, to_object)| {
        let mirrored = to_object.matrix3.determinant() < 0.0;
        let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        let to_object = if mirrored { to_object } else { to_object * mirror };
        NormalQuery { normal: normal.normalize(), to_object }
    });
    trial.forall(1000, inputs, |queries| judge_normals(trial, queries))
}

pub(super) fn placement_multiplies_in_the_right_order(trial: &Trial<'_>) -> Outcome {
    let empty = trial.kit.placement(&[Vec::new()])[0];
    if empty.is_none_or(|place| (place.to_world, place.to_object) != (Affine3A::IDENTITY, Affine3A::IDENTITY))
    {
        return Err(Broken::new("placement(&[])", empty, "the identity, twice", "the definition"));
    }
    trial.forall(1000, prop::collection::vec(transform(), 1..5), |paths| {
        compare(paths, trial.kit.placement(paths), |path, yours| {
            let exact = path.iter().map(Affine3A::as_daffine3).fold(DAffine3::IDENTITY, |all, one| all * one);
            let input = format!("placement(&{})", list(path));
            let Some(yours) = yours else {
                let broken = Broken::with_texts(input, "None", "Some", "each transform can be undone");
                return Err(broken.looks_like(Some("a determinant below 0 is a mirror, and not singular")));
            };
            let near = |yours: &Affine3A, right: &DAffine3| {
                let (yours, right) = (yours.as_daffine3().to_cols_array(), right.to_cols_array());
                let size = right.iter().fold(1.0, |largest: f64, entry| largest.max(entry.abs()));
                // Of products of five small matrices in single precision, up to some hundred roundings.
                yours.iter().zip(right).all(|(yours, right)| (yours - right).abs() <= 1e-4 * size)
            };
            let (up, down) = (near(&yours.to_world, &exact), near(&yours.to_object, &exact.inverse()));
            if up && down {
                return Ok(());
            }
            let turned = path.iter().rev().map(Affine3A::as_daffine3).fold(DAffine3::IDENTITY, |all, one| all * one);
            let diagnosis = match () {
                () if !up && near(&yours.to_world, &turned) => "multiplied from the node up: the root's comes first",
                () if !down && near(&yours.to_object, &turned.inverse()) => {
                    "the inverses are in the order of the transforms: the one that was applied last is undone first"
                }
                () if near(&yours.to_object, &exact) => "the way back is the way up",
                () if !up && path.last().is_some_and(|own| near(&yours.to_world, &own.as_daffine3())) => {
                    "its own transform alone: a node stands where all above it put it"
                }
                () if yours.to_object.as_daffine3().matrix3 == exact.matrix3.transpose() => {
                    "the transpose is the inverse of a rotation, and of nothing else"
                }
                () => "",
            };
            let which = if up { "to_object" } else { "to_world" };
            let (got, right) =
                if up { (yours.to_object, exact.inverse()) } else { (yours.to_world, exact) };
            let describe = |entries: Vec<f64>| format!("{which} {entries:.3?}");
            Err(Broken::with_texts(
                input,
                describe(got.as_daffine3().to_cols_array().to_vec()),
                describe(right.to_cols_array().to_vec()),
                "double precision",
            )
            .looks_like(known(diagnosis)))
        })
    })
}

pub(super) fn placement_refuses_what_cannot_be_undone(trial: &Trial<'_>) -> Outcome {
    let flat = Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0));
    let line = Affine3A::from_mat3(Mat3::from_cols(Vec3::ONE, Vec3::ONE, 2.0 * Vec3::ONE));
    let turn = Affine3A::from_rotation_y(0.5);
    let paths = vec![vec![flat], vec![turn, line], vec![flat, turn, turn]];
    let judge = |path: &Vec<Affine3A>, yours: Option<raykata::graph::Placement>| match yours {
        None => Ok(()),
        Some(_) => Err(Broken::with_texts(
            format!("placement(&{})", list(path)),
            "Some",
            "None",
            "its determinant is 0: it squeezes space flat",
        )
        .looks_like(Some("one factor that cannot be undone makes the product such"))),
    };
    compare(&paths, trial.kit.placement(&paths), judge).into_iter().collect::<Outcome>()?;
    // Small and large is not flat.
    let small =
        vec![Affine3A::from_scale(Vec3::splat(1e-4)), Affine3A::from_scale(Vec3::new(1e-3, 1e3, -1.0))];
    match trial.kit.placement(std::slice::from_ref(&small))[0] {
        Some(_) => Ok(()),
        None => {
            Err(Broken::with_texts(format!("placement(&{})", list(&small)), "None", "Some", "the definition")
                .looks_like(Some(
                    "a fixed limit for the determinant: it is small because the object is small",
                )))
        }
    }
}
