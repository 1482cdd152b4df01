//! Stores the grades of a class in an SQLite database beside the reports. Each grade is written in one transaction when it
//! is complete, so a killed run loses only the submissions that were in progress.

use super::report::clean::clean_line;
use super::result::{Class, Graded, Note, Session};
use super::shard::Part;
use crate::course::CourseFiles;
use crate::platform::PlatformTable;
use crate::queue::lock;
use anyhow::{Context, Result, anyhow, bail, ensure};
use raykata_cli::lock::Lock;
use rusqlite::{Connection, OptionalExtension, params};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::{BTreeMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard};

/// The name of the database in the folder of results.
pub const FILE: &str = "grades.sqlite";

/// The table of the instructor in the folder of results: students, points that are added, and notes.
pub const NOTES: &str = "notes.csv";

/// The file that a grader locks while it writes grades. The database itself cannot be locked in this way: closing a second
/// handle of it would drop the locks of SQLite.
const LOCK: &str = "grades.lock";

const TABLES: &str = "
    CREATE TABLE IF NOT EXISTS session (id INTEGER PRIMARY KEY CHECK (id = 0), json TEXT NOT NULL);
    CREATE TABLE IF NOT EXISTS graded (
        student TEXT PRIMARY KEY,
        content TEXT NOT NULL,
        json TEXT NOT NULL
    );
    CREATE TABLE IF NOT EXISTS course (id INTEGER PRIMARY KEY CHECK (id = 0), json TEXT NOT NULL);
    CREATE TABLE IF NOT EXISTS part (id INTEGER PRIMARY KEY CHECK (id = 0), json TEXT NOT NULL);";

/// The grades of a class.
pub struct Store {
    connection: Mutex<Connection>,
    /// The path of the database, for errors.
    file: PathBuf,
    /// Kept until the store is dropped, if this process may write grades.
    _lock: Option<Lock>,
}

impl Store {
    /// Opens or creates the database in `folder` to write grades. Returns an error if another process is writing.
    pub fn claim(folder: &Path) -> Result<Store> {
        let lock = Lock::file(&folder.join(LOCK), || {
            format!(
                "another grader is writing to {}: wait until it is done, or choose another folder",
                folder.display()
            )
        })?;
        Ok(Store { _lock: Some(lock), ..Store::open(folder)? })
    }

    /// Opens or creates the database in `folder`.
    pub fn open(folder: &Path) -> Result<Store> {
        let path = folder.join(FILE);
        let connection =
            Connection::open(&path).with_context(|| format!("cannot open {}", path.display()))?;
        let make = || {
            connection.pragma_update(None, "journal_mode", "wal")?;
            connection.pragma_update(None, "synchronous", "full")?;
            connection.busy_timeout(std::time::Duration::from_secs(10))?;
            connection.execute_batch(TABLES)
        };
        make().map_err(|error| {
            let is_full = error.sqlite_error_code() == Some(rusqlite::ErrorCode::DiskFull);
            let what =
                if is_full { "cannot be written" } else { "is not a grade database; choose another folder" };
            anyhow!(error).context(format!("{} {what}", path.display()))
        })?;
        Ok(Store { connection: Mutex::new(connection), file: path, _lock: None })
    }

    /// Returns the session, if grading was begun.
    pub fn session(&self) -> Result<Option<Session>> {
        self.one("session")
    }

    /// Stores the session. Another course file or fewer stages change what stored outcomes count. Returns an error if outcomes
    /// were made in another way, and leaves them as they are.
    pub fn begin(&self, mut session: Session) -> Result<()> {
        if let Some(begun) = self.session()? {
            let mut graded = begun.graded();
            ensure!(
                (&begun.kit, begun.seed) == (&session.kit, session.seed)
                    && session.stages.iter().all(|stage| graded.remove(stage)),
                "the grades there were made in another way ({}) than asked for now ({}){}; choose another folder, or use \
                 the same kit, stages and options",
                begun.words(),
                session.words(),
                if begun.seed == session.seed { "" } else { ", with another --seed" }
            );
            session.dropped = graded.into_iter().collect();
        }
        self.keep_one("session", &session)
    }

    /// Returns the course file with which the grades were made.
    pub fn course(&self) -> Result<Option<CourseFiles>> {
        self.one("course")
    }

    /// Stores the course file, so that later runs and merges need not be given it again.
    pub fn keep_course(&self, course: Option<&CourseFiles>) -> Result<()> {
        course.map_or(Ok(()), |course| self.keep_one("course", course))
    }

