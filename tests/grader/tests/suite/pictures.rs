//! Small pictures of the scenes of the kit, bit by bit, with what they cost: whoever changes one, looks at it and blesses it
//! with `INSTA_UPDATE=always cargo test -p grader --test suite pictures`.

use grader::kits::{Need, Source, Which};
use grader::pictures::Scenes;
use std::path::Path;

#[test]
fn every_scene_looks_and_costs_as_before() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let reference = Source::prepare(&root, Which::Solutions, Need::Frames).expect("it builds").fresh();
    let scenes = Scenes::read(&root, &*reference).unwrap_or_else(|error| panic!("{error:#}"));
    let shown = scenes.shown_by(&*reference);
    assert!(shown.iter().all(|one| one.pixels.is_ok()));
    let text: String = shown.iter().map(|one| format!("{one}\n")).collect();
    // Sines and powers are those of the system, so the last bits are known on one kind of machine only.
    let exact = cfg!(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu"));
    if exact {
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(root.join("tests/golden"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.bind(|| insta::assert_snapshot!("pictures", text));
    }
    assert_eq!(shown, scenes.shown_by(&*reference), "the same again is the same");
}
