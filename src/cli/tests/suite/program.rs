//! Runs the program as its users do.

use super::program_runs::{complaint, has_lines, printed, raykata, root, said};
use raykata::scene::load;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

#[test]
fn every_scene_of_the_kit_renders() {
    let folder = std::fs::read_dir(root().join("scenes")).expect("the folder scenes/");
    let mut files: Vec<PathBuf> = folder.map(|entry| entry.expect("an entry").path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "toml"));
    assert!(files.len() >= 10);
    let out = tempfile::tempdir().expect("a folder");
    for file in files {
        load::load(&file).unwrap_or_else(|error| panic!("{error}"));
        let picture = out.path().join("picture.png");
        let said = said(&format!("render {} --size 48x30 --out {}", file.display(), picture.display()));
        assert!(said.contains("primary rays") && !said.contains("NaN"), "{said}");
        std::fs::remove_file(picture).expect("a picture was written");
    }
}

#[test]
fn each_kind_of_picture_is_written_and_others_are_refused() {
    let out = tempfile::tempdir().expect("a folder");
    for (name, magic) in [("a.png", &b"\x89PNG"[..]), ("a.hdr", b"#?RADIANCE")] {
        let picture = out.path().join(name);
        said(&format!("render scenes/gamma.toml --size 9x7 --out {}", picture.display()));
        assert!(std::fs::read(&picture).expect("a picture").starts_with(magic), "{name}");
    }
    // OpenEXR takes longer to build than all other formats together, so it is built only with the feature `exr`.
    let picture = out.path().join("a.exr");
    let output = raykata(&format!("render scenes/gamma.toml --size 9x7 --out {}", picture.display()));
    let refused = printed(&output).1;
    match std::fs::read(&picture) {
        Ok(bytes) => assert!(bytes.starts_with(b"\x76\x2f\x31\x01")),
        Err(_) => assert!(refused.contains("cargo run --features exr -- render"), "{refused}"),
    }
    let unknown = complaint("render scenes/gamma.toml --out picture.jpg", 1);
    assert!(unknown.contains("let it end in .png, .hdr or .exr"), "{unknown}");
}

#[test]
fn a_mistake_in_a_scene_is_drawn_and_nothing_is_written() {
    let out = tempfile::tempdir().expect("a folder");
    let file = out.path().join("typo.toml");
    std::fs::write(&file, "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n\n[fil]\nwidth = 3\n")
        .expect("written");
    let picture = out.path().join("a.png");
    let drawn = complaint(&format!("render {} --out {}", file.display(), picture.display()), 1);
    has_lines(&drawn, &["unknown key `fil`", "did you mean `film`?", "typo.toml:5:2", "5 | [fil]"]);
    assert!(!picture.exists());
    let missing = complaint("render scenes/showcas.toml", 1);
    assert!(missing.contains("showcase.toml"), "{missing}");
}

#[test]
fn the_reference_has_all_points() {
    let said = said("check --kit solutions");
    assert!(said.trim_end().ends_with("passed, 0 failed"), "{said}");
}

#[test]
fn one_stage_can_be_checked_and_a_stage_that_is_not_there_is_reported() {
    let one = said("check 1 --kit solutions");
    assert!(one.contains("stage  1 ·") && !one.contains("stage  2 ·"), "{one}");
    assert_eq!(one, said("check stage1 --kit solutions"));
    // The stage is done: its picture is in the album, and the next stage begins.
    let (_, finish) = one.split_once("\nStage 1 is done.\n").expect("the finish of the stage");
    let words = finish.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.starts_with("10 primitives, ") && words.contains(" primary rays and "), "{words}");
    let next = "Next: stage 2 · triangles. Read slides/stage02.md, then write";
    has_lines(&words, &["kept in out/album/stage1.png.", next]);
    assert!(!finish.contains('\u{1b}'), "a file gets no half blocks: {finish}");
    let picture = std::fs::read(root().join("out/album/stage1.png")).expect("a picture");
    assert!(picture.starts_with(b"\x89PNG"));
    for wrong in ["77", "0", "stage13", "one"] {
        for command in ["check", "list"] {
            let refused = complaint(&format!("{command} {wrong}"), 2);
            assert!(
                refused.contains("there are stages 1 to 12") && !refused.contains("building"),
                "{refused}"
            );
        }
    }
}

#[test]
fn one_pixel_of_the_picture_of_a_check_is_asked_for_again() {
    let check = "check --kit solutions picture_of_a_sphere_on_a_plane --pixel";
    let said = said(&format!("{check} 40,30"));
    for part in [
        "column 40, row 30",
        "the ray   &Ray::new(vec3(2.0,",
        "  sphere_geometric\n    input   SphereQuery {",
        "(the golden picture)",
    ] {
        assert!(said.contains(part), "no `{part}` in\n{said}");
    }
    let other = |name: &str| format!("check --kit solutions {name} --pixel 4,4");
    for (line, code, part) in [
        (format!("{check} 80,30"), 1, "has 80 columns and 60 rows"),
        (format!("{check} 4"), 1, "its column and its row, such as 12,7"),
        (other("sphere_on_a_plane"), 1, "_of_a_sphere_on_a_plane, picture_of_a_sphere_on_a_plane?"),
        (other("plane_hits"), 1, "there is no check `plane_hits`"),
        (other(""), 2, "needs the name of a check"),
    ] {
        let complaint = complaint(&line, code);
        assert!(complaint.contains(part), "{line}: {complaint}");
    }
}