    /// Returns the stored grade of a submission, if its content is unchanged.
    pub fn known(&self, student: &str, content: &str) -> Result<Option<Graded>> {
        let json: Option<String> = self
            .lock()
            .query_row(
                "SELECT json FROM graded WHERE student = ?1 AND content = ?2",
                [student, content],
                |row| row.get(0),
            )
            .optional()?;
        json.map(|json| serde_json::from_str(&json).context("a grade is from another version")).transpose()
    }

    /// Stores a grade durably.
    pub fn keep(&self, graded: &Graded) -> Result<()> {
        let json = serde_json::to_string(graded)?;
        let stored = self.lock().execute(
            "INSERT OR REPLACE INTO graded (student, content, json) VALUES (?1, ?2, ?3)",
            params![graded.student, graded.content, json],
        );
        let student = clean_line(&graded.student, 80);
        stored.map(drop).with_context(|| {
            format!(
                "cannot store the grade of {student} in {}: the grades before it are stored, and `--resume` continues there",
                self.file.display()
            )
        })
    }

    /// Returns the graded students that are not among `students`.
    pub fn others(&self, students: &[&str]) -> Result<Vec<String>> {
        let students: HashSet<&str> = students.iter().copied().collect();
        Ok(self.names()?.into_iter().filter(|name| !students.contains(name.as_str())).collect())
    }

    /// Deletes the grade of a student.
    pub fn forget(&self, student: &str) -> Result<()> {
        self.lock().execute("DELETE FROM graded WHERE student = ?1", [student])?;
        Ok(())
    }

    fn names(&self) -> Result<Vec<String>> {
        let connection = self.lock();
        let mut statement = connection.prepare("SELECT student FROM graded ORDER BY student")?;
        let names = statement.query_map([], |row| row.get(0))?;
        Ok(names.collect::<rusqlite::Result<_>>()?)
    }

    /// Returns the session and all grades.
    pub fn class(&self) -> Result<Class> {
        let session = self.session()?.context("nothing has been graded here yet")?;
        let mut students = Vec::new();
        self.each(&mut |graded| {
            students.push(graded);
            Ok(())
        })?;
        Ok(Class { session, students })
    }

    /// The points and notes of the instructor by student, and the rows that belong to no student. The file is the
    /// instructor's: no run writes to it.
    pub fn notes(&self) -> Result<(BTreeMap<String, Note>, Vec<String>)> {
        let file = self.file.with_file_name(NOTES);
        if !file.exists() {
            return Ok(Default::default());
        }
        let table = PlatformTable::read(&file)?;
        let names = self.names()?;
        let found = table.find(&names.iter().map(String::as_str).collect::<Vec<_>>(), |_| true);
        let note = |(student, row): (String, usize)| {
            let [points, text] = [1, 2].map(|column| table.cell(row, column));
            let points = if points.is_empty() { Ok(0) } else { points.parse() };
            let points = points.map_err(|_| {
                anyhow!("{}: `{}` is not a whole number of points", table.place(row), table.cell(row, 1))
            })?;
            Ok((student, Note { points, text }))
        };
        Ok((found.rows.into_iter().map(note).collect::<Result<_>>()?, found.others))
    }

