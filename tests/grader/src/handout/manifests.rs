//! Manifests without what is not handed out. They are cut as text, so that students read the comments, too.

use anyhow::{Context, Result};
use std::collections::BTreeSet;
use std::path::Path;

/// The members of a hand-out's workspace.
const MEMBERS: [&str; 5] = ["exercises", "tests/checks", "tests/checks/all", "tests/oracle", "tests/grader"];

/// How many stages have a package of their own in `tests/checks`.
const STAGES: u8 = 10;

/// All manifests of a hand-out, by their paths. `present` tells which other files it has.
pub(super) fn all(root: &Path, present: &dyn Fn(&str) -> bool) -> Result<Vec<(String, String)>> {
    let mut manifests = Vec::new();
    let workspace = super::text(root, "Cargo.toml")?;
    let mut wanted = dependencies(&workspace)?;
    let stages = (1..=STAGES).map(|stage| format!("tests/checks/stage{stage}"));
    for folder in MEMBERS.into_iter().map(str::to_owned).chain(stages) {
        let path = format!("{folder}/Cargo.toml");
        let text = member(&super::text(root, &path)?);
        wanted.extend(dependencies(&text).with_context(|| path.clone())?);
        manifests.push((path, text));
    }
    manifests.push(("Cargo.toml".into(), self::workspace(&workspace, &wanted, present)));
    Ok(manifests)
}

/// A member without what only the feature `author` needs.
fn member(text: &str) -> String {
    cut(text, |lines, kept| {
        let starts = |start: &str| lines.iter().any(|line| line.starts_with(start));
        let gone = starts("[features]") || starts("required-features");
        kept.retain(|line| !gone && !line.contains("optional = true"));
    })
}

/// The workspace without the solutions, and with the dependencies that its members still want.
fn workspace(text: &str, wanted: &BTreeSet<String>, present: &dyn Fn(&str) -> bool) -> String {
    let text = text.replace("\"solutions\", ", "");
    let mut of_workspace = false;
    cut(&text, |lines, kept| {
        let header = lines.iter().find(|line| line.starts_with('['));
        if let Some(header) = header {
            of_workspace = *header == "[workspace.dependencies]";
        }
        let one_package =
            header.is_some_and(|header| header.contains(".package.") && !header.contains("\"*\""));
        let missing = header == Some(&"[[test]]")
            && lines.iter().filter_map(|line| line.strip_prefix("name = ")).any(|name| {
                let name = name.trim_matches('"');
                !present(&format!("tests/{name}.rs"))
            });
        kept.retain(|line| {
            let dependency = line.split_once(" = ").filter(|_| of_workspace && !line.starts_with('#'));
            !one_package && !missing && dependency.is_none_or(|(name, _)| wanted.contains(name))
        });
    })
}

/// Puts each paragraph to `choose`, which takes lines out of the second of its arguments. A paragraph of which only
/// headers and comments are left goes as well, but not one that was a comment before.
fn cut<'a>(text: &'a str, mut choose: impl FnMut(&[&'a str], &mut Vec<&'a str>)) -> String {
    let mut paragraphs = Vec::new();
    for paragraph in text.trim_end().split("\n\n") {
        let lines: Vec<&str> = paragraph.lines().collect();
        let mut kept = lines.clone();
        choose(&lines, &mut kept);
        let says = |line: &&str| !line.starts_with('#') && !line.starts_with('[');
        if kept.len() == lines.len() || kept.iter().any(says) {
            paragraphs.push(kept.join("\n"));
        }
    }
    paragraphs.join("\n\n") + "\n"
}

/// The names of what a package depends on.
fn dependencies(manifest: &str) -> Result<BTreeSet<String>> {
    let manifest: toml::Table = toml::from_str(manifest)?;
    let tables =
        ["dependencies", "dev-dependencies"].into_iter().filter_map(|name| manifest.get(name)?.as_table());
    Ok(tables.flat_map(|table| table.keys().cloned()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_authors_need_goes_with_its_comments() {
        let manifest = "[package]\nname = \"a\"\n\n# Gates.\n[features]\ndefault = [\"author\"]\n\n# A bench.\n[[bench]]\n\
                        name = \"b\"\nrequired-features = [\"author\"]\n\n[dependencies]\nclap.workspace = true\n\
                        syn = { workspace = true, optional = true }\n\n# Walls.\n[target.'cfg(unix)'.dependencies]\n\
                        nix = { workspace = true, optional = true }\n\n[lints]\nworkspace = true\n";
        assert_eq!(
            member(manifest),
            "[package]\nname = \"a\"\n\n[dependencies]\nclap.workspace = true\n\n[lints]\nworkspace = true\n"
        );
    }

    #[test]
    fn a_workspace_keeps_what_its_members_want() {
        let manifest = "[workspace]\nmembers = [\"exercises\", \"solutions\", \"tests/checks\"]\n\n\
                        [workspace.dependencies]\nglam = \"1\" # vectors\nsolutions = { path = \"solutions\" }\n\n\
                        # Only for authors.\nsyn = \"3\"\n\n# All of them.\n\n[[test]]\nname = \"stage1\"\n\n\
                        [[test]]\nname = \"untouched\"\n\n[profile.dev.package.\"*\"]\nopt-level = 2\n\n\
                        # A database.\n[profile.dev.package.sqlite]\nopt-level = 0\n";
        let wanted = BTreeSet::from(["glam".to_owned()]);
        assert_eq!(
            workspace(manifest, &wanted, &|path| path == "tests/stage1.rs"),
            "[workspace]\nmembers = [\"exercises\", \"tests/checks\"]\n\n[workspace.dependencies]\n\
             glam = \"1\" # vectors\n\n# All of them.\n\n[[test]]\nname = \"stage1\"\n\n\
             [profile.dev.package.\"*\"]\nopt-level = 2\n"
        );
    }
}
