//! A pixel that is asked for again has the colour that the whole picture has there.

use checks::picture::{Replay, Replayed};
use checks::{Inputs, examine, linked};
use std::sync::Arc;

/// The result for a pixel of each check that compares a picture.
fn results(x: u32, y: u32) -> Vec<(&'static str, Replayed)> {
    let checks = all_checks::STAGES.iter().flat_map(|(_, checks)| checks.iter());
    let result = |check: &'static checks::Check| {
        let replay = Arc::new(Replay::new(x, y));
        let inputs = Inputs { pixel: Some(Arc::clone(&replay)), ..Inputs::default() };
        let outcome = examine(check, &linked(solutions::Kit), 0, inputs);
        let result = replay.result()?;
        assert_eq!(outcome, Ok(Ok(())), "{}", check.name);
        Some((check.name, result))
    };
    checks.filter(|check| check.name.starts_with("picture_")).filter_map(result).collect()
}

#[test]
fn a_pixel_alone_has_the_color_of_the_picture() {
    for (x, y) in [(24, 12), (2, 20), (30, 16), (44, 27)] {
        let results = results(x, y);
        assert!(results.len() >= 12, "{results:?}");
        for (check, result) in results {
            assert!(result.expected.is_none() || result.yours.is_some(), "{check} ({x}, {y}): {result:?}");
            // Other samples of a random picture make another colour.
            assert!(result.ray.is_none() || !result.differs(), "{check} ({x}, {y}): {result:?}");
        }
    }
}

#[test]
fn a_pixel_outside_is_not_composed() {
    for (check, result) in results(80, 3) {
        assert_eq!((result.expected, result.yours), (None, None), "{check}");
    }
}
