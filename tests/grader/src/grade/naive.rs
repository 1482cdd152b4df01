//! The result of a naive grader, for comparison: it runs `cargo test` on a submission as it was handed in, with all of its files,
//! and believes the exit code and the printed words.
//!
//! Each run has namespaces of its own (`unshare`): it reaches no network and no process of others, it can write only to a
//! copy of the kit and to the folder beside it, and all of its processes end with it.

use super::attacks::{self, Attack, AttackFolders, CANARY};
use crate::handout;
use crate::sandbox::{self, Ended, How};
use anyhow::{Context, Result, bail, ensure};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use tempfile::TempDir;

/// Time limit for a run. An honest submission needs four seconds.
const PATIENCE: Duration = Duration::from_secs(60);

/// Most output that is read from each of the two streams, in bytes.
const MOST_OUTPUT: usize = 16 << 20;

/// Puts the copy in the place of the kit, because cargo would build everything again in another place. Makes all other folders
/// read-only, limits memory (4 GiB) and files (1 GiB), gives up all rights, and becomes the command.
const CONFINED: &str = r#"
set -e
mount --bind "$BESIDE" "$BESIDE"
mount --bind "$COPY" "$KIT"
mount -o remount,bind,ro /
mount -t tmpfs tmpfs /dev/shm
ulimit -v 4194304; ulimit -f 2097152; ulimit -c 0
cd "$KIT"
exec setpriv --bounding-set=-all --inh-caps=-all --no-new-privs "$@"
"#;

/// The kit as students get it, with what cargo has built of it.
pub struct Naive {
    root: PathBuf,
    kit: TempDir,
}

impl Naive {
    /// Hands out the kit at `root` and builds the tests of these stages.
    pub fn prepare(root: &Path, stages: &[u8]) -> Result<Naive> {
        let kit = tempfile::tempdir()?;
        handout::write(root, kit.path(), None)?;
        let mut cargo = cargo(stages);
        let built = cargo.arg("--no-run").current_dir(kit.path()).output()?;
        ensure!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
        Ok(Naive { root: root.canonicalize()?, kit })
    }

    /// Runs `cargo test` on an attack and returns the result in words; `None` if the submission is no folder.
    pub fn grade(&self, attack: &Attack) -> Result<Option<String>> {
        let folder = tempfile::tempdir()?;
        let submission = attacks::make(attack, &AttackFolders { root: &self.root, folder: folder.path() })?;
        if !submission.is_dir() {
            return Ok(None);
        }
        // Write all files of the submission over a copy of the kit.
        let (kit, copy) = (self.kit.path(), folder.path().join("kit"));
        copy_over(kit, &copy)?;
        copy_over(&submission, &copy)?;
        fs::create_dir_all(copy.join("target/tmp"))?;
        // Run its tests.
        let mut command = Command::new("unshare");
        command.args(["--map-root-user", "--mount", "--net", "--pid", "--ipc", "--mount-proc"]);
        command.args(["--fork", "--kill-child", "--", "sh", "-c", CONFINED, "sh"]);
        let beside = folder.path().join("beside");
        let before = attacks::fingerprints(&beside)?;
        command.env("KIT", kit).env("COPY", &copy).env("BESIDE", &beside);
        command.env("TMPDIR", kit.join("target/tmp"));
        let cargo = cargo(&attack.stages);
        command.arg(cargo.get_program()).args(cargo.get_args());
        let ended =
            sandbox::run(command, b"", PATIENCE, MOST_OUTPUT).context("`unshare` cannot be started")?;
        let mut words = in_words(&ended)?;
        // Report damage.
        if [&ended.stdout, &ended.stderr].iter().any(|text| String::from_utf8_lossy(text).contains(CANARY)) {
            words += ", and prints a secret";
        }
        if !attacks::changes(&before, &attacks::fingerprints(&beside)?).is_empty() {
            words += ", and changes a file of somebody else";
        }
        Ok(Some(words))
    }
}

/// Returns the command that runs the checks of these stages.
fn cargo(stages: &[u8]) -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["test", "--offline", "--no-fail-fast"]);
    cargo.args(stages.iter().map(|stage| format!("--test=stage{stage}")));
    cargo
}

/// Copies the content of a folder over another one, with its times, so that cargo builds only what differs. Links stay links. A
/// file does not replace a folder, and a folder does not replace a file.
fn copy_over(from: &Path, to: &Path) -> Result<()> {
    let mut copy = Command::new("cp");
    copy.args(["--archive", "--remove-destination"]).arg(from.join(".")).arg(to);
    copy.output().context("`cp` cannot be started")?;
    Ok(())
}

fn in_words(ended: &Ended) -> Result<String> {
    let stderr = String::from_utf8_lossy(&ended.stderr);
    if stderr.starts_with("unshare:") || stderr.starts_with("mount:") {
        bail!("the namespaces cannot be made: {}", stderr.lines().next().unwrap_or_default());
    }
    let stdout = String::from_utf8_lossy(&ended.stdout);
    let printed = stdout.lines().filter_map(|line| line.strip_prefix("test result: "));
    let counts: Vec<(u32, u32)> = printed.filter_map(counts).collect();
    let (passed, failed) = counts.iter().fold((0, 0), |sum, count| (sum.0 + count.0, sum.1 + count.1));
    let counted = format!("{passed} of {} checks pass", passed + failed);
    Ok(match ended.how {
        How::Exited(0) if counts.is_empty() => "success by exit code".into(),
        How::Exited(0) if failed == 0 => format!("full marks: {counted}"),
        How::Exited(0) => format!("success by exit code, {counted}"),
        How::Exited(_) if !counts.is_empty() => counted,
        How::Exited(_) if stderr.contains("could not compile") => "does not compile".into(),
        How::Exited(_) if stderr.contains("process didn't exit successfully") => {
            "the process dies, and all results are lost".into()
        }
        How::Exited(_) | How::Signalled(_) => "cargo fails".into(),
        How::TookTooLong | How::UsedUpCpu => "hangs".into(),
        How::WroteTooMuch => "writes without end".into(),
        How::TooManyProcesses => "starts processes without end".into(),
    })
}

/// Reads the numbers of passed and failed tests from `ok. 3 passed; 0 failed; …`.
fn counts(result: &str) -> Option<(u32, u32)> {
    let number = |word: &str| {
        let before = result.split(word).next()?.trim_end();
        before.rsplit(' ').next()?.parse().ok()
    };
    Some((number("passed")?, number("failed")?))
}
