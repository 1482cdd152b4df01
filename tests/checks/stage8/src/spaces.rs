//! Checks of `ray_to_object`, `normal_to_world` and `placement`.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::{direction, point, rough_point};
use checks::judge::{compare, known};
use checks::paste::{call, list};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Mat3, Vec3};
use proptest::prelude::*;
use raykata::kit::{NormalQuery, ObjectRayQuery};
use raykata::ray::Ray;

/// Rotations, shears, scales and reflections with small whole numbers and a determinant of at least 1 in size.
fn transform() -> impl Strategy<Value = Affine3A> + Clone {
    let column = || (-2..=2i32, -2..=2i32, -2..=2i32);
    (column(), column(), column(), point(4))
        .prop_map(|(x, y, z, translation)| {
            let vector = |(a, b, c): (i32, i32, i32)| Vec3::new(a as f32, b as f32, c as f32);
            Affine3A::from_mat3_translation(Mat3::from_cols(vector(x), vector(y), vector(z)), translation)
        })
        .prop_filter("it has an inverse", |transform| transform.matrix3.determinant().abs() >= 1.0)
}

pub(super) fn rays_pass_the_same_points_in_every_space(trial: &Trial<'_>) -> CheckResult {
    // X1: first a quarter turn of a stretched object, for which the matrix, its inverse and the transposes of both all
    // differ. Scales along the axes do not show a wrong transpose.
    let to_object = Affine3A::from_mat3(Mat3::from_cols(Vec3::NEG_Y, 2.0 * Vec3::X, Vec3::Z));
    let turned = ObjectRayQuery { ray: Ray::new(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)), to_object };
    judge_points(trial, &[turned]).into_iter().collect::<CheckResult>()?;
    let inputs = (point(4), direction(), transform()).prop_map(|(origin, direction, to_object)| {
        ObjectRayQuery { ray: Ray::new(origin, direction), to_object }
    });
    trial.forall(2000, inputs, |queries| judge_points(trial, queries))?;
    // Test an object far from the origin: the subtraction must not lose the low digits of the ray's origin.
    let far = (rough_point(4.0), direction()).prop_map(|(offset, direction)| {
        let place = Vec3::new(148_376.0, 1_234.0, -223_423.0);
        ObjectRayQuery {
            ray: Ray::new(place + offset, direction),
            to_object: Affine3A::from_translation(-place),
        }
    });
    trial.forall(500, far, |queries| judge_points(trial, queries))
}

