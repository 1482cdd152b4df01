//! The rubric: points, title, slide and three hints of each check, read from `tests/checks/stageN/rubric.toml`. A
//! [`Course`] may change them. It is part of this crate so that `raykata list` and `raykata hint` need not build the checks.
//!
//! Rubric, course file and language file write a check in the same way, as a table `[stageN.checks.NAME]`: a lecturer copies an
//! entry of the rubric into the course file and edits it there.

pub use super::score::{Level, Score};
pub use super::stage::{CheckEntry, Stage};
use super::stage::{PLAIN, RUBRIC_FILES};
use super::{Course, parse, parse_language};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{LazyLock, OnceLock};

static FILE: LazyLock<BTreeMap<String, Stage>> = LazyLock::new(|| {
    let mut stages = PLAIN.clone();
    course().apply(&mut stages);
    stages
});

/// The path of a stage's deck, from the root of the kit.
pub fn deck(stage: u8) -> String {
    format!("slides/stage{stage:02}.md")
}

impl CheckEntry {
    /// Where the check is taught: a page of the kit's deck. Without the deck, and where the course names slides of its own, these.
    pub fn taught(&self) -> String {
        static DECKS: [OnceLock<String>; 12] = [const { OnceLock::new() }; 12];
        let deck = deck(self.stage);
        let read =
            || std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(&deck)).unwrap_or_default();
        let text = DECKS.get(usize::from(self.stage).wrapping_sub(1)).map(|text| text.get_or_init(read));
        match text.and_then(|text| page_of(text, &self.slide, &self.name)) {
            Some(page) => format!("{deck}, page {page}"),
            None => self.slide.clone(),
        }
    }
}

/// The page of a deck that teaches what a check tests, as `12: Object median`. A speaker note refers to checks by the beginning of
/// their names (`check "bounds_of_"`) and to slides of the lectures (`slide "RTGI: Object Median"`). The longest beginning decides,
/// then the slide, then the signature of the function with whose name the check begins, and then the first page. `None` if no note
/// refers to either.
fn page_of(deck: &str, slide: &str, check: &str) -> Option<String> {
    let longest = |text: &str, before: &str, after: &[char]| {
        let names = text.split(before).skip(1).filter_map(|rest| rest.split(after).next());
        names.filter(|name| check.starts_with(name)).map(str::len).max()
    };
    let fit = |page: &str| {
        let note = page.rsplit("<!--").next().unwrap_or_default();
        let named = longest(note, "check \"", &['"']);
        let is_of_slide = note.contains(&format!("slide \"{slide}\""));
        let fit = (named, is_of_slide, longest(page, "pub fn ", &['(', '<']));
        (named.is_some() || is_of_slide).then_some(fit)
    };
    // The text before the first page is about the whole deck.
    let pages = deck.split("\n---\n").enumerate().skip(1);
    let best = pages.filter_map(|(number, page)| Some((fit(page)?, Reverse(number), page))).max();
    let (_, Reverse(number), page) = best?;
    let heading = page.lines().find_map(|line| line.trim_start_matches('#').strip_prefix(' '))?;
    Some(format!("{number}: {heading}"))
}

/// The course of this program: that of [`use_course`], or that of the kit, which is the default outside of hand-outs.
static COURSE: OnceLock<Course> = OnceLock::new();

/// Applies a course to the rubric of this program, in place of that of the kit. Returns `false`, and changes nothing, if
/// the rubric was read before.
#[must_use]
pub fn use_course(course: Course) -> bool {
    COURSE.set(course).is_ok()
}

/// The course of the kit.
fn of_kit() -> Course {
    let file = |name| Path::new(name);
    let mut course = parse(file("tests/course.toml"), include_str!("../../tests/course.toml"))
        .unwrap_or_else(|error| panic!("{error}"));
    let language = include_str!("../../tests/language.toml");
    course.translate(
        parse_language(file("tests/language.toml"), language).unwrap_or_else(|error| panic!("{error}")),
    );
    course
}