    /// Calls `each` with one grade after the other, sorted by the names of the students, with the stages that count, their points
    /// and the instructor's. Only one grade is in memory at a time.
    pub fn each(&self, each: &mut dyn FnMut(Graded) -> Result<()>) -> Result<()> {
        let stages = self.session()?.unwrap_or_default().stages;
        let mut notes = self.notes()?.0;
        let connection = self.lock();
        let mut statement = connection.prepare("SELECT json FROM graded ORDER BY student")?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let json: String = row.get(0)?;
            let graded: Graded = serde_json::from_str(&json).context("a grade is from another version")?;
            let note = notes.remove(&graded.student);
            each(Graded { note, ..graded.valued(&stages) })?;
        }
        Ok(())
    }

    /// Returns which part of a class is graded here; `None` if it is the whole class.
    pub fn part(&self) -> Result<Option<Part>> {
        self.one("part")
    }

    /// Stores which part of the class a run begins to grade. Returns an error if grades of another part are stored.
    pub fn begin_part(&self, part: Option<&Part>) -> Result<()> {
        let (begun, is_empty) = (self.part()?, self.names()?.is_empty());
        match (&begun, part) {
            (Some(begun), Some(part)) if begun.shard == part.shard => {}
            (None, None) => return Ok(()),
            (None, Some(_)) if is_empty => {}
            _ => bail!(
                "the grades there are of {}, and {} is to be graded now: choose another folder",
                words(begun.as_ref()),
                words(part)
            ),
        }
        self.keep_one("part", &part)
    }

    /// Stores that all submissions of the part are graded.
    pub fn finish_part(&self) -> Result<()> {
        if let Some(part) = self.part()? {
            self.keep_one("part", &Part { finished: true, ..part })?;
        }
        Ok(())
    }

    /// Copies the grades from the folders of all parts of a class into this empty store. Returns an error if they were graded
    /// with different kits, stages or seeds, or if a student is in two of them. The session is stored last, so a merge that was
    /// interrupted leaves no grades that count.
    pub fn take_over(&self, parts: &[PathBuf]) -> Result<()> {
        self.lock().execute("DELETE FROM graded", [])?;
        let mut known: Option<Session> = None;
        for folder in parts {
            let theirs = Store::open(folder)?.session()?;
            let theirs = theirs.with_context(|| format!("{} contains no grades", folder.display()))?;
            let session = known.get_or_insert_with(|| theirs.clone());
            ensure!(
                session.same_grades(&theirs),
                "{} was graded in another way ({}) than the other parts ({}): all parts need the same kit, course file, stages and --seed",
                folder.display(),
                theirs.words(),
                session.words()
            );
            ensure!(
                session.due == theirs.due,
                "{} has other dates than the other parts: `grader grade … --resume --course FILE` with the new dates takes them \
                 over, and grades nothing again",
                folder.display()
            );
            self.copy_from(folder)?;
        }
        self.begin(known.context("there are no parts")?)
    }

    /// Copies all grades of the store in `folder` in one transaction.
    fn copy_from(&self, folder: &Path) -> Result<()> {
        let file = folder.join(FILE);
        let file = file.to_str().with_context(|| format!("{} is not UTF-8: rename it", folder.display()))?;
        let mut connection = self.lock();
        connection.execute("ATTACH ?1 AS other", [file])?;
        let copied = copy_from_other(&mut connection);
        connection.execute("DETACH other", [])?;
        match copied? {
            Some(student) => {
                bail!("{student} is graded twice, here and in {}: remove one of them", folder.display())
            }
            None => Ok(()),
        }
    }

    /// Returns the value in a table that holds at most one.
    fn one<T: DeserializeOwned>(&self, table: &str) -> Result<Option<T>> {
        let select = format!("SELECT json FROM {table}");
        let json: Option<String> = self.lock().query_row(&select, [], |row| row.get(0)).optional()?;
        let read = |json: String| {
            serde_json::from_str(&json).with_context(|| format!("the {table} is from another version"))
        };
        json.map(read).transpose()
    }

    /// Stores the value of such a table.
    fn keep_one(&self, table: &str, value: &impl Serialize) -> Result<()> {
        let insert = format!("INSERT OR REPLACE INTO {table} (id, json) VALUES (0, ?1)");
        self.lock().execute(&insert, [serde_json::to_string(value)?])?;
        Ok(())
    }

    fn lock(&self) -> MutexGuard<'_, Connection> {
        lock(&self.connection)
    }
}

impl Session {
    /// Returns whether a submission gets the same grade in both sessions.
    fn same_grades(&self, other: &Session) -> bool {
        let decide = |session: &Session| {
            (session.kit.clone(), session.course.clone(), session.stages.clone(), session.seed)
        };
        decide(self) == decide(other)
    }

    /// Describes stages, kit and course, on which grades depend. The seed stays secret.
    fn words(&self) -> String {
        let stages: Vec<String> = self.stages.iter().map(u8::to_string).collect();
        let course = if self.course.is_empty() { "none" } else { &self.course };
        format!("stages {}, kit {}, course file: {course}", stages.join(", "), self.kit)
    }
}

/// Copies all grades of the attached database `other`. If one is of a student that has a grade here, copies none and returns the
/// student.
fn copy_from_other(connection: &mut Connection) -> rusqlite::Result<Option<String>> {
    let twice = "SELECT student FROM other.graded INTERSECT SELECT student FROM main.graded";
    let twice: Option<String> = connection.query_row(twice, [], |row| row.get(0)).optional()?;
    if twice.is_some() {
        return Ok(twice);
    }
    let transaction = connection.transaction()?;
    let copy =
        "INSERT INTO main.graded (student, content, json) SELECT student, content, json FROM other.graded";
    transaction.execute(copy, [])?;
    transaction.commit()?;
    Ok(None)
}

