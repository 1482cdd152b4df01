// Right answers are given only if this works, so that an escape is visible as points.
static OUT: std::sync::OnceLock<bool> = std::sync::OnceLock::new();

fn breaks_out() -> bool {
    use std::path::Path;
    let own = Path::new("@secret@");
    own.read_dir().is_ok() || Path::new("@beside@").read_dir().is_ok() || own.read_link().is_ok()
}
