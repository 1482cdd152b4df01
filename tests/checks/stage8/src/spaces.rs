//! Checks of `ray_to_object` and `normal_to_world`.

use checks::prelude::*;
use glam::{Affine3A, DMat3, Mat3};

/// Rotations, shears, scales and reflections with small whole numbers and a determinant of at least 1 in size, all multiplied
/// by one power of two.
pub(super) fn transform(exponents: std::ops::RangeInclusive<i32>) -> impl Strategy<Value = Affine3A> + Clone {
    let column = || (-2..=2i32, -2..=2i32, -2..=2i32);
    let scale = prop_oneof![2 => Just(1.0f32), 1 => nasty::scale(exponents)];
    (column(), column(), column(), point(4), scale)
        .prop_map(|(x, y, z, translation, scale)| {
            let vector = |(a, b, c): (i32, i32, i32)| scale * Vec3::new(a as f32, b as f32, c as f32);
            let matrix = Mat3::from_cols(vector(x), vector(y), vector(z));
            Affine3A::from_mat3_translation(matrix, scale * translation)
        })
        .prop_filter("it has an inverse", |transform| determinant(transform) != 0.0)
}

/// The determinant in double precision, which small scales do not round to 0.
pub(super) fn determinant(transform: &Affine3A) -> f64 {
    transform.as_daffine3().matrix3.determinant()
}

pub(super) fn rays_pass_the_same_points_in_every_space(trial: &Trial<'_>) -> CheckResult {
    // First a quarter turn of a stretched object, for which the matrix, its inverse and the transposes of both all
    // differ. Scales along the axes do not show a wrong transpose.
    let matrix = Mat3::from_cols(Vec3::NEG_Y, 2.0 * Vec3::X, Vec3::Z);
    let to_object = Affine3A::from_mat3_translation(matrix, Vec3::new(0.5, -1.0, 2.0));
    let turned = ObjectRayQuery { ray: Ray::new(Vec3::X, Vec3::new(1.0, 1.0, 0.0)), to_object };
    // The origin may be some thousand times as far away as the direction is long.
    let directions = prop_oneof![direction(), nasty::unit()];
    let near = (rough_point(4.0), directions, nasty::scale(-12..=12), transform(-40..=40)).prop_map(
        |(origin, direction, scale, to_object)| ObjectRayQuery {
            ray: Ray::new(origin, scale * direction),
            to_object,
        },
    );
    // An object far from the origin: the low digits of the ray's origin must not be lost.
    let far = (rough_point(4.0), direction()).prop_map(|(offset, direction)| {
        let place = Vec3::new(148_376.0, 1_234.0, -223_423.0);
        ObjectRayQuery {
            ray: Ray::new(place + offset, direction),
            to_object: Affine3A::from_translation(-place),
        }
    });
    let inputs = prop_oneof![4 => near, 1 => far];
    trial.each_and(&[turned], 2000, inputs, <dyn Kit>::ray_to_object, judge_points)
}

fn judge_points(query: &ObjectRayQuery, yours: Ray) -> Judged {
    let ObjectRayQuery { ray, to_object } = query;
    let exact = to_object.as_daffine3();
    let (origin, direction) =
        (exact.transform_point3(ray.origin.as_dvec3()), exact.transform_vector3(ray.direction.as_dvec3()));
    let sizes = |v: Vec3, and: DVec3| terms(&exact.matrix3, v.as_dvec3()) + and.abs();
    // Allow six rounding errors of the terms, for three products and three sums in single precision.
    let close = |yours: Vec3, right: DVec3, size: DVec3| {
        ((yours.as_dvec3() - right).abs()).cmple(6.0 * U * size).all()
    };
    let right_origin = close(yours.origin, origin, sizes(ray.origin, exact.translation));
    let right_dir = close(yours.direction, direction, sizes(ray.direction, DVec3::ZERO))
        || is_along(yours.direction, direction); // another check tests the length
    let along = |matrix: DMat3| is_roughly_along(yours.direction, matrix * ray.direction.as_dvec3());
    // The answer of a mistake that concerns the direction only, or the origin only.
    let turned = |direction: bool| right_origin && direction;
    let moved = |origin: bool| right_dir && origin;
    let back = exact.inverse();
    let there = |point: DVec3| {
        let size = sizes(ray.origin, exact.translation).length().max(point.length());
        (yours.origin.as_dvec3() - point).length() <= 1e-4 * size
    };
    let from = ray.origin.as_dvec3();
    let describe = |origin: Vec3, direction: Vec3| format!("origin {origin}, direction {direction}");
    unless(right_origin && right_dir, || {
        let expected = describe(origin.as_vec3(), direction.as_vec3());
        let yours = describe(yours.origin, yours.direction);
        Broken::with_texts(query.call("ray_to_object"), yours, expected, "double precision")
    })
    .formulas([
        "you multiply the direction by the transpose of to_object, the inverse transpose of to_world, as the slide does: this is for normals only"
            .when(turned(along(exact.matrix3.transpose()))),
        "you multiply the direction by the inverse transpose of to_object: this is for normals only"
            .when(turned(along(exact.matrix3.inverse().transpose()))),
        "you multiply the direction by the inverse of to_object, which leads to the world"
            .when(turned(along(exact.matrix3.inverse()))),
        (turned(is_along(yours.direction, ray.direction.as_dvec3())), "you do not transform the direction"),
        (turned(is_along(yours.direction, -direction)), "you reverse the direction"),
        (moved(there(origin + direction)), "you start at origin + direction: start at the origin"),
        "you translate the direction: only points are translated"
            .when(turned(is_along(yours.direction, direction + exact.translation))),
        (moved(there(origin - exact.translation)), "you do not translate the origin: it is a point"),
        (moved(there(from)), "you do not transform the origin"),
        "you transform the origin by the inverse of to_object, which leads to the world"
            .when(moved(there(back.transform_point3(from)))),
        "you transform the ray by the inverse of to_object, which leads to the world"
            .when(along(exact.matrix3.inverse()) && there(back.transform_point3(from))),
    ])
}

