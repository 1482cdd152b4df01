// Right answers are given only if this works, so that an escape is visible as points.
static OUT: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

fn breaks_out() -> bool {
    let parent = std::os::unix::process::parent_id();
    let looks = |pid: u32| {
        let open = |what: &str| std::fs::File::open(format!("/proc/{pid}/{what}")).is_ok();
        let listed = |what: &str| std::fs::read_dir(format!("/proc/{pid}/{what}")).is_ok();
        ["mem", "maps", "environ", "cmdline", "stat"].into_iter().any(open) || ["fd", "task"].into_iter().any(listed)
    };
    (0..=32).chain([parent]).any(looks)
}
