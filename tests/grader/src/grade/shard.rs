//! Parts of a class: `grade --shard 2/8` grades one of them, and `grader merge` refuses a class of which a part is missing.

use super::submission::Submission;
use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// A part of a class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Its number, from 1.
    pub index: u64,
    /// The number of parts.
    pub of: u64,
}

/// Reads a part such as `2/8`.
pub fn shard(text: &str) -> Result<Shard> {
    let (index, of) = text.split_once('/').with_context(|| format!("`{text}` is not like 2/8"))?;
    let shard = Shard { index: index.parse()?, of: of.parse()? };
    ensure!((1..=shard.of).contains(&shard.index), "parts are counted from 1: 1/{of} to {of}/{of}");
    Ok(shard)
}

impl Shard {
    /// Returns whether a student belongs to this part. This depends only on the name, so that all machines agree even if
    /// their folders differ.
    pub fn holds(self, student: &str) -> bool {
        let hash = Sha256::digest(student);
        let number = hash[..8].iter().fold(0u64, |number, byte| number << 8 | u64::from(*byte));
        number % self.of == self.index - 1
    }
}

/// What a run with `--shard` stores beside its grades, so that a merge notices what is missing.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Part {
    /// Which part of the class it is.
    pub shard: Shard,
    /// The number of submissions of the whole class, as this run has found them.
    pub submissions: usize,
    /// A fingerprint of the names of all submissions.
    pub class: String,
    /// Whether all submissions of the part are graded.
    pub finished: bool,
}

impl Part {
    /// The part `shard` of a class, before it is graded.
    pub(super) fn of(shard: Shard, class: &[Submission]) -> Part {
        let mut names = Sha256::new();
        class.iter().for_each(|one| names.update(format!("{}\0", one.student)));
        let class_name = super::worker_builder::hex(&names.finalize())[..16].to_owned();
        Part { shard, submissions: class.len(), class: class_name, finished: false }
    }
}

/// Returns what is wrong with the parts that are given by the names of their folders: parts that are missing, that are not
/// finished, that were given twice, or that are of another class. Empty if they are complete.
pub(super) fn faults(parts: &[(String, Part)]) -> Vec<String> {
    let Some((first_name, first)) = parts.first() else { return Vec::new() };
    let mut faults = Vec::new();
    let of = first.shard.of;
    let mut found: BTreeMap<u64, &str> = BTreeMap::new();
    for (name, part) in parts {
        let Shard { index, of: theirs } = part.shard;
        if theirs != of {
            faults.push(format!("{name} is part {index} of {theirs}, but {first_name} is one of {of} parts"));
            continue;
        }
        if let Some(other) = found.insert(index, name) {
            faults.push(format!("part {index} of {of} is in {other} and in {name}: leave one of them out"));
        }
        if !part.finished {
            faults.push(format!("part {index} of {of} is not finished: {name}"));
        }
        if part.class != first.class {
            faults.push(format!(
                "{name} was graded when the class had {} submissions, and {first_name} when it had {} or others",
                part.submissions, first.submissions
            ));
        }
    }
    let missing: Vec<String> = missing(of, found.keys().copied()).collect();
    match &missing[..] {
        [] => {}
        [only] => faults.push(format!("part {only} of {of} is missing")),
        several => faults.push(format!("parts {} of {of} are missing", several.join(", "))),
    }
    faults
}

/// Returns the numbers from 1 to `of` that are not in `found`, which is sorted. Neighbours are joined to a range, such as `3-5`.
fn missing(of: u64, found: impl Iterator<Item = u64>) -> impl Iterator<Item = String> {
    let mut next = 1;
    let ends = found.chain([of + 1]).map(move |end| std::mem::replace(&mut next, end + 1)..end);
    ends.filter(|gap| !gap.is_empty()).map(|gap| match gap.end - gap.start {
        1 => gap.start.to_string(),
        _ => format!("{}-{}", gap.start, gap.end - 1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_read_as_people_write_them() {
        assert_eq!(shard("2/8").unwrap(), Shard { index: 2, of: 8 });
        for wrong in ["0/8", "9/8", "2", "a/b", "1/0"] {
            assert!(shard(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_student_is_in_one_part() {
        for student in ["ann", "bob", "c d", "é"] {
            let parts = (1..=7).filter(|&index| Shard { index, of: 7 }.holds(student)).count();
            assert_eq!(parts, 1, "{student}");
        }
    }

    fn part(index: u64, of: u64) -> (String, Part) {
        let class = "c".to_owned();
        (format!("p{index}"), Part { shard: Shard { index, of }, submissions: 9, class, finished: true })
    }

    #[test]
    fn missing_parts_are_named() {
        assert_eq!(faults(&[]), [""; 0]);
        assert_eq!(faults(&[part(2, 3), part(1, 3), part(3, 3)]), [""; 0]);
        assert_eq!(faults(&[part(2, 2)]), ["part 1 of 2 is missing"]);
        assert_eq!(faults(&[part(3, 9), part(8, 9)]), ["parts 1-2, 4-7, 9 of 9 are missing"]);
    }

    #[test]
    fn parts_that_do_not_fit_are_named() {
        let (mut unfinished, mut other) = (part(2, 2), part(2, 2));
        unfinished.1.finished = false;
        assert_eq!(faults(&[part(1, 2), unfinished]), ["part 2 of 2 is not finished: p2"]);
        (other.1.class, other.1.submissions) = ("d".into(), 10);
        let words = faults(&[part(1, 2), other]).concat();
        assert!(
            words.contains("p2 was graded when the class had 10 submissions, and p1 when it had 9"),
            "{words}"
        );
        assert_eq!(
            faults(&[part(1, 2), part(2, 2), ("again".into(), part(1, 2).1)]),
            ["part 1 of 2 is in p1 and in again: leave one of them out"]
        );
        assert_eq!(
            faults(&[part(1, 2), part(2, 2), part(3, 8)]),
            ["p3 is part 3 of 8, but p1 is one of 2 parts"]
        );
    }
}
