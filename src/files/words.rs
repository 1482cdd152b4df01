//! Names in messages: how they are shown, and which known name was probably meant.

/// The known name with the smallest Damerau-Levenshtein distance to `word`, without regard to case, if at
/// most a third of the letters differ (or one). A name of more than 100 characters is never the answer.
pub(crate) fn nearest<'n>(word: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    let word = word.to_lowercase();
    known
        .into_iter()
        .filter_map(|name| {
            let longest = word.chars().count().max(name.chars().count());
            // Skip long names, because the comparison takes time and memory quadratic in the length.
            if longest > 100 {
                return None;
            }
            let slips = strsim::damerau_levenshtein(&word, &name.to_lowercase());
            (slips <= (longest / 3).max(1) && slips < longest).then_some((slips, name))
        })
        .min_by_key(|(slips, _)| *slips)
        .map(|(_, name)| name)
}

/// The name between backticks, on one line and cut after 60 characters.
pub(crate) fn quoted(name: &str) -> String {
    format!("`{}`", one_line(name))
}

/// The first 60 characters of `text` on one line, control characters escaped; an ellipsis stands for the
/// rest.
pub(crate) fn one_line(text: &str) -> String {
    const LONGEST: usize = 60; // keeps a message with two names within two lines of a terminal
    let cut = text.char_indices().nth(LONGEST).map_or(text.len(), |(end, _)| end);
    let mut line = String::new();
    for character in text[..cut].chars() {
        if character.is_control() { line.extend(character.escape_default()) } else { line.push(character) }
    }
    if cut < text.len() {
        line.push('…');
    }
    line
}

/// The names for a sentence, each between backticks: "`a`, `b`, `c`". After 17 names only the number of the
/// others is given.
pub(crate) fn listed<'n>(names: impl IntoIterator<Item = &'n str>) -> String {
    const MOST: usize = 17; // the most keys that a table has; a scene may define hundreds of materials
    let mut names = names.into_iter();
    let shown: Vec<String> = names.by_ref().take(MOST).map(quoted).collect();
    match names.count() {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slip_of_the_finger_is_forgiven_and_another_word_is_not() {
        let known = ["center", "radius", "a", "b"];
        assert_eq!(nearest("radus", known), Some("radius"));
        assert_eq!(nearest("Centre", known), Some("center"));
        assert_eq!(nearest("normal", known), None);
        assert_eq!(nearest("c", known), None);
        assert_eq!(nearest("", known), None);
    }

    #[test]
    fn a_name_stays_on_its_line() {
        assert_eq!(quoted("a\nb\u{1b}[31m"), "`a\\nb\\u{1b}[31m`");
        assert_eq!(quoted(&"é".repeat(61)), format!("`{}…`", "é".repeat(60)));
        assert_eq!(listed(["a"; 19]).matches('a').count(), 17 + 1); // the `a` of "and"
    }
}
