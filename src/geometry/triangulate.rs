//! Cuts polygons into triangles: convex ones into a fan around their first corner, concave ones by ear clipping
//! (crate `earcut`).

use earcut::Earcut;
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// The smallest angle, in radians, that counts as a turn: corners that were written with five digits are that
/// far off a straight edge.
const STRAIGHT: f64 = 1e-5;

/// How much the areas of the triangles may differ from that of the polygon, relative to the latter, if its outline does
/// not cross itself: the corners of a face are rounded, and not exactly in one plane.
const AREA_TOLERANCE: f64 = 1e-3;

/// How a polygon is cut into triangles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Cut {
    /// As a fan around the first corner, because the polygon is convex or has no area.
    Fan,
    /// Into these triangles, two fewer than there are corners. Each names its corners by their position in the
    /// outline, in ascending order; so it has the orientation of the polygon.
    Triangles(Vec<[usize; 3]>),
    /// As a fan, which is only a guess: the outline crosses itself, so it encloses no polygon.
    Crossed,
}

/// The triangles of a fan around the first of `count` corners.
pub(crate) fn fan(count: usize) -> impl Iterator<Item = [usize; 3]> {
    (2..count).map(|index| [0, index - 1, index])
}

/// Decides how the polygon with these corners is cut. Corners may repeat, lie in the middle of a straight edge, and be
/// slightly out of the plane. Fewer than four corners, and corners that are not finite, give [`Cut::Fan`].
pub(crate) fn cut(corners: &[Vec3]) -> Cut {
    if corners.len() < 4 {
        return Cut::Fan;
    }
    let corners: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
    let doubled_area = area_vector(&corners);
    let Some(normal) = doubled_area.try_normalize() else {
        return if is_bow_tie(&corners) { Cut::Crossed } else { Cut::Fan };
    };
    let outline = project(&corners, normal);
    match turns(&outline) {
        Turns::Convex => return Cut::Fan,
        Turns::Several => return Cut::Crossed,
        Turns::Concave => {}
    }

    let mut indices: Vec<u32> = Vec::new();
    Earcut::new().earcut(outline.iter().map(|corner| corner.to_array()), &[], &mut indices);
    let mut triangles: Vec<[usize; 3]> = indices
        .chunks_exact(3)
        .map(|corners| {
            // In the order of the outline, each triangle has the orientation of the polygon.
            let mut triangle = [corners[0] as usize, corners[1] as usize, corners[2] as usize];
            triangle.sort_unstable();
            triangle
        })
        .collect();
    add_straight_corners(&mut triangles, corners.len());

    let signed_area = |&[a, b, c]: &[usize; 3]| (outline[b] - outline[a]).perp_dot(outline[c] - outline[a]);
    let covered: f64 = triangles.iter().map(|triangle| signed_area(triangle).abs()).sum();
    let area = doubled_area.length();
    let complete = triangles.len() == corners.len() - 2;
    match complete && (covered - area).abs() <= AREA_TOLERANCE * area {
        true => Cut::Triangles(triangles),
        false => Cut::Crossed,
    }
}

/// The normal of the polygon, twice as long as its area: the sum over all edges of the parallelograms that
/// they span with the first corner.
pub(crate) fn area_vector(corners: &[DVec3]) -> DVec3 {
    corners.windows(2).map(|edge| (edge[0] - corners[0]).cross(edge[1] - corners[0])).sum()
}

/// Whether a polygon without area has corners that are not on one line: its halves cancel.
fn is_bow_tie(corners: &[DVec3]) -> bool {
    let [first, ..] = corners else { return false };
    let largest = |of: &dyn Fn(&DVec3) -> f64| corners.iter().map(of).fold(0.0, f64::max);
    let size = largest(&|corner| corner.distance(*first));
    let Some(far) = corners.iter().find(|corner| corner.distance(*first) == size) else { return false };
    let off_line = largest(&|corner| (*corner - first).cross(far - first).length());
    off_line > STRAIGHT * size * size
}

/// How an outline turns.
enum Turns {
    /// Always to the same side, and once around.
    Convex,
    /// To both sides.
    Concave,
    /// Always to the same side, but several times around.
    Several,
}

/// How the outline turns, which encloses an area anticlockwise.
fn turns(outline: &[DVec2]) -> Turns {
    let count = outline.len();
    // Repeated corners make edges without a direction, which do not turn.
    let edges: Vec<DVec2> =
        (0..count).filter_map(|i| (outline[(i + 1) % count] - outline[i]).try_normalize()).collect();
    let mut turned = 0.0;
    for (i, edge) in edges.iter().enumerate() {
        let before = edges[(i + edges.len() - 1) % edges.len()];
        let angle = before.perp_dot(*edge).atan2(before.dot(*edge));
        if !(-STRAIGHT..PI - STRAIGHT).contains(&angle) {
            return Turns::Concave;
        }
        turned += angle;
    }
    if turned > 1.5 * TAU { Turns::Several } else { Turns::Convex }
}

