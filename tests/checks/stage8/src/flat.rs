//! Pitfalls of the formulas for flat shapes.

use super::hard::{judge_cases, of};
use super::solids::{agrees_flat, input};
use checks::prelude::*;
use oracle::splitmix::Random;
use raykata::shape::{Disk, Polygon};

pub(super) fn disk_agrees_with_exact_arithmetic(trial: &Trial<'_>) -> CheckResult {
    agrees_flat::<Disk>(trial)?;
    // Test the rim, which the general laws leave out, at points whose distance from the centre is a whole number.
    let coin = Disk { center: Vec3::ZERO, normal: 2.0 * Vec3::Z, radius: 5.0 };
    let down = |x: f32, y: f32| of(&coin)(vec3(x, y, 3.0), Vec3::NEG_Z);
    let rim = "you lose rays at the rim, which belongs to the disk: compare with <= instead of <";
    let cases = [
        (down(5.0, 0.0), Some(3.0), rim),
        (down(3.0, -4.0), Some(3.0), rim),
        (down(-4.0, 3.0), Some(3.0), rim),
        (down(3.0, 2.0), Some(3.0), ""),
        (down(5.25, 0.0), None, ""),
    ];
    judge_cases(trial, &cases)
}

const IN_A_LINE: &str = "you lose polygons with three corners on a line: sum the normal over all edges";

/// Rays at edges and corners, and at an edge that two polygons share.
pub(super) fn polygon_at_edges_and_corners(trial: &Trial<'_>) -> CheckResult {
    let square = Polygon {
        corners: vec![vec3(0.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0), vec3(2.0, 2.0, 0.0), vec3(0.0, 2.0, 0.0)],
    };
    let turned = Polygon { corners: square.corners.iter().rev().copied().collect() };
    let in_a_line = Polygon {
        corners: vec![vec3(0.0, 0.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(2.0, 0.0, 0.0), vec3(1.0, 2.0, 0.0)],
    };
    let mut straight_first = in_a_line.clone();
    straight_first.corners.rotate_left(1);
    let down = |polygon: &Polygon, x: f32, y: f32| of(polygon)(vec3(x, y, 3.0), Vec3::NEG_Z);
    let closed = "you lose rays exactly at edges or corners, which belong to the polygon: compare with <= instead of <";
    let diagonal = "you lose a ray on a diagonal of the fan: diagonals lie inside the polygon";
    // The ray starts on an edge and meets the plane only there, so its range must include t = 0.
    let on_an_edge = SolidQuery {
        ray: Ray::new(vec3(1.0, 0.0, 0.0), Vec3::NEG_Z).with_range(-1.0, 1.0),
        solid: square.clone(),
    };
    let normalized = "you lose rays that start on the line of an edge: the plane through both has the normal 0, so it must \
        not be normalized or excluded";
    let in_plane = "you return a hit for a ray in the plane of the polygon: it does not hit it";
    let winding = "you lose polygons whose corners run clockwise as the ray sees them: the order of the corners must not \
        matter, because a ray can hit a polygon from both sides";
    // Students who lose diagonals may lose edges as well, so test diagonals first.
    let cases = [
        (down(&square, 1.0, 1.0), Some(3.0), diagonal),
        (down(&square, 0.25, 0.25), Some(3.0), diagonal),
        (down(&square, 0.5, 1.5), Some(3.0), ""),
    ];
    judge_cases(trial, &cases)?;
    let cases = [
        (down(&square, 0.5, 1.5), Some(3.0), ""),
        (down(&square, 0.0, 0.0), Some(3.0), closed),
        (down(&square, 2.0, 1.0), Some(3.0), closed),
        (down(&turned, 0.0, 0.0), Some(3.0), closed),
        (down(&turned, 2.0, 1.0), Some(3.0), closed),
        (down(&square, 2.25, 1.0), None, ""),
        (
            down(&square, 2.0 + 2f32.powi(-13), 1.0),
            None,
            "you hit the polygon with rays that pass just beside an edge: do not widen it by an epsilon",
        ),
        (down(&turned, 0.5, 1.5), Some(3.0), winding),
        (down(&turned, 1.5, 0.25), Some(3.0), winding),
        (down(&in_a_line, 1.0, 0.5), Some(3.0), IN_A_LINE),
        (down(&in_a_line, 0.75, 0.75), Some(3.0), IN_A_LINE),
        (down(&in_a_line, 1.75, 1.0), None, ""),
        (down(&straight_first, 0.75, 0.75), Some(3.0), IN_A_LINE),
        (of(&square)(vec3(-1.0, 1.0, 0.0), Vec3::X), None, in_plane),
        (of(&square)(vec3(1.0, 1.0, 0.0), vec3(1.0, 2.0, -0.0)), None, in_plane),
    ];
    judge_cases(trial, &cases)?;
    judge_cases(trial, &[(on_an_edge, Some(0.0), normalized), (down(&square, 0.5, 1.5), Some(3.0), "")])?;
    // Two polygons share an edge far from the origin, and no ray may pass between them. The coordinates have few bits, so
    // that the four corners lie exactly in a plane; points on the edge between its ends need more bits.
    let place = vec3(1483.0, 12.0, -2234.0);
    let (a, b, e) =
        (place + vec3(0.125, 0.25, 0.0), place + vec3(1.25, -0.375, 0.125), place + vec3(2.875, 0.125, 0.25));
    let edge = vec3(1639.0, 6143.0, 3277.0) / 4096.0;
    let (c, d) = (b + edge, a + edge);
    let (left, right) = (Polygon { corners: vec![a, b, c, d] }, Polygon { corners: vec![b, e, c] });
    let mut random = Random::new(trial.seed, 9);
    let rays: Vec<Ray> = (0..3000)
        .map(|_| {
            let origin = place + vec3(0.0, 0.0, 4.0) + random.in_cube();
            Ray::new(origin, b.lerp(c, 0.05 + 0.9 * random.unit()) - origin)
        })
        .collect();
    let queries = |polygon: &Polygon| -> Vec<SolidQuery<Polygon>> {
        rays.iter().map(|ray| SolidQuery { ray: *ray, solid: polygon.clone() }).collect()
    };
    let (left, right) = (queries(&left), queries(&right));
    let pairs: Vec<_> = trial.kit.polygon(&left).into_iter().zip(trial.kit.polygon(&right)).collect();
    let outcomes = compare(&left, pairs, |query, answers| match answers {
        (None, None) => Err(Broken::with_texts(
            format!("{}\nand its neighbour at the edge", input(query)),
            "None, twice",
            "a hit of at least one of them",
            "they share the edge",
        )),
        _ => Ok(()),
    });
    // The share of the rays that pass between the polygons shows whether rounding decides, or the edge is left out.
    let n_lost = outcomes.iter().filter(|outcome| outcome.is_err()).count();
    let by_rounding = n_lost < outcomes.len() * 9 / 10;
    all_hold(outcomes).map_err(|broken| {
        broken.explained_by([
            "you lose some rays at an edge that two polygons share: a rounded point on the plane can lie between the two, so test on which side of each edge the ray passes"
                .when(by_rounding),
            (!by_rounding, "you lose rays at an edge that two polygons share: edges belong to both"),
        ])
    })
}
