//! The constructs that no exercise needs, by rule.

/// Modules of the standard library that no exercise needs, by rule.
pub(super) const MODULES: [(&str, &str, &str); 12] = [
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
    ("input", "stdin", "no input is typed while exercises are graded"),
];

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

/// Lints that a file must not switch off, each with the reason. Forbidding them is allowed.
pub(super) const LINTS: [(&str, &str); 2] = [
    ("unsafe_code", "unsafe code is not part of any exercise"),
    ("long_running_const_eval", "this lint stops constants whose evaluation never ends"),
];
