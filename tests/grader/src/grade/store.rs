//! Stores the grades of a class in an SQLite database beside the reports. Each grade is written in one transaction when it
//! is complete, so a killed run loses only the submissions that were in progress.

use super::result::{Class, Graded, Session};
use anyhow::{Context, Result, bail, ensure};
use nix::fcntl::{Flock, FlockArg};
use rusqlite::{Connection, OptionalExtension, params};
use std::fs::{self, File};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The name of the database in the folder of results.
pub const FILE: &str = "grades.sqlite";

/// The file that a grader locks while it writes grades. The database itself cannot be locked in this way: closing a second
/// handle of it would drop the locks of SQLite.
const LOCK: &str = "grades.lock";

const TABLES: &str = "
    CREATE TABLE IF NOT EXISTS session (id INTEGER PRIMARY KEY CHECK (id = 0), json TEXT NOT NULL);
    CREATE TABLE IF NOT EXISTS graded (
        student TEXT PRIMARY KEY,
        content TEXT NOT NULL,
        json TEXT NOT NULL
    );";

/// The grades of a class.
pub struct Store {
    connection: Mutex<Connection>,
    /// Kept until the store is dropped, if this process may write grades.
    _lock: Option<Flock<File>>,
}

impl Store {
    /// Opens or creates the database in `folder` to write grades. Returns an error if another process is writing.
    pub fn claim(folder: &Path) -> Result<Store> {
        let path = folder.join(LOCK);
        let file = fs::OpenOptions::new().create(true).append(true).open(&path);
        let file = file.with_context(|| format!("cannot write {}", path.display()))?;
        let Ok(lock) = Flock::lock(file, FlockArg::LockExclusiveNonblock) else {
            bail!(
                "another grader is writing to {}: wait until it is done, or choose another folder",
                folder.display()
            )
        };
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
        make()
            .with_context(|| format!("{} is not a grade database; choose another folder", path.display()))?;
        Ok(Store { connection: Mutex::new(connection), _lock: None })
    }

    /// Returns the session, if grading was begun.
    pub fn session(&self) -> Result<Option<Session>> {
        let json: Option<String> =
            self.lock().query_row("SELECT json FROM session", [], |row| row.get(0)).optional()?;
        json.map(|json| serde_json::from_str(&json).context("the session is from another version"))
            .transpose()
    }

    /// Stores the session. Returns an error if the stored grades were made in another way, and leaves them as they are.
    pub fn begin(&self, session: &Session) -> Result<()> {
        if let Some(begun) = self.session()? {
            ensure!(
                begun.same_grades(session),
                "the grades there were made in another way ({}) than asked for now ({}){}; choose another folder, or use \
                 the same kit and options",
                begun.words(),
                session.words(),
                if begun.seed == session.seed { "" } else { ", with another --seed" }
            );
        }
        let json = serde_json::to_string(session)?;
        self.lock().execute("INSERT OR REPLACE INTO session (id, json) VALUES (0, ?1)", [json])?;
        Ok(())
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
        self.lock().execute(
            "INSERT OR REPLACE INTO graded (student, content, json) VALUES (?1, ?2, ?3)",
            params![graded.student, graded.content, json],
        )?;
        Ok(())
    }

    /// Returns the graded students that are not among `students`.
    pub fn others(&self, students: &[&str]) -> Result<Vec<String>> {
        Ok(self.names()?.into_iter().filter(|name| !students.contains(&name.as_str())).collect())
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
        let connection = self.lock();
        let mut statement = connection.prepare("SELECT json FROM graded ORDER BY student")?;
        let rows = statement.query_map([], |row| row.get::<_, String>(0))?;
        let students = rows.map(|json| Ok(serde_json::from_str(&json?)?)).collect::<Result<_>>()?;
        Ok(Class { session, students })
    }

    /// Adds the grades of another part of the class. Returns an error if it was graded with another kit, other stages or
    /// another seed, or if a student is in both.
    pub fn take_over(&self, other: &Class, from: &Path) -> Result<()> {
        match self.session()? {
            None => self.begin(&other.session)?,
            Some(session) if session.same_grades(&other.session) => {}
            Some(session) => bail!(
                "{} was graded in another way ({}) than the other parts ({}): all parts need the same kit, stages and --seed",
                from.display(),
                other.session.words(),
                session.words()
            ),
        }
        // Copy the grades. A student may be in only one part.
        let names = self.names()?;
        for graded in &other.students {
            ensure!(
                !names.contains(&graded.student),
                "{} is graded twice, here and in {}: remove one of them",
                graded.student,
                from.display()
            );
            self.keep(graded)?;
        }
        Ok(())
    }

    fn lock(&self) -> MutexGuard<'_, Connection> {
        self.connection.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Session {
    /// Returns whether a submission gets the same grade in both sessions.
    fn same_grades(&self, other: &Session) -> bool {
        (&self.kit, &self.stages, self.seed) == (&other.kit, &other.stages, other.seed)
    }

    /// Describes the stages and the kit, on which grades depend. The seed stays secret.
    fn words(&self) -> String {
        let stages: Vec<String> = self.stages.iter().map(u8::to_string).collect();
        format!("stages {}, kit {}", stages.join(", "), self.kit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn session(seed: u64) -> Session {
        Session { kit: "1".into(), stages: vec![1], seed, isolation: String::new() }
    }

    fn graded(student: &str, content: &str) -> Graded {
        Graded {
            student: student.into(),
            content: content.into(),
            checks: Vec::new(),
            remarks: Vec::new(),
            compiler: String::new(),
            trouble: String::new(),
            cpu_ms: 0,
        }
    }

    #[test]
    fn stored_grades_survive_a_crash_another_class_and_other_options() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store::open(folder.path()).unwrap();
        store.begin(&session(7)).unwrap();
        store.keep(&graded("ann", "x")).unwrap();
        // Leave the database open, as a killed process does.
        std::mem::forget(store);
        let store = Store::open(folder.path()).unwrap();
        store.begin(&session(7)).unwrap();
        assert!(store.known("ann", "x").unwrap().is_some());
        assert!(store.known("ann", "y").unwrap().is_none());
        // Another class, and other options, change nothing.
        assert_eq!(store.others(&["bob"]).unwrap(), ["ann"]);
        let error = store.begin(&session(8)).unwrap_err().to_string();
        assert!(error.contains("another --seed"), "{error}");
        let stages = Session { stages: vec![2], ..session(7) };
        assert!(store.begin(&stages).unwrap_err().to_string().contains("stages 1, kit 1"));
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
        let (one, two) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let (store, other) = (Store::open(one.path()).unwrap(), Store::open(two.path()).unwrap());
        other.begin(&session(1)).unwrap();
        other.keep(&graded("ann", "x")).unwrap();
        let part = other.class().unwrap();
        store.take_over(&part, two.path()).unwrap();
        assert_eq!(store.class().unwrap(), part);
        assert!(store.take_over(&part, two.path()).unwrap_err().to_string().contains("is graded twice"));
        let strange = Class { session: session(2), students: Vec::new() };
        assert!(store.take_over(&strange, two.path()).unwrap_err().to_string().contains("another way"));
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
