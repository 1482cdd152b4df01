//! Only what a scene calls for is computed: scenes with something that looks as if it cost time and changes nothing, each
//! with the counts and the pixels of the scene without it. `called_for.txt` has the scenes and explains itself: a case
//! changes the scene above it, `- LINE` removes a line, `+ LINE` adds one in its place, and other lines follow at the end.
//! Behind `~~~` are the changes for the scene without it, if it is not the scene above.

#[path = "../../../src/files/scene/tests/changed.rs"]
mod changed;

use crate::scene::{render, scene};
use changed::changed;
use std::fmt::Write;

#[test]
fn what_changes_nothing_costs_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let white = folder.path().join("white.png");
    image::RgbImage::from_pixel(4, 2, image::Rgb([255; 3])).save(&white).expect("an image");
    let mut wrong = String::new();
    for section in include_str!("called_for.txt").split("=== ").skip(1) {
        let mut parts = section.split("\n## ");
        let base = parts.next().unwrap_or_default();
        let base = base.split_once('\n').map_or("", |(_, base)| base);
        for case in parts {
            let (title, case) = case.split_once('\n').expect("a case has lines");
            let (with, without) = case.split_once("~~~\n").unwrap_or((case, ""));
            let [with, without] = [with, without].map(|changes| {
                let changes: Vec<&str> = changes.lines().collect();
                let text = changed(base, &changes).replace("WHITE.png", &white.display().to_string());
                render(&scene(&text))
            });
            if with.counts != without.counts {
                let _ = writeln!(wrong, "{title}:\n  {:?}\n  {:?}", with.counts, without.counts);
            }
            if with.film.pixels != without.film.pixels {
                let _ = writeln!(wrong, "{title}: other pixels");
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
