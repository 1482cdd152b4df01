//! Compares small pictures of the kit's scenes bit by bit, with their cost. If your change is meant to alter a picture,
//! look at the picture and accept it with `INSTA_UPDATE=always cargo test -p author --test suite pictures`.

use super::program_runs::root;
use author::pictures::Scenes;
use grader::kits::{Need, Source, Which};

#[test]
fn every_scene_looks_and_costs_as_before() {
    let root = root();
    let reference = Source::prepare(&root, Which::Solutions, Need::Frames).expect("it builds").fresh();
    let scenes = Scenes::read(&root, &*reference).unwrap_or_else(|error| panic!("{error:#}"));
    let shown = scenes.shown_by(&*reference);
    assert!(shown.iter().all(|one| one.pixels.is_ok()));
    let text: String = shown.iter().map(|one| format!("{one}\n")).collect();
    // The system computes sines and powers, so the last bits are reproducible on one kind of machine only.
    let exact = cfg!(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu"));
    if exact {
        let mut settings = insta::Settings::clone_current();
        settings.set_snapshot_path(root.join("tests/golden"));
        settings.set_prepend_module_to_snapshot(false);
        settings.set_omit_expression(true);
        settings.bind(|| insta::assert_snapshot!("pictures", text));
    }
    assert_eq!(shown, scenes.shown_by(&*reference), "a second run gives the same result");
}
