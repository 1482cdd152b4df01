//! Tables of learning platforms: the grading worksheet of Moodle, the gradebook of Canvas, and lists of names and times. Every
//! cell that is not changed keeps its bytes.

use anyhow::{Context, Result, anyhow, bail};
use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use unicode_normalization::UnicodeNormalization;

/// What a column holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Column {
    /// The platform's number of a student, at the end of the cell: `Participant 123`.
    Identifier,
    /// The whole name, also as `Last, First`.
    Name,
    /// The first name.
    FirstName,
    /// The last name.
    LastName,
    /// An address, or a number or name by which the institution knows the student.
    Login,
    /// When a submission was handed in.
    HandedIn,
    /// The points.
    Points,
    /// The most points that the platform accepts.
    MostPoints,
    /// Text for the student.
    Feedback,
}

/// The headers of the platforms in English and German, folded.
const HEADERS: [(Column, &[&str]); 11] = [
    (Column::Identifier, &["identifier", "id"]),
    (Column::Name, &["full name", "student", "name", "vollständiger name"]),
    (Column::FirstName, &["first name", "vorname"]),
    (Column::LastName, &["last name", "surname", "nachname"]),
    (Column::Login, &["email address", "email", "username", "id number"]),
    (Column::Login, &["e-mail-adresse", "anmeldename", "matrikelnummer"]),
    (Column::Login, &["sis user id", "sis login id"]),
    (Column::HandedIn, &["last modified (submission)", "zuletzt geändert (abgabe)", "handed_in", "time"]),
    (Column::Points, &["grade", "bewertung"]),
    (Column::MostPoints, &["maximum grade", "bestwertung"]),
    (Column::Feedback, &["feedback comments", "feedback als kommentar"]),
];

/// A table with a header, of a text file whose cells are separated by `,`, `;` or tabs. An encoding is recognised by the mark at
/// the start of the file; without one it is UTF-8 or else Windows-1252.
#[derive(Debug)]
pub struct PlatformTable {
    file: PathBuf,
    encoding: &'static Encoding,
    has_mark: bool,
    separator: char,
    /// The header first.
    rows: Vec<Row>,
    /// What each column holds, as far as its header is known.
    kinds: Vec<Option<Column>>,
}

#[derive(Debug, Default)]
struct Row {
    /// The number of its first line, from 1.
    line: usize,
    /// The cells as they stand in the file, with quotation marks.
    cells: Vec<String>,
    /// The end of the line.
    end: String,
}

/// Which student has which row.
#[derive(Debug, Default)]
pub struct Matches {
    /// The index of the row, by student.
    pub rows: BTreeMap<String, usize>,
    /// One line about each student without a row.
    pub students: Vec<String>,
    /// One line about each row without a student.
    pub others: Vec<String>,
}

impl PlatformTable {
    /// Reads a table from a file.
    pub fn read(file: &Path) -> Result<PlatformTable> {
        let bytes = std::fs::read(file).with_context(|| format!("cannot read {}", file.display()))?;
        if bytes.starts_with(b"PK") {
            bail!("{} is a workbook: save it as CSV in the spreadsheet program", file.display());
        }
        PlatformTable::parse(file, &bytes)
    }

    fn parse(file: &Path, bytes: &[u8]) -> Result<PlatformTable> {
        let marked = Encoding::for_bom(bytes).map(|(encoding, _)| encoding);
        let plain = if std::str::from_utf8(bytes).is_ok() { UTF_8 } else { WINDOWS_1252 };
        let encoding = marked.unwrap_or(plain);
        let text = encoding.decode_with_bom_removal(bytes).0;
        // The separator is the most frequent one of the header.
        let header = text.split(['\n', '\r']).next().unwrap_or_default();
        let count = |separator: &char| header.matches(*separator).count();
        let separator = [',', ';', '\t'].into_iter().max_by_key(count).unwrap_or(',');
        let rows = rows(&text, separator).map_err(|why| anyhow!("{}:{why}", file.display()))?;
        let kind = |header: &String| {
            let header = folded(unquoted(header).trim());
            HEADERS.iter().find(|(_, names)| names.contains(&header.as_str())).map(|(kind, _)| *kind)
        };
        let kinds = rows.first().map_or(Vec::new(), |row| row.cells.iter().map(kind).collect());
        let has_mark = marked.is_some();
        Ok(PlatformTable { file: file.to_owned(), encoding, has_mark, separator, rows, kinds })
    }

