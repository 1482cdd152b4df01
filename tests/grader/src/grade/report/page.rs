//! The parts that all pages share. A page is one file that loads nothing from the network.

use crate::grade::result::Session;
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// A content security policy that forbids scripts and all outside resources. It protects readers even if a student's text
/// were not escaped.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'";

/// Returns a page with a title and a body.
pub(super) fn page(title: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="referrer" content="no-referrer";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(include_str!("style.css"))) }
            }
            body { (body) }
        }
    };
    page.into_string()
}

/// Describes course, kit, stages and sandbox of the grading, in one line.
pub(super) fn session_line(session: &Session) -> Markup {
    html! {
        p.session {
            @if !session.course.is_empty() { (session.course) " · " }
            "Kit " (session.kit) " · " (stages(&session.stages)) " · sandbox: " (session.isolation)
        }
    }
}

/// Describes stages as a range, or one by one if there are gaps.
fn stages(stages: &[u8]) -> String {
    match stages {
        [] => "no stages".to_owned(),
        [only] => format!("stage {only}"),
        [first, .., last] if usize::from(last - first) + 1 == stages.len() => {
            format!("stages {first}–{last}")
        }
        _ => {
            let stages: Vec<String> = stages.iter().map(u8::to_string).collect();
            format!("stages {}", stages.join(", "))
        }
    }
}

/// Formats a title: text between backticks becomes `code`.
pub(super) fn with_code(text: &str) -> Markup {
    html! {
        @for (i, part) in text.split('`').enumerate() {
            @if i % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_listed_briefly() {
        assert_eq!(stages(&[1, 2, 3, 4]), "stages 1–4");
        assert_eq!(stages(&[1, 3]), "stages 1, 3");
        assert_eq!(stages(&[7]), "stage 7");
    }

    #[test]
    fn code_is_marked_and_everything_is_escaped() {
        assert_eq!(with_code("`a<b>` & c").into_string(), "<code>a&lt;b&gt;</code> &amp; c");
    }
}