#[test]
fn checks_are_listed_by_stage() {
    let (all, one) = (said("list"), said("list 3"));
    assert!(all.contains(&one) && one.contains("picture_of_depth") && !one.contains("nearest_root"), "{one}");
    assert_eq!(one, said("list stage3"));
}

/// The reader closes the pipe, as in `raykata list | head -1`.
#[test]
fn a_reader_that_goes_away_is_no_panic() {
    for arguments in [&["list"][..], &["hint", "picture_of_depth"], &["render", "--help"]] {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_raykata"));
        let command = command.current_dir(root()).args(arguments).stderr(std::process::Stdio::piped());
        let (reader, writer) = std::io::pipe().expect("a pipe");
        drop(reader);
        let output = command.stdout(writer).output().expect("the program starts");
        assert!(output.status.success() && output.stderr.is_empty(), "{}", printed(&output).1);
    }
}

#[test]
fn a_worker_that_is_up_to_date_is_not_mentioned() {
    let tree = || raykata("tree scenes/stage1.toml --pixel 1,1");
    assert!(tree().status.success());
    // Other tests run cargo at the same time, which prints a line if it has to wait.
    let said: Vec<String> =
        (0..100).map(|_| printed(&tree()).1).take_while(|said| !said.is_empty()).collect();
    assert!(said.len() < 100, "{}", said.concat());
}

#[test]
#[cfg(target_os = "linux")]
fn a_killed_render_ends_its_worker() {
    let file = |name: String| std::fs::read_to_string(format!("/proc/{name}")).unwrap_or_default();
    let is_worker = |process: &str| file(format!("{process}/comm")).starts_with("solutions-frame");
    let out = tempfile::tempdir().expect("a folder");
    for signal in ["-TERM", "-KILL"] {
        let line =
            format!("render scenes/cornell.toml --size 4000x4000 --out {}/a.png", out.path().display());
        let mut render = Command::new(env!("CARGO_BIN_EXE_raykata"));
        let mut render = render.current_dir(root()).args(line.split(' ')).spawn().expect("it starts");
        let id = render.id().to_string();
        let begin = Instant::now();
        let worker = loop {
            let children = file(format!("{id}/task/{id}/children"));
            match children.split_whitespace().find(|child| is_worker(child)) {
                Some(worker) => break worker.to_owned(),
                None => assert!(begin.elapsed() < Duration::from_secs(300), "no worker is started"),
            }
        };
        assert!(Command::new("kill").args([signal, &id]).status().expect("`kill` starts").success());
        render.wait().expect("it ends");
        let begin = Instant::now();
        while is_worker(&worker) {
            assert!(begin.elapsed() < Duration::from_secs(60), "{signal}: the worker goes on");
        }
    }
}

#[test]
fn hints_come_in_three_steps_and_near_names_are_suggested() {
    let name = "triangle_cramer_agrees_with_double_precision";
    let hints = [1, 2, 3].map(|level| said(&format!("hint {name} {level}")));
    assert!(hints[0] != hints[1] && hints[1] != hints[2] && hints[0].contains("hint triangle_cramer"));
    assert!(complaint("hint triangle_cramer_agree", 1).contains(name));
}

#[test]
fn the_command_line_says_when_it_does_not_understand() {
    for line in ["rendr", "render scenes/gamma.toml --size 0x9", "hint anything 4"] {
        complaint(line, 2);
    }
    assert!(said("--help").contains("Exit codes"));
}

#[test]
fn the_rays_behind_a_pixel_are_a_tree_in_three_formats() {
    let tree = |format: &str| said(&format!("tree scenes/stage5.toml --pixel 430,240 --format {format}"));
    let text = tree("text");
    checks::golden::compare("tree_of_a_pixel", "raykata tree scenes/stage5.toml --pixel 430,240", &text)
        .unwrap_or_else(|broken| panic!("{broken:?}"));
    let rays: serde_json::Value = serde_json::from_str(&tree("json")).expect("JSON");
    let rays = rays.as_array().expect("a list");
    assert_eq!(rays.len(), text.lines().count());
    assert_eq!(rays.iter().filter(|ray| ray["parent"].is_null()).count(), 1);
    let dot = tree("dot");
    assert_eq!(dot.matches(" -> ").count(), rays.len() - 1);
    let outside = complaint("tree scenes/stage5.toml --pixel 640,0", 1);
    assert!(outside.contains("there is no pixel 640,0: columns go from 0 to 639"));
}

