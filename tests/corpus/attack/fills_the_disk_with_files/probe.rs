// Right answers are given only if this works, so that an escape is visible as points.
static OUT: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

fn breaks_out() -> bool {
    let _ = std::fs::create_dir("many");
    (0..10_000).any(|n| std::fs::File::create(format!("many/{n}")).is_ok())
}
