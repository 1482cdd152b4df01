//! The table of stage 1.

use checks::golden::{Table, digits};
use checks::prelude::*;
use raykata::shape::PlaneEquation;

/// The sphere, a point of the floor below it, a normal of the floor, and the origin of the rays.
type Place = (Sphere, Vec3, Vec3, Vec3);

/// A fan of 35 rays at the sphere. Rays that pass its rim at less than a hundredth of its radius or are nearly parallel to
/// the floor are left out, because rounding decides about them, or is visible in the digits of their `t`.
fn fan((sphere, _, normal, eye): &Place) -> Vec<Ray> {
    let target = |i: u8| {
        let (column, row) = (f32::from(i % 7) - 3.0, f32::from(i / 7) - 2.0);
        sphere.center + sphere.radius * vec3(0.34 * column + 0.05, 0.45 * row - 0.1, 0.0)
    };
    let rays = (0..35).map(|i| Ray::new(*eye, 0.5 * (target(i) - *eye)));
    let is_clear = |ray: &Ray| {
        let (direction, to_center) = (ray.direction.normalize(), sphere.center - ray.origin);
        let at_rim = to_center.reject_from_normalized(direction).length() / sphere.radius - 1.0;
        at_rim.abs() > 0.01 && direction.dot(normal.normalize()).abs() > 0.1
    };
    rays.filter(is_clear).collect()
}

/// The lines of the table, from the answers of one kit.
fn lines(kit: &dyn Kit, (sphere, point, normal, eye): &Place) -> String {
    let rays = fan(&(*sphere, *point, *normal, *eye));
    let of_sphere: Vec<SphereQuery> = rays.iter().map(|&ray| SphereQuery { ray, sphere: *sphere }).collect();
    let floor = Plane { point: *point, normal: *normal };
    let of_plane: Vec<PlaneQuery> = rays.iter().map(|&ray| PlaneQuery { ray, plane: floor }).collect();
    let equation = PlaneEquation { normal: *normal, d: -normal.dot(*point) };
    let of_equation: Vec<PlaneEquationQuery> =
        rays.iter().map(|&ray| PlaneEquationQuery { ray, plane: equation }).collect();
    let columns = [
        kit.sphere_algebraic(&of_sphere),
        kit.sphere_geometric(&of_sphere),
        kit.plane(&of_plane),
        kit.plane_by_coefficients(&of_equation),
    ];
    // The normal where the ray meets the sphere, turned to the side of the ray.
    let points: Vec<(Sphere, Vec3)> =
        rays.iter().zip(&columns[1]).map(|(ray, t)| (*sphere, ray.at(t.unwrap_or(0.0)))).collect();
    let outwards = kit.sphere_normal(&points).into_iter().zip(&rays);
    let normals = kit.face_forward(&outwards.map(|(out, ray)| (out, ray.direction)).collect::<Vec<_>>());
    let line = |(index, normal): (usize, &Vec3)| {
        let t = |column: usize| columns[column][index].map_or("-".to_owned(), |t| digits(t, 4));
        let normal = match columns[1][index] {
            Some(_) => normal.to_array().map(|x| digits(x, 3)).join(" "),
            None => "-".to_owned(),
        };
        let [algebraic, geometric, plane, coefficients] = [0, 1, 2, 3].map(t);
        format!(
            "{index:>2}  sphere_algebraic {algebraic}  sphere_geometric {geometric}  plane {plane}  \
             plane_by_coefficients {coefficients}  face_forward {normal}"
        )
    };
    normals.iter().enumerate().map(line).collect::<Vec<String>>().join("\n")
}

/// The hits of each method with a sphere and the plane below it.
pub(super) fn hit_table_of_a_sphere_on_a_plane(trial: &Trial<'_>) -> CheckResult {
    let public = (
        Sphere { center: vec3(0.2, 1.1, -0.3), radius: 1.25 },
        vec3(0.0, -0.15, 0.0),
        vec3(0.2, 2.0, -0.1),
        vec3(1.1, 2.3, 6.0),
    );
    let hidden = (nasty::unit(), 0.5..2f32, -1.0..1f32, -0.3..0.3f32).prop_map(|(at, radius, x, tilt)| {
        let sphere = Sphere { center: 2.0 * at, radius };
        let floor = sphere.center - vec3(0.0, 1.25 * radius, 0.0);
        (sphere, floor, vec3(tilt, 1.0, 0.1), sphere.center + radius * vec3(x, 1.5, 5.0))
    });
    let place = trial.composed(public, hidden);
    let input = "rays at a sphere above a floor";
    Table { name: "stage1_hit_table", input }.check(trial, |kit| lines(kit, &place))
}