    /// The table as bytes, in its encoding.
    pub fn bytes(&self) -> Vec<u8> {
        let separator = self.separator.to_string();
        let line = |row: &Row| row.cells.join(&separator) + &row.end;
        let text = if self.has_mark { "\u{feff}" } else { "" }.to_owned();
        let text = text + &self.rows.iter().map(line).collect::<String>();
        match self.encoding {
            utf_16 if utf_16 == UTF_16LE => text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
            utf_16 if utf_16 == UTF_16BE => text.encode_utf16().flat_map(u16::to_be_bytes).collect(),
            encoding => encoding.encode(&text).0.into_owned(),
        }
    }

    /// The place of a row, for messages.
    pub fn place(&self, row: usize) -> String {
        format!("{}:{}", self.file.display(), self.rows[row].line)
    }

    /// The indices of all rows below the header.
    pub fn rows(&self) -> std::ops::Range<usize> {
        1..self.rows.len()
    }

    /// The text of a cell, without quotation marks and spaces around it; empty if the row has no such cell.
    pub fn cell(&self, row: usize, column: usize) -> String {
        self.rows[row].cells.get(column).map_or_else(String::new, |raw| unquoted(raw).trim().to_owned())
    }

    /// Replaces the text of a cell. A row that is too short gets empty cells before it.
    pub fn set(&mut self, row: usize, column: usize, text: &str) {
        let cells = &mut self.rows[row].cells;
        cells.resize(cells.len().max(column + 1), String::new());
        let raw = &mut cells[column];
        let needs_quotes = raw.starts_with('"') || text.contains(['"', '\n', '\r', self.separator]);
        *raw = if needs_quotes { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() };
    }

    /// The texts of the header.
    pub fn headers(&self) -> Vec<String> {
        (0..self.kinds.len()).map(|column| self.cell(0, column)).collect()
    }

    /// The first column that holds this.
    pub fn column(&self, wanted: Column) -> Option<usize> {
        self.columns(wanted).first().copied()
    }

    fn columns(&self, wanted: Column) -> Vec<usize> {
        (0..self.kinds.len()).filter(|&column| self.kinds[column] == Some(wanted)).collect()
    }

    /// Finds the rows of students. The name of a student is that of a folder or an archive, as people or the downloads of
    /// the platforms name it. An identifier decides alone where both sides have one; where two have the same name, a name decides
    /// nothing.
    pub fn find(&self, students: &[&str], is_row: impl Fn(usize) -> bool) -> Matches {
        let rows: Vec<usize> = self.rows().filter(|&row| is_row(row)).collect();
        let keys: Vec<[BTreeSet<String>; 2]> = rows.iter().map(|&row| self.keys(row)).collect();
        let of_students: Vec<[BTreeSet<String>; 2]> =
            students.iter().map(|student| keys_of(student)).collect();
        let mut found: Vec<Vec<usize>> = vec![Vec::new(); students.len()];
        for strength in 0..2 {
            let mut by_key: HashMap<&str, Vec<usize>> = HashMap::new();
            for (index, keys) in keys.iter().enumerate() {
                keys[strength].iter().for_each(|key| by_key.entry(key).or_default().push(index));
            }
            let by_number = strength == 1 && self.column(Column::Identifier).is_some();
            for (found, keys) in found.iter_mut().zip(&of_students) {
                if !found.is_empty() || by_number && has_number(&keys[0]) {
                    continue;
                }
                let rows = keys[strength].iter().filter_map(|key| by_key.get(key.as_str())).flatten();
                *found = rows.copied().collect::<BTreeSet<_>>().into_iter().collect();
            }
        }
        let mut claims: BTreeMap<usize, usize> = BTreeMap::new();
        found
            .iter()
            .filter(|found| found.len() == 1)
            .for_each(|found| *claims.entry(found[0]).or_default() += 1);
        let mut matches = Matches::default();
        for (student, found) in students.iter().zip(&found) {
            let why = match found[..] {
                [row] if claims[&row] == 1 => {
                    matches.rows.insert((*student).to_owned(), rows[row]);
                    continue;
                }
                [row] => format!("another submission belongs to {} as well", self.place(rows[row])),
                [] => "no row has this name or identifier".to_owned(),
                [first, second, ..] => format!(
                    "{} and {} have this name: put the identifier into the name of the submission",
                    self.place(rows[first]),
                    self.place(rows[second])
                ),
            };
            matches.students.push(format!("{student}: {why}"));
        }
        let taken: BTreeSet<usize> = matches.rows.values().copied().collect();
        // The columns that say who a student is: the first one, if no header is known.
        let kinds = [Column::Name, Column::FirstName, Column::LastName, Column::Identifier, Column::Login];
        let mut names: Vec<usize> = kinds.into_iter().flat_map(|kind| self.columns(kind)).collect();
        if names.is_empty() {
            names.push(0);
        }
        for &row in rows.iter().filter(|row| !taken.contains(row)) {
            let cells = names.iter().map(|&column| self.cell(row, column)).filter(|cell| !cell.is_empty());
            let who = cells.take(3).collect::<Vec<_>>().join(", ");
            matches.others.push(format!("{}: {who}: no submission", self.place(row)));
        }
        matches
    }

