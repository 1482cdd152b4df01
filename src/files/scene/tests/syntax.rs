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
fn what_is_not_toml_says_where() {
    check_refused_with("[film\nwidth = 3", "s.toml:2:6: this is not TOML: unclosed table, expected `]`");
    check_refused_with(
        "[film]\nwidth 3",
        "s.toml:3:7: a key has no value\nhelp: write the key, `=` and the value",
    );
    check_refused_with(
        "[film]\nwidth = \nheight = 3",
        "s.toml:3:9: a value is missing after `=`\nhelp: write it, as in `width = 640`",
    );
    check_refused_with(
        "a = [0 0, 0]",
        "s.toml:2:6: `0 0` is not a number\nhelp: put commas between numbers, as in `[0, 1, 5]`",
    );
    check_refused_with(
        "a = 0, 1, 5",
        "s.toml:2:6: the line continues after its value\nhelp: put lists between brackets, as in `[0, 1, 5]`",
    );
    check_refused_with(
        "a = red",
        "s.toml:2:5: `red` has no quotes\nhelp: put text between quotes, as in `\"red\"`",
    );
    check_refused_with(
        "a = .5",
        "s.toml:2:5: a number has no digits on one side of its point\nhelp: write `0.5` and `5.0`",
    );
    check_refused_with(
        "a = 5.",
        "s.toml:2:7: a number has no digits on one side of its point\nhelp: write `0.5` and `5.0`",
    );
    check_refused_with(
        "[film]\nwidth = 3\nwidth = 4",
        "s.toml:4:1: `width` is given twice\nhelp: delete one of the two",
    );
    check_refused_with("[film]\n[film]", "s.toml:3:2: `film` is given twice\nhelp: delete one of the two");
    // Columns count characters, not bytes.
    check_refused_with(
        "materials = { 'é' = { difuse = 1 } }",
        "s.toml:2:23: unknown key `difuse`; did you mean `diffuse`?",
    );
}

#[test]
fn tables_stand_where_they_belong() {
    check_refused_with("fim = { width = 3 }", "s.toml:2:1: unknown key `fim`; did you mean `film`?");
    check_refused_with(
        "weather = 'fine'",
        "s.toml:2:1: unknown key `weather`\nhelp: known names are `color_encoding`, `film`, `camera`, `environment`, \
         `quality`, `materials`, `textures`, `meshes`, `lights`, `nodes`",
    );
    check_refused_with("film = 3", "s.toml:2:8: `film` must be a table, but is 3");
    check_refused_with("materials = 3", "s.toml:2:13: `materials` must be a table, but is 3");
    check_refused_with("[materials]\nred = 1", "s.toml:3:7: `red` must be a table, but is 1");
    check_refused_with(
        "[nodes]",
        "s.toml:2:1: `nodes` must be a list of tables, each under `[[nodes]]`, but is a table",
    );
    check_refused_with("nodes = [3]", "s.toml:2:10: entry 1 of `nodes` must be a table, but is 3");
    check_refused_with(
        "lights = 1979-05-27",
        "s.toml:2:10: `lights` must be a list of tables, each under `[[lights]]`, but is a date",
    );
}

#[test]
fn numbers_are_finite_and_of_single_precision() {
    let ambient = |number: &str, message: &str| {
        check_refused_with(&format!("environment.ambient = {number}"), &format!("s.toml:2:23: {message}"));
    };
    ambient("nan", "`ambient` must be a finite number, but is nan");
    ambient("-inf", "`ambient` must be a finite number, but is -inf");
    ambient("1e999", "`ambient` is 1e999, which is too large: the largest number is 3.4e38");
    ambient("1e39", "`ambient` is 1e39, which is too large: the largest number is 3.4e38");
    ambient("1e-50", "`ambient` is 1e-50, which is too close to zero: the smallest number is 1.4e-45");
    ambient(
        &format!("0x{}", "f".repeat(40)),
        &format!("`ambient` is 0x{}, which is too large: the largest number is 3.4e38", "f".repeat(40)),
    );
    ambient(
        "[1, 2]",
        "`ambient` must be a colour, that is one number, three, or a text such as \"#ff8000\", but has 2",
    );
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
    let folder = super::files::Folder::new("syntax");
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
