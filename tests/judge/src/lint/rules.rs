//! The constructs that no exercise needs, by rule.

/// Rules about what the sandbox stops, or what harms only the functions that use it. A file with such constructs is graded.
pub(super) const LEFT_TO_SANDBOX: [&str; 8] =
    ["process", "files", "network", "environment", "threads", "system", "panics", "input"];

/// Modules of the standard library that no exercise needs, by rule.
pub(super) const MODULES: [(&str, &str, &str); 11] = [
    ("process", "process", "an exercise must not start or end processes"),
    ("files", "fs", "an exercise must not read or write files: the scaffold loads scenes"),
    ("network", "net", "an exercise must not use the network"),
    ("environment", "env", "an exercise may depend only on its arguments"),
    ("threads", "thread", "the scaffold renders on all cores; exercises need no threads of their own"),
    ("system", "os", "an exercise must not call the operating system"),
    ("system", "ffi", "an exercise must not call foreign code"),
    ("system", "alloc", "an exercise needs no allocator of its own"),
    ("panics", "panic", "an exercise may panic, and the kit reports it; it must not catch or hide a panic"),
    ("intrinsics", "arch", "an exercise must not use assembly or intrinsics"),
    ("intrinsics", "intrinsics", "an exercise must not use assembly or intrinsics"),
];

/// Why standard input is not read.
pub(super) const STDIN: &str =
    "no input is typed while exercises are graded, so this waits in vain; take values from the arguments";

/// Macros that read data from outside of the file, by rule.
pub(super) const MACROS: [(&str, &str, &str); 8] = [
    ("include", "include", "an exercise must be complete in its own file"),
    ("include", "include_str", "an exercise must be complete in its own file"),
    ("include", "include_bytes", "an exercise must be complete in its own file"),
    ("environment", "env", "an exercise may depend only on its arguments"),
    ("environment", "option_env", "an exercise may depend only on its arguments"),
    ("intrinsics", "asm", "an exercise must not use assembly or intrinsics"),
    ("intrinsics", "global_asm", "an exercise must not use assembly or intrinsics"),
    ("intrinsics", "naked_asm", "an exercise must not use assembly or intrinsics"),
];

/// Attributes that change the build, by rule.
pub(super) const ATTRIBUTES: [(&str, &str, &str); 11] = [
    ("include", "path", "an exercise must be complete in its own file"),
    ("linkage", "link", "an exercise must not link libraries"),
    ("linkage", "link_section", "an exercise must not change how programs are linked"),
    ("linkage", "link_name", "an exercise must not change how programs are linked"),
    ("linkage", "no_mangle", "an exercise must not change how programs are linked"),
    ("linkage", "export_name", "an exercise must not change how programs are linked"),
    ("linkage", "used", "an exercise must not change how programs are linked"),
    ("linkage", "global_allocator", "an exercise needs no allocator of its own"),
    (
        "linkage",
        "panic_handler",
        "an exercise may panic, and the kit reports it; it must not catch or hide a panic",
    ),
    ("linkage", "no_std", "an exercise must not change how it is built"),
    ("linkage", "no_main", "an exercise must not change how it is built"),
];

/// Levels of lints that a file must not set, each with the reason. Forbidding both lints is allowed.
pub(super) const LINTS: [(&str, &str, &str); 5] = [
    ("allow", "unsafe_code", UNSAFE),
    ("expect", "unsafe_code", UNSAFE),
    ("allow", "long_running_const_eval", ENDLESS),
    ("expect", "long_running_const_eval", ENDLESS),
    ("warn", "long_running_const_eval", ENDLESS),
];

const UNSAFE: &str = "unsafe code is not part of any exercise";
const ENDLESS: &str = "this lint stops constants whose evaluation never ends";
