//! Changes of texts, for tests that try many texts. Tests of the reference use this file too.

/// The text with lines removed, added in their place or, without a sign, added at the end.
pub fn changed(text: &str, changes: &[&str]) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let mut place = 0;
    for change in changes {
        if let Some(line) = change.strip_prefix("- ") {
            place += lines[place..].iter().position(|known| *known == line).expect(change);
            lines.remove(place);
        } else if let Some(line) = change.strip_prefix("+ ") {
            lines.insert(place, line);
            place += 1;
        } else {
            lines.push(change);
        }
    }
    lines.iter().map(|line| format!("{line}\n")).collect()
}