/// The paths, from the root of the kit, of all files of `tests` that this crate needs when it is built: the rubric, the course
/// and its language.
pub fn files() -> impl Iterator<Item = &'static str> {
    RUBRIC_FILES.iter().map(|(path, _)| *path).chain(["tests/course.toml", "tests/language.toml"])
}

/// The whole rubric, by stage name (`stage1`, `stage2`, …), as the course changes it. It is parsed on first use.
///
/// # Panics
///
/// On first use, if one of [`files`] is malformed.
pub static RUBRIC: LazyLock<&BTreeMap<String, Stage>> = LazyLock::new(|| &FILE);

/// The course of this program.
///
/// # Panics
///
/// On the first use, if `tests/course.toml` or `tests/language.toml` is malformed.
pub fn course() -> &'static Course {
    COURSE.get_or_init(of_kit)
}

/// The stages that the course asks for, with their numbers, in ascending order.
///
/// # Panics
///
/// On the first use of [`RUBRIC`], if one of [`files`] is malformed.
pub fn stages() -> Vec<(u8, &'static Stage)> {
    let number = |name: &str| name.trim_start_matches("stage").parse().ok();
    let mut stages: Vec<(u8, &Stage)> =
        RUBRIC.iter().filter_map(|(name, stage)| Some((number(name)?, stage))).collect();
    stages.retain(|(number, _)| !course().leaves_out(*number));
    stages.sort_by_key(|(number, _)| *number);
    stages
}

/// The rubric's entry for a check. A check that the rubric does not list gets an entry of one point with its
/// name as title; a test of the kit finds such checks.
///
/// # Panics
///
/// On the first use of [`RUBRIC`], if one of [`files`] is malformed.
pub fn entry(stage: u8, check: &str) -> CheckEntry {
    RUBRIC.get(&format!("stage{stage}")).and_then(|stage| stage.checks.get(check)).cloned().unwrap_or_else(
        || CheckEntry {
            stage,
            name: check.into(),
            points: 1,
            title: check.replace('_', " "),
            ..CheckEntry::default()
        },
    )
}

/// The bar of this name in the table `[stageN.bars]` of the rubric: what the reference needs.
///
/// # Panics
///
/// On the first use of [`RUBRIC`], if one of [`files`] is malformed, and if there is no such bar.
pub fn bar(stage: u8, name: &str) -> f64 {
    let bar = RUBRIC.get(&format!("stage{stage}")).and_then(|stage| stage.bars.get(name));
    *bar.unwrap_or_else(|| {
        panic!(
            "tests/checks/stage{stage}/rubric.toml has no bar {name:?} in [stage{stage}.bars]; `author bars` writes it"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_check_is_taught_on_the_page_that_fits_best() {
        let deck = "---\nmarp: true\n---\n\n# One\n\n<!-- slide \"a: b\". -->\n\n---\n\n## Two\n\npub fn slab(\n\n<!-- slide \
                    \"a: b\". -->\n\n---\n\n## Three\n\n<!-- check \"slab_of_\". -->\n";
        let page = |slide: &str, check: &str| page_of(deck, slide, check);
        assert_eq!(page("a: b", "union_holds").as_deref(), Some("1: One"));
        assert_eq!(page("a: b", "slab_agrees").as_deref(), Some("2: Two"));
        assert_eq!(page("a: b", "slab_of_a_flat_box").as_deref(), Some("3: Three"));
        assert_eq!(page("a slide of another lecture", "slab_agrees"), None);
    }

    #[test]
    fn stages_and_checks_have_the_order_of_the_lecture() {
        let numbers: Vec<u8> = stages().into_iter().map(|(number, _)| number).collect();
        assert_eq!(numbers, (1..=12).collect::<Vec<_>>());
        for (number, stage) in stages() {
            let checks = stage.in_order();
            assert!(checks.iter().all(|(_, entry)| entry.stage == number && entry.place < usize::MAX));
            assert!(checks.is_sorted_by_key(|(_, entry)| entry.place));
        }
    }
}