/// Describes a part of a class in messages.
fn words(part: Option<&Part>) -> String {
    part.map_or("the whole class".to_owned(), |part| format!("part {}/{}", part.shard.index, part.shard.of))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grade::shard::Shard;

    fn session(seed: u64) -> Session {
        Session { kit: "1".into(), stages: vec![1], seed, ..Session::default() }
    }

    fn graded(student: &str, content: &str) -> Graded {
        Graded { student: student.into(), content: content.into(), ..Graded::default() }
    }

    #[test]
    fn stored_grades_survive_a_crash_another_class_and_other_options() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).unwrap();
        store.begin(session(7)).unwrap();
        store.keep(&graded("ann", "x")).unwrap();
        // Leave the database open, as a killed process does.
        std::mem::forget(store);
        let store = Store::open(folder.path()).unwrap();
        store.begin(session(7)).unwrap();
        assert!(store.known("ann", "x").unwrap().is_some());
        assert!(store.known("ann", "y").unwrap().is_none());
        // Another class, and other options, change nothing.
        assert_eq!(store.others(&["bob"]).unwrap(), ["ann"]);
        let error = store.begin(session(8)).unwrap_err().to_string();
        assert!(error.contains("another --seed"), "{error}");
        let stages = Session { stages: vec![2], ..session(7) };
        assert!(store.begin(stages).unwrap_err().to_string().contains("stages 1, kit 1"));
        assert!(store.known("ann", "x").unwrap().is_some());
        store.forget("ann").unwrap();
        assert!(store.known("ann", "x").unwrap().is_none());
    }

    #[test]
    fn one_grader_writes_to_a_folder_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::claim(folder.path()).unwrap();
        let error = Store::claim(folder.path()).err().unwrap().to_string();
        assert!(error.contains("another grader is writing"), "{error}");
        assert!(Store::open(folder.path()).is_ok(), "reading is always possible");
        drop(store);
        assert!(Store::claim(folder.path()).is_ok());
    }

    #[test]
    fn parts_of_a_class_fit_together_or_say_why_not() {
        let folders: Vec<_> = (0..4).map(|_| tempfile::tempdir().unwrap()).collect();
        let paths: Vec<PathBuf> = folders.iter().map(|folder| folder.path().to_owned()).collect();
        for (folder, student, seed) in [(1, "ann", 1), (2, "bob", 1), (3, "cat", 2)] {
            let part = Store::open(&paths[folder]).unwrap();
            part.begin(session(seed)).unwrap();
            part.keep(&graded(student, "x")).unwrap();
        }
        let store = Store::open(&paths[0]).unwrap();
        let refused = |parts: &[PathBuf]| store.take_over(parts).unwrap_err().to_string();
        let twice = refused(&[paths[1].clone(), paths[1].clone()]);
        assert!(twice.contains("ann is graded twice"), "{twice}");
        assert!(refused(&paths[1..]).contains("another way"));
        assert!(store.session().unwrap().is_none(), "a merge that failed leaves no grades that count");
        drop(store);
        let store = Store::open(&paths[0]).unwrap();
        store.take_over(&paths[1..3]).unwrap();
        assert_eq!(store.class().unwrap().students, [graded("ann", "x"), graded("bob", "x")]);
    }

    #[test]
    fn a_folder_holds_one_part_of_a_class() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).unwrap();
        store.begin(session(1)).unwrap();
        let part = |index| Part {
            shard: Shard { index, of: 3 },
            submissions: 5,
            class: "c".into(),
            finished: false,
        };
        store.begin_part(Some(&part(2))).unwrap();
        assert_eq!(store.part().unwrap(), Some(part(2)));
        store.finish_part().unwrap();
        assert!(store.part().unwrap().unwrap().finished);
        // A run that begins again is not finished until it ends.
        store.begin_part(Some(&part(2))).unwrap();
        assert!(!store.part().unwrap().unwrap().finished);
        let error = store.begin_part(Some(&part(1))).unwrap_err().to_string();
        assert!(error.contains("are of part 2/3, and part 1/3 is to be graded"), "{error}");
        let error = store.begin_part(None).unwrap_err().to_string();
        assert!(error.contains("the whole class is to be graded"), "{error}");
    }

    #[test]
    fn what_is_no_database_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(FILE), "my notes, which are longer than a header of a database is")
            .unwrap();
        let error = Store::open(folder.path()).err().unwrap();
        assert!(format!("{error:#}").contains("not a grade database"), "{error:#}");
        assert!(std::fs::read_to_string(folder.path().join(FILE)).unwrap().starts_with("my notes"));
    }
}