/// The sums of the sizes of the terms of a product.
fn terms(matrix: &DMat3, v: DVec3) -> DVec3 {
    matrix.x_axis.abs() * v.x.abs() + matrix.y_axis.abs() * v.y.abs() + matrix.z_axis.abs() * v.z.abs()
}

/// Whether a direction is that of a mistake, whose rounding errors are not known.
fn is_roughly_along(yours: Vec3, wrong: DVec3) -> bool {
    (yours.as_dvec3().normalize_or_zero() - wrong.normalize_or_zero()).length() <= 1e-3
}

fn is_along(yours: Vec3, right: DVec3) -> bool {
    // The error of a cross product of two rounded vectors is a few rounding errors of their lengths.
    let (yours, length) = (yours.as_dvec3(), yours.length() as f64 * right.length());
    yours.dot(right) > 0.0 && yours.cross(right).length() <= 16.0 * U * length
}

pub(super) fn rays_keep_their_t_in_every_space(trial: &Trial<'_>) -> CheckResult {
    // An object that is scaled is hit at the same t, which counts lengths of the direction.
    let grown = ObjectRayQuery {
        ray: Ray::new(Vec3::new(0.0, 0.0, -5.0), 2.0 * Vec3::Z),
        to_object: Affine3A::from_scale(Vec3::splat(0.125)),
    };
    let ranges =
        prop_oneof![Just((0.5f32, 8.0f32, 0.25f32)), Just((0.0, 2.0, 1.0)), Just((-1.0, f32::INFINITY, 0.5))];
    let directions = prop_oneof![direction(), nasty::unit()];
    let inputs = (point(4), directions, nasty::scale(-12..=12), ranges, transform(-20..=20)).prop_map(
        |(origin, direction, scale, (t_min, t_max, time), to_object)| {
            let ray = Ray { time, ..Ray::new(origin, scale * direction).with_range(t_min, t_max) };
            ObjectRayQuery { ray, to_object }
        },
    );
    let timed = Ray { time: 0.25, ..grown.ray.with_range(0.5, 8.0) };
    let chosen = [grown, ObjectRayQuery { ray: timed, ..grown }];
    trial.each_and(&chosen, 500, inputs, <dyn Kit>::ray_to_object, judge_range)
}

fn judge_range(query: &ObjectRayQuery, yours: Ray) -> Judged {
    let ObjectRayQuery { ray, to_object } = query;
    let world = ray.direction.as_dvec3();
    let exact = to_object.as_daffine3().transform_vector3(world).length();
    let length = yours.direction.as_dvec3().length();
    // Allow eight rounding errors of the terms, whose sum may be shorter.
    let terms = terms(&to_object.as_daffine3().matrix3, world).length();
    let near = |right: f64| (length - right).abs() <= 8.0 * U * (terms / exact) * right;
    let same_length = near(exact);
    let same_range = (yours.t_min, yours.t_max) == (ray.t_min, ray.t_max);
    let same_time = yours.time == ray.time;
    // Which parts are wrong.
    let only_length = same_range && same_time;
    let factor = exact / world.length();
    let is = |yours: f32, right: f64| {
        (f64::from(yours) - right).abs() <= 1e-5 * right.abs() || f64::from(yours) == right
    };
    let [low, high] = [ray.t_min, ray.t_max].map(f64::from);
    let describe = |length: f64, ray: &Ray| {
        format!("length {length:.6e}, t in {:?}..{:?}, time {:?}", ray.t_min, ray.t_max, ray.time)
    };
    unless(same_length && same_range && same_time, || {
            let (got, right) = (describe(length, &yours), describe(exact, ray));
            Broken::with_texts(query.call("ray_to_object"), got, right, "the definition")
            .explained_by(["you raise t_min: the range stays, and an offset of the origin belongs to other rays"
                .when(same_length && same_time && yours.t_max == ray.t_max && yours.t_min > ray.t_min)])
        }).formulas([
            "you normalize the direction: t then has another unit than in the world and cannot be compared"
                .when(only_length && near(1.0)),
            "you give the direction the length that it has in the world: then the same t is another point"
                .when(only_length && near(world.length())),
            (same_range && same_length && yours.time == 0.0, "you do not copy the time of the ray"),
            "you start with a new range: copy t_min and t_max from the ray"
                .when((yours.t_min, yours.t_max) == (0.0, f32::INFINITY)),
            "you change the range of the ray by the length of the direction: t is the same number in both spaces, so t_min and t_max stay"
                .when(is(yours.t_min, low * factor) && is(yours.t_max, high * factor)),
            "you multiply the range by the length of the direction: t is the same number in both spaces, so t_min and t_max stay"
                .when((is(yours.t_min, low) || is(yours.t_min, low * exact)) && is(yours.t_max, high * exact)),
            "you normalize the direction and scale the range: t is then another number than in the world"
                .when(near(1.0) && is(yours.t_max, high * exact) && (is(yours.t_min, low) || is(yours.t_min, low * exact))),
            "you divide the range of the ray by the change of the direction's length: t is the same number in both spaces, so t_min and t_max stay"
                .when(is(yours.t_min, low / factor) && is(yours.t_max, high / factor)),
        ])
}

