//! Makes text from students harmless for terminals, editors and readers. Escaping is up to each format.

use std::iter::Peekable;
use std::str::Chars;

/// Returns at most `cap` bytes of `text`, without invisible characters and without characters that move or recolour other
/// text: control characters (except line ends and tabs), terminal escape sequences, bidirectional overrides. If text was
/// cut, a note at the end says how much. Cleaning a cleaned text changes nothing.
pub fn clean(text: &str, cap: usize) -> String {
    cut(visible(text), cap, "\n")
}

/// Cleans a name or a cell of a table: the result is one line with single spaces.
pub fn clean_line(text: &str, cap: usize) -> String {
    let words: Vec<String> = visible(text).split_whitespace().map(str::to_owned).collect();
    cut(words.join(" "), cap, " ")
}

fn visible(text: &str) -> String {
    let mut kept = String::new();
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        match c {
            '\n' | '\t' => kept.push(c),
            '\u{1b}' => skip_escape(&mut rest),
            '\u{9b}' => skip_control_sequence(&mut rest),
            // CRLF is one line end. A single CR would let lines overwrite each other on a terminal.
            '\r' if rest.peek() == Some(&'\n') => {}
            '\r' | '\u{85}' | '\u{2028}' | '\u{2029}' => kept.push('\n'),
            _ if c.is_control() || is_invisible(c) => {}
            _ => kept.push(c),
        }
    }
    kept
}

/// Skips the rest of an escape sequence: a control sequence, a string for the terminal, or one character.
fn skip_escape(rest: &mut Peekable<Chars>) {
    match rest.peek() {
        Some('[') => {
            rest.next();
            skip_control_sequence(rest);
        }
        Some(']' | 'P' | 'X' | '^' | '_') => skip_terminal_string(rest),
        _ => {
            while rest.next_if(|c| matches!(c, ' '..='/')).is_some() {}
            rest.next_if(|c| matches!(c, '0'..='~'));
        }
    }
}

fn skip_control_sequence(rest: &mut Peekable<Chars>) {
    while rest.next_if(|c| matches!(c, ' '..='?')).is_some() {}
    rest.next_if(|c| matches!(c, '@'..='~'));
}

/// Skips a terminal string, such as a window title or a link. It stops at the end of the line at the latest, so that an
/// unfinished string cannot hide the lines below.
fn skip_terminal_string(rest: &mut Peekable<Chars>) {
    while let Some(c) = rest.next_if(|&c| c != '\n') {
        match c {
            '\u{7}' | '\u{9c}' => return,
            '\u{1b}' => {
                rest.next_if_eq(&'\\');
                return;
            }
            _ => {}
        }
    }
}

/// Returns whether a character is invisible and may reorder, join or hide others, or is not a character at all.
fn is_invisible(c: char) -> bool {
    matches!(
        c,
        '\u{ad}'
            | '\u{34f}'
            | '\u{61c}'
            | '\u{115f}'..='\u{1160}'
            | '\u{17b4}'..='\u{17b5}'
            | '\u{180b}'..='\u{180f}'
            | '\u{200b}'..='\u{200f}'
            | '\u{202a}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}'
            | '\u{2800}'
            | '\u{3164}'
            | '\u{fdd0}'..='\u{fdef}'
            | '\u{fe00}'..='\u{fe0f}'
            | '\u{feff}'
            | '\u{ffa0}'
            | '\u{fff0}'..='\u{fffb}'
            | '\u{13430}'..='\u{1343f}'
            | '\u{1bca0}'..='\u{1bca3}'
            | '\u{1d173}'..='\u{1d17a}'
            | '\u{e0000}'..='\u{e0fff}'
    ) || u32::from(c) & 0xfffe == 0xfffe
}

fn cut(text: String, cap: usize, before_mark: &str) -> String {
    if text.len() <= cap {
        return text;
    }
    let mark = |n: usize| format!("{before_mark}[… {n} more bytes were cut]");
    // The note for the whole text is the longest possible one. If even that does not fit, cut the text without a note.
    let room = cap.checked_sub(mark(text.len()).len());
    let kept = upto(&text, room.unwrap_or(cap)).trim_end();
    match room {
        Some(_) if kept.is_empty() => mark(text.len()).trim_start().to_owned(),
        Some(_) => format!("{kept}{}", mark(text.len() - kept.len())),
        None => kept.to_owned(),
    }
}

fn upto(text: &str, n_bytes: usize) -> &str {
    let end = (0..=n_bytes.min(text.len())).rev().find(|&end| text.is_char_boundary(end));
    &text[..end.unwrap_or(0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn escapes_overrides_and_controls_go_and_text_stays() {
        for (dirty, cleaned) in [
            ("a\u{1b}[31;1mred\u{1b}[0m b", "ared b"),
            ("a\u{9b}2Jb", "ab"),
            ("x\u{1b}]0;title\u{7}y\u{1b}]8;;http://example.org\u{1b}\\z", "xyz"),
            ("x\u{1b}]0;never ends\nnext", "x\nnext"),
            ("x\u{1b}(By\u{1b}cz\u{1b}", "xyz"),
            ("evil\u{202e}txt.exe\u{2066}\u{200b}\u{feff}", "eviltxt.exe"),
            ("one\r\ntwo\rthree\u{2028}four\0\u{8}\t!", "one\ntwo\nthree\nfour\t!"),
            ("tags\u{e0041}\u{fe0f}\u{ffff}\u{1fffe}", "tags"),
            ("Zoë Ångström 名前 ∩ ✓", "Zoë Ångström 名前 ∩ ✓"),
        ] {
            assert_eq!(clean(dirty, 1000), cleaned);
        }
    }

    #[test]
    fn what_is_cut_is_reported() {
        assert_eq!(clean(&"é".repeat(50), 60), format!("{}\n[… 70 more bytes were cut]", "é".repeat(15)));
        assert_eq!(clean("äöü", 3), "ä");
        assert_eq!(clean_line(&"x".repeat(100), 30), "[… 100 more bytes were cut]");
        assert_eq!(clean_line("  two\n\twords ", 100), "two words");
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn nothing_dangerous_survives(
            text in proptest::collection::vec(prop_oneof![
                any::<char>(),
                proptest::sample::select(vec!['\u{1b}', '[', ']', '\\', '\u{7}', '\r', '\n', '\u{202e}', '\u{9b}', 'm', ' ']),
            ], 0..300),
            cap in 0usize..400,
        ) {
            let text: String = text.into_iter().collect();
            for cleaned in [clean(&text, cap), clean_line(&text, cap)] {
                prop_assert!(cleaned.len() <= cap);
                prop_assert!(cleaned.chars().all(|c| matches!(c, '\n' | '\t') || !c.is_control() && !is_invisible(c)));
            }
            let once = clean(&text, cap);
            prop_assert_eq!(&clean(&once, cap), &once);
            let line = clean_line(&text, cap);
            prop_assert!(!line.contains(['\n', '\t']));
            prop_assert_eq!(&clean_line(&line, cap), &line);
        }

        #[test]
        fn plain_text_stays_as_it_is(text in "[ -~\nà-ž]{0,200}") {
            prop_assert_eq!(clean(&text, 1000), text);
        }
    }
}
