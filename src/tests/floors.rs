//! The floors of the kit: a file uses files of its own floor and of lower ones, and no files use each other in a circle. Tests
//! may use all floors.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The files and folders of `src`, from the lowest floor to the highest. Programs stand above them.
const FLOORS: [&str; 9] = [
    "message",
    "geometry",
    "light camera count",
    "progress",
    "trees",
    "scene",
    "files kit",
    "world course",
    "tracer",
];

/// The packages of the workspace in the same order. None uses another one of its own floor.
const PACKAGES: [&str; 9] = [
    "raykata browser",
    "raykata-cli oracle checks",
    "stage1 stage2 stage3 stage4 stage5 stage6 stage7 stage8 stage9 stage10 stage11 stage12 live figures",
    "all-checks",
    "judge",
    "grader",
    "author",
    "exercises solutions",
    "misbehaving peers",
];

/// The number of the floor that lists a name; `None` if no floor does.
fn floor(floors: &[&str], name: &str) -> Option<usize> {
    floors.iter().position(|names| names.split(' ').any(|known| known == name))
}

/// Finds the paths at the start of `text`, with their new names after `as`: `a::{b, c::d}` has `a::b` and `a::c::d`. Returns
/// the text after them.
fn paths<'t>(text: &'t str, prefix: &str, found: &mut Vec<(String, String)>) -> &'t str {
    let end_of =
        |text: &str| text.find(|c: char| !c.is_alphanumeric() && !"_:".contains(c)).unwrap_or(text.len());
    let (names, mut rest) = text.trim_start().split_at(end_of(text.trim_start()));
    let path = prefix.to_owned() + names;
    if rest.starts_with('{') {
        while rest.starts_with(['{', ',']) {
            rest = paths(&rest[1..], &path, found).trim_start();
        }
        return rest.strip_prefix('}').unwrap_or(rest);
    }
    if !names.is_empty() {
        let alias = rest.strip_prefix(" as ").map(|alias| alias.split_at(end_of(alias)));
        let (name, after) = alias.unwrap_or((path.rsplit("::").next().unwrap_or_default(), rest));
        found.push((path.clone(), name.to_owned()));
        rest = after;
    }
    rest
}

/// The modules of a crate by their paths; that of `lib.rs` is empty.
#[derive(Default)]
struct Crate {
    /// The paths that a module names, with whether a `pub use` names them.
    modules: BTreeMap<String, Vec<(bool, String)>>,
    /// The original of each path that a `pub use` adds.
    exports: BTreeMap<String, String>,
}

impl Crate {
    /// Reads files, each given by its path within `src` and its text.
    fn new(files: &[(String, String)]) -> Crate {
        let module = |path: &str| match path.trim_end_matches(".rs") {
            "lib" => String::new(),
            path => path.trim_end_matches("/mod").replace('/', "::"),
        };
        let mut read = Crate::default();
        read.modules.extend(files.iter().map(|(path, _)| (module(path), Vec::new())));
        for (path, text) in files {
            let module = module(path);
            let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
            let code: Vec<&str> = code.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
            let code = code.join("\n");
            let starts =
                ["use ", "crate::", "super::"].into_iter().flat_map(|start| code.match_indices(start));
            for (at, start) in starts.filter(|(at, _)| !code[..*at].ends_with([':', '$'])) {
                let is_public = start == "use " && code[..at].trim_end_matches(' ').ends_with(['b', ')']);
                let mut found = Vec::new();
                paths(code[at..].trim_start_matches("use "), "", &mut found);
                for (path, name) in found {
                    let Some(path) = read.absolute(&module, &path) else { continue };
                    if is_public {
                        read.exports.insert(join(&module, &name), path.clone());
                    }
                    read.modules.entry(module.clone()).or_default().push((is_public, path));
                }
            }
        }
        read
    }

    /// The path from the root of the crate; `None` for a path into another crate.
    fn absolute(&self, module: &str, path: &str) -> Option<String> {
        if let Some(path) = path.strip_prefix("crate::") {
            return Some(path.to_owned());
        }
        if let Some(path) = path.strip_prefix("super::") {
            let parent = module.rsplit_once("::").map_or("", |(parent, _)| parent);
            return self.absolute(parent, path).or_else(|| Some(join(parent, path)));
        }
        let first = path.split("::").next().unwrap_or_default();
        self.modules.contains_key(&join(module, first)).then(|| join(module, path))
    }

    /// The module that defines the item at this path.
    fn home(&self, path: &str) -> String {
        let (mut module, mut rest) = ("", path);
        while let Some(name) = rest.split("::").next().filter(|name| !name.is_empty()) {
            let end = path.len() - rest.len() + name.len();
            rest = path[end..].trim_start_matches("::");
            match self.exports.get(&path[..end]) {
                _ if self.modules.contains_key(&path[..end]) => module = &path[..end],
                Some(original) => return self.home(&join(original, rest)),
                None => break,
            }
        }
        module.to_owned()
    }

    /// Which module uses which other one. A module that re-exports what its own folder defines does not use it.
    fn arrows(&self) -> BTreeSet<(String, String)> {
        let mut arrows = BTreeSet::new();
        for (module, named) in self.modules.iter().filter(|(module, _)| !module.is_empty()) {
            for (is_public, path) in named {
                let home = self.home(path);
                let is_own = home == *module || *is_public && home.starts_with(&join(module, ""));
                // A path of one name that is no module is a macro.
                if !is_own && (!home.is_empty() || path.contains("::")) {
                    arrows.insert((module.clone(), home));
                }
            }
        }
        arrows
    }
}

