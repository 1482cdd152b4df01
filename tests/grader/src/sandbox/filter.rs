//! Limits by seccomp which system calls a sandboxed program may make. The lists name the allowed calls.
//!
//! Any other call fails with "operation not permitted", so that Rust code gets an error instead of a crash. System calls of
//! another architecture end the process. Landlock checks file names. It does not protect permission bits, owners and times,
//! so no list contains a call that changes these.

use super::Purpose;
use anyhow::{Context, Result};
use nix::libc;
use seccompiler::SeccompCmpOp::{Eq, MaskedEq, Ne};
use seccompiler::{
    BpfProgram, SeccompAction, SeccompCmpArgLen, SeccompCmpOp, SeccompCondition, SeccompFilter, SeccompRule,
};
use std::collections::BTreeMap;

/// Calls for start-up and end of a program, memory, reading, waiting and time.
const ALL: &[i64] = &[
    libc::SYS_brk,
    libc::SYS_clock_getres,
    libc::SYS_clock_gettime,
    libc::SYS_clock_nanosleep,
    libc::SYS_close,
    libc::SYS_execve, // the launcher needs it once; after that Landlock limits it
    libc::SYS_exit,
    libc::SYS_exit_group,
    libc::SYS_faccessat,
    libc::SYS_faccessat2,
    libc::SYS_fstat,
    libc::SYS_futex,
    libc::SYS_getegid,
    libc::SYS_geteuid,
    libc::SYS_getgid,
    libc::SYS_getpid,
    libc::SYS_getppid,
    libc::SYS_getrandom,
    libc::SYS_getrusage,
    libc::SYS_gettid,
    libc::SYS_gettimeofday,
    libc::SYS_getuid,
    libc::SYS_lseek,
    libc::SYS_madvise,
    libc::SYS_mmap,
    libc::SYS_mprotect,
    libc::SYS_mremap,
    libc::SYS_munmap,
    libc::SYS_nanosleep,
    libc::SYS_newfstatat,
    libc::SYS_openat,
    libc::SYS_ppoll,
    libc::SYS_pread64,
    libc::SYS_read,
    libc::SYS_readlinkat,
    libc::SYS_readv,
    libc::SYS_restart_syscall,
    libc::SYS_rseq,
    libc::SYS_rt_sigprocmask,
    libc::SYS_rt_sigreturn,
    libc::SYS_sched_getaffinity,
    libc::SYS_sched_yield,
    libc::SYS_set_robust_list,
    libc::SYS_set_tid_address,
    libc::SYS_sigaltstack,
    libc::SYS_statx,
    libc::SYS_uname,
    libc::SYS_write,
    libc::SYS_writev,
];

/// Older variants of these calls, which newer architectures lack.
#[cfg(target_arch = "x86_64")]
const ALL_OLDER: &[i64] = &[
    libc::SYS_access,
    libc::SYS_arch_prctl,
    libc::SYS_lstat,
    libc::SYS_open,
    libc::SYS_poll,
    libc::SYS_readlink,
    libc::SYS_stat,
    libc::SYS_time,
];
#[cfg(not(target_arch = "x86_64"))]
const ALL_OLDER: &[i64] = &[];

/// Calls for the socket of a worker.
const SOCKET: &[i64] = &[libc::SYS_getpeername, libc::SYS_getsockname, libc::SYS_recvfrom];

/// Calls for files in a scratch folder and pipes between threads.
const COMPILER: &[i64] = &[
    libc::SYS_copy_file_range,
    libc::SYS_dup,
    libc::SYS_dup3,
    libc::SYS_fadvise64,
    libc::SYS_fallocate,
    libc::SYS_fdatasync,
    libc::SYS_flock,
    libc::SYS_fstatfs,
    libc::SYS_fsync,
    libc::SYS_ftruncate,
    libc::SYS_getcwd,
    libc::SYS_getdents64,
    libc::SYS_mkdirat,
    libc::SYS_msync,
    libc::SYS_pipe2,
    libc::SYS_preadv,
    libc::SYS_pwrite64,
    libc::SYS_pwritev,
    libc::SYS_renameat,
    libc::SYS_renameat2,
    libc::SYS_statfs,
    libc::SYS_sysinfo,
    libc::SYS_umask,
    libc::SYS_unlinkat,
];
#[cfg(target_arch = "x86_64")]
const COMPILER_OLDER: &[i64] = &[
    libc::SYS_dup2,
    libc::SYS_getdents,
    libc::SYS_mkdir,
    libc::SYS_pipe,
    libc::SYS_rename,
    libc::SYS_rmdir,
    libc::SYS_unlink,
];
#[cfg(not(target_arch = "x86_64"))]
const COMPILER_OLDER: &[i64] = &[];

/// Calls to start other programs and wait for them.
const LINKER: &[i64] = &[libc::SYS_recvfrom, libc::SYS_wait4, libc::SYS_waitid];
#[cfg(target_arch = "x86_64")]
const LINKER_OLDER: &[i64] = &[libc::SYS_fork, libc::SYS_vfork];
#[cfg(not(target_arch = "x86_64"))]
const LINKER_OLDER: &[i64] = &[];

/// Flags that no clone may have: new namespaces, or a parent other than the caller.
const NO_CLONE: u64 = (libc::CLONE_NEWNS
    | libc::CLONE_NEWCGROUP
    | libc::CLONE_NEWUTS
    | libc::CLONE_NEWIPC
    | libc::CLONE_NEWUSER
    | libc::CLONE_NEWPID
    | libc::CLONE_NEWNET
    | libc::CLONE_PARENT
    | libc::CLONE_PTRACE) as u64;

