//! Limits by Landlock which files a sandboxed program may read, write and execute.

use super::Purpose;
use anyhow::{Context, Result, bail};
use landlock::{
    ABI, Access, AccessFs, AccessNet, BitFlags, CompatLevel, Compatible, LandlockStatus, PathBeneath, PathFd,
    RestrictionStatus, Ruleset, RulesetAttr, RulesetCreated, RulesetCreatedAttr, RulesetStatus, Scope,
    make_bitflags,
};
use std::path::Path;

/// The newest version that the library knows. Older kernels enforce the part that they support.
const NEWEST: ABI = ABI::V9;

/// Folders with shared libraries.
const LIBRARY_FOLDERS: [&str; 9] = [
    "/lib/x86_64-linux-gnu",
    "/usr/lib/x86_64-linux-gnu",
    "/lib/aarch64-linux-gnu",
    "/usr/lib/aarch64-linux-gnu",
    "/lib64",
    "/usr/lib64",
    "/lib",
    "/usr/lib",
    "/usr/local/lib",
];

/// The shared libraries of a Rust program and of rustc. They are listed one by one, because their folders contain other
/// files that a submission must not read.
const LIBRARIES: [&str; 9] = [
    "libc.so.6",
    "libm.so.6",
    "libgcc_s.so.1",
    "libdl.so.2",
    "libpthread.so.0",
    "librt.so.1",
    "libutil.so.1",
    "libz.so.1",
    "libstdc++.so.6",
];

/// The dynamic loaders, which must be executable.
const LOADERS: [&str; 2] = ["ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"];

/// Where the loader looks up libraries.
const CACHE: &str = "/etc/ld.so.cache";

/// Folders with compiler drivers, linkers, their libraries and start-up code.
const TOOL_FOLDERS: [&str; 7] =
    ["/usr/bin", "/usr/lib", "/usr/lib64", "/usr/libexec", "/bin", "/lib", "/lib64"];

pub(super) fn restrict(
    purpose: Purpose,
    program: &Path,
    readable: &[impl AsRef<Path>],
    writable: &[impl AsRef<Path>],
) -> Result<RestrictionStatus> {
    let read = make_bitflags!(AccessFs::{ReadFile | ReadDir});
    let run = make_bitflags!(AccessFs::{ReadFile | Execute});
    // Allow no links, sockets, pipes or devices, because they lead outside.
    let write = read
        | make_bitflags!(AccessFs::{
            WriteFile | Truncate | MakeReg | MakeDir | RemoveFile | RemoveDir | Refer
        });
    let mut rules = handle_everything().context("Landlock is not available")?;
    rules = allow(rules, program, run)?;
    for folder in LIBRARY_FOLDERS {
        for name in LIBRARIES {
            rules = allow_if_there(rules, &Path::new(folder).join(name), AccessFs::ReadFile.into())?;
        }
        for name in LOADERS {
            rules = allow_if_there(rules, &Path::new(folder).join(name), run)?;
        }
    }
    rules = allow_if_there(rules, Path::new(CACHE), AccessFs::ReadFile.into())?;
    if purpose.writes() {
        rules = allow_if_there(rules, Path::new("/dev/null"), AccessFs::ReadFile | AccessFs::WriteFile)?;
    }
    let tool = if purpose == Purpose::Linker { read | AccessFs::Execute } else { read };
    if purpose == Purpose::Linker {
        for folder in TOOL_FOLDERS {
            rules = allow_if_there(rules, Path::new(folder), tool)?;
        }
    }
    for path in readable {
        // Some tools of a linker are in the toolchain.
        rules = allow(rules, path.as_ref(), tool)?;
    }
    for path in writable {
        rules = allow(rules, path.as_ref(), write)?;
    }
    let status = rules.restrict_self().context("Landlock cannot be enforced")?;
    if status.ruleset == RulesetStatus::NotEnforced || !status.no_new_privs {
        bail!("Landlock is not enforced on this machine: it needs Linux 5.13 with Landlock switched on");
    }
    Ok(status)
}

fn handle_everything() -> Result<RulesetCreated> {
    Ok(Ruleset::default()
        .set_compatibility(CompatLevel::HardRequirement)
        .handle_access(AccessFs::from_all(ABI::V1))?
        .set_compatibility(CompatLevel::BestEffort)
        .handle_access(AccessFs::from_all(NEWEST))?
        // On kernels without these, the filter of system calls still blocks the network and other processes.
        .handle_access(AccessNet::from_all(NEWEST))?
        .scope(Scope::from_all(NEWEST))?
        .create()?)
}

fn allow_if_there(rules: RulesetCreated, path: &Path, access: BitFlags<AccessFs>) -> Result<RulesetCreated> {
    if path.exists() { allow(rules, path, access) } else { Ok(rules) }
}

fn allow(rules: RulesetCreated, path: &Path, access: BitFlags<AccessFs>) -> Result<RulesetCreated> {
    let about = || format!("{} cannot be made accessible", path.display());
    let access = if path.metadata().with_context(about)?.is_dir() {
        access
    } else {
        access & AccessFs::from_file(NEWEST)
    };
    let opened = PathFd::new(path).with_context(about)?;
    rules.add_rule(PathBeneath::new(opened, access)).with_context(about)
}

/// Returns the Landlock version in words. This restricts the calling process.
pub(super) fn level() -> Result<String> {
    let myself = std::env::current_exe()?;
    let nothing: [&Path; 0] = [];
    let status = restrict(Purpose::Worker, &myself, &nothing, &nothing)?;
    Ok(match status.landlock {
        LandlockStatus::Available { kernel_abi: Some(newer), .. } => format!("Landlock ABI {newer}"),
        LandlockStatus::Available { effective_abi, .. } => format!("Landlock ABI {}", effective_abi as i32),
        other => bail!("Landlock: {other:?}"),
    })
}

#[test]
fn the_manual_lists_what_a_worker_may_read() {
    let manual = include_str!("../../README.md");
    let start = manual.find("a worker may read: ").expect("the list");
    let list = manual[start..].split("None of them").next().unwrap_or_default();
    let named = list.split('`').skip(1).step_by(2).collect::<std::collections::BTreeSet<_>>();
    assert_eq!(named, LIBRARIES.into_iter().chain(LOADERS).chain([CACHE]).collect());
}