fn judge_points(trial: &Trial<'_>, queries: &[ObjectRayQuery]) -> Vec<CheckResult> {
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
        // Allow six rounding errors of the terms, for three products and three sums in single precision.
        let close = |yours: Vec3, right: DVec3, size: DVec3| {
            ((yours.as_dvec3() - right).abs()).cmple(6.0 * checks::double::U * size).all()
        };
        let right_origin = close(yours.origin, origin, sizes(ray.origin, exact.translation));
        let right_dir = close(yours.direction, direction, sizes(ray.direction, DVec3::ZERO))
            || is_along(yours.direction, direction); // another check tests the length
        if right_origin && right_dir {
            return Ok(());
        }
        let with = |matrix: DMat3| is_along(yours.direction, matrix * ray.direction.as_dvec3());
        let diagnosis = match () {
            () if !right_dir && with(exact.matrix3.transpose()) => {
                "you multiply the direction by the transpose of to_object, the inverse transpose of \
                 to_world, as the slide does: this is for normals only"
            }
            () if !right_dir && with(exact.matrix3.inverse().transpose()) => {
                "you multiply the direction by the inverse transpose of to_object: this is for normals only"
            }
            () if !right_dir && with(exact.matrix3.inverse()) => {
                "you multiply the direction by the inverse of to_object, which leads to the world"
            }
            () if !right_dir && is_along(yours.direction, direction + exact.translation) => {
                "you translate the direction: only points are translated"
            }
            () if !right_origin
                && close(yours.origin, origin - exact.translation, sizes(ray.origin, exact.translation)) =>
            {
                "you do not translate the origin: it is a point"
            }
            () if !right_origin && origin.length() < 10.0 && exact.translation.length() > 1e5 => {
                "you lose digits of an origin far from 0: transform it in double precision"
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
    // The error of a cross product of two rounded vectors is a few rounding errors of their lengths.
    let (yours, length) = (yours.as_dvec3(), yours.length() as f64 * right.length());
    yours.dot(right) > 0.0 && yours.cross(right).length() <= 16.0 * checks::double::U * length
}

pub(super) fn rays_keep_their_t_in_every_space(trial: &Trial<'_>) -> CheckResult {
    // X2: an object that is scaled is hit at the same t, which counts lengths of the direction.
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
        // Allow a rounding error of each term of the length.
        let same_length = (f64::from(yours.direction.length()) / exact - 1.0).abs() < 1e-6;
        let same_range = (yours.t_min, yours.t_max, yours.time) == (ray.t_min, ray.t_max, ray.time);
        if same_length && same_range {
            return Ok(());
        }
        let unit = (yours.direction.length() - 1.0).abs() < 1e-6;
        let diagnosis = match () {
            () if !same_length && unit => {
                "you normalize the direction: t then has another unit than in the world and cannot be \
                 compared"
            }
            () if !same_length && (yours.direction.length() / ray.direction.length() - 1.0).abs() < 1e-6 => {
                "you give the direction the length that it has in the world: then the same t is another point"
            }
            () if !same_length => "your direction has another length than to_object gives it",
            () if yours.time != ray.time => "you do not copy the time of the ray",
            () => {
                "you change the range of the ray: t is the same number in both spaces, so t_min and t_max \
                 stay"
            }
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

/// The normal in the world, computed in double precision.
fn normal(query: &NormalQuery) -> DVec3 {
    (query.to_object.as_daffine3().matrix3.transpose() * query.normal.as_dvec3()).normalize()
}

fn judge_normals(trial: &Trial<'_>, queries: &[NormalQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.normal_to_world(queries), |query, yours| {
        let (right, exact) = (normal(query), query.to_object.as_daffine3().matrix3);
        // The tolerance covers a normalized sum of three products whose terms are at most ten times as large as the sum.
        if (yours.as_dvec3() - right).length() <= 1e-5 {
            return Ok(());
        }
        let own = query.normal.as_dvec3();
        let like = |other: DVec3| (yours.as_dvec3().normalize_or_zero() - other.normalize()).length() <= 1e-5;
        let diagnosis = match () {
            () if like(-right) => {
                "your normal points inwards: the inverse transpose needs no change of sign, also for a \
                 reflection"
            }
            () if like(right) => "your normal does not have unit length",
            () if like(exact.inverse() * own) => {
                "you transform the normal like a point, by to_world: it is then not perpendicular to the \
                 surface"
            }
            () if like(exact * own) => "you multiply by to_object without the transpose",
            () if like(exact.inverse().transpose() * own) => {
                "you multiply by the transpose of to_world: use the transpose of to_object, which is the \
                 inverse"
            }
            () => "",
        };
        let input = call("normal_to_world", &[&query.normal, &query.to_object]);
        Err(Broken::new(input, yours, right.as_vec3(), "double precision").looks_like(known(diagnosis)))
    })
}

pub(super) fn normals_are_at_right_angles_to_the_surface(trial: &Trial<'_>) -> CheckResult {
    // Stretch and shear, so that the matrix, its inverse and the transposes of both all differ.
    let to_object =
        Affine3A::from_mat3(Mat3::from_cols(Vec3::new(0.5, 0.0, 0.0), Vec3::new(0.5, 1.0, 0.0), Vec3::Z));
    let leaning = NormalQuery { normal: Vec3::new(0.6, 0.8, 0.0), to_object };
    judge_normals(trial, &[leaning]).into_iter().collect::<CheckResult>()?;
    let inputs = (direction(), transform())
        .prop_filter("another check tests reflections", |(_, transform)| {
            transform.matrix3.determinant() > 0.0
        })
        .prop_map(|(normal, to_object)| NormalQuery { normal: normal.normalize(), to_object });
    trial.forall(2000, inputs, |queries| judge_normals(trial, queries))?;
    // 65: scale by 1000 along one axis and by 1/1000 along another.
    let extreme = direction().prop_map(|normal| NormalQuery {
        normal: normal.normalize(),
        to_object: Affine3A::from_scale(Vec3::new(1e3, 1.0, 1e-3)),
    });
    trial.forall(200, extreme, |queries| judge_normals(trial, queries))
}

pub(super) fn normals_stay_outside_in_a_mirror(trial: &Trial<'_>) -> CheckResult {
    let inputs = (direction(), transform()).prop_map(|(normal, to_object)| {
        let mirrored = to_object.matrix3.determinant() < 0.0;
        let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        let to_object = if mirrored { to_object } else { to_object * mirror };
        NormalQuery { normal: normal.normalize(), to_object }
    });
    trial.forall(1000, inputs, |queries| judge_normals(trial, queries))
}

pub(super) fn placement_multiplies_in_the_right_order(trial: &Trial<'_>) -> CheckResult {
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
                let broken = Broken::with_texts(input, "None", "Some", "each transform has an inverse");
                return Err(broken.looks_like(Some(
                    "you return None, but no determinant is 0: a negative one belongs to a reflection",
                )));
            };
            let near = |yours: &Affine3A, right: &DAffine3| {
                let (yours, right) = (yours.as_daffine3().to_cols_array(), right.to_cols_array());
                let size = right.iter().fold(1.0, |largest: f64, entry| largest.max(entry.abs()));
                // Allow some hundred rounding errors, for a product of up to four small matrices in single precision.
                yours.iter().zip(right).all(|(yours, right)| (yours - right).abs() <= 1e-4 * size)
            };
            let (up, down) = (near(&yours.to_world, &exact), near(&yours.to_object, &exact.inverse()));
            if up && down {
                return Ok(());
            }
            let turned =
                path.iter().rev().map(Affine3A::as_daffine3).fold(DAffine3::IDENTITY, |all, one| all * one);
            let diagnosis = match () {
                () if !up && near(&yours.to_world, &turned) => {
                    "you multiply from the node up to the root: the root's transform is the first factor"
                }
                () if !down && near(&yours.to_object, &turned.inverse()) => {
                    "you multiply the inverses in the order of the transforms: the order must be reversed"
                }
                () if near(&yours.to_object, &exact) => {
                    "you return to_world as to_object, without the inverse"
                }
                () if !up && path.last().is_some_and(|own| near(&yours.to_world, &own.as_daffine3())) => {
                    "you use the node's own transform only: multiply all transforms of the path"
                }
                () if yours.to_object.as_daffine3().matrix3 == exact.matrix3.transpose() => {
                    "you take the transpose for the inverse: this is right for rotations only"
                }
                () => "",
            };
            let which = if up { "to_object" } else { "to_world" };
            let (got, right) = if up { (yours.to_object, exact.inverse()) } else { (yours.to_world, exact) };
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

pub(super) fn placement_refuses_what_cannot_be_undone(trial: &Trial<'_>) -> CheckResult {
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
            "a determinant is 0",
        )
        .looks_like(Some(
            "you accept a path with a singular transform: if one factor has no inverse, the product has none",
        ))),
    };
    compare(&paths, trial.kit.placement(&paths), judge).into_iter().collect::<CheckResult>()?;
    // Scales by very small and very large numbers have inverses.
    let small =
        vec![Affine3A::from_scale(Vec3::splat(1e-4)), Affine3A::from_scale(Vec3::new(1e-3, 1e3, -1.0))];
    match trial.kit.placement(std::slice::from_ref(&small))[0] {
        Some(_) => Ok(()),
        None => Err(Broken::with_texts(
            format!("placement(&{})", list(&small)),
            "None",
            "Some",
            "the definition",
        )
        .looks_like(Some(
            "do not compare the determinant with a fixed limit: it is small because the object is small",
        ))),
    }
}
