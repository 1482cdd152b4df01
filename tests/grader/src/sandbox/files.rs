//! What a sandboxed program may read, write and execute: Landlock.

use super::Purpose;
use anyhow::{Context, Result, bail};
use landlock::{
    ABI, Access, AccessFs, AccessNet, BitFlags, CompatLevel, Compatible, LandlockStatus, PathBeneath, PathFd,
    RestrictionStatus, Ruleset, RulesetAttr, RulesetCreated, RulesetCreatedAttr, RulesetStatus, Scope,
    make_bitflags,
};
use std::path::Path;

/// The newest that the library knows; older kernels enforce what they can of it.
const NEWEST: ABI = ABI::V9;

/// Where systems keep shared libraries.
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

/// Those that a Rust program, or rustc, is linked to. Exact files, because the folders hold much that is nobody's
/// business.
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

/// What loads a program and its libraries, which counts as executing it.
const LOADERS: [&str; 2] = ["ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"];

/// Compiler drivers, linkers, their libraries and the start of programs.
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
    // No links, sockets, pipes or devices: nothing that points elsewhere.
    let write = read
        | make_bitflags!(AccessFs::{
            WriteFile | Truncate | MakeReg | MakeDir | RemoveFile | RemoveDir | Refer
        });
    let mut rules = handle_everything().context("Landlock is not to be had")?;
    rules = allow(rules, program, run)?;
    for folder in LIBRARY_FOLDERS {
        for name in LIBRARIES {
            rules = allow_if_there(rules, &Path::new(folder).join(name), AccessFs::ReadFile.into())?;
        }
        for name in LOADERS {
            rules = allow_if_there(rules, &Path::new(folder).join(name), run)?;
        }
    }
    rules = allow_if_there(rules, Path::new("/etc/ld.so.cache"), AccessFs::ReadFile.into())?;
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
        // A linker finds some of its tools in the toolchain.
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
        // Without these the filter of system calls still stands between it and the network and other processes.
        .handle_access(AccessNet::from_all(NEWEST))?
        .scope(Scope::from_all(NEWEST))?
        .create()?)
}

fn allow_if_there(rules: RulesetCreated, path: &Path, access: BitFlags<AccessFs>) -> Result<RulesetCreated> {
    if path.exists() { allow(rules, path, access) } else { Ok(rules) }
}

fn allow(rules: RulesetCreated, path: &Path, access: BitFlags<AccessFs>) -> Result<RulesetCreated> {
    let about = || format!("{} cannot be made accessible", path.display());
    let access = if path.metadata().with_context(about)?.is_dir() { access } else { access & of_files() };
    let opened = PathFd::new(path).with_context(about)?;
    rules.add_rule(PathBeneath::new(opened, access)).with_context(about)
}

/// The rights that make sense for a file that is no folder.
fn of_files() -> BitFlags<AccessFs> {
    AccessFs::from_file(NEWEST)
}

/// In words. The process that asks is restricted afterwards.
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
