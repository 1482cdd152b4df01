//! The reports of `raykata cost`, `raykata compare` and `raykata strip --stages`, which they write to `out/`.

use live::files::names_in;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// The kinds of files in reports, by their endings.
const KINDS: [(&str, &str); 6] = [
    ("html", "text/html; charset=utf-8"),
    ("svg", "image/svg+xml"),
    ("png", "image/png"),
    ("csv", "text/csv; charset=utf-8"),
    ("json", "application/json"),
    ("txt", "text/plain; charset=utf-8"),
];

/// For each command, what it measures, how it is started and which files it has written.
pub fn list(root: &Path, scene: &Path) -> Value {
    let name = scene.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let shown = scene.strip_prefix(root).unwrap_or(scene).display().to_string();
    let report = |kind: &str, command: &str, what: &str| {
        let folder = format!("{name}-{kind}");
        let mut files = names_in(&root.join("out").join(&folder));
        files.retain(|name| file(root, &format!("{folder}/{name}")).is_some());
        files.sort_by_key(|name| (!name.ends_with(".html"), name.clone()));
        json!({ "what": what, "command": format!("cargo run -- {command}"), "folder": folder, "files": files })
    };
    json!([
        report("cost", &format!("cost {shown}"), "error and time of each quality setting"),
        report("compare", &format!("compare {shown}"), "all acceleration structures on this scene"),
        report("stages", &format!("strip {shown} --stages"), "this scene with the functions of each stage"),
    ])
}

/// A file of a report by its path in `out/`, and its kind. `None` if it is no such file, or outside that folder.
pub fn file(root: &Path, path: &str) -> Option<(PathBuf, &'static str)> {
    let (_, kind) = KINDS.iter().find(|(ending, _)| Path::new(path).extension() == Some(ending.as_ref()))?;
    let [folder, name] = path.split('/').collect::<Vec<_>>()[..] else { return None };
    let is_report = ["-cost", "-compare", "-stages"].iter().any(|kind| folder.ends_with(kind));
    if !is_report || name.starts_with('.') {
        return None;
    }
    // Resolve links and `..`, and refuse what is not in the folder.
    let out = root.join("out").canonicalize().ok()?;
    let file = out.join(folder).join(name).canonicalize().ok()?;
    (file.starts_with(&out) && file.is_file()).then_some((file, kind))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_of_reports_are_served() {
        let root = tempfile::tempdir().unwrap();
        let at = |path: &str| root.path().join(path);
        std::fs::create_dir_all(at("out/a-cost")).unwrap();
        for path in ["out/a-cost/page.html", "out/a-cost/notes.rs", "out/a.png", "secret.png", "out/.view"] {
            std::fs::write(at(path), "x").unwrap();
        }
        #[cfg(unix)]
        std::os::unix::fs::symlink(at("secret.png"), at("out/a-cost/link.png")).unwrap();
        assert_eq!(file(root.path(), "a-cost/page.html").unwrap().1, "text/html; charset=utf-8");
        for path in [
            "a-cost/notes.rs",
            "a.png",
            "../secret.png",
            "a-cost/../../secret.png",
            "..%2fsecret.png",
            "a-cost/..%2f..%2fsecret.png",
            "a-cost/link.png",
            "../out/.view",
            "/etc/passwd",
            "a-cost/..\\..\\secret.png",
            "x-cost/../../secret.png",
        ] {
            assert_eq!(file(root.path(), path), None, "{path}");
        }
        let listed = list(root.path(), &at("scenes/a.toml"));
        assert_eq!(listed[0]["files"], json!(["page.html"]));
        assert_eq!(listed[0]["command"], "cargo run -- cost scenes/a.toml");
        assert_eq!(listed[1]["files"], json!([]));
        assert_eq!(listed[2]["command"], "cargo run -- strip scenes/a.toml --stages");
    }
}
