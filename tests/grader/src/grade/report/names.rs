//! Makes file names from the names of students, which may be any text.

use sha2::{Digest, Sha256};
use std::collections::BTreeSet;

/// Longest part of a name that is kept, in bytes.
const LONGEST: usize = 60;

/// Reserved names: device names of some systems, and the page of the class.
const RESERVED: [&str; 5] = ["con", "prn", "aux", "nul", "index"];

/// Makes a file name for each student. It contains only letters, digits, `-`, `_` and `.`. The names also differ on file
/// systems that ignore case. A changed name ends in a fingerprint of the old one.
#[derive(Default)]
pub struct FileNames {
    taken: BTreeSet<String>,
}

impl FileNames {
    /// Returns the file name for the next student.
    pub fn name(&mut self, student: &str) -> String {
        let plain = plain(student);
        let marked = format!("{plain}-{}", fingerprint(student));
        let numbered = (2..).map(|n: usize| format!("{marked}-{n}"));
        let unchanged = (plain == student).then(|| plain.clone());
        let mut names = unchanged.into_iter().chain([marked.clone()]).chain(numbered);
        // There are more numbers than students, so one of these names is free.
        names.find(|name| self.taken.insert(name.to_lowercase())).unwrap_or_default()
    }
}

fn plain(student: &str) -> String {
    let mut plain = String::new();
    for c in student.chars() {
        match c {
            'a'..='z' | 'A'..='Z' | '0'..='9' | '_' | '.' => plain.push(c),
            _ if !plain.ends_with('-') => plain.push('-'),
            _ => {}
        }
    }
    plain.truncate(LONGEST);
    let plain = plain.trim_matches(['-', '.']);
    let device = plain.split('.').next().unwrap_or_default().to_lowercase();
    let numbered = ["com", "lpt"].iter().any(|port| device.strip_prefix(port).is_some_and(|n| n.len() == 1));
    match plain.is_empty() || numbered || RESERVED.contains(&device.as_str()) {
        true => format!("student-{plain}").trim_end_matches('-').to_owned(),
        false => plain.to_owned(),
    }
}

fn fingerprint(text: &str) -> String {
    Sha256::digest(text).iter().take(4).map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn names(students: &[&str]) -> Vec<String> {
        let mut names = FileNames::default();
        students.iter().map(|student| names.name(student)).collect()
    }

    fn is_safe(name: &str) -> bool {
        name.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.'))
            && !name.is_empty()
            && !name.starts_with(['.', '-'])
            && name.len() < 100
    }

    #[test]
    fn ordinary_names_stay() {
        let ordinary = ["anna", "b.mueller", "C_3-x", "group-12"];
        assert_eq!(names(&ordinary), ordinary);
    }

    #[test]
    fn odd_names_become_plain_ones_that_differ() {
        let long = "x".repeat(500);
        let odd = [
            "",
            ".",
            "..",
            "../../etc/passwd",
            "a/b",
            "a\\b",
            "a b",
            "A b",
            "anna",
            "Anna",
            "ANNA",
            "anna",
            "名前",
            "名字",
            "con",
            "NUL.txt",
            "com1",
            "index",
            "<script>alert(1)</script>",
            "=cmd|' /C calc'!A0",
            "a\0b",
            "-rf",
            &long,
            ".hidden",
            "é",
            "e\u{301}",
            "trailing.",
        ];
        let names = names(&odd);
        assert!(names.iter().all(|name| is_safe(name)), "{names:?}");
        let different: BTreeSet<String> = names.iter().map(|name| name.to_lowercase()).collect();
        assert_eq!(different.len(), odd.len(), "{names:?}");
        assert!(names[odd.iter().position(|&name| name == "con").unwrap_or(0)].starts_with("student-con-"));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn any_text_gives_safe_names_that_differ(students in proptest::collection::vec("(?s).{0,12}|[aA]{1,2}(-2)?", 0..30)) {
            let students: Vec<&str> = students.iter().map(String::as_str).collect();
            let names = names(&students);
            prop_assert!(names.iter().all(|name| is_safe(name)), "{names:?}");
            let different: BTreeSet<String> = names.iter().map(|name| name.to_lowercase()).collect();
            prop_assert_eq!(different.len(), students.len());
        }
    }
}
