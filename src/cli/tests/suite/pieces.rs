//! Pieces of a picture, as users render and merge them.

use super::program_runs::{complaint, kill_when, root, said};
use raykata_cli::lock::Lock;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Renders a scene with these options, and returns what was printed.
#[track_caller]
fn render(scene: &str, more: &str, out: &Path) -> String {
    said(&format!("render {scene} --size 60x50 --spp 2 --out {} {more}", out.display()))
}

/// The command that merges pieces.
fn merge(pieces: &[PathBuf], out: &Path) -> String {
    let pieces: Vec<String> = pieces.iter().map(|piece| piece.display().to_string()).collect();
    format!("merge-picture --out {} {}", out.display(), pieces.join(" "))
}

/// The lines of a report that state counts.
fn counts(report: &str) -> Vec<&str> {
    let is_count = |line: &&str| {
        ["rays", "hits", "numbers", "reads", "visits", "tests"].iter().any(|word| line.contains(word))
    };
    report.lines().filter(is_count).filter(|line| !line.contains("per ray")).collect()
}

#[test]
fn merged_pieces_are_the_file_and_the_counts_of_the_whole_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    // One scene is encoded with sRGB and a tone curve, the other with gamma 2, which is an exercise.
    for (scene, more) in [("scenes/showcase.toml", "--tone aces"), ("scenes/gamma.toml", "")] {
        let whole = render(scene, more, &at("whole.png"));
        render(scene, more, &at("whole.hdr"));
        for division in [&["0..50"][..], &["0..16", "16..50"], &["32..48", "0..16", "48..50", "16..32"]] {
            let pieces: Vec<PathBuf> = division.iter().map(|rows| at(&format!("{rows}.piece"))).collect();
            for (rows, piece) in division.iter().zip(&pieces) {
                let said = render(scene, &format!("{more} --rows {rows}"), piece);
                assert!(said.contains(&format!("rows {rows} of 60 × 50 pixels")), "{said}");
            }
            for ending in ["png", "hdr"] {
                let merged = at("merged").with_extension(ending);
                let said = said(&merge(&pieces, &merged));
                let [ours, theirs] = [&merged, &at("whole").with_extension(ending)]
                    .map(|file| std::fs::read(file).expect("a picture"));
                assert!(ours == theirs, "{scene} in {division:?}: another .{ending} file");
                assert_eq!(counts(&said), counts(&whole), "{scene} in {division:?}");
            }
        }
    }
}

#[test]
fn pieces_that_make_no_picture_are_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let scene = "scenes/gamma.toml";
    render(scene, "--rows 0..16", &at("a.piece"));
    render(scene, "--rows 32..50", &at("c.piece"));
    render(scene, "--rows 16..32 --seed 4", &at("b.piece"));
    let merged = at("merged.png");
    let gap = complaint(&merge(&[at("a.piece"), at("c.piece")], &merged), 1);
    assert!(gap.contains("rows 16..32 are missing"), "{gap}");
    let other = complaint(&merge(&[at("a.piece"), at("b.piece"), at("c.piece")], &merged), 1);
    assert!(other.contains("b.piece is a piece of another picture than"), "{other}");
    assert!(other.contains("seed 4 instead of 0"), "{other}");
    assert!(!merged.exists());
    for (words, part) in [
        ("--rows 5..20", "multiples of 16 or at the last row, as 0..32"),
        ("--rows 0..64", "the picture has 50 rows"),
        ("--rows 0..16 --out a.png", "with --rows the file must end in .piece"),
        ("--out a.piece", "give them by --rows"),
    ] {
        let complaint = complaint(&format!("render {scene} --size 60x50 {words}"), 1);
        assert!(complaint.contains(part), "{words}: {complaint}");
    }
    let complaint = complaint(&format!("render {scene} --rows 0-16"), 2);
    assert!(complaint.contains("rows are written as 0..32"), "{complaint}");
}

/// The names of the finished pieces in a folder.
fn finished(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
    names.filter(|name| name.ends_with(".piece") && !name.starts_with('.')).collect()
}

#[test]
fn a_render_in_pieces_that_is_killed_continues_and_gives_the_same_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let scene = "scenes/showcase.toml";
    let whole = render(scene, "", &at("whole.png"));
    let pieces = at("killed.pieces");
    let killed = at("killed.png");
    let line = format!("render {scene} --size 60x50 --spp 2 --out {} --pieces 4", killed.display());
    // Kill the run as soon as the first piece is there.
    let mut run = Command::new(env!("CARGO_BIN_EXE_raykata"));
    run.current_dir(root()).args(line.split(' ')).stdout(Stdio::null()).stderr(Stdio::null());
    kill_when(&mut run.spawn().expect("the program starts"), || !finished(&pieces).is_empty());
    assert!(!killed.exists(), "the run ended before it was killed");
    // A piece that was cut off is rendered again.
    let kept = finished(&pieces);
    assert!(!kept.is_empty());
    fs::write(pieces.join("48-50.piece"), "raykata piece 1\n{").expect("written");
    // Another run on the same folder is refused.
    let lock = Lock::on(&pieces).expect("a lock");
    let complaint = complaint(&line, 1);
    assert!(complaint.contains("another run is writing to"), "{complaint}");
    drop(lock);
    let said = said(&line);
    assert!(said.contains("of 4 pieces were rendered before"), "{said}");
    assert_eq!(counts(&said), counts(&whole));
    assert!(fs::read(&killed).expect("a picture") == fs::read(at("whole.png")).expect("a picture"));
    assert!(!pieces.exists());
}
