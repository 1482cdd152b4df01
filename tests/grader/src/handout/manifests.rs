//! Removes from the workspace's manifest the parts that are not handed out. The manifest is cut as text, so that its
//! comments stay.

use anyhow::{Context, Result};
use std::collections::{BTreeMap, BTreeSet};

/// Returns the manifest of a hand-out with these files, which include those of its packages.
pub(super) fn of_workspace(text: &str, files: &BTreeMap<String, Vec<u8>>) -> Result<String> {
    let mut wanted = dependencies(text)?;
    for (path, manifest) in files.iter().filter(|(path, _)| path.ends_with("/Cargo.toml")) {
        wanted.extend(dependencies(&String::from_utf8_lossy(manifest)).with_context(|| path.to_owned())?);
    }
    let lock = files.get("Cargo.lock").map(|lock| String::from_utf8_lossy(lock).into_owned());
    let built = built(&lock.unwrap_or_default(), &wanted)?;
    Ok(workspace(text, &wanted, &built, &|path| {
        let (start, end) = path.split_once('*').unwrap_or((path, ""));
        let is = |file: &String| file.starts_with(start) && file.ends_with(end) && file.len() >= path.len();
        if path.contains('*') { files.keys().any(is) } else { files.contains_key(path) }
    }))
}

/// Returns the names of all packages that these need, by the locked versions.
fn built(lock: &str, wanted: &BTreeSet<String>) -> Result<BTreeSet<String>> {
    let lock: toml::Table = toml::from_str(lock)?;
    let packages = lock.get("package").and_then(|packages| packages.as_array()).into_iter().flatten();
    let mut needs: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for package in packages {
        let name = package.get("name").and_then(|name| name.as_str()).unwrap_or_default();
        let list = package.get("dependencies").and_then(|list| list.as_array()).into_iter().flatten();
        // If there are several versions, the version follows the name.
        let list = list.filter_map(|one| one.as_str()?.split(' ').next());
        needs.entry(name).or_default().extend(list);
    }
    let mut built = wanted.clone();
    let mut waiting: Vec<&str> = wanted.iter().map(String::as_str).collect();
    while let Some(name) = waiting.pop() {
        let list = needs.get(name).into_iter().flatten();
        waiting.extend(list.filter(|one| built.insert((**one).to_owned())));
    }
    Ok(built)
}

/// Returns the workspace with its present members and their dependencies. Settings stay for packages that are built.
/// `present` returns whether a file exists; its name may contain a `*`.
fn workspace(
    text: &str,
    wanted: &BTreeSet<String>,
    built: &BTreeSet<String>,
    present: &dyn Fn(&str) -> bool,
) -> String {
    let text = with_settings_of(built, &with_members(text, present));
    let mut of_workspace = false;
    cut(&text, |lines, kept| {
        let header = lines.iter().find(|line| line.starts_with('['));
        if let Some(header) = header {
            of_workspace = *header == "[workspace.dependencies]";
        }
        let missing = header == Some(&"[[test]]")
            && lines.iter().filter_map(|line| line.strip_prefix("name = ")).any(|name| {
                let name = name.trim_matches('"');
                !present(&format!("tests/{name}.rs"))
            });
        kept.retain(|line| {
            let dependency = line.split_once(" = ").filter(|_| of_workspace && !line.starts_with('#'));
            !missing && dependency.is_none_or(|(name, _)| wanted.contains(name))
        });
    })
}

/// Returns the text with the settings of only those packages that are built. Cargo would warn about others.
fn with_settings_of(built: &BTreeSet<String>, text: &str) -> String {
    let mut keep = true;
    let mut kept = String::new();
    for line in text.lines() {
        if line.is_empty() || line.starts_with('[') || line.starts_with('#') {
            let of_package = line.strip_prefix("[profile.").and_then(|rest| rest.split_once(".package."));
            let name = of_package.map(|(_, name)| name.trim_end_matches(']').trim_matches('"'));
            keep = name.is_none_or(|name| name == "*" || built.contains(name));
        }
        if keep {
            kept += line;
            kept.push('\n');
        }
    }
    // Remove a comment without settings.
    let stood_alone = |part: &str| text.split("\n\n").any(|one| one.trim_end() == part.trim_end());
    let parts = kept.split("\n\n").filter(|part| !is_comment(part) || stood_alone(part));
    parts.collect::<Vec<_>>().join("\n\n")
}

