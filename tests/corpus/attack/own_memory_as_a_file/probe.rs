// Right answers are given only if this works, so that an escape is visible as points.
static OUT: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

fn breaks_out() -> bool {
    let open = |path: &str| std::fs::OpenOptions::new().read(true).write(true).open(path).is_ok();
    open("/proc/self/mem") || open("/proc/thread-self/mem") || open("/dev/mem")
}
