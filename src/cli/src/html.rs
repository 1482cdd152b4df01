//! Small pieces of HTML, and data as text.

use crate::svg::escaped;
use std::fmt::{Display, Write};

/// The text, escaped for HTML.
pub fn escape(text: impl Display) -> String {
    escaped(&text.to_string()).replace('"', "&quot;")
}

/// An element around text, which is escaped.
pub fn element(name: &str, text: impl Display) -> String {
    around(name, "", &escape(text))
}

/// An element with attributes around HTML. Attributes are not escaped.
pub fn around(name: &str, attributes: &str, inner: &str) -> String {
    let space = if attributes.is_empty() { "" } else { " " };
    format!("<{name}{space}{attributes}>{inner}</{name}>")
}

/// Bytes in base64, as web pages hold pictures.
pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |place: usize| u32::from(group.get(place).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            let digit = char::from(DIGITS[(bits >> (18 - 6 * place) & 63) as usize]);
            text.push(if place > group.len() { '=' } else { digit });
        }
    }
    text
}

/// A line of a CSV table (RFC 4180).
pub fn csv_line(cells: &[String]) -> String {
    let mut line = String::new();
    for (place, cell) in cells.iter().enumerate() {
        let comma = if place > 0 { "," } else { "" };
        let _ = match cell.contains([',', '"', '\n', '\r']) {
            true => write!(line, "{comma}\"{}\"", cell.replace('"', "\"\"")),
            false => write!(line, "{comma}{cell}"),
        };
    }
    line + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_agrees_with_the_examples_of_rfc_4648() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xfb, 0xff]), "+/8=");
    }

    #[test]
    fn text_cannot_become_markup() {
        assert_eq!(element("td", "<b a=\"1\"> & c"), "<td>&lt;b a=&quot;1&quot;&gt; &amp; c</td>");
        assert_eq!(around("p", "class=\"a\"", "<b></b>"), "<p class=\"a\"><b></b></p>");
    }

    #[test]
    fn cells_with_commas_are_quoted() {
        let cells = ["a", "b, c", "d \"e\"", ""].map(str::to_owned);
        assert_eq!(csv_line(&cells), "a,\"b, c\",\"d \"\"e\"\"\",\n");
    }
}
