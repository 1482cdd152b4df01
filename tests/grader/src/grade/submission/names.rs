//! Names: of students, and of exercise files that a browser or a system has renamed.

use super::archive;
use std::ffi::OsStr;
use std::os::unix::ffi::OsStrExt;

/// Returns the name of a student from that of a folder or archive without its extension. Different names stay different:
/// bytes that are not valid UTF-8, and backslashes, are escaped.
pub fn of_student(name: &OsStr) -> String {
    let escaped = |bytes: &[u8]| bytes.iter().map(|byte| format!("\\x{byte:02x}")).collect::<String>();
    let parts = name.as_encoded_bytes().utf8_chunks();
    parts.map(|part| part.valid().replace('\\', "\\\\") + &escaped(part.invalid())).collect()
}

/// Splits the extension of an archive off a name, in upper or lower case.
pub fn archive_stem(name: &OsStr) -> Option<&OsStr> {
    let bytes = name.as_encoded_bytes();
    let endings = archive::ENDINGS.iter().chain(&archive::UNREADABLE);
    let stem = endings.filter_map(|ending| {
        let (stem, tail) = bytes.split_at_checked(bytes.len().checked_sub(ending.len())?)?;
        tail.eq_ignore_ascii_case(ending.as_bytes()).then_some(stem)
    });
    // Of `.gz` and `.tar.gz`, take the longer one.
    let stem = stem.min_by_key(|stem| stem.len())?;
    Some(OsStr::from_bytes(stem))
}

/// Returns the exercise file that a name stands for, and whether it is exactly its name. Accepts another case, and what
/// browsers and systems add: `.txt`, ` (1)`, ` - Copy`, `Copy of `, a dot at the end.
pub fn of_exercise<'a>(name: &str, wanted: &'a [String]) -> Option<(&'a str, bool)> {
    if let Some(exact) = wanted.iter().find(|wanted| *wanted == name) {
        return Some((exact, true));
    }
    let lower = name.trim_end_matches(['.', ' ']).to_lowercase();
    let plain = lower.strip_suffix(".txt").unwrap_or(&lower);
    let stem = plain.strip_suffix(".rs")?;
    let stem = stem.strip_prefix("copy of ").unwrap_or(stem);
    // Drop a number in brackets, then the word "copy" with its number.
    let stem = match stem.strip_suffix(')').and_then(|stem| stem.rsplit_once('(')) {
        Some((stem, number)) if number.bytes().all(|digit| digit.is_ascii_digit()) => stem.trim_end(),
        _ => stem,
    };
    let stem =
        stem.trim_end_matches(|c: char| c.is_ascii_digit() || c == ' ').strip_suffix("copy").unwrap_or(stem);
    let stem = stem.trim_end_matches([' ', '-', '_']);
    let exercise =
        |wanted: &&String| wanted.strip_suffix(".rs").is_some_and(|wanted| wanted.to_lowercase() == stem);
    wanted.iter().find(exercise).map(|wanted| (wanted.as_str(), false))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_students_differ_whatever_bytes_they_have() {
        let name = |bytes: &[u8]| of_student(OsStr::from_bytes(bytes));
        assert_eq!(name("Zoë".as_bytes()), "Zoë");
        let different = [&b"a\xff"[..], b"a\xfe", b"a\\xff", "a\u{fffd}".as_bytes(), b"a"].map(name);
        for (index, one) in different.iter().enumerate() {
            assert!(!different[..index].contains(one), "{one}");
        }
    }

    #[test]
    fn archives_are_known_by_their_extension_in_any_case() {
        let stem = |name: &'static str| archive_stem(OsStr::new(name)).map(|stem| stem.to_str().unwrap());
        for name in
            ["ann.zip", "ann.ZIP", "ann.tar.gz", "ann.TGZ", "ann.Tar", "ann.tar.xz", "ann.7z", "ann.rar"]
        {
            assert_eq!(stem(name), Some("ann"), "{name}");
        }
        assert_eq!(stem("ann.txt"), None);
        assert_eq!(stem("ann"), None);
    }

    #[test]
    fn renamed_exercises_are_recognised_and_others_are_not() {
        let wanted = ["stage1_shapes.rs".to_owned(), "stage10_stability.rs".to_owned()];
        assert_eq!(of_exercise("stage1_shapes.rs", &wanted), Some(("stage1_shapes.rs", true)));
        for name in [
            "Stage1_Shapes.rs",
            "stage1_shapes.rs.txt",
            "stage1_shapes (1).rs",
            "stage1_shapes(12).rs",
            "stage1_shapes copy.rs",
            "stage1_shapes copy 2.rs",
            "stage1_shapes - Copy.rs",
            "Copy of stage1_shapes.rs",
            "stage1_shapes.rs.",
            "stage1_shapes - Copy (3).RS",
        ] {
            assert_eq!(of_exercise(name, &wanted), Some(("stage1_shapes.rs", false)), "{name}");
        }
        for name in
            ["stage1.rs", "stage1_shapes.py", "shapes.rs", "stage1_shapes_old.rs", "stage2_shapes.rs", ".rs"]
        {
            assert_eq!(of_exercise(name, &wanted), None, "{name}");
        }
    }
}
