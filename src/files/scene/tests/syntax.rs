//! Text that is invalid TOML, or TOML that is not a scene.

use super::{CAMERA, check_refused, check_refused_with, scene, scene_with};
use crate::files::scene::load;
use std::path::Path;

#[test]
fn windows_writes_scenes_too() {
    let unix = format!("{CAMERA}[environment]\nambient = 1\n");
    let windows = format!("\u{feff}{}", unix.replace('\n', "\r\n"));
    assert_eq!(scene(&windows), scene(&unix));
    // A byte order mark does not count as a column.
    check_refused("\u{feff}abmient = 1", &scene_error("abmient = 1"));
}

fn scene_error(text: &str) -> String {
    super::parse(Path::new("s.toml"), text).unwrap_err().to_string()
}

#[test]
fn a_value_that_is_missing_is_named() {
    check_refused_with(
        "[film]\nwidth = \nheight = 3",
        "s.toml:3:9: a value is missing after `=`\nhelp: write it, as in `width = 640`",
    );
}

#[test]
fn numbers_are_of_single_precision() {
    let sound = |number: &str| scene_with(&format!("environment.ambient = {number}")).ambient.x;
    assert_eq!(sound("+1_000"), 1000.0);
    assert_eq!(sound("0xff"), 255.0);
    assert_eq!(sound("3.4028234663852886e38"), f32::MAX);
    assert_eq!(sound("1e-999999999"), 0.0); // 0 even in double precision
}

#[test]
fn nesting_has_a_bottom() {
    for (open, close) in [("[", "]"), ("{ a = ", "}")] {
        let deep = format!("{CAMERA}nodes = {}{}", open.repeat(100_000), close.repeat(100_000));
        assert!(super::parse(Path::new("s.toml"), &deep).is_err());
    }
    let dotted = format!("{CAMERA}{} = 1", vec!["a"; 100_000].join("."));
    assert!(super::parse(Path::new("s.toml"), &dotted).is_err());
}

#[test]
fn a_scene_that_is_not_there_is_missed_by_name() {
    let folder = crate::tests::folder::Folder::new("syntax");
    folder.write("room.toml", CAMERA);
    assert!(load(&folder.path("room.toml")).is_ok());
    let error = load(&folder.path("rom.toml")).unwrap_err();
    assert_eq!(error.message, "there is no such file");
    let path = folder.path("rom.toml");
    assert_eq!(error.help, Some(format!("looked for {}; did you mean `room.toml`?", path.display())));

    folder.write("latin1.toml", b"# R\xf6ntgen");
    let error = load(&folder.path("latin1.toml")).unwrap_err();
    assert_eq!((error.place, error.message.as_str()), (Some((1, 4)), "the file is not text in UTF-8"));
    assert!(load(&folder.path("")).is_err());
}