    /// The folded identifiers and the folded names of a row.
    fn keys(&self, row: usize) -> [BTreeSet<String>; 2] {
        let texts = |kind| {
            self.columns(kind).into_iter().map(|column| folded(&self.cell(row, column))).collect::<Vec<_>>()
        };
        let mut strong = BTreeSet::new();
        for text in texts(Column::Identifier) {
            strong.insert(format!("#{}", number_of(&text)));
            strong.insert(text);
        }
        for text in texts(Column::Login) {
            strong.extend(text.split_once('@').map(|(local, _)| local.to_owned()));
            strong.insert(text);
        }
        let mut weak: BTreeSet<String> = BTreeSet::new();
        let names = if strong.is_empty() && texts(Column::Name).is_empty() {
            vec![folded(&self.cell(row, 0))]
        } else {
            texts(Column::Name)
        };
        for name in names {
            weak.extend(name.split_once(", ").map(|(last, first)| format!("{first} {last}")));
            weak.insert(name);
        }
        for (first, last) in texts(Column::FirstName).iter().zip(texts(Column::LastName)) {
            weak.insert(format!("{first} {last}"));
        }
        strong.retain(|key| !key.is_empty() && key != "#");
        weak.retain(|key| !key.is_empty());
        [strong, weak]
    }
}

/// The identifiers and the names that a student's name may mean: `Ann Lee_123_assignsubmission_file_` of Moodle,
/// `leeann_123_456_kit` and `leeann_LATE_123_456_kit` of Canvas, or any other name for itself.
fn keys_of(student: &str) -> [BTreeSet<String>; 2] {
    let name = folded(student);
    let (mut strong, mut weak) = (BTreeSet::from([name.clone()]), BTreeSet::from([name.clone()]));
    let parts: Vec<&str> = name.split('_').filter(|part| *part != "late").collect();
    let is_number = |part: &&str| !part.is_empty() && part.chars().all(|c| c.is_ascii_digit());
    if let [name, number, ref rest @ ..] = parts[..]
        && is_number(&number)
        && rest.first().is_some_and(|next| *next == "assignsubmission" || is_number(next))
    {
        strong.insert(format!("#{number}"));
        weak.insert(name.to_owned());
    }
    [strong, weak]
}

/// Whether a submission has the platform's number in its name, as in its downloads.
pub fn numbered(student: &str) -> bool {
    has_number(&keys_of(student)[0])
}

fn has_number(identifiers: &BTreeSet<String>) -> bool {
    identifiers.iter().any(|key| key.starts_with('#'))
}

/// The digits at the end of an identifier: `123` of `Participant 123`; empty if there are none.
pub fn number_of(identifier: &str) -> &str {
    &identifier[identifier.trim_end_matches(|c: char| c.is_ascii_digit()).len()..]
}