/// The normal in the world, computed in double precision.
fn normal(query: &NormalQuery) -> DVec3 {
    (query.to_object.as_daffine3().matrix3.transpose() * query.normal.as_dvec3()).normalize()
}

fn judge_normals(query: &NormalQuery, yours: Vec3) -> Judged {
    let (right, exact) = (normal(query), query.to_object.as_daffine3().matrix3);
    let own = query.normal.as_dvec3();
    // Allow sixteen rounding errors of the terms, whose sum may be shorter, and some of the usual terms.
    let terms = DVec3::from_array([0, 1, 2].map(|row| exact.col(row).abs().dot(own.abs())));
    let cancels = terms.length() / (exact.transpose() * own).length();
    let near = 1e-5f64.max(16.0 * U * cancels);
    let unit = (yours.as_dvec3().length() - 1.0).abs() <= near;
    let like = |other: DVec3| (yours.as_dvec3().normalize_or_zero() - other.normalize()).length() <= near;
    let broken = || {
        let input = query.call("normal_to_world");
        Broken::new(input, yours, right.as_vec3(), "double precision").explained_by([
            (yours == Vec3::ZERO, "your normal is 0: a short product has a direction, too, so normalize it"),
            (like(right) && !unit, "your normal does not have unit length"),
            "your normal points inwards: the inverse transpose needs no change of sign, also for a reflection"
                .when(like(-right) && unit),
        ])
    };
    unless((yours.as_dvec3() - right).length() <= near, broken).formulas([
        "you transform the normal like a point, by to_world: it is then not perpendicular to the surface"
            .when(like(exact.inverse() * own)),
        (like(exact * own), "you multiply by to_object without the transpose"),
        "you multiply by the transpose of to_world: use the transpose of to_object, which is the inverse"
            .when(like(exact.inverse().transpose() * own)),
        (like(own), "you do not transform the normal"),
    ])
}

pub(super) fn normals_are_at_right_angles_to_the_surface(trial: &Trial<'_>) -> CheckResult {
    // Stretch and shear, so that the matrix, its inverse and the transposes of both all differ.
    let to_object =
        Affine3A::from_mat3(Mat3::from_cols(Vec3::new(0.5, 0.0, 0.0), Vec3::new(0.5, 1.0, 0.0), Vec3::Z));
    let leaning = NormalQuery { normal: Vec3::new(0.6, 0.8, 0.0), to_object };
    let any = (nasty::unit(), transform(-40..=40))
        .prop_filter("another check tests reflections", |(_, transform)| determinant(transform) > 0.0)
        .prop_map(|(normal, to_object)| NormalQuery { normal, to_object });
    // 65: scale by 1000 along one axis and by 1/1000 along another.
    let extreme = nasty::unit().prop_map(|normal| NormalQuery {
        normal,
        to_object: Affine3A::from_scale(Vec3::new(1e3, 1.0, 1e-3)),
    });
    let inputs = prop_oneof![8 => any, 1 => extreme];
    trial.each_and(&[leaning], 2000, inputs, <dyn Kit>::normal_to_world, judge_normals)
}

pub(super) fn normals_stay_outside_in_a_mirror(trial: &Trial<'_>) -> CheckResult {
    let inputs = (nasty::unit(), transform(-40..=40)).prop_map(|(normal, to_object)| {
        let mirrored = determinant(&to_object) < 0.0;
        let mirror = Affine3A::from_scale(Vec3::new(-1.0, 1.0, 1.0));
        let to_object = if mirrored { to_object } else { to_object * mirror };
        NormalQuery { normal, to_object }
    });
    trial.each(1000, inputs, <dyn Kit>::normal_to_world, judge_normals)
}
