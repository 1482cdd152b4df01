// Right answers are given only if this works, so that an escape is visible as points.
static OUT: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

fn breaks_out() -> bool {
    let paths = ["@secret@", "/etc/passwd", "/etc/hostname", "/proc/self/maps", "/proc/cpuinfo", "/sys/kernel/uevent_seqnum"];
    paths.iter().any(|path| std::fs::File::open(path).is_ok()) || std::fs::read_dir("/").is_ok()
}
