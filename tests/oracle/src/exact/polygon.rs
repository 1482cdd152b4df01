//! Ray and closed convex polygon, as the fan of triangles around its first corner. Corners in `f32` seldom
//! lie exactly in one plane, so a polygon is defined as its fan here, and the diagonals of the fan belong to
//! the inside.

use super::body::Body;
use super::{Contact, Meeting, Tier, meet, triangle, verdict_with};
use raykata::ray::Ray;
use raykata::shape::{Polygon, Triangle};

/// The triangles of the fan.
pub fn fan(polygon: &Polygon) -> Vec<Triangle> {
    let corners = &polygon.corners;
    let pairs = corners.windows(2).skip(1);
    pairs.map(|pair| Triangle { a: corners[0], b: pair[0], c: pair[1] }).collect()
}

/// How and where the ray meets the polygon first, and the triangle of the fan that says so (the first of several).
/// `None` for corners or rays that are not finite.
pub fn meet_fan(ray: &Ray, polygon: &Polygon) -> Option<(Meeting, Option<usize>)> {
    let triangles = fan(polygon);
    if !polygon.corners.iter().all(|corner| corner.is_finite()) || !super::is_ray_finite(ray) {
        return None;
    }
    let ties = triangle::tie_set(ray, &triangles);
    let Some(&index) = ties.first() else {
        return Some((Meeting { verdict: Contact::Out, t: None }, None));
    };
    let t = meet(ray, Body::Triangle(triangles[index]))?.t;
    // Inside means inside one triangle, or on a shared diagonal but not at its ends, which are corners.
    let inside_one =
        |&tie: &usize| verdict_with(Tier::Auto, ray, Body::Triangle(triangles[tie])) == Some(Contact::In);
    let on_diagonal = || match ties[..] {
        [first, second] => second == first + 1 && triangle::is_within_edge(ray, &triangles[first]),
        _ => false,
    };
    let inside = ties.iter().any(inside_one) || on_diagonal();
    Some((Meeting { verdict: if inside { Contact::In } else { Contact::On }, t }, Some(index)))
}
