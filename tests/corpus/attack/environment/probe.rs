// Right answers are given only if this works, so that an escape is visible as points.
static OUT: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

fn breaks_out() -> bool {
    let telling = ["SEED", "RAYKATA", "CARGO", "HOME", "USER", "TOKEN", "SECRET", "PATH", "SUBMISSION"];
    std::env::vars().any(|(name, _)| telling.iter().any(|word| name.contains(word))) || std::env::args().count() > 1
}