/// A text as it is compared: in normal form C, in small letters, with single spaces.
fn folded(text: &str) -> String {
    text.nfc().collect::<String>().to_lowercase().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Divides a text into rows and cells. An error begins with the number of the line.
fn rows(text: &str, separator: char) -> Result<Vec<Row>, String> {
    let (mut rows, mut row, mut cell) = (Vec::new(), Row { line: 1, ..Row::default() }, String::new());
    let (mut line, mut is_quoted) = (1, false);
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        line += usize::from(c == '\n');
        match c {
            // Two quotation marks in a quoted cell stand for one, and close and open it again here.
            '"' if is_quoted || cell.is_empty() || cell.starts_with('"') => {
                is_quoted = !is_quoted;
                cell.push(c);
            }
            '\n' | '\r' if !is_quoted => {
                row.end =
                    if c == '\r' && chars.next_if_eq(&'\n').is_some() { "\r\n".into() } else { c.into() };
                line += usize::from(row.end != "\n");
                row.cells.push(std::mem::take(&mut cell));
                rows.push(std::mem::replace(&mut row, Row { line, ..Row::default() }));
            }
            _ if c == separator && !is_quoted => row.cells.push(std::mem::take(&mut cell)),
            _ => cell.push(c),
        }
    }
    if is_quoted {
        return Err(format!("{}: a quotation mark is open until the end of the file", row.line));
    }
    if !cell.is_empty() || !row.cells.is_empty() {
        row.cells.push(cell);
        rows.push(row);
    }
    Ok(rows)
}

fn unquoted(raw: &str) -> String {
    match raw.strip_prefix('"').and_then(|raw| raw.trim_end().strip_suffix('"')) {
        Some(text) => text.replace("\"\"", "\""),
        None => raw.to_owned(),
    }
}

