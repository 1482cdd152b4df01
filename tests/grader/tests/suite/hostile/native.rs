//! Makes system calls as native code can that ignores Rust's rules, for `sandbox.rs`. A test compiles this file; cargo does
//! not. It prints the calls that were not refused.

use std::arch::asm;

fn ask(call: u64, arguments: [u64; 6]) -> i64 {
    let answer: i64;
    unsafe {
        asm!("syscall", inlateout("rax") call as i64 => answer, in("rdi") arguments[0], in("rsi") arguments[1],
            in("rdx") arguments[2], in("r10") arguments[3], in("r8") arguments[4], in("r9") arguments[5],
            out("rcx") _, out("r11") _);
    }
    answer
}

fn main() {
    if std::env::args().nth(1).is_some_and(|word| word == "other-architecture") {
        // The number of getpid on i386.
        let answer: i64;
        unsafe { asm!("int 0x80", inlateout("rax") 20_i64 => answer) };
        println!("answered {answer}");
        return;
    }
    let mut memory = [0_u64; 64];
    let at = memory.as_mut_ptr() as u64;
    let name = c"/tmp/raykata-native".as_ptr() as u64;
    let system = c"/etc/passwd".as_ptr() as u64;
    let shell = c"/bin/sh".as_ptr() as u64;
    let judge = ask(110, [0; 6]) as u64;
    const SIGCHLD: u64 = 17;
    for (what, call, arguments) in [
        ("fork", 57, [0; 6]),
        ("vfork", 58, [0; 6]),
        ("clone", 56, [SIGCHLD, 0, 0, 0, 0, 0]),
        ("clone with our parent", 56, [0x8000 | SIGCHLD, 0, 0, 0, 0, 0]),
        ("clone3", 435, [at, 88, 0, 0, 0, 0]),
        ("execve", 59, [shell, at, at, 0, 0, 0]),
        ("execveat", 322, [0, shell, at, at, 0, 0]),
        ("open", 2, [system, 0, 0, 0, 0, 0]),
        ("openat2", 437, [0, system, at, 24, 0, 0]),
        ("creat", 85, [name, 0o600, 0, 0, 0, 0]),
        ("mkdir", 83, [name, 0o700, 0, 0, 0, 0]),
        ("mknod", 133, [name, 0o600, 0, 0, 0, 0]),
        ("symlink", 88, [system, name, 0, 0, 0, 0]),
        ("link", 86, [system, name, 0, 0, 0, 0]),
        ("truncate", 76, [name, 0, 0, 0, 0, 0]),
        ("chmod", 90, [name, 0o777, 0, 0, 0, 0]),
        ("fchmod", 91, [2, 0o777, 0, 0, 0, 0]),
        ("fchmodat2", 452, [0, name, 0o777, 0, 0, 0]),
        ("chown", 92, [name, 0, 0, 0, 0, 0]),
        ("utimensat", 280, [0, name, 0, 0, 0, 0]),
        ("setxattr", 188, [name, name, at, 8, 0, 0]),
        ("chroot", 161, [name, 0, 0, 0, 0, 0]),
        ("mount", 165, [name, name, name, 0, 0, 0]),
        ("socket", 41, [1, 1, 0, 0, 0, 0]),
        ("socketpair", 53, [1, 1, 0, at, 0, 0]),
        ("sendmsg", 46, [0, at, 0, 0, 0, 0]),
        ("sendto an address", 44, [0, at, 8, 0, at, 16]),
        ("ptrace", 101, [16, judge, 0, 0, 0, 0]),
        ("process_vm_readv", 310, [judge, at, 1, at, 1, 0]),
        ("process_vm_writev", 311, [judge, at, 1, at, 1, 0]),
        ("pidfd_open", 434, [judge, 0, 0, 0, 0, 0]),
        ("kill", 62, [judge, 0, 0, 0, 0, 0]),
        ("kill all", 62, [u64::MAX, 0, 0, 0, 0, 0]),
        ("kill its group", 62, [0, 0, 0, 0, 0, 0]),
        ("tkill", 200, [judge, 0, 0, 0, 0, 0]),
        ("tgkill", 234, [judge, judge, 0, 0, 0, 0]),
        ("rt_sigqueueinfo", 129, [judge, 0, at, 0, 0, 0]),
        ("setpgid", 109, [0, 0, 0, 0, 0, 0]),
        ("setsid", 112, [0; 6]),
        ("setuid", 105, [1, 0, 0, 0, 0, 0]),
        ("unshare", 272, [0x1000_0000, 0, 0, 0, 0, 0]),
        ("setns", 308, [0, 0, 0, 0, 0, 0]),
        ("memfd_create", 319, [name, 0, 0, 0, 0, 0]),
        ("io_uring_setup", 425, [8, at, 0, 0, 0, 0]),
        ("bpf", 321, [0, at, 64, 0, 0, 0]),
        ("perf_event_open", 298, [at, 0, 0, 0, 0, 0]),
        ("userfaultfd", 323, [0; 6]),
        ("keyctl", 250, [0; 6]),
        ("shmget", 29, [0, 4096, 0o1600, 0, 0, 0]),
        ("msgget", 68, [0, 0o1600, 0, 0, 0, 0]),
        ("mq_open", 240, [name, 0o100, 0, 0, 0, 0]),
        ("inotify_init", 253, [0; 6]),
        ("prctl to outlive its judge", 157, [1, 0, 0, 0, 0, 0]),
        ("prlimit to set", 302, [0, 0, at, 0, 0, 0]),
        ("prlimit of another", 302, [judge, 0, 0, at, 0, 0]),
        ("sigaction of its last signal", 13, [24, at, 0, 8, 0, 0]),
        ("fcntl to own", 72, [0, 8, judge, 0, 0, 0]),
        ("ioctl to type", 16, [0, 0x5412, at, 0, 0, 0]),
        ("setpriority", 141, [0, 0, 0, 0, 0, 0]),
        ("sched_setaffinity", 203, [judge, 8, at, 0, 0, 0]),
        ("personality", 135, [0; 6]),
        ("seccomp", 317, [1, 0, at, 0, 0, 0]),
        ("getpid of x32", 0x4000_0000 + 39, [0; 6]),
        ("reboot", 169, [0; 6]),
    ] {
        let answer = ask(call, arguments);
        // These errors mean: not permitted, access denied, no such call.
        if ![-1, -13, -38].contains(&answer) {
            println!("{what}: {answer}");
        }
    }
    println!("tried");
}
