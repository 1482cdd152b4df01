//! A full disk is an error, and no result of what was tried on it.

use super::author;
use super::program_runs::{leaves_out_what_takes_long, printed, root, small_disk};

/// A compiler without room fails for any entry, which then must not count as one that does not compile. What the programs write
/// goes to the small disk, over the folder of earlier builds.
#[test]
fn a_full_disk_is_no_result_of_an_entry() {
    if leaves_out_what_takes_long() {
        return;
    }
    let program = env!("CARGO_BIN_EXE_author");
    let entry = "right/stage4/specular_double";
    let before = author(&["corpus", entry, "--jobs", "1"]);
    assert!(before.status.success(), "{}", printed(&before).1);
    let folder = tempfile::tempdir().unwrap();
    let (disk, corpus) = (folder.path().display(), root().join("target/corpus"));
    let corpus = corpus.display();
    let script = format!(
        "mount -t tmpfs -o size=6m tmpfs {disk}\n\
         mkdir {disk}/upper {disk}/work\n\
         mount -t overlay -o lowerdir={corpus},upperdir={disk}/upper,workdir={disk}/work overlay {corpus}\n\
         {program} corpus {entry} --jobs 1 && echo 'ended well' || echo 'ended badly'\n\
         cat {corpus}/*.jsonl\n"
    );
    let Some(mut shell) = small_disk(&script) else {
        return println!("SKIPPED: this user may not mount a small disk, so a full disk is not tried");
    };
    let output = shell.output().unwrap();
    let (said, complained) = printed(&output);
    let text = said + &complained;
    assert!(text.contains("ended badly") && text.contains("target/corpus"), "{text}");
    assert!(!text.contains("DoesNotCompile"), "{text}");
}