/// A date of a platform as TOML writes it: `Monday, 2 November 2026, 6:30 PM` and `Montag, 2. November 2026, 18:30` of Moodle,
/// `02.11.2026 18:30`, or as it is. `None` if there is none: the cell is empty or `-`.
pub fn date(text: &str) -> Option<String> {
    // The beginnings of the names in English and German.
    const MONTHS: [&str; 2] = [
        "jan feb mar apr may jun jul aug sep oct nov dec",
        "jän feb mär apr mai jun jul aug sep okt nov dez",
    ];
    let text = text.trim();
    if text.is_empty() || text == "-" {
        return None;
    }
    let folded = folded(text);
    let words: Vec<&str> = folded.split([' ', ',', '.']).filter(|word| !word.is_empty()).collect();
    let number = |word: &str| word.parse::<u32>().ok();
    let month = |word: &str| {
        let among = |names: &str| names.split(' ').position(|name| word.starts_with(name));
        let named = MONTHS.iter().find_map(|names| among(names));
        number(word).or(named.map(|month| month as u32 + 1))
    };
    // A day, a month and a year side by side.
    let triple = words.windows(3).find_map(|three| {
        let (day, month, year) = (number(three[0])?, month(three[1])?, number(three[2])?);
        (year >= 1000).then_some((day, month, year))
    });
    let Some((day, month, year)) = triple else { return Some(text.to_owned()) };
    let clock = words.iter().find_map(|word| word.split_once(':'));
    let Some((hour, rest)) = clock else { return Some(format!("{year:04}-{month:02}-{day:02}")) };
    let hour = match (number(hour), words.contains(&"pm"), words.contains(&"am")) {
        (Some(hour), true, _) if hour < 12 => hour + 12,
        (Some(12), _, true) => 0,
        (Some(hour), ..) => hour,
        (None, ..) => return Some(text.to_owned()),
    };
    let rest = if rest.contains(':') { rest.to_owned() } else { format!("{rest}:00") };
    Some(format!("{year:04}-{month:02}-{day:02}T{hour:02}:{rest}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(bytes: &[u8]) -> PlatformTable {
        PlatformTable::parse(Path::new("table.csv"), bytes).unwrap()
    }

    #[test]
    fn what_is_not_changed_keeps_its_bytes_in_every_encoding() {
        let text = "Identifier;\"Full name\";Grade\r\nParticipant 1;\"Lee; \"\"Ann\"\"\r\nM.\";\r\nParticipant 2;Böll;\"7,5\"";
        let encodings: [fn(&str) -> Vec<u8>; 4] = [
            |text| text.as_bytes().to_vec(),
            |text| format!("\u{feff}{text}").into_bytes(),
            |text| format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect(),
            |text| WINDOWS_1252.encode(text).0.into_owned(),
        ];
        for encoded in encodings {
            let mut table = table(&encoded(text));
            assert_eq!(table.bytes(), encoded(text));
            assert_eq!(table.cell(1, 1), "Lee; \"Ann\"\r\nM.");
            assert_eq!((table.place(2).as_str(), table.cell(2, 1).as_str()), ("table.csv:4", "Böll"));
            table.set(1, 2, "3,5");
            table.set(2, 2, "9");
            let expected = text.replace("M.\";", "M.\";3,5").replace("7,5", "9");
            assert_eq!(table.bytes(), encoded(&expected));
        }
        let error = PlatformTable::parse(Path::new("t.csv"), b"a,b\n\"c,d\n").unwrap_err().to_string();
        assert_eq!(error, "t.csv:2: a quotation mark is open until the end of the file");
    }

    #[test]
    fn students_are_found_by_identifier_or_name_and_the_others_are_listed() {
        let moodle = "Identifier,\"Full name\",\"Email address\",Grade\n\
                      Participant 11,\"Ann Lee\",ann@uni.edu,\n\
                      Participant 12,\"Ann Lee\",lee2@uni.edu,\n\
                      Participant 13,\"Zoë Böll\",zoe@uni.edu,\n\
                      Participant 14,\"Tom Fox\",tom@uni.edu,\n";
        let table = table(moodle.as_bytes());
        let find = |students: &[&str]| table.find(students, |_| true);
        // The name of Zoë in normal form D, as a Mac writes it.
        let found = find(&["Ann Lee_12_assignsubmission_file_", "Zoe\u{308} Bo\u{308}ll", "tom"]);
        assert_eq!(found.rows.values().collect::<Vec<_>>(), [&2, &3, &4]);
        assert_eq!(found.others, ["table.csv:2: Ann Lee, Participant 11, ann@uni.edu: no submission"]);
        let found = find(&[
            "Ann Lee",
            "zoe",
            "zoe boll_13_assignsubmission_file_",
            "eve",
            "Tom Fox_99_assignsubmission",
        ]);
        // Another student of the same name has number 99.
        assert!(found.rows.is_empty());
        assert!(
            found.students[0].starts_with("Ann Lee: table.csv:2 and table.csv:3 have this name: put the")
        );
        assert_eq!(found.students[1], "zoe: another submission belongs to table.csv:4 as well");
        assert_eq!(found.students[3], "eve: no row has this name or identifier");
        let canvas = PlatformTable::parse(
            Path::new("c.csv"),
            b"Student,ID,SIS Login ID,Section\n\"Lee, Ann\",11,lee1,A\n\"Fox, Tom\",14,tom,A\n",
        )
        .unwrap();
        let found = canvas.find(&["foxtom_LATE_14_900_kit", "Ann Lee"], |_| true);
        assert_eq!(found.rows.values().collect::<Vec<_>>(), [&1, &2]);
    }

    #[test]
    fn dates_of_platforms_are_read() {
        for (text, expected) in [
            ("Monday, 2 November 2026, 6:30 PM", "2026-11-02T18:30:00"),
            ("Tuesday, 3 November 2026, 12:05 AM", "2026-11-03T00:05:00"),
            ("Dienstag, 3. März 2026, 10:37", "2026-03-03T10:37:00"),
            ("02.11.2026 18:30", "2026-11-02T18:30:00"),
            ("2.11.2026, 08:30:15 Uhr", "2026-11-02T08:30:15"),
            ("2026-11-02T18:30:00+01:00", "2026-11-02T18:30:00+01:00"),
            ("sometime", "sometime"),
        ] {
            assert_eq!(date(text).as_deref(), Some(expected));
        }
        assert_eq!((date("-"), date(" ")), (None, None));
    }
}
