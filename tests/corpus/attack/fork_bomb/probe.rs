// Right answers are given only if this works, so that an escape is visible as points.
static OUT: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

fn breaks_out() -> bool {
    let programs = ["/proc/self/exe", "/bin/true", "/usr/bin/true"];
    (0..64).any(|n| std::process::Command::new(programs[n % 3]).spawn().is_ok())
}