/// The path of `name` in `module`.
fn join(module: &str, name: &str) -> String {
    if module.is_empty() { name.to_owned() } else { format!("{module}::{name}") }
}

/// A sentence about each arrow that runs up, and about each arrow of a circle.
fn faults(arrows: &BTreeSet<(String, String)>) -> Vec<String> {
    let floor = |module: &str| floor(&FLOORS, module.split("::").next().unwrap_or_default());
    let up = arrows.iter().filter(|(from, to)| floor(to).is_none_or(|to| floor(from) < Some(to)));
    let mut faults: Vec<String> = up.map(|(from, to)| format!("{from} uses {to}, which is higher")).collect();
    // Drop arrows to modules that use nothing, and from modules that nothing uses, until only circles are left.
    let (mut left, mut before) = (arrows.clone(), usize::MAX);
    while left.len() < before {
        before = left.len();
        let (users, used): (BTreeSet<_>, BTreeSet<_>) = left.iter().cloned().unzip();
        left.retain(|(from, to)| users.contains(to) && used.contains(from));
    }
    faults.extend(left.iter().map(|(from, to)| format!("{from} uses {to} in a circle")));
    faults
}

/// Finds the Rust files in a folder, without tests and without those of other packages.
fn rust_files(src: &Path, folder: &Path, files: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() && !path.join("Cargo.toml").exists() && !path.ends_with("tests") {
            rust_files(src, &path, files);
        } else if path.extension().is_some_and(|end| end == "rs") && !path.ends_with("tests.rs") {
            let name = path.strip_prefix(src).expect("a file of src").to_string_lossy().replace('\\', "/");
            files.push((name, fs::read_to_string(&path).expect("a text")));
        }
    }
}

#[test]
fn no_file_uses_a_higher_floor_or_a_circle() {
    let (src, mut files) = (Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), Vec::new());
    rust_files(&src, &src, &mut files);
    let arrows = Crate::new(&files).arrows();
    assert!(arrows.len() > 400, "only {} arrows", arrows.len());
    let faults = faults(&arrows);
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The packages that a package must not use although its manifest lists them.
fn package_faults(manifest: &str) -> Vec<String> {
    let after = |start: &str| manifest.split_once(start).map_or("", |(_, rest)| rest);
    let name = after("name = \"").split('"').next().unwrap_or_default();
    let own = floor(&PACKAGES, name);
    let table = after("[dependencies]\n").split("\n[").next().unwrap_or_default();
    let used = table.lines().filter_map(|line| line.split(['.', ' ']).next());
    let used = used.filter(|used| floor(&PACKAGES, used).is_some_and(|used| own <= Some(used)));
    used.map(|used| format!("{name} uses {used}")).collect()
}

#[test]
fn no_package_uses_one_of_its_own_or_a_higher_floor() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folders =
        ["", "src", "tests", "tests/checks"].into_iter().flat_map(|folder| fs::read_dir(root.join(folder)));
    let manifests = folders.flatten().map(|entry| entry.expect("an entry").path().join("Cargo.toml"));
    let faults: Vec<String> =
        manifests.flat_map(fs::read_to_string).flat_map(|manifest| package_faults(&manifest)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    let planted =
        "[package]\nname = \"stage3\"\n[dependencies]\nraykata.workspace = true\ngrader.workspace = true\n";
    assert_eq!(package_faults(planted), ["stage3 uses grader"]);
}

#[test]
fn planted_arrows_and_circles_are_found() {
    let lib = ("lib.rs", "pub use geometry::ray;\npub use camera::{film, rows as lines};");
    let faults = |files: &[(&str, &str)]| {
        let files = files
            .iter()
            .chain([&lib, &("geometry/mod.rs", "pub mod ray;")])
            .map(|&(path, text)| (path.to_owned(), text.to_owned()));
        faults(&Crate::new(&files.collect::<Vec<_>>()).arrows())
    };
    let camera = ("camera/mod.rs", "pub mod film;\npub mod rows;\npub use film::Film;");
    let film = (
        "camera/film.rs",
        "use crate::{ray::{Ray, Range}};\n#[cfg(test)]\nmod tests {\nuse crate::kit::A;\n}",
    );
    let (ray, rows) = (("geometry/ray.rs", "use glam::Vec3;"), ("camera/rows.rs", "use super::Film;"));
    assert_eq!(faults(&[camera, film, ray, rows]), [""; 0]);
    // An arrow that runs up by the short path of `lib.rs`, by a re-export, or without `use`.
    let higher = ["geometry::ray uses camera::film, which is higher"];
    for text in ["use crate::film;", "use crate::camera::{Film};", "fn a() { crate::camera::Film::new() }"] {
        assert_eq!(faults(&[camera, film, rows, ("geometry/ray.rs", text)])[..1], higher, "{text}");
    }
    // A circle of two files of a folder, which the arrow from `rows` to `film` closes.
    let film = ("camera/film.rs", "use crate::lines::Rows;");
    let circle = ["camera::film uses camera::rows in a circle", "camera::rows uses camera::film in a circle"];
    assert_eq!(faults(&[camera, film, ray, rows]), circle);
}