fn is_comment(paragraph: &str) -> bool {
    paragraph.lines().all(|line| line.starts_with('#'))
}

/// Returns the text with only those members and default members that are present.
fn with_members(text: &str, present: &dyn Fn(&str) -> bool) -> String {
    let mut rest = text;
    let mut changed = String::new();
    while let Some(start) = rest.find("members = [") {
        let list = start + "members = [".len();
        let Some(length) = rest[list..].find(']') else { break };
        let members = rest[list..list + length].split(',').map(|member| member.trim().trim_matches('"'));
        let is_present = |member: &&str| {
            *member == "." || (!member.is_empty() && present(&format!("{member}/Cargo.toml")))
        };
        let kept: Vec<String> = members.filter(is_present).map(|member| format!("\"{member}\"")).collect();
        changed += &rest[..list];
        changed += &kept.join(", ");
        rest = &rest[list + length..];
    }
    changed + rest
}

/// Calls `choose` for each paragraph. It removes lines from its second argument. A paragraph with only headers and comments
/// left is removed as well, except if it was only a comment before.
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

/// Returns the names of a package's dependencies, also of those that only some systems need.
fn dependencies(manifest: &str) -> Result<BTreeSet<String>> {
    let manifest: toml::Table = toml::from_str(manifest)?;
    let of_systems = manifest.get("target").and_then(|target| target.as_table()).into_iter();
    let of_systems = of_systems.flat_map(|target| target.values()).filter_map(|system| system.as_table());
    let tables = std::iter::once(&manifest).chain(of_systems).flat_map(|table| {
        ["dependencies", "dev-dependencies"].into_iter().filter_map(|name| table.get(name)?.as_table())
    });
    Ok(tables.flat_map(|table| table.keys().cloned()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependencies_of_one_system_count() {
        let manifest = "[dependencies]\nglam = \"1\"\n[target.'cfg(unix)'.dependencies]\nnix.workspace = true\n\
                        [dev-dependencies]\ninsta = \"1\"\n";
        let names: Vec<String> = dependencies(manifest).unwrap().into_iter().collect();
        assert_eq!(names, ["glam", "insta", "nix"]);
    }

    #[test]
    fn a_workspace_keeps_what_its_members_want() {
        let manifest = "[workspace]\nmembers = [\"exercises\", \"solutions\", \"tests/checks\", \"tests/x*\"]\n\n\
                        [workspace.dependencies]\nglam = \"1\" # vectors\nsolutions = { path = \"solutions\" }\n\n\
                        # Only for authors.\nsyn = \"3\"\n\n# All of them.\n\n[[test]]\nname = \"stage1\"\n\n\
                        [[test]]\nname = \"untouched\"\n\n[profile.dev.package.\"*\"]\nopt-level = 2\n\n\
                        [profile.dev.package.matrixmultiply]\nopt-level = 3\n\n\
                        # A database.\n[profile.dev.package.sqlite]\nopt-level = 0\n";
        let wanted = BTreeSet::from(["glam".to_owned()]);
        let lock = "[[package]]\nname = \"glam\"\ndependencies = [\"matrixmultiply 1.0.0\"]\n\
                    [[package]]\nname = \"sqlite\"\n";
        let built = built(lock, &wanted).unwrap();
        assert_eq!(
            workspace(manifest, &wanted, &built, &|path| {
                ["tests/stage1.rs", "exercises/Cargo.toml", "tests/checks/Cargo.toml"].contains(&path)
            }),
            "[workspace]\nmembers = [\"exercises\", \"tests/checks\"]\n\n[workspace.dependencies]\n\
             glam = \"1\" # vectors\n\n# All of them.\n\n[[test]]\nname = \"stage1\"\n\n\
             [profile.dev.package.\"*\"]\nopt-level = 2\n\n[profile.dev.package.matrixmultiply]\nopt-level = 3\n"
        );
    }
}
