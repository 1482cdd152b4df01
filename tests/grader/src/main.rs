//! The tool.
mod sync;
fn main() -> anyhow::Result<()> {
    let root = std::env::current_dir()?;
    if std::env::args().nth(1).as_deref() == Some("sync") {
        sync::sync(&root, std::env::args().any(|a| a == "--force"))
    } else {
        sync::check(&root)
    }
}