/// The corners projected to a plane with this normal, relative to the first one.
fn project(corners: &[DVec3], normal: DVec3) -> Vec<DVec2> {
    let (x, y) = normal.any_orthonormal_pair();
    let in_plane = |offset: DVec3| DVec2::new(offset.dot(x), offset.dot(y));
    corners.iter().map(|corner| in_plane(corner - corners[0])).collect()
}

/// Divides triangles so that each of the `count` corners of the outline is a corner of one. Ear clipping leaves out corners in
/// the middle of a straight edge, and a neighbouring face that uses such a corner would then leave a gap for rays.
fn add_straight_corners(triangles: &mut Vec<[usize; 3]>, count: usize) {
    let mut used = vec![false; count];
    triangles.iter().flatten().for_each(|&corner| used[corner] = true);
    let missing: Vec<usize> = (0..count).filter(|&corner| !used[corner]).collect();
    for corner in missing {
        // The edge that replaces the way over this corner joins the nearest corners in use on both sides.
        let step = |by: usize| (1..count).map(move |n| (corner + n * by) % count);
        let (Some(after), Some(before)) = (step(1).find(|&i| used[i]), step(count - 1).find(|&i| used[i]))
        else {
            return;
        };
        let Some(triangle) = triangles.iter_mut().find(|t| t.contains(&after) && t.contains(&before)) else {
            return;
        };
        let Some(&opposite) = triangle.iter().find(|&&i| i != after && i != before) else { return };
        let sorted = |mut triangle: [usize; 3]| {
            triangle.sort_unstable();
            triangle
        };
        *triangle = sorted([before, corner, opposite]);
        triangles.push(sorted([corner, after, opposite]));
        used[corner] = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(corners: &[[f32; 2]]) -> Vec<Vec3> {
        corners.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect()
    }

    /// Checks that the triangles cover the polygon once, in all rotations and both orientations of its outline.
    #[track_caller]
    fn check_covered(corners: &[[f32; 2]], area: f64) {
        let mut corners = flat(corners);
        for turn in 0..2 * corners.len() {
            corners.rotate_left(1);
            if turn == corners.len() {
                corners.reverse();
            }
            let Cut::Triangles(triangles) = cut(&corners) else {
                panic!("{:?} of {corners:?}", cut(&corners))
            };
            assert_eq!(triangles.len(), corners.len() - 2);
            let exact: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
            let side = area_vector(&exact).normalize();
            let areas = triangles.iter().map(|t| area_vector(&t.map(|i| exact[i])).dot(side) / 2.0);
            assert!(areas.clone().all(|area| area >= -1e-9), "a triangle is turned over: {triangles:?}");
            assert!((areas.sum::<f64>() - area).abs() < 1e-5 * area, "{triangles:?}");
            let used = |corner| triangles.iter().flatten().any(|&i| i == corner);
            assert!((0..corners.len()).all(used), "{triangles:?}");
        }
    }

    #[test]
    fn concave_polygons_are_covered_once() {
        // An arrow; an L; a U with a straight corner; a ring with a bridge; a comb.
        check_covered(&[[0.0, 0.0], [2.0, 0.0], [0.5, 0.5], [0.0, 2.0]], 1.0);
        check_covered(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]], 3.0);
        let u = [
            [0.0, 0.0],
            [1.5, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [2.0, 3.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ];
        check_covered(&u, 7.0);
        let ring = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ];
        check_covered(&ring, 12.0);
    }

    #[test]
    fn convex_polygons_keep_their_fan() {
        assert_eq!(cut(&flat(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])), Cut::Fan);
        assert_eq!(
            cut(&flat(&[[0.0, 0.0], [0.5, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 1.0], [0.0, 1.0]])),
            Cut::Fan
        );
        assert_eq!(cut(&flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]])), Cut::Fan);
        // A square that is bent out of its plane.
        let bent = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.3), Vec3::Y];
        assert_eq!(cut(&bent), Cut::Fan);
        assert_eq!(cut(&[Vec3::NAN; 5]), Cut::Fan);
        assert_eq!(
            cut(&[Vec3::MAX, Vec3::MIN, Vec3::X, Vec3::Y]),
            cut(&[Vec3::MAX, Vec3::MIN, Vec3::X, Vec3::Y])
        );
    }

    #[test]
    fn outlines_that_cross_themselves_are_noticed() {
        let bow_tie = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]];
        let uneven = [[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 1.0]];
        let star = [[0.0, 10.0], [6.0, -8.0], [-10.0, 3.0], [10.0, 3.0], [-6.0, -8.0]];
        for crossed in [&bow_tie[..], &uneven, &star] {
            assert_eq!(cut(&flat(crossed)), Cut::Crossed, "{crossed:?}");
        }
    }
}
