//! Divides the points of a stage among its checks.

/// Divides `total` points in proportion to the weights, by the method of Huntington and Hill: each weight above 0 gets at
/// least one point, and the sum is exact. If the total is the sum of the weights, each gets its weight.
///
/// The total must be at least the number of weights above 0, or there must be none.
pub(super) fn divide(total: u32, weights: &[u32]) -> Vec<u32> {
    let mut points: Vec<u32> = weights.iter().map(|&weight| u32::from(weight > 0)).collect();
    let given: u32 = points.iter().sum();
    for _ in given..total {
        // The next point goes to the weight w with p points for which w²/(p(p + 1)) is greatest, and to the first of equals.
        let claim = |place: usize| (u128::from(weights[place]).pow(2), u128::from(points[place]));
        let stronger = |best: Option<usize>, place: usize| {
            let Some(best) = best else { return Some(place) };
            let ((w, p), (best_w, best_p)) = (claim(place), claim(best));
            let is_stronger = w * best_p * (best_p + 1) > best_w * p * (p + 1);
            Some(if is_stronger { place } else { best })
        };
        let Some(next) = (0..weights.len()).filter(|&place| weights[place] > 0).fold(None, stronger) else {
            break;
        };
        points[next] += 1;
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_divided_exactly_and_each_check_keeps_one() {
        assert_eq!(divide(6, &[3, 2, 1]), [3, 2, 1]);
        assert_eq!(divide(12, &[3, 2, 1]), [6, 4, 2]);
        assert_eq!(divide(3, &[30, 2, 1]), [1, 1, 1]);
        assert_eq!(divide(10, &[5, 0, 5]), [5, 0, 5]);
        assert_eq!(divide(3, &[1, 1]), [2, 1]);
        assert_eq!(divide(7, &[0, 0]), [0, 0]);
        for total in 5..200 {
            let points = divide(total, &[13, 1, 4, 4, 2]);
            assert_eq!(points.iter().sum::<u32>(), total);
            assert!(points.iter().all(|&points| points > 0) && points[2].abs_diff(points[3]) <= 1);
        }
    }
}