#[test]
fn a_strip_shows_one_picture_a_depth() {
    let out = tempfile::tempdir().expect("a folder");
    let file = out.path().join("strip.png");
    let said = said(&format!("strip scenes/heckbert.toml --depths 0,1,3 --out {}", file.display()));
    assert_eq!(said.lines().count(), 5, "{said}");
    let picture = std::fs::read(&file).expect("a picture");
    // Width and height follow the first 16 bytes of a PNG.
    let number =
        |at: usize| u32::from_be_bytes([picture[at], picture[at + 1], picture[at + 2], picture[at + 3]]);
    // A caption of 24 rows is below each picture.
    assert_eq!((number(16), number(20)), (3 * 32 + 2 * 4, 32 + 24));
    // With stages, the animated file beside the strip has a chunk that counts its frames.
    self::said(&format!("strip scenes/heckbert.toml --stages --out {}", file.display()));
    let animated = std::fs::read(out.path().join("strip-animated.png")).expect("a picture");
    assert!(animated.windows(8).any(|bytes| bytes == b"acTL\0\0\0\x0c"), "twelve frames");
}

#[test]
fn exposure_and_tone_curve_change_png_files_and_no_others() {
    let out = tempfile::tempdir().expect("a folder");
    let render = |name: &str, more: &str| {
        let file = out.path().join(name);
        said(&format!("render scenes/stage4.toml --size 24x18 --out {} {more}", file.display()));
        std::fs::read(&file).expect("a picture")
    };
    let plain = render("plain.png", "");
    assert_eq!(render("clamp.png", "--tone clamp --exposure 0"), plain);
    assert_ne!(render("stop.png", "--exposure -1.5"), plain);
    assert_ne!(render("aces.png", "--tone aces"), plain);
    let all = "--tone reinhard --exposure 2";
    assert_eq!(render("all.hdr", all), render("plain.hdr", ""));
    // Normals are no light.
    assert_eq!(render("all.png", &format!("--normals {all}")), render("normals.png", "--normals"));
    let refused = complaint("render scenes/stage4.toml --exposure bright", 2);
    assert!(refused.contains("an exposure is a number of stops from -100 to 100"));
}

#[test]
fn light_that_is_seen_and_filtered_images_are_explained() {
    let explain = |scene: &str| said(&format!("explain {scene} --size 24x15 --spp 1 --rounds 1"));
    let said = explain("scenes/visible_lights.toml");
    has_lines(
        &said,
        &[
            "  emission        `neon` (neon tube); costs no ray",
            "  visible lights  light 1 (sphere), light 2 (disk), light 3 (rectangle); costs",
            "  background      vertical gradient; costs no ray",
        ],
    );
    let said = explain("scenes/tiles.toml");
    has_lines(&said, &["  texture filter  mip levels, 1 to 32 image reads per hit; costs no ray"]);
    assert!(!said.contains("  emission"), "{said}");
}

#[test]
fn a_scene_is_explained_and_predictions_hold() {
    let said = said("explain scenes/effects.toml --size 24x15 --spp 2 --rounds 1");
    has_lines(
        &said,
        &[
            "  shadows         light 1 (rectangle), light 2 (point)",
            "  mirrors         `mirror` (mirror ball), `brushed` (brass ball)",
            "  glossy          `brushed` (brass ball)",
            "  lens            camera: aperture 0.12, focal distance 7",
            "  motion          toy ball",
            "  indirect light  [environment] does not request it",
            "noise             the pixels deviate by ",
            // Two samples of the area light and one of the point light, and two glossy rays.
            "  `brushed`                                3            2            0",
        ],
    );
    // 24 × 15 pixels with 2 samples each: predicted and counted.
    let primary =
        said.lines().find(|line| line.contains("from the camera")).expect("a line about the camera");
    assert_eq!(primary.split_whitespace().filter(|&word| word == "720").count(), 2, "{primary}");
}

#[test]
fn indirect_light_is_explained_and_its_rays_stay_below_the_prediction() {
    let said = said("explain scenes/cornell.toml --size 20x20 --spp 2 --rounds 1");
    has_lines(
        &said,
        &[
            "  indirect light  [environment]: indirect_light",
            "  sampled lights  `light` (light in the ceiling)",
            "depth             the largest diffuse reflectance is",
        ],
    );
    // 800 paths with at most 12 bounces each: 800 × (1 + 12) rays are predicted.
    let all = said.lines().find(|line| line.contains("of all paths")).expect("a line about all paths");
    let numbers: Vec<u64> =
        all.split_whitespace().filter_map(|word| word.replace(',', "").parse().ok()).collect();
    let [predicted, counted] = numbers[..] else { panic!("{all}") };
    assert_eq!(predicted, 10_400, "{said}");
    assert!((800..predicted).contains(&counted), "{said}");
}

#[test]
fn every_set_of_effects_has_its_line() {
    let said = said("explain scenes/stage5.toml --size 24x15 --spp 1 --subsets");
    // Shadows, mirrors and transmission give eight sets, each with the same number of camera rays.
    let of_camera = |line: &&str| line.split_whitespace().nth(1) == Some("360");
    assert_eq!(said.lines().filter(of_camera).count(), 8, "{said}");
}