type Rules = BTreeMap<i64, Vec<SeccompRule>>;

pub(super) fn install(purpose: Purpose) -> Result<()> {
    // Install this filter first, because the list does not allow another filter.
    seccompiler::apply_filter(&newer_clone_is_unknown()?)?;
    seccompiler::apply_filter(&list(purpose)?)?;
    Ok(())
}

/// Makes `clone3` fail as unknown, because a filter cannot read its flags in memory. The C library then uses `clone`.
fn newer_clone_is_unknown() -> Result<BpfProgram> {
    let rules: Rules = [(libc::SYS_clone3, vec![])].into();
    program(rules, SeccompAction::Allow, SeccompAction::Errno(libc::ENOSYS as u32))
}

fn list(purpose: Purpose) -> Result<BpfProgram> {
    let mut rules = Rules::new();
    let mut allow = |calls: &[i64]| rules.extend(calls.iter().map(|call| (*call, vec![])));
    allow(ALL);
    allow(ALL_OLDER);
    // The other filter handles this call.
    allow(&[libc::SYS_clone3]);
    match purpose {
        Purpose::Worker | Purpose::Reader => allow(SOCKET),
        Purpose::Compiler | Purpose::Linker => {
            allow(COMPILER);
            allow(COMPILER_OLDER);
        }
    }
    if purpose == Purpose::Linker {
        allow(LINKER);
        allow(LINKER_OLDER);
    }
    rules.extend(with_conditions(purpose)?);
    program(rules, SeccompAction::Errno(libc::EPERM as u32), SeccompAction::Allow)
}

fn with_conditions(purpose: Purpose) -> Result<Rules> {
    let myself = u64::from(std::process::id());
    let commands = |commands: &[i32]| -> Result<Vec<SeccompRule>> {
        commands.iter().map(|command| when(&[(1, Eq, *command as u64)])).collect()
    };
    let mut rules: Rules = [
        // The signal for too much processor time must end the process, so its handler cannot be set.
        (libc::SYS_rt_sigaction, vec![when(&[(0, Ne, libc::SIGXCPU as u64)])?]),
        // A process may only read its own limits.
        (libc::SYS_prlimit64, vec![when_wide(&[(0, Eq, 0), (2, Eq, 0)])?]),
        (libc::SYS_prctl, vec![when(&[(0, Eq, libc::PR_SET_NAME as u64)])?]),
        // A process may signal only itself and its own threads, for example to abort.
        (libc::SYS_kill, vec![when(&[(0, Eq, myself)])?]),
        (libc::SYS_tgkill, vec![when(&[(0, Eq, myself)])?]),
        // These commands make the kernel neither send signals nor type on a terminal.
        (
            libc::SYS_fcntl,
            commands(&[
                libc::F_DUPFD,
                libc::F_DUPFD_CLOEXEC,
                libc::F_GETFD,
                libc::F_SETFD,
                libc::F_GETFL,
                libc::F_SETFL,
            ])?,
        ),
        (libc::SYS_ioctl, commands(&[libc::TCGETS as i32, libc::FIOCLEX as i32, libc::FIONBIO as i32])?),
    ]
    .into();
    match purpose {
        Purpose::Worker | Purpose::Reader => {
            // Allow sending only to the other end of its socket, without an address.
            rules.insert(libc::SYS_sendto, vec![when_wide(&[(4, Eq, 0)])?]);
        }
        Purpose::Compiler => {
            let thread = libc::CLONE_THREAD as u64;
            rules.insert(libc::SYS_clone, vec![when(&[(0, MaskedEq(NO_CLONE | thread), thread)])?]);
        }
        Purpose::Linker => {
            rules.insert(libc::SYS_clone, vec![when(&[(0, MaskedEq(NO_CLONE), 0)])?]);
            // Rust's library uses a socket pair to learn whether a program could be started.
            rules.insert(libc::SYS_socketpair, vec![when(&[(0, Eq, libc::AF_UNIX as u64)])?]);
        }
    }
    Ok(rules)
}

/// Allows a call if all these comparisons of 32-bit arguments hold.
fn when(conditions: &[(u8, SeccompCmpOp, u64)]) -> Result<SeccompRule> {
    rule(conditions, SeccompCmpArgLen::Dword)
}

/// The same with 64-bit arguments, for pointers.
fn when_wide(conditions: &[(u8, SeccompCmpOp, u64)]) -> Result<SeccompRule> {
    rule(conditions, SeccompCmpArgLen::Qword)
}

fn rule(conditions: &[(u8, SeccompCmpOp, u64)], length: SeccompCmpArgLen) -> Result<SeccompRule> {
    let conditions = conditions.iter().map(|(argument, compare, value)| {
        SeccompCondition::new(*argument, length.clone(), compare.clone(), *value)
    });
    Ok(SeccompRule::new(conditions.collect::<Result<_, _>>()?)?)
}

fn program(rules: Rules, otherwise: SeccompAction, on_match: SeccompAction) -> Result<BpfProgram> {
    let architecture =
        std::env::consts::ARCH.try_into().context("the filter does not support this architecture")?;
    Ok(SeccompFilter::new(rules, otherwise, on_match, architecture)?.try_into()?)
}
